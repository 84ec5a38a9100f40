"""Work against precision: every contestant flies the same balls, and is held against a far tighter reference."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np

from wallkit.accuracy import engines
from wallkit.accuracy.reference import Event, Reference, sure_events
from wallkit.accuracy.reference_pairs import Meeting, PairsReference, sure_meetings
from wallkit.accuracy.scenes import BuiltIn, break_of_fifteen, built_in
from wallkit.accuracy.sure_digits import PrecisionError
from wallkit.geometry.arrays import FloatArray
from wallkit.geometry.bulge_arcs import edge_points
from wallkit.scene.scene import Scene
from wallkit.simulation.ways import WRONG

BOUNCES = 3  # the error is taken after so many: few enough that chaos has not yet mixed everything up
MEETINGS = 20  # the same where balls meet: contacts of two of them
METHODS = ("exact", "stop", "full-step", "reflect-in-place")


@dataclass(frozen=True, slots=True)
class Effort:
    """How much is done.

    Attributes:
        bounces: of the reference, in which the first wrong bounce is looked for.
        runs: the time is the least of so many.
        draws: of the roundings, in the horizon's table.
        steps: time steps of what is stepped.
        tolerances: of what is drawn as lines or arcs, as parts of the scene's size.
        finer: more of them for arcs, of which it takes so few.
        fine_steps: more time steps for engines where balls meet, many of them within one of the others.
        digits: of the reference to begin with; it adds more by itself until nothing changes.
        fixed: take the digits as they are.
    """

    bounces: int = 60
    runs: int = 5
    draws: int = 4
    steps: tuple[float, ...] = (1 / 30, 1 / 60, 1 / 120, 1 / 240, 1 / 1000, 1 / 5000)
    tolerances: tuple[float, ...] = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8)
    finer: tuple[float, ...] = (1e-9,)
    fine_steps: tuple[float, ...] = (1 / 20_000, 1 / 100_000)
    digits: int = 32
    fixed: bool = False


QUICK = Effort(
    bounces=20,
    runs=2,
    draws=3,
    steps=(1 / 60, 1 / 240, 1 / 1000),
    tolerances=(1e-3, 1e-5, 1e-7),
    finer=(),
    fine_steps=(),
)


@dataclass(frozen=True, slots=True)
class Point:
    """One contestant's result.

    Attributes:
        series: who.
        setting: with what, for people.
        value: the same as a number: a time step, a tolerance or a friction.
        error: distance from the reference after :data:`BOUNCES` bounces, in the scene's units; where balls meet that
            of the ball that is farthest off, after :data:`MEETINGS` contacts of two of them.
        seconds: of processor time per simulated second.
        wrong: the first bounce (where balls meet, contact of any of them) after which one is somewhere else, or None.
        drift: of the energy over the whole run, relative; NaN where it is not to be kept.
        escaped: a ball was outside of its room at some time.
        reached: so many bounces were looked at; fewer than the reference has where that took too many steps.
    """

    series: str
    setting: str
    value: float
    error: float
    seconds: float
    wrong: int | None
    drift: float
    escaped: bool
    reached: int


@dataclass(slots=True)
class Contest:
    """All results on one scene.

    Attributes:
        name: of the scene.
        story: what is hard about it.
        bounces: of the reference.
        size: the larger side of the scene.
        radius: of the (first) ball.
        points: the results, series by series.
        balls: how many there are; more than one of them meet.
    """

    name: str
    story: str
    bounces: int
    size: float
    radius: float
    points: list[Point] = field(default_factory=list)
    balls: int = 1

    def series(self) -> dict[str, list[Point]]:
        """Give the points by series, in order."""
        found: dict[str, list[Point]] = {}
        for point in self.points:
            found.setdefault(point.series, []).append(point)
        return found

    def to_json(self) -> dict[str, Any]:
        """Give everything as plain data; a number that is not finite is null."""
        plain = asdict(self)
        for point in plain["points"]:
            point.update({k: None for k, v in point.items() if isinstance(v, float) and not math.isfinite(v)})
        return plain


@dataclass(frozen=True, slots=True)
class Subject:
    """What is flown: the same scene as lines and with arcs, at any tolerance.

    Attributes:
        name: of the scene.
        story: what is hard about it.
        lines: the scene of lines within a tolerance.
        arcs: the scene with arcs, or None where it has no curves.
        swept: its arcs depend on the tolerance.
    """

    name: str
    story: str
    lines: Callable[[float], Scene]
    arcs: Callable[[float], Scene] | None
    swept: bool

    @classmethod
    def of(cls, scene: BuiltIn) -> Subject:
        """Take a built-in scene."""
        arcs = None if scene.arcs is None else lambda t: scene.scene(t)
        return cls(scene.name, scene.story, lambda t: scene.scene(t, lines=True), arcs, scene.fitted)

    @classmethod
    def of_the_break(cls) -> Subject:
        """Take the balls that meet."""
        story = f"16 balls; the farthest, after {MEETINGS} met"
        return cls("break", story, lambda _: break_of_fifteen(), None, False)

    def truth(self, tolerance: float) -> Scene:
        """Give the scene that the others are held against."""
        return self.lines(tolerance) if self.arcs is None else self.arcs(tolerance)


def subjects() -> dict[str, Subject]:
    """Give the built-in scenes by name, in the report's order."""
    found = {scene.name: Subject.of(scene) for scene in built_in()}
    return found | {"break": Subject.of_the_break()}


def contestants(subject: Subject, effort: Effort, size: float) -> Iterator[engines.Contestant]:
    """Set up everybody; walls of lines are as fine as a person would draw them for all that steps."""
    fine = subject.lines(1e-5 * size)
    best = fine if subject.arcs is None else subject.arcs(min(effort.tolerances) * size)
    if subject.arcs is None:
        yield engines.exact(fine, "exact, lines", "as drawn", 0.0)
    else:
        for part in effort.tolerances:
            yield engines.exact(subject.lines(part * size), "exact, lines", f"within {part * size:.2g}", part * size)
        for part in (*effort.tolerances, *effort.finer) if subject.swept else ():
            yield engines.exact(subject.arcs(part * size), "exact, arcs", f"within {part * size:.2g}", part * size)
        if not subject.swept:
            yield engines.exact(best, "exact, arcs", "as drawn", 0.0)
    for way in METHODS[:1] if best.meeting else METHODS:
        yield from (engines.stepped(best, way, dt) for dt in effort.steps)
    yield from engines.others(fine, best, [*effort.steps, *(effort.fine_steps if best.meeting else ())])


def contest(subject: Subject, effort: Effort, progress: Callable[[str], None] | None = None) -> Contest:
    """Let everybody fly one scene.

    Args:
        subject: the scene.
        effort: how much is done.
        progress: is told who flies next.

    Raises:
        PrecisionError: the digits asked for cannot give the reference.
    """
    low_x, low_y, high_x, high_y = subject.lines(1.0).walls.box()
    size = max(high_x - low_x, high_y - low_y) or 1.0
    truth = subject.truth(min(*effort.tolerances, *effort.finer, 1.0) * size / 30)
    if progress:
        progress("reference")
    events = _reference(truth, effort)
    times, places = _between(events, truth)
    taken = _taken(events, len(times))
    area = _room(truth)
    radius, balls = float(truth.balls.radius[0]), len(truth.balls)
    result = Contest(subject.name, subject.story, len(times), size, radius, balls=balls)
    for contestant in contestants(subject, effort, size):
        if progress:
            progress(f"{contestant.series}, {contestant.setting}")
        flown = contestant.fly(times, effort.runs)
        result.points.append(_judged(contestant, flown, places, size, area, truth, taken))
    return result


def _reference(truth: Scene, effort: Effort) -> Sequence[Event | Meeting]:
    wanted = effort.bounces + 1
    events: Sequence[Event | Meeting]
    if truth.meeting:
        fixed = PairsReference(truth, effort.digits).run(wanted) if effort.fixed else None
        events = fixed or sure_meetings(truth, wanted, digits=effort.digits)
    elif effort.fixed:
        events = Reference(truth, effort.digits).run(wanted)
    else:
        events = sure_events(truth, wanted, digits=effort.digits)
    if len(events) < 2:
        raise PrecisionError("the ball does not bounce twice in this scene", code="no-bounces", fix="aim it at walls")
    return events


def _taken(events: Sequence[Event | Meeting], count: int) -> int:
    """After which of the contacts the error is taken, from 0: the last where there are fewer."""
    met = [index for index, event in enumerate(events) if isinstance(event, Meeting) and event.other >= 0]
    index = met[:MEETINGS][-1] if met else BOUNCES - 1
    return min(index, count - 1)


def _between(events: Sequence[Event | Meeting], truth: Scene) -> tuple[FloatArray, FloatArray]:
    """Times in the middle of the flights after each contact, and the exact places of all balls (m, n, 2), rounded."""
    number = type(events[0].time)
    balls, pull = truth.balls, truth.gravity or (0.0, 0.0)
    states: list[Any] = [(number(0), *pair) for pair in zip(balls.position, balls.velocity, strict=True)]
    times, places = [], []
    for a, b in itertools.pairwise(events):
        states[a.ball if isinstance(a, Meeting) else 0] = (a.time, a.position, a.velocity)
        if isinstance(a, Meeting) and a.other >= 0:
            states[a.other] = (a.time, a.other_position, a.other_velocity)
        time = float((a.time + b.time) / 2)
        spans = [number(time) - since for since, _, _ in states]
        times.append(time)
        places.append([
            [float(p[i] + v[i] * span + pull[i] * span * span / 2) for i in (0, 1)]
            for span, (_, p, v) in zip(spans, states, strict=True)
        ])  # fmt: skip
    return np.array(times), np.array(places)


def _judged(
    contestant: engines.Contestant,
    flown: engines.Flown,
    places: FloatArray,
    size: float,
    area: Any,
    truth: Scene,
    taken: int,
) -> Point:
    from shapely import contains_xy

    got = flown.position
    off = np.hypot(*np.moveaxis(got - places[: len(got)], -1, 0)).max(axis=1) if len(got) else np.empty(0)
    error = float(off[taken]) if len(off) > taken else math.nan
    wrong = np.flatnonzero(~(off <= WRONG * size))
    escaped = area is not None and bool(len(got)) and not bool(contains_xy(area, got[..., 0], got[..., 1]).all())
    kept = truth.gravity is None and engines.lossless(truth)
    mass = np.where(truth.balls.mass > 0.0, truth.balls.mass, 1.0)[:, None]  # one point has none
    energy, first = (float((mass * velocity**2).sum()) for velocity in (flown.velocity, truth.balls.velocity))
    return Point(
        contestant.series,
        contestant.setting,
        contestant.value,
        error,
        flown.seconds,
        int(wrong[0]) + 1 if len(wrong) else None,
        energy / first - 1 if kept else math.nan,
        escaped,
        len(got),
    )


def _room(scene: Scene) -> Any:
    """The area within the walls that the ball starts in, pillars and all, a little wider; None where it is open.

    It is the outline of the face around the ball of all that the walls part the plane into: one wall around it, or
    several that touch.
    """
    import shapely

    walls, (x, y) = scene.walls, np.asarray(scene.balls.position, dtype=np.float64)[0]
    pieces = []
    for wall in walls:
        ends = np.roll(wall.vertices, -1, axis=0) if wall.closed else wall.vertices[1:]
        points = [along(a, b, float(k)) for a, b, k in zip(wall.vertices, ends, wall.bulges, strict=False)]
        pieces.append(shapely.linestrings(np.concatenate([*points, ends[-1:]])))
    noded = shapely.node(shapely.multilinestrings(pieces))
    faces = [face for face in shapely.get_parts(shapely.polygonize([*shapely.get_parts(noded)]))
             if shapely.contains_xy(face, x, y)]  # fmt: skip
    if not faces:
        return None
    low_x, low_y, high_x, high_y = walls.box()
    return shapely.Polygon(faces[0].exterior).buffer(1e-3 * max(high_x - low_x, high_y - low_y))


def along(a: FloatArray, b: FloatArray, bulge: float, pieces: int = 128) -> FloatArray:
    """Give points of an edge from a to just before b, an arc in equal parts."""
    if bulge == 0.0:
        return a[None]
    part = np.arange(1, pieces) / pieces
    inner = edge_points(np.tile(a, (pieces - 1, 1)), np.tile(b, (pieces - 1, 1)), np.full(pieces - 1, bulge), part)
    return np.concatenate([a[None], inner])
