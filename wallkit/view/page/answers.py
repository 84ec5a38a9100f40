"""Answers: what the page may ask of the library. Each takes JSON, checks and bounds it, and gives JSON or a file."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from importers.errors import WallkitError
from importers.limits import MAX_COORDINATE
from importers.problems import Problem
from wallkit.scene.opening import OpenedScene, open_scene
from wallkit.scene.samples import shown
from wallkit.scene.scene import Balls, Scene, area_of
from wallkit.scene.wishes import USUAL, Wishes
from wallkit.simulation.run import Ending, Run
from wallkit.simulation.ways import Stepped
from wallkit.simulation.world import Way
from wallkit.view.page import aiming, ways
from wallkit.view.page.documents import Document, Reader
from wallkit.view.page.payload import Table, run_table, starts, walls_table
from wallkit.view.page.questions import Opening
from wallkit.view.page.worlds import SLOWING, CompilingError, Worlds, check_index
from wallkit.walls import Walls
from wallkit.walls.fields import MOST_RESTITUTION
from wallkit.walls.import_options import ImportOptions

MOST_BALLS = 1_000
MOST_CONTACTS = 100_000
"""In one answer, of all balls together."""
INTERPRETED_CONTACTS = 1_000
"""The same, as long as the compiler is at work; a tenth of a second, with gravity one."""
MOST_PROBLEMS = 500
SAVED = ("scene", "replay", "picture", "film", "walls")
FILM_SECONDS = 8.0
MOST_TIME, MOST_MASS = 1e12, 1e100


class QuestionError(WallkitError):
    """The page asked for something that is no question."""


@dataclass(frozen=True, slots=True)
class Download:
    """A file for the person to keep."""

    name: str
    content: str | bytes
    media: str


class Answers:
    """What a worker knows to answer; the server knows nothing of what the questions mean."""

    def __init__(self, reader: Reader) -> None:
        self.reader = reader
        self._worlds, self._other_worlds = Worlds(), Worlds()

    def open(self, file: Opening, watched: bool = False) -> Document:
        """Open a file's bytes; only a file of this machine's own owner may name others, in its folder."""
        wishes = wishes_of(file.importing)
        opened = with_a_ball(open_scene(file.data, wishes, name=file.name, folder=file.folder))
        return Document(file.name, opened, file.importing, folder=file.folder, watched=watched)

    def saved(self, data: bytes, document: Document) -> Document:
        """Open a document's file anew, as it was saved now and imported as before."""
        wishes = wishes_of(document.importing)
        opened = with_a_ball(open_scene(data, wishes, name=document.name, folder=document.folder))
        return document.anew(opened, version=document.version + 1)

    def sample(self, body: Table) -> Document:
        """Open a sample by name."""
        for sample in shown():
            if sample.name == body.get("name"):
                return self.open(Opening(sample.path.read_bytes(), sample.name, sample.path.parent, USUAL))
        raise QuestionError("there is no such sample", code="no-sample", fix="choose one of the gallery")

    def walls(self, body: Table, document: Document) -> Document:
        """Import a document's drawing again, with another tolerance or other curves."""
        if document.opened.drawing is None or document.opened.kind == "scene":
            raise QuestionError("these walls do not come from a drawing", code="no-drawing", fix="open the drawing")
        curves = body.get("curves", "arcs")
        if curves not in ("lines", "arcs"):
            raise QuestionError(f"curves is {curves!r}", code="bad-request", fix='give "lines" or "arcs"')
        tolerance = body.get("tolerance")
        within = None if tolerance is None else number(tolerance, "tolerance", 0.0, MAX_COORDINATE)
        importing = replace(document.importing, curves=curves, tolerance=within)
        opened = with_a_ball(open_scene(document.opened.drawing, wishes_of(importing)))
        return document.anew(opened, importing=importing)

    def simulate(self, body: Table, document: Document) -> Table:
        """Fly balls: to a time, or for a number of bounces each; in a second panel's world, too, if asked for one."""
        run, stepped, table = self._shown(body, document, self._worlds)
        other = body.get("other")
        if other is None:
            return table
        if not isinstance(other, dict):
            raise QuestionError("other is no object", code="bad-request", fix="give the second panel's settings")
        run_2, stepped_2, table["other"] = self._shown(ways.own_settings(body, other), document, self._other_worlds)
        table["apart"] = ways.panels_part(run, stepped, run_2, stepped_2)
        return table | {"partial": True} if table["other"].get("partial") else table

    def _shown(self, body: Table, document: Document, worlds: Worlds) -> tuple[Run, Stepped | None, Table]:
        """Fly what one panel shows: the exact run, and the frames over it where a way is asked for."""
        scene = scene_of(body, document)
        until, bounces = limits_of(body, len(scene.balls))
        way, dt = way_of(body)
        fly, ready = worlds.flight(body, document, scene)
        most = bounces if ready else min(bounces, max(1, INTERPRETED_CONTACTS // len(scene.balls)))
        run = fly(until, most)
        table = run_table(run, horizon="until" in body)
        if most < bounces and Ending.BOUNCE_LIMIT in run.ending:  # the page asks again, the compiler ready by then
            table |= {"partial": True, "duration": float(run.final["time"].min())}
        stepped = None if way == "exact" else ways.stepped_of(run, way, dt)
        if stepped is not None:
            table["stepped"] = ways.stepped_table(run, stepped)
        return run, stepped, table

    def check(self, document: Document) -> Table:
        """Give all that is doubtful, leaks among it: what `wallkit check` finds, in its words."""
        from wallkit.scene.look_over import given_of, look_over

        found = look_over(given_of(document.opened), None).problems
        return {"problems": self.problems_table(found, document.name)}

    def settle(self, body: Table, document: Document) -> Table:
        """Move discs that overlap a wall to the nearest free spot, as `simulate --settle` does."""
        from wallkit.scene.start_overlaps import settled

        return {"balls": balls_table(settled(scene_of(body, document)).balls)}

    def aim(self, body: Table, document: Document) -> Table:
        """Find all shots of a ball that reach a target."""
        scene = scene_of(body, document)
        target = body.get("target")
        if not isinstance(target, list) or len(target) != 3:
            raise QuestionError("target is no disc", code="bad-request", fix="give [x, y, radius]")
        x, y, radius = (number(part, "target", -MAX_COORDINATE, MAX_COORDINATE) for part in target)
        bounces = int(number(body.get("bounces", 3), "bounces", 0, aiming.MOST_BOUNCES))
        check_index(scene)
        windows = aiming.windows_of(scene, (x, y, radius), bounces)
        if windows is None:
            raise CompilingError
        return aiming.windows_table(windows)

    def save(self, body: Table, document: Document) -> Download:
        """Give the scene, the walls, or the run: as a replay, or with the frames of its way as a picture or a film."""
        stem = re.sub(r"[^A-Za-z0-9_-]+", "-", Path(document.name).stem).strip("-")[:60] or "wallkit"
        what = body.get("what")
        if what == "walls":
            from wallkit.walls.walls_json import to_json

            return Download(f"{stem}.walls.json", json.dumps(to_json(document.opened.scene.walls)), "application/json")
        scene = scene_of(body, document)
        until, bounces = limits_of(body, len(scene.balls))
        if what == "scene":
            from wallkit.scene.scene_files import scene_to_json

            lesson = document.opened.lesson
            said = {"lesson": lesson.to_json()} if lesson is not None else {}
            content = json.dumps(scene_to_json(scene, until) | said, allow_nan=False)
            return Download(f"{stem}.scene.json", content, "application/json")
        if what in ("replay", "picture", "film"):
            fly, ready = self._worlds.flight(body, document, scene)
            if not ready:  # a file is whole, or is none
                raise CompilingError
            run, (way, dt) = fly(until, bounces), way_of(body)
            if what == "replay":
                from wallkit.view.replay import replay_html

                page = replay_html(run, title=document.name, lesson=document.opened.lesson)
                return Download(f"{stem}.html", page, "text/html; charset=utf-8")
            stepped = None if way == "exact" else ways.stepped_of(run, way, dt)
            return _film(stem, run, stepped) if what == "film" else _picture(stem, run, stepped, document.name)
        raise QuestionError(f"what is {what!r}", code="bad-request", fix=f"give one of {', '.join(SAVED)}")

    def document_table(self, document: Document) -> Table:
        """Give all that the page shows of a document."""
        from wallkit.view.frame import united, walls_box

        opened, walls = document.opened, document.opened.scene.walls
        begin = starts_of(opened.scene)
        boxes = [walls_box(walls)] if len(walls) else []
        materials = set(walls.materials)
        first = walls.materials[0] if walls.materials else None
        return {
            "id": document.key,
            "name": document.name,
            "watched": document.watched,
            "version": document.version,
            "facts": facts(walls, opened.kind),
            "exactness": exactness(walls),
            "assumed": [re.sub(r" \(--[^()]*\)$", "", words) for words in opened.assumed],  # no options on the page
            "drawn": opened.drawing is not None and opened.kind != "scene",
            "curves": document.importing.curves if opened.drawing is not None else curves_of(walls),
            "tolerance": walls.tolerance,
            "walls": walls_table(walls, begin[:, :2], opened.scene.sensors),
            "problems": self.problems_table(opened.problems, document.name),
            "balls": balls_table(opened.scene.balls),
            "lesson": opened.lesson.to_json() if opened.lesson is not None else None,
            "targets": aiming.targets_of(opened.scene),
            "gravity": opened.scene.gravity,
            **{name: getattr(opened.scene, name) for name in SLOWING},
            "materials": {
                "restitution": first.restitution if first else 1.0,
                "tangential_restitution": first.tangential_restitution if first else 1.0,
                "mixed": len(materials) > 1,
            },
            "box": united([*boxes, *((x, y, x, y) for x, y, _, _ in begin.tolist())]),
        }

    def problems_table(self, problems: Sequence[Problem], name: str) -> list[Table]:
        """Give findings with the command line's words; of very many the first, and how many there are more."""
        table = [
            {**problem.to_json(), "text": self.reader.describe_problem(problem, name)}
            for problem in problems[:MOST_PROBLEMS]
        ]
        if len(problems) > MOST_PROBLEMS:
            more = f"and {len(problems) - MOST_PROBLEMS:,} more; wallkit check lists them all"
            table.append({**table[-1], "severity": "info", "message": more, "fix": "", "text": more, "layer": "",
                          "name": "", "x": None, "y": None})  # fmt: skip
        return table


def _picture(stem: str, run: Run, stepped: Stepped | None, title: str) -> Download:
    from wallkit.view.run_picture import run_canvas
    from wallkit.view.ways_picture import ways_canvas

    canvas = run_canvas(run, title=title) if stepped is None else ways_canvas(run, stepped, title=title)
    return Download(f"{stem}.svg", canvas.to_svg(), "image/svg+xml")


def _film(stem: str, run: Run, stepped: Stepped | None) -> Download:
    from wallkit.view.film import film

    return Download(f"{stem}.gif", film(run, "gif", seconds=FILM_SECONDS, stepped=stepped), "image/gif")


def wishes_of(importing: ImportOptions) -> Wishes:
    """Wish for what the page needs; how far balls fly each question says itself, so that nothing is assumed of it."""
    return Wishes(importing=importing, may_be_empty=True, bounces=MOST_CONTACTS)


def scene_of(body: Table, document: Document) -> Scene:
    """Make the scene that a question is about: the document's, with the balls and the world of the page."""
    scene = document.opened.scene
    walls = with_material(scene.walls, body)
    gravity, meeting = pair_or_none(body.get("gravity"), "gravity"), scene.meeting and body.get("alone") is not True
    slowing: Table = {name: number_or_none(body[name], name) for name in SLOWING if name in body}
    return replace(scene, walls=walls, balls=balls_of(body), gravity=gravity, meeting=meeting, **slowing)


def limits_of(body: Table, balls: int) -> tuple[float | None, int]:
    """Bound a run: at most MOST_CONTACTS bounces of all balls together, whatever was asked for."""
    until = body.get("until")
    end = None if until is None else number(until, "until", 0.0, MOST_TIME)
    bounces = body.get("bounces")
    most = MOST_CONTACTS // max(balls, 1)
    asked = most if bounces is None else int(number(bounces, "bounces", 0, MOST_CONTACTS))
    return end, min(asked, most)


def way_of(body: Table) -> tuple[Way, float]:
    """Take the way in which contacts within a frame are treated, ``"exact"`` if none is asked for, and dt."""
    said = body.get("way") or "exact"
    way = next((way for way in ways.WAYS if way == said), None)
    if way is None:
        raise QuestionError(f"way is {str(said)[:60]}", code="bad-request", fix=f"give one of {', '.join(ways.WAYS)}")
    return way, 1.0 if way == "exact" else number(body.get("dt"), "dt", ways.LEAST_DT, ways.MOST_DT)


def number(value: object, name: str, least: float = -math.inf, most: float = math.inf) -> float:
    """Take a finite number within bounds.

    Raises:
        QuestionError: it is something else.
    """
    real = value if isinstance(value, int | float) and not isinstance(value, bool) else math.nan
    if not (least <= real <= most and abs(real) < math.inf):  # compared: no float holds a number of 400 digits
        words = str(value)[:60]
        raise QuestionError(f"{name} is {words}", code="bad-request", fix=f"give a number, {least:g} to {most:g}")
    return float(real)


def number_or_none(value: object, name: str) -> float | None:
    """Take a number from 0 on, or null."""
    return None if value is None else number(value, name, 0.0, MAX_COORDINATE)


def pair_or_none(value: object, name: str) -> tuple[float, float] | None:
    """Take [x, y] or null."""
    if value is None:
        return None
    if not isinstance(value, list) or len(value) != 2:
        raise QuestionError(f"{name} is {str(value)[:60]}", code="bad-request", fix="give [x, y]")
    x, y = (number(part, name, -MAX_COORDINATE, MAX_COORDINATE) for part in value)
    return x, y


def balls_of(body: Table) -> Balls:
    """Take the balls of a question: ``[{"x", "y", "vx", "vy", "radius", "mass"}, ...]``, the mass if it is no area."""
    rows = body.get("balls")
    if not isinstance(rows, list) or not 0 < len(rows) <= MOST_BALLS:
        raise QuestionError("balls is not a list of balls", code="bad-request", fix=f"give 1 to {MOST_BALLS}")
    table = np.empty((len(rows), 6))
    for row, ball in zip(table, rows, strict=True):
        if not isinstance(ball, dict):
            raise QuestionError("a ball is not an object", code="bad-request")
        for index, name in enumerate(("x", "y", "vx", "vy")):
            row[index] = number(ball.get(name), name, -MAX_COORDINATE, MAX_COORDINATE)
        row[4] = number(ball.get("radius", 0.0), "radius", 0.0, MAX_COORDINATE)
        row[5] = area_of(row[4]) if ball.get("mass") is None else number(ball["mass"], "mass", 0.0, MOST_MASS)
    return Balls(table[:, 0:2].copy(), table[:, 2:4].copy(), table[:, 4].copy(), table[:, 5].copy())


def with_material(walls: Walls, body: Table) -> Walls:
    """Set the restitutions that the page asks for on every wall; null leaves them as they are."""
    changes = {
        name: number(body[name], name, 0.0, most)
        for name, most in (("restitution", MOST_RESTITUTION), ("tangential_restitution", 1.0))
        if body.get(name) is not None
    }
    if not changes:
        return walls
    return replace(walls, materials=tuple(replace(material, **changes) for material in walls.materials))


def with_a_ball(opened: OpenedScene) -> OpenedScene:
    """Put a ball in the middle where no place was found for one: it is shown all the same, and the person moves it."""
    if not len(opened.scene.balls):
        x0, y0, x1, y1 = opened.scene.walls.box()
        opened.scene.balls = Balls([[(x0 + x1) / 2, (y0 + y1) / 2]], [[0.0, 0.0]])
    return opened


def curves_of(walls: Walls) -> str:
    """Tell what the curves of walls have become."""
    return "arcs" if walls.has_arcs else "lines"


def starts_of(scene: Scene) -> np.ndarray:
    """Give (n, 4) x, y, vx, vy of a scene's balls."""
    return starts(Run(scene, np.empty(0), np.empty(0), ()))


def balls_table(balls: Balls) -> list[Table]:
    """Give balls as the page keeps them, MOST_BALLS at most."""
    position, velocity, radius = (
        np.asarray(part)[:MOST_BALLS] for part in (balls.position, balls.velocity, balls.radius)
    )
    rows = np.column_stack([position, velocity, np.broadcast_to(radius, len(position))])
    table = [dict(zip(("x", "y", "vx", "vy", "radius"), row, strict=True)) for row in rows.tolist()]
    for ball, mass in zip(table, balls.mass.tolist(), strict=False):
        if mass != area_of(ball["radius"]):
            ball["mass"] = mass
    return table


def facts(walls: Walls, kind: str) -> str:
    """Say in one line what is open."""
    return f"{kind}, {counted(len(walls), 'wall')}, {counted(len(walls.edge_starts), 'edge')}"


def exactness(walls: Walls) -> str:
    """Say in one line what the import cost in exactness."""
    arcs = int(np.count_nonzero(walls.bulges))
    words = counted(len(walls.edge_starts), "edge") + (f", {arcs:,} of them arcs" if arcs else "")
    if walls.tolerance > 0:
        exact = walls.measured_error == 0
        words += "; exactly as drawn" if exact else f"; at most {walls.measured_error:.3g} from the drawn curves"
    if walls.measured_normal_error:
        words += f", normals to {walls.measured_normal_error:.2g} rad"
    return words


def counted(count: int, word: str) -> str:
    """Give ``1 wall`` or ``1,200 walls``."""
    return f"{count:,} {word if count == 1 else word + 's'}"
