"""Scenes in files: TOML for people, JSON for programs, the same keys in both. docs/files.md describes the format.

Everything that is wrong with a file is found before anything is said, so that one look at the message is enough.
"""

from __future__ import annotations

import json
import math
import re
import reprlib
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from importers.limits import Work, check_input_size
from wallkit.geometry.arrays import FloatArray
from wallkit.globs import fits as like
from wallkit.globs import steps_of
from wallkit.scene.drawn_scene import apart, drawn_scene, together
from wallkit.scene.lesson import Lesson, read_lesson
from wallkit.scene.scene import Balls, Scene, SceneError, area_of, downwards
from wallkit.scene.scene_rules import FIT_KEYS, MATCHING, RULE_KEYS, Fit, Rule, Ruled, say_roles
from wallkit.toml_text import parse_toml
from wallkit.walls import Material, Walls
from wallkit.walls.fields import MOST_RESTITUTION
from wallkit.walls.import_options import ImportOptions, option_names
from wallkit.walls.origins import ORIGIN_KEYS, Origin
from wallkit.walls.tags import ROLES
from wallkit.walls.walls import WallsError
from wallkit.walls.walls_json import from_json, load, to_json

if TYPE_CHECKING:
    from importers.drawing import Drawing
    from wallkit.scene.drawn_scene import Drawn


BALL_RESTITUTIONS = ("ball_restitution", "ball_tangential_restitution")
_SHORTER = "write a shorter number, such as 1e30"
_PLACE = re.compile(r" \(at (?:line (\d+), column (\d+)|end of document)\)")


@dataclass(slots=True)
class SceneFile:
    """A scene file, read.

    Attributes:
        scene: what is simulated; its balls may be none.
        until: the end that the file asks for in seconds, or None.
        bounces: the number of bounces a ball that it asks for, or None.
        drawn: what the drawing that it names holds, or None where it names none.
        drawing: that drawing.
        importing: how it became walls.
        lesson: what it says to a class, or None.
    """

    scene: Scene
    until: float | None = None
    bounces: int | None = None
    drawn: Drawn | None = None
    drawing: Drawing | None = None
    importing: ImportOptions | None = None
    lesson: Lesson | None = None


def load_scene(path: str | Path) -> SceneFile:
    """Read a scene from a TOML or JSON file; names of other files in it are meant from its folder.

    Raises:
        SceneError: it cannot be read, or says what a scene cannot; the message lists every such place.
    """
    try:
        data = Path(path).read_bytes()
    except OSError as error:
        raise SceneError(f"cannot read it: {error.strerror}", code="cannot-read", file=str(path)) from error
    return read_scene(data, file=str(path), folder=Path(path).parent)


def read_scene(
    data: bytes,
    *,
    file: str = "",
    folder: Path | None = None,
    importing: Mapping[str, Any] | None = None,
    balls: FloatArray | None = None,
) -> SceneFile:
    """Read a scene from the bytes of a TOML or JSON file.

    Args:
        data: the file's content.
        file: its name, for messages.
        folder: where the files that it names are; None forbids naming any (a scene from a stranger).
        importing: options of ``import_walls`` that go before those of the file.
        balls: (n, 2) places of balls that go before those of the file, where these help to decide what is solid.

    Raises:
        SceneError: as :func:`load_scene`.
        LimitError: it is larger, or its keys are longer, than the limits allow.
    """
    check_input_size(len(data), file)
    table = _parsed(data, file)
    if table.get("format") == "wallkit-run":
        table = table.get("scene", {}) if isinstance(table.get("scene"), dict) else {}
    reader = _Reader(Work(file, len(data)), folder, importing or {}, balls)
    result = reader.scene_file(table)
    reader.finish()
    return result


def _parsed(data: bytes, file: str) -> dict[str, Any]:
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise SceneError("it is not UTF-8 text", code="not-a-scene", file=file) from error
    try:
        if text.lstrip().startswith("{"):
            return dict(json.loads(text, parse_constant=_no_constant))
        return parse_toml(text, file)
    except json.JSONDecodeError as error:
        raise SceneError(error.msg, code="bad-json", file=file, line=error.lineno, column=error.colno) from error
    except tomllib.TOMLDecodeError as error:
        place = _PLACE.search(str(error))
        line, column = (int(place[1]), int(place[2])) if place and place[1] else (text.count("\n") + 1, None)
        raise SceneError(_PLACE.sub("", str(error)), code="bad-toml", file=file, line=line, column=column) from error
    except RecursionError as error:
        raise SceneError("it is nested too deeply", code="not-a-scene", file=file) from error
    except ValueError as error:  # from Python's own reader of whole numbers
        raise SceneError(str(error).partition(";")[0], code="bad-number", file=file, fix=_SHORTER) from error


def _no_constant(word: str) -> None:
    raise SceneError(f"{word} is not a number of JSON", code="bad-json", fix="write finite numbers")


class _Reader:
    """Turns the parsed table into a scene and collects what is wrong on the way, each with its key."""

    def __init__(self, work: Work, folder: Path | None, importing: Mapping[str, Any], balls: FloatArray | None) -> None:
        self.work = work
        self.file = work.file
        self.folder = folder
        self.importing = importing
        self.places = balls
        self.drawing: Drawing | None = None
        self.options: ImportOptions | None = None
        self.wrong: list[str] = []

    def finish(self) -> None:
        if self.wrong:
            shown = "; ".join(self.wrong[:12]) + (f"; and {len(self.wrong) - 12} more" if len(self.wrong) > 12 else "")
            raise SceneError(shown, code="bad-scene", file=self.file, fix="docs/files.md lists the keys of a scene")

    def scene_file(self, table: dict[str, Any]) -> SceneFile:
        known = {"format", "version", "walls", "drawing", "import", "gravity", "rolling_friction", "drag", "sensors",
                 "materials", "colours", "balls", "run", "y_axis", "meeting", "lesson", *BALL_RESTITUTIONS}  # fmt: skip
        self.known_keys(table, known, "")
        if table.get("format", "wallkit-scene") != "wallkit-scene":
            self.wrong.append(f"format: {table['format']!r} is not 'wallkit-scene'")
        if table.get("version", 1) not in (1, 2):
            self.wrong.append(f"version: {table['version']!r} is not 1 or 2, those that this wallkit reads")
        balls = self.balls(table["balls"]) if "balls" in table else Balls(np.empty((0, 2)), np.empty((0, 2)))
        walls, drawn = self.walls(table, balls)
        if walls is None:  # the rest is still checked, on no walls
            walls = Walls.from_polylines([])
        if "balls" not in table and drawn is not None:
            balls = drawn.balls
        elif drawn is not None:
            drawn = replace(drawn, used=False, still=False)
        self.materials(walls, table)
        gravity = self.gravity(table["gravity"], walls) if "gravity" in table else None
        slowing: dict[str, Any] = {
            key: self.number(table[key], key, least=0.0) for key in ("rolling_friction", "drag") if key in table
        }
        walls, sensors = apart(walls) if drawn is None else (walls, drawn.sensors)
        if "sensors" in table:
            walls, sensors = self.sensors(walls, sensors, table["sensors"])
        run = self.table(table.get("run", {}), "run")
        self.known_keys(run, {"until", "bounces"}, "run.")
        until = self.number(run["until"], "run.until", least=0.0) if "until" in run else None
        bounces = self.whole(run["bounces"], "run.bounces") if "bounces" in run else None
        scene = Scene(walls, balls, gravity, sensors=sensors, **slowing | self.meeting(table))
        lesson = read_lesson(table["lesson"], self.wrong) if "lesson" in table else None
        return SceneFile(scene, until, bounces, drawn, self.drawing, self.options, lesson)

    def gravity(self, value: Any, walls: Walls) -> tuple[float, float] | None:
        if isinstance(value, int | float) and not isinstance(value, bool):
            return downwards(self.number(value, "gravity"), walls)
        return self.pair(value, "gravity")

    def meeting(self, table: dict[str, Any]) -> dict[str, Any]:
        """Whether discs meet, and with what restitution."""
        said = {"meeting": self.one_of(table["meeting"], "meeting", (True, False))} if "meeting" in table else {}
        return said | {key: self.number(table[key], key, 0.0, 1.0) for key in BALL_RESTITUTIONS if key in table}

    # -- values

    def known_keys(self, table: dict[str, Any], known: set[str], prefix: str) -> None:
        self.wrong.extend(f"{prefix}{key}: no such key" for key in table if key not in known)

    def table(self, value: Any, key: str) -> dict[str, Any]:
        if isinstance(value, dict):
            return value
        self.wrong.append(f"{key}: not a table")
        return {}

    def rows(self, value: Any, key: str) -> list[tuple[str, dict[str, Any]]]:
        if not isinstance(value, list):
            self.wrong.append(f"{key}: not a list of tables")
            return []
        return [(f"{key}[{index}]", self.table(row, f"{key}[{index}]")) for index, row in enumerate(value)]

    def number(self, value: Any, key: str, least: float = -math.inf, most: float = math.inf) -> float:
        try:
            finite = not isinstance(value, bool) and isinstance(value, int | float) and math.isfinite(value)
        except OverflowError:  # a whole number that no double reaches
            finite = False
        if not finite:
            self.wrong.append(f"{key}: {reprlib.repr(value)} is not a finite number")
            return max(least, 0.0)
        if not least <= value <= most:
            bound = f"from {least:g} to {most:g}" if math.isfinite(most) else f"at least {least:g}"
            self.wrong.append(f"{key}: {value!r} is not {bound}")
            return max(least, 0.0)
        return float(value)

    def whole(self, value: Any, key: str) -> int:
        number = self.number(value, key, least=0.0)
        if number != int(number):
            self.wrong.append(f"{key}: {value!r} is not a whole number")
        return int(number)

    def one_of(self, value: Any, key: str, words: tuple[Any, ...]) -> Any:
        if not any(value is word or (isinstance(value, str) and value == word) for word in words):
            self.wrong.append(f"{key}: {value!r} is not {' or '.join(str(word).lower() for word in words)}")
            return words[0]
        return value

    def pair(self, value: Any, key: str) -> tuple[float, float]:
        if not isinstance(value, list) or len(value) != 2:
            self.wrong.append(f"{key}: {value!r} is not a pair of numbers")
            return 0.0, 0.0
        return self.number(value[0], f"{key}[0]"), self.number(value[1], f"{key}[1]")

    def text(self, value: Any, key: str) -> str:
        if not isinstance(value, str):
            self.wrong.append(f"{key}: {value!r} is not text")
            return ""
        return value

    # -- parts

    def walls(self, table: dict[str, Any], balls: Balls) -> tuple[Walls | None, Drawn | None]:
        """Give the walls, and what else a drawing holds."""
        sources = [key for key in ("walls", "drawing") if key in table]
        if len(sources) != 1:
            self.wrong.append("walls, drawing: give exactly one of the two")
            return None, None
        value = table[sources[0]]
        if "y_axis" in table and not isinstance(value, list):
            self.wrong.append("y_axis: only goes with walls of the scene's own; a drawing and saved walls have theirs")
        if sources == ["drawing"]:
            drawn = self.drawn(table, np.asarray(balls.position))
            return None if drawn is None else drawn.walls, drawn
        if "import" in table:
            self.wrong.append("import: only goes with a drawing")
        if isinstance(value, str):
            path = self.path(value, "walls")
            return load(path) if path else None, None
        if isinstance(value, dict):
            return from_json(value, self.file), None
        walls = self.polylines(value)
        if walls is not None:
            walls.y_axis = self.one_of(table.get("y_axis", "up"), "y_axis", ("up", "down"))
        return walls, None

    def drawn(self, table: dict[str, Any], balls: FloatArray) -> Drawn | None:
        path = self.path(table["drawing"], "drawing")
        options = self.table(table.get("import", {}), "import")
        names = set(option_names()) - {"via"}  # who opens a file says what program may run, not the file
        self.known_keys(options, names, "import.")
        known = {key: value for key, value in options.items() if key in names}
        try:
            self.options = ImportOptions(**{"curves": "arcs", **known, **self.importing})
        except WallsError as error:
            self.wrong.append(f"import.{error.message}: {error.fix}")
            return None
        if path is None:
            return None
        from importers.read import read_drawing

        self.drawing = read_drawing(path, page=self.options.page, via=self.options.via)
        say_roles(self.drawing, self.roles(table), self.work)
        return drawn_scene(self.drawing, self.options, balls if self.places is None else self.places)

    def path(self, value: Any, key: str) -> Path | None:
        name = self.text(value, key)
        if not name:
            return None
        if self.folder is None:
            self.wrong.append(f"{key}: this scene may not name other files; put its walls into it")
            return None
        return self.folder / name

    def polylines(self, value: Any, name: str = "walls") -> Walls | None:
        before = len(self.wrong)
        rows = self.rows(value, name)
        keys = {"vertices", "bulges", "closed", "name", "layer", "sides", "material", *ORIGIN_KEYS}
        for key, row in rows:
            self.known_keys(row, keys, f"{key}.")
        if len(self.wrong) > before:
            return None
        try:
            return Walls.from_polylines(
                [row.get("vertices", ()) for _, row in rows],
                [self.one_of(row.get("closed", True), f"{key}.closed", (True, False)) for key, row in rows],
                bulges=[row.get("bulges") for _, row in rows],
                sides=[self.one_of(row.get("sides", "both"), f"{key}.sides", ("both", "outward")) for key, row in rows],
                material=[self.material(row.get("material", {}), f"{key}.material") for key, row in rows],
                names=[self.text(row.get("name", ""), f"{key}.name") for key, row in rows],
                layers=[self.text(row.get("layer", ""), f"{key}.layer") for key, row in rows],
                origins=[Origin.of_json(row) for _, row in rows],
            )
        except (ValueError, TypeError):
            self.wrong.append(f"{name}: vertices are lists of [x, y], groups and tags of texts")
            return None

    def sensors(self, walls: Walls, drawn: Walls | None, value: Any) -> tuple[Walls, Walls | None]:
        """Give the walls left, and the sensors: saved ones, or those drawn and polylines or walls that globs name."""
        if isinstance(value, dict):
            return walls, from_json(value, self.file)
        if not isinstance(value, list) or not all(isinstance(glob, str) for glob in value):
            return walls, together(drawn, self.polylines(value, "sensors"))
        self.work.charge(MATCHING, len(value) * (steps_of(walls.layers) + steps_of(walls.names)))
        fits = [any(like(word, glob) for word in (walls.layers[index], walls.names[index]) for glob in value)
                for index in range(len(walls))]  # fmt: skip
        if len(walls) and not any(fits):
            self.wrong.append(f"sensors: no wall has a name or layer like {', '.join(map(repr, value))}")
        return walls.take(np.logical_not(fits)), together(drawn, walls.take(np.array(fits, dtype=np.bool_)))

    def material(self, value: Any, key: str) -> Material:
        return Material(**self.restitutions(self.table(value, key), key))

    def restitutions(self, table: dict[str, Any], key: str) -> dict[str, float]:
        most = {"restitution": MOST_RESTITUTION, "tangential_restitution": 1.0, "static_friction": math.inf}
        return {name: self.number(table[name], f"{key}.{name}", 0.0, most[name]) for name in most if name in table}

    def materials(self, walls: Walls, table: dict[str, Any]) -> None:
        """Give walls their materials and sides by their colours, then by globs; see scene_rules.py."""
        ruled = Ruled(walls)
        for colour, row in self.table(table.get("colours", {}), "colours").items():
            self.apply(ruled, walls, Fit(colour=colour), row, f"colours.{colour}", "no wall is painted so")
        for key, row in self.rows(table.get("materials", []), "materials"):
            fit = Fit(**{word: self.text(row.get(word, "*"), f"{key}.{word}") for word in FIT_KEYS})
            among = "" if fit.group == "*" else f" in a group {fit.group!r}"
            otherwise = f"no wall has the name {fit.wall!r}{among} on a layer {fit.layer!r}"
            self.apply(ruled, walls, fit, row, key, otherwise)
        ruled.finish()

    def apply(self, ruled: Ruled, walls: Walls, fit: Fit, value: Any, key: str, otherwise: str) -> None:
        """Read one table of a rule and let it hold; say so where nothing fits."""
        row = self.table(value, key)
        self.known_keys(row, {*RULE_KEYS, *(FIT_KEYS if fit.colour is None else ())}, f"{key}.")
        sides = self.one_of(row["sides"], f"{key}.sides", ("both", "outward")) if "sides" in row else None
        self.work.charge(MATCHING, ruled.steps)
        fits = fit.walls(walls)
        self.work.charge(MATCHING, 2 * len(fits))
        ruled.apply(Rule(**self.restitutions(row, key), sides=sides), fits)
        if "role" in row:
            self.one_of(self.text(row["role"], f"{key}.role").partition(":")[0], f"{key}.role", ROLES)
            if self.drawing is None:
                self.wrong.append(f"{key}.role: only goes with a drawing; walls of the scene's own have tags")
        some = fits or ("role" in row and self.drawing is not None and fit.paths(self.drawing))
        if not some and len(walls):
            self.wrong.append(f"{key}: {otherwise}")

    def roles(self, table: dict[str, Any]) -> Iterator[tuple[Fit, str]]:
        """Give what tables make of the paths that fit; what is wrong with a table is said where it is applied."""
        colours, rows = table.get("colours"), table.get("materials")
        named = [(Fit(colour=key), row) for key, row in colours.items()] if isinstance(colours, dict) else []
        tables = [row for row in rows if isinstance(row, dict)] if isinstance(rows, list) else []
        named += [(Fit(**{word: str(row.get(word, "*")) for word in FIT_KEYS}), row) for row in tables]
        for fit, row in named:
            role = row.get("role") if isinstance(row, dict) else None
            if isinstance(role, str) and role.partition(":")[0] in ROLES:
                yield fit, role

    def balls(self, value: Any) -> Balls:
        rows = self.rows(value, "balls")
        position, velocity, radius = np.zeros((len(rows), 2)), np.zeros((len(rows), 2)), np.zeros(len(rows))
        mass: dict[int, float] = {}
        for index, (key, row) in enumerate(rows):
            self.known_keys(row, {"position", "velocity", "radius", "mass"}, f"{key}.")
            position[index] = self.pair(row.get("position"), f"{key}.position")
            velocity[index] = self.pair(row.get("velocity", [0.0, 0.0]), f"{key}.velocity")
            radius[index] = self.number(row.get("radius", 0.0), f"{key}.radius", least=0.0)
            if "mass" in row:
                mass[index] = self.number(row["mass"], f"{key}.mass", least=math.ulp(0.0))
        masses = area_of(radius)
        for index, one in mass.items():
            masses[index] = one
        return Balls(position, velocity, radius, masses)


def scene_to_json(scene: Scene, until: float | None = None, bounces: int | None = None) -> dict[str, Any]:
    """Give a scene as the ``wallkit-scene`` format has it, walls and materials included.

    Version 2 is that of scenes with what version 1 has no words for: balls that meet, and their masses.
    """
    position = np.asarray(scene.balls.position, dtype=np.float64).reshape(-1, 2)
    velocity = np.asarray(scene.balls.velocity, dtype=np.float64).reshape(-1, 2)
    radius = np.broadcast_to(np.asarray(scene.balls.radius, dtype=np.float64), len(position))
    balls = zip(position.tolist(), velocity.tolist(), radius.tolist(), scene.balls.mass.tolist(), strict=True)
    heavy = bool((scene.balls.mass != area_of(radius)).any())
    meeting = {"meeting": True} if scene.meeting else {}
    meeting |= {key: getattr(scene, key) for key in BALL_RESTITUTIONS if getattr(scene, key) != 1.0}
    run = {key: value for key, value in (("until", until), ("bounces", bounces)) if value is not None}
    return {
        "format": "wallkit-scene",
        "version": 2 if meeting or heavy else 1,
        **({"gravity": list(scene.gravity)} if scene.gravity is not None else {}),
        **({"rolling_friction": scene.rolling_friction} if scene.rolling_friction is not None else {}),
        **({"drag": scene.drag} if scene.drag is not None else {}),
        **({"sensors": to_json(scene.sensors)} if scene.sensors is not None else {}),
        **meeting,
        **({"run": run} if run else {}),
        "balls": [
            {"position": p, "velocity": v, "radius": r, **({"mass": m} if heavy else {})} for p, v, r, m in balls
        ],
        "walls": to_json(apart(scene.walls)[0]),
    }
