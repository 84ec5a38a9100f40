"""How far a run can be trusted: a small error is carried along from contact to contact.

Between contacts a small error of the state (dx, dv) grows as ``dx + dv t``; gravity is the same for both and
drops out. At a contact with unit normal n and velocity v (v' after) the neighbour touches earlier or later by
``dt = -dx.n / (v.n)``, at ``dx + v dt`` along the wall, where the normal is turned by ``dn = k (dx + v dt)``
(k the curvature of the line that the ball's centre cannot cross: 0 beside a line, 1 / r about a corner,
1 / (R + r) outside and -1 / (R - r) inside an arc). With the rule of the bounce
``v' = T v - (T + R) (v.n) n`` and gravity g this gives the state just after, at the time of the run itself (a
ball that begins to slide keeps what its error has along the wall):

    dx' = dx + (v - v') dt
    dv' = T w - (T + R) ((w.n) n + (v.dn) n + (v.n) dn) - g dt,      w = dv + g dt

(Dellago, Posch and Hoover, Phys. Rev. E 53, 1485 (1996), here with restitution and gravity). Each contact adds
its own new error: what its arithmetic has made, or the wall's own displacement and turn.

*What the arithmetic has made is known* after a flight (see ``made_errors``), for its contacts are there: so it is
carried as it is, with its sign, and is no matter of chance. What this adds up to is the first order e of how far the
run is off, and promised is 2 e. Twice is for what the second order adds. It adds most where a convex wall is met at a
graze, by the depth D that a neighbour may be off there: at the angle h with D = rho h^2 / 2, a neighbour off by d is
met sqrt(2 rho) (sqrt D - sqrt(D - d)) along it, and e is that with d / 2 D for 1 - sqrt(1 - d / D). Trust ends where
2 d reaches D (below), and up to d = D / 2 the one is at most 1.17 times the other.

*What is not known is taken as chance*: roundings where a ball keeps to a wall, where drag acts, and in the tip of a
corner; and what walls are off as drawn. The covariance of these is carried (new errors count as independent), which
gives the root mean square; promised is three times that. A place's rounding counts in full for each of its two
components. All of it is in one of them where the place is far along that, so that less would be too little in some
direction; counted by half for each, as many of some 4,600 runs were told to the bounce (80 % at 1e-12).

Without gravity rolling friction and drag leave the path as it is: the errors are those of the same ball without them.
Under gravity drag k takes t to the free time f = (1 - e^(-k t)) / k, and dv to dv e^(-k t); what is g above is g - k v.

A ball that keeps to a line is pulled along it; along a circle its error is that of a pendulum (see ``glide_errors``),
and its velocity before a bounce, and the g before it, are those on the circle. Where it runs off an edge, a neighbour
that is there later by dt falls later: dv' = dv + (g before - g after) dt. Where endless bounces take what speed it has
along the wall, it sets out from there later by dT, what they take longer in all: dv' = -a dT (see ``contact``); where
they leave it all, rolling friction begins later by dT.

Where the first order ends, trust ends: when the error reaches the distance by which the path passed a corner
(points: the distance of a hit from a corner that turns), or the depth of a grazing hit.

A run is good throughout if its end is good too: the place to the tolerance, and the velocity to the tolerance a second,
so that a second later the ball would be where it should be. An error of the time at which endless bounces are over,
some rounding of a place over the speed of the last of them, is seen nowhere else.
"""

from __future__ import annotations

import contextlib
import math
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from wallkit.geometry.arrays import FloatArray
from wallkit.geometry.bulge_arcs import circles
from wallkit.kernels.flight.error_growth import (
    BOUNCES,
    JOINS,
    LEAVES,
    PASSES,
    SLIDES,
    SLOWS,
    STOPS,
    TURNS,
    carry,
    stretch,
)
from wallkit.kernels.impact.leaving import LEVEL_SPEED
from wallkit.kernels.jit import NotCompiledError, compile_for, compiled, never_compiling
from wallkit.kernels.signatures import kinds_of
from wallkit.scene.scene import Scene
from wallkit.simulation.contact_errors import SURE, Course, drawing_errors, roundings
from wallkit.simulation.damping import damping_of, on_a_free_clock, slowing_of
from wallkit.simulation.glide_errors import COLUMNS, glides_of
from wallkit.simulation.gliding import edges_of, pull_along
from wallkit.simulation.made_errors import made_errors
from wallkit.simulation.near_misses import NEAR_CORNER, NEAR_GRAZE, FlightTable, near_misses

ErrorSource = Literal["rounding", "drawing"]
VERTEX, ENTER, END = 1, 4, 8
"""Kinds of contacts, see ``wallkit.simulation.run.ContactKind``: bounces up to the first, sensors from the second; and
of a row that is none, where the run ends."""
COMPILED_FROM = 50_000  # contacts
FIRST = 4096  # contacts of a long run that are asked first
TWICE = 2.0  # promised is this many times the known error


@dataclass(frozen=True, slots=True)
class Horizon:
    """Up to where one ball's run is good to a tolerance.

    Attributes:
        tolerance: of the place of a contact, in the drawing's units.
        bounces: so many bounces, from the first, are good to it.
        time: of the last contact that is; the run's end where all are good.
        whole: nothing of the run is in doubt: neither a contact, nor place and velocity at its end.
        source: what the error comes from: the rounding of the arithmetic, or the drawing's own tolerance.
        reason: why trust ends: ``"growth"``, ``"corner"`` (it may pass a corner on the other side), ``"graze"``
            (it may miss what it grazed), ``"meeting"`` (it may meet another ball, or one of its balls may be in
            doubt), or ``""``.
    """

    tolerance: float
    bounces: int
    time: float
    whole: bool
    source: ErrorSource = "rounding"
    reason: str = ""

    def sentence(self) -> str:
        """Say it in one line, for people."""
        to = f"{self.tolerance:g}".replace("e-0", "e-")
        if self.whole:
            return f"good to {to} throughout ({self.bounces} bounces)"
        after = {
            "corner": "a corner decides after that",
            "graze": "a grazing hit decides after that",
            "meeting": "whom it meets is in doubt after that",
        }
        end = after.get(self.reason, "chaos after that")
        return f"good to {to} up to bounce {self.bounces}; {end}"


def trusted_until(
    scene: Scene,
    contacts: Any,
    ball: int = 0,
    tolerance: float = 1e-6,
    source: ErrorSource = "rounding",
    final: Any = None,
) -> Horizon:
    """Say up to where a ball's contacts are good to ``tolerance``.

    Args:
        scene: what was run.
        contacts: its contacts (the dtype ``run.CONTACT``), of all balls, in order of time for each; where a
            slide begins and ends is part of the path, and no bounce.
        ball: which ball.
        tolerance: of the place of a contact, in the drawing's units; above 0.
        source: ``"rounding"``, or ``"drawing"``: walls that are off by their ``measured_error``.
        final: where the run ended, of ``run.FINAL``, after all these contacts; or None, where only they matter.
    """
    own = contacts[(contacts["ball"] == ball) & (contacts["kind"] < ENTER)]  # a sensor changes no flight
    if final is not None and len(scene.walls):
        own = _and_end(own, final)
    place, speed = _promised(*_errors(scene, own, ball, source))
    good = place <= tolerance
    if final is not None and len(own):
        good[-1] &= speed[-1] <= tolerance
    limit = len(own) if good.all() else int(np.argmin(good))
    reason = "" if good.all() else "growth"
    doubt, why = _first_doubt(scene, own[:limit], ball, place[:limit])
    if doubt < limit:
        limit, reason = doubt, why
    whole = limit == len(own)
    time = float(own["time"][limit - 1]) if limit else 0.0
    bounces = int(np.count_nonzero(own["kind"][:limit] <= VERTEX))
    return Horizon(tolerance, bounces, time, whole, source, reason)


def _and_end(own: Any, final: Any) -> Any:
    """Add a last row to a ball's contacts, where its run ended."""
    end = own[-1:].copy() if len(own) else np.zeros(1, dtype=own.dtype)
    end["kind"] = END
    for name in ("time", "x", "y", "vx", "vy"):
        end[name] = final[name]
    return np.concatenate([own, end])


def predicted_errors(
    scene: Scene, own: Any, ball: int = 0, source: ErrorSource = "rounding"
) -> tuple[FloatArray, FloatArray]:
    """Predict the error of the place of each contact of one ball: what it is expected to be, and at worst.

    Args:
        scene: what was run.
        own: (n,) contacts of that ball alone, in order.
        ball: which ball.
        source: see :func:`trusted_until`.

    Returns:
        Two arrays (n,), in the drawing's units; infinite once that is no number any more. The first is what the errors
        that are known add up to, with the root mean square of the others.
    """
    known, rms = _errors(scene, own, ball, source)
    return np.hypot(known[0], rms[0]), _promised(known, rms)[0]


def _promised(known: FloatArray, rms: FloatArray) -> FloatArray:
    """(2, n) what errors are at most, of :func:`_errors`."""
    return TWICE * known + SURE * rms


def _errors(
    scene: Scene, own: Any, ball: int, source: ErrorSource, at_hand: bool = False
) -> tuple[FloatArray, FloatArray]:
    """(2, n) errors of the place of each contact, and of the velocity after it: known, and the root mean square.

    What is ``at_hand`` of machine code is used for few contacts, too.
    """
    if len(own) > 2 * FIRST:  # chaos has multiplied them beyond all numbers long before
        first = _errors(scene, own[:FIRST], ball, source, at_hand=len(own) > COMPILED_FROM)
        if math.isinf(first[1][0, -1]):
            known, rms = (np.pad(part, ((0, 0), (0, len(own) - FIRST)), constant_values=np.inf) for part in first)
            return known, rms
    with np.errstate(over="ignore", invalid="ignore"):  # as compiled kernels do
        carried = _carried(scene, own, ball, source)
        variance, sums = carried[-2:]
        _carry(carried, len(own), at_hand)
    for table in (variance, sums):
        table[~(table >= 0.0)] = np.inf  # overflown on the way: beyond any promise
    # a ball that stands is exactly still; one that damping slowed down has lost as much of its error as of its speed
    now, free = np.hypot(own["vx"], own["vy"]), np.hypot(*carried[1][:, 1:3].T)
    part = np.divide(now, free, out=np.ones(len(own)), where=free > 0.0)
    known, rms = sums.T, np.sqrt(variance).T
    for errors in (known, rms):
        errors[1] = np.multiply(part, errors[1], out=np.zeros(len(own)), where=now > 0.0)
    return known, rms


def _carried(scene: Scene, own: Any, ball: int, source: ErrorSource) -> tuple[Any, ...]:
    """What the kernel takes that carries errors along; the last two are where variances and known errors go."""
    course = _course(scene, own, ball)
    variance, sums = np.full((len(own), 2), np.inf), np.zeros((len(own), 2))
    if source == "drawing":
        return (*course, drawing_errors(scene, own), None, variance, sums)
    fresh, in_corner = roundings(scene, own, course, ball)
    _, path, _, keep, _, _, glides = course
    made, known = made_errors(scene, own, path, keep, ~np.isnan(glides[:, 0]) | in_corner, ball)
    fresh[known] = 0.0
    return (*course, fresh, made, variance, sums)


def warm_horizon(scene: Scene, contacts: Any) -> None:
    """Compile what a long run's horizon takes in scenes like this one, of which these are some ball's contacts."""
    compile_for(carry, *kinds_of(_carried(scene, contacts[contacts["kind"] < ENTER], 0, "rounding")))


def growth(scene: Scene, own: Any, ball: int = 0) -> FloatArray:
    """Carry one small error along; its mean per time is the largest Lyapunov exponent.

    Args:
        scene: what was run.
        own: (n,) contacts of one ball alone, in order.
        ball: which ball.

    Returns:
        (n,) natural logarithm of the growth from each contact to the next, of ``|(dx, dv)|`` with lengths and
        speeds in the drawing's units.
    """
    logs = np.zeros(len(own))
    _kernel(stretch, len(own))(*_course(scene, own, ball), np.array([0.6, 0.3, 0.2, 0.7]), logs)
    return logs


def _carry(carried: tuple[Any, ...], contacts: int, at_hand: bool) -> None:
    """Carry errors along: interpreted where few contacts would have to wait for a compiler."""
    if at_hand:
        with contextlib.suppress(NotCompiledError), never_compiling():
            compiled(carry)(*carried)
            return
    _kernel(carry, contacts)(*carried)


def _kernel(function: Any, contacts: int) -> Any:
    """Interpret some 20 microseconds a contact, or compile (seconds, once) where that would take longer."""
    return compiled(function) if contacts > COMPILED_FROM else function


def _course(scene: Scene, own: Any, ball: int) -> Course:
    """What the kernels need of one ball's run: first velocity, path, bends, restitutions, accelerations, drag."""
    materials = scene.walls.materials
    table = np.array([(m.tangential_restitution, m.restitution) for m in materials]).reshape(-1, 2)
    path = np.stack([own[name].astype(np.float64) for name in ("time", "vx", "vy", "nx", "ny", "kind")], axis=1)
    path[:, 5] = np.maximum(path[:, 5] - 1.0, 0.0)  # edge and vertex are bounces; slide and leave are not
    slides = path[:, 5] == SLIDES
    stands = (own["vx"] == 0.0) & (own["vy"] == 0.0)
    before = np.concatenate([[LEAVES], path[:-1, 5]])
    path[slides & (before == SLIDES), 5] = np.where(stands, TURNS, PASSES)[slides & (before == SLIDES)]
    begin, start = (np.atleast_2d(np.asarray(part))[ball] for part in (scene.balls.position, scene.balls.velocity))
    if (damping := damping_of(scene)) is not None:
        path[:, 0], path[:, 1:3] = on_a_free_clock(damping, np.concatenate([begin, start]), own)
    gravity = np.asarray(scene.gravity if scene.gravity is not None else (0.0, 0.0), dtype=np.float64)
    pull = np.tile(gravity, (len(own) + 1, 1))
    slowing = slowing_of(scene)
    for row in np.flatnonzero(slides).tolist():
        pull[row + 1] = pull_along(gravity, slowing, path[row, 1:3], path[row, 3:5])
    keep = table[own["wall"]]
    ended = slides & (before == BOUNCES) & (keep[:, 1] < 1.0) & (np.diff(path[:, 0], prepend=0.0) > 0)
    path[ended & stands & (keep[:, 0] < 1.0), 5] = STOPS
    path[ended & ~stands & (keep[:, 0] == 1.0) & (slowing.rolling is not None), 5] = SLOWS
    for row in np.flatnonzero(path[:, 5] == SLOWS).tolist():
        pull[row + 1] = _pull_after_bounces(gravity, slowing.rolling or 0.0, path[row - 1], path[row], keep[row, 1])
    glides = glides_of(scene, own, gravity) if slides.any() else np.full((len(own), COLUMNS), math.nan)
    course = start, np.ascontiguousarray(path), bends(scene, own, ball), keep, pull, slowing.drag or 0.0, glides
    if slides.any():
        _mark_joins(course)
    return course


def _mark_joins(course: Course) -> None:
    """Mark the bounces at which a ball comes along a hollow's tangent to where it begins, and goes on along it.

    They turn nothing, and no neighbour is turned by more than its error; a wall that takes speed along it takes it all
    from a neighbour that strikes it, so there they are left to be what they are, a doubt.
    """
    _, path, bend, keep, _, _, _ = course
    at_once = np.diff(path[:, 0], append=np.inf) == 0.0
    held = np.concatenate([path[1:, 5], [LEAVES]]) == SLIDES
    found = (path[:, 5] == BOUNCES) & at_once & held & (bend < 0.0) & (keep[:, 0] == 1.0)
    if found.any():
        velocity = _velocities_before(course)
        across = (velocity * path[:, 3:5]).sum(axis=1)
        rows = np.flatnonzero(found & (np.abs(across) <= LEVEL_SPEED * np.abs(velocity).sum(axis=1)))
        path[rows, 5], path[rows + 1, 5] = JOINS, PASSES


def _pull_after_bounces(
    gravity: FloatArray, rolling: float, bounce: FloatArray, slide: FloatArray, restitution: float
) -> FloatArray:
    """Acceleration along the wall where a ball begins to slide, whose endless bounces took T = 2 w / p (1 - e)."""
    ahead = np.array([-slide[4], slide[3]])
    pressed = 2.0 * float(bounce[1:3] @ bounce[3:5]) / ((1.0 - restitution) * (slide[0] - bounce[0]))
    pull = float(gravity @ ahead) - math.copysign(rolling * pressed, float(slide[1:3] @ ahead))
    return pull * ahead


def bends(scene: Scene, own: Any, ball: int) -> FloatArray:
    """(n,) curvature at each contact of the line that the ball's centre cannot cross, positive when convex."""
    walls = scene.walls
    radius = _radius(scene, ball)
    bent = np.zeros(len(own))
    corner = own["edge"] < 0
    if radius > 0:
        bent[corner] = 1 / radius
    if walls.has_arcs:
        edge = edges_of(walls, own)
        start = walls.edge_starts[edge]
        bulge = np.where(corner, 0.0, walls.bulges[start])
        round_ = bulge != 0
        centre, curve = circles(walls.vertices[start], walls.vertices[walls.edge_ends[edge]], bulge)
        facing = (own["x"] - centre[:, 0]) * own["nx"] + (own["y"] - centre[:, 1]) * own["ny"]
        with np.errstate(divide="ignore"):
            outside, inside = 1 / (curve + radius), -1 / (curve - radius)
        bent[round_] = np.where(facing > 0, outside, inside)[round_]
    return bent


def _radius(scene: Scene, ball: int) -> float:
    radii = np.asarray(scene.balls.radius, dtype=np.float64)
    return float(radii if radii.ndim == 0 else radii[ball])


def _first_doubt(scene: Scene, own: Any, ball: int, worst: FloatArray) -> tuple[int, str]:
    """Find the first contact whose flight, or hit, is so close to a corner or a graze that the error decides."""
    if not len(own):
        return 0, ""
    radius = _radius(scene, ball)
    doubts = np.zeros(len(own), dtype=np.int8)
    grazing = grazing_depths(scene, own, ball)
    doubts[grazing <= worst] = NEAR_GRAZE
    # Between two contacts an error is convex in time: nowhere more than at one of them, where it may be 0 by chance.
    worst = np.maximum(worst, np.concatenate([[0.0], worst[:-1]]))
    for index, clear, decides in near_misses(scene, _flights(scene, own, ball), radius, float(worst.max())):
        doubts[index[clear <= worst[index]]] = decides
    found = np.flatnonzero(doubts)
    if not len(found):
        return len(own), ""
    return int(found[0]), "corner" if doubts[found[0]] == NEAR_CORNER else "graze"


def _flights(scene: Scene, own: Any, ball: int) -> FlightTable:
    first, path, _, _, pull, drag, _ = _course(scene, own, ball)
    begin = np.atleast_2d(np.asarray(scene.balls.position, dtype=np.float64))[ball]
    ends = np.stack([own["x"], own["y"]], axis=1)
    held = (path[:-1, 5, None] == (SLIDES, PASSES, STOPS, SLOWS, TURNS)).any(axis=1)
    slides = np.concatenate([[False], held])  # a ball that slides misses nothing
    return FlightTable(
        start=np.concatenate([begin[None], ends[:-1]]),
        end=ends,
        velocity=np.concatenate([first[None], path[:-1, 1:3]]),
        time=np.where(slides, 0.0, np.diff(path[:, 0], prepend=0.0)),
        pull=pull[:-1] if scene.gravity is not None else None,
        drag=drag,
    )


def _velocities_before(course: Course) -> FloatArray:
    """(n, 2) velocity just before each contact; one that restitution 0 leaves tells no angle any more."""
    start, path, _, _, pull, drag, glides = course
    time = np.diff(path[:, 0], prepend=0.0)
    left, free = np.ones(len(path)), time
    if drag > 0.0:
        left, free = np.exp(-drag * time), -np.expm1(-drag * time) / drag
    flown = np.concatenate([start[None], path[:-1, 1:3]]) * left[:, None] + pull[:-1] * free[:, None]
    return np.where(np.isnan(glides[:, :1]), flown, glides[:, :2])


def grazing_depths(scene: Scene, own: Any, ball: int) -> FloatArray:
    """(n,) by how much a neighbour may be off before it misses the convex thing that was hit: rho (1 - sin)."""
    bent, course = bends(scene, own, ball), _course(scene, own, ball)
    velocity = _velocities_before(course)
    speed, normal = np.hypot(velocity[:, 0], velocity[:, 1]), course[1][:, 3:5]
    cosine = np.divide((velocity * normal).sum(axis=1), speed, out=np.ones(len(own)), where=speed > 0)
    lost = cosine**2 / (1 + np.sqrt(np.maximum(0.0, 1 - cosine**2)))
    depth: FloatArray = np.divide(lost, bent, out=np.full(len(own), np.inf), where=(bent > 0) & (own["kind"] <= VERTEX))
    return depth
