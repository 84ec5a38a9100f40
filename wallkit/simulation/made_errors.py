"""The errors that the arithmetic of a run has made at each contact: known, since the contacts are there.

From the state that is told after one contact the flight p + v t + g t^2 / 2 to the next, the wall that is met there and
the bounce off it are computed with twice the digits. What is told of the next contact, less that, is the error made on
the way: of its place, and of the state after it at the time that is told. It may be of any size and is no chance; its
own error is 2^-50 of a rounding. Carried along (see ``wallkit.simulation.horizon``) these add up to the run's error.

Of a wall from a to b with the bulge k, and w the way from a to the ball's centre, f(w) = m.w + K w^2 / 2 is the
distance d from it along its outward normal, plus K d^2 / 2. For the chord c of length |c|, with c turned right as c_r,

    m = ((1 - k^2) c_r - 2 k c) / (|c| (1 + k^2)),    K = 4 k / (|c| (1 + k^2)):

the outward normal at a, and the curvature; a line has k = 0, and nothing of the size 1 / K cancels where k is small. A
disc of radius r on the side s of it (1 or -1) touches it where the gap f(w) - s r - K r^2 / 2 is 0, and a vertex where
(w^2 / r - r) / 2 is. The gap's gradient, m + K w, is normal to the wall.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray, distinct
from wallkit.geometry.double_double import Double
from wallkit.kernels.flight.error_growth import BOUNCES, ENDS, LEAVES, SLOWS, STOPS
from wallkit.scene.scene import Scene
from wallkit.simulation.damping import damping_of
from wallkit.simulation.gliding import edges_of

COLUMNS = 6
"""Error of the contact's place (x, y), and of the state after it at the time that is told (x, y, vx, vy)."""
BLOCK = 4096
"""Contacts that are looked at together, so that their numbers stay in the cache."""
MOST_DISTANCES = 2**20
"""Distances from contacts to vertices that are in memory at once."""


class Vector(NamedTuple):
    """(n,) vectors with twice the digits."""

    x: Double
    y: Double

    @staticmethod
    def of(rows: FloatArray) -> Vector:
        """Floats (n, 2), as they are."""
        return Vector(Double.of(rows[:, 0]), Double.of(rows[:, 1]))

    def plus(self, other: Vector) -> Vector:
        """The sum."""
        return Vector(self.x.plus(other.x), self.y.plus(other.y))

    def minus(self, other: Vector) -> Vector:
        """The difference."""
        return Vector(self.x.minus(other.x), self.y.minus(other.y))

    def times(self, number: Double) -> Vector:
        """The vector, longer by a number."""
        return Vector(self.x.times(number), self.y.times(number))

    def dot(self, other: Vector) -> Double:
        """The scalar product."""
        return self.x.times(other.x).plus(self.y.times(other.y))

    def rounded(self) -> FloatArray:
        """(n, 2), the nearest floats."""
        return np.stack([self.x.rounded(), self.y.rounded()], axis=1)


class Gap(NamedTuple):
    """What is 0 where a ball touches: m.w + K w^2 / 2 - q, with w from a to its centre."""

    a: Vector
    m: Vector
    bend: Double
    touch: Double

    def at(self, place: Vector) -> tuple[Double, Vector]:
        """Give the gap at a place, and its gradient there."""
        w = place.minus(self.a)
        bent = w.times(self.bend)
        half = Vector(bent.x.scaled(0.5), bent.y.scaled(0.5))
        return w.dot(self.m.plus(half)).minus(self.touch), self.m.plus(bent)


def made_errors(
    scene: Scene, own: NDArray[Any], path: FloatArray, keep: FloatArray, gliding: NDArray[np.bool_], ball: int
) -> tuple[FloatArray, NDArray[np.bool_]]:
    """Give what each contact's arithmetic has made of error, where that is known.

    Known it is after a flight without drag, at a bounce and where the run ends.

    Args:
        scene: what was run.
        own: (n,) contacts of one ball, in order, of the dtype ``run.CONTACT``.
        path: of :func:`wallkit.kernels.flight.error_growth.carry`.
        keep: see ``path``.
        gliding: (n,) whether the ball came a circle along to a contact.
        ball: which ball.

    Returns:
        (n, COLUMNS) errors, 0 where they are not known; (n,) whether they are.
    """
    made, known = np.zeros((len(own), COLUMNS)), np.zeros(len(own), dtype=np.bool_)
    before = np.concatenate([[LEAVES], path[:-1, 5]])
    flown = ~gliding & np.isin(before, (BOUNCES, LEAVES)) & np.isin(path[:, 5], (BOUNCES, ENDS))
    if scene.drag or damping_of(scene) is not None or not flown.any():
        return made, known
    rows, told = np.flatnonzero(flown), _told(scene, own, ball)
    with np.errstate(all="ignore"):  # an edge without length has no normal, and is not met
        edges = _Edges(scene, edges_of(scene.walls, own))
    joins = np.isin(np.concatenate([path[1:, 5], [ENDS]]), (STOPS, SLOWS))
    radius = float(np.broadcast_to(np.asarray(scene.balls.radius), len(scene.balls))[ball])
    for some in np.array_split(rows, 1 + len(rows) // BLOCK):
        bounces = path[some, 5] == BOUNCES
        with np.errstate(all="ignore"):  # what overflows is no number, and not known
            gap = _gap(scene, own[some], edges.at(some), path[some, 3:5], radius)
            found, late = _errors(scene, told[some], told[some + 1], gap, keep[some], bounces)
            if joins[some].any():
                found[:, 2:4] -= _off_the_wall(gap, told[some + 1, 1:3], joins[some])
        # a hop as short as its own rounding is none that a neighbour shares
        short = np.abs(late) > 0.25 * (told[some + 1, 0] - told[some, 0])
        known[some] = ~short & np.isfinite(found).all(axis=1)
        made[some] = np.where(known[some, None], found, 0.0)
    return made, known


def _told(scene: Scene, own: NDArray[Any], ball: int) -> FloatArray:
    """(n + 1, 5) time, place and velocity at the start and after each contact."""
    balls = scene.balls
    first = [np.atleast_2d(np.asarray(part, dtype=np.float64))[ball] for part in (balls.position, balls.velocity)]
    rows = np.stack([own[name] for name in ("time", "x", "y", "vx", "vy")], axis=1)
    return np.concatenate([[[0.0, *first[0], *first[1]]], rows])


def _errors(
    scene: Scene, then: FloatArray, now: FloatArray, gap: Gap, keep: FloatArray, bounces: NDArray[np.bool_]
) -> tuple[FloatArray, FloatArray]:
    """Errors as of :func:`made_errors`, and by how much later than told what is met is met."""
    g = None
    if scene.gravity is not None:
        g = Vector.of(np.broadcast_to(np.asarray(scene.gravity, dtype=np.float64), (len(then), 2)))
    time = Double.of(now[:, 0]).minus(Double.of(then[:, 0]))
    place, velocity = _flown(Vector.of(then[:, 1:3]), Vector.of(then[:, 3:5]), g, time)
    # One step of Newton's to where the gap is 0; it is off by late^2, a rounding of a rounding.
    beyond, normal = gap.at(place)
    late = np.where(bounces, -beyond.rounded() / normal.dot(velocity).rounded(), 0.0)
    met, arriving = _moved(place, velocity, g, late)
    normal = normal.plus(Vector.of((gap.bend.high * late)[:, None] * velocity.rounded()))
    leaving = _turned(arriving, normal, keep, bounces)
    after, quick = _moved(met, leaving, g, -late)
    here, there = Vector.of(now[:, 1:3]), Vector.of(now[:, 3:5])
    return np.concatenate(
        [here.minus(part).rounded() for part in (met, after)] + [there.minus(quick).rounded()], 1
    ), late


def _flown(place: Vector, velocity: Vector, g: Vector | None, time: Double) -> tuple[Vector, Vector]:
    """Place and velocity a time later: p + (v + g t / 2) t, v + g t."""
    if g is None:
        return place.plus(velocity.times(time)), velocity
    gained = g.times(time)
    half = velocity.plus(Vector(gained.x.scaled(0.5), gained.y.scaled(0.5)))
    return place.plus(half.times(time)), velocity.plus(gained)


def _moved(place: Vector, velocity: Vector, g: Vector | None, time: FloatArray) -> tuple[Vector, Vector]:
    """Place and velocity a time later, so short that its own rounding matters no more."""
    t = Double.of(time)
    moved = place.plus(velocity.times(t))
    if g is None:
        return moved, velocity
    gained = g.times(t)
    return moved.plus(gained.times(Double.of(0.5 * time))), velocity.plus(gained)


def _turned(velocity: Vector, normal: Vector, keep: FloatArray, bounces: NDArray[np.bool_]) -> Vector:
    """T v - (T + R) (v.n) n / n^2 where a ball bounces, see ``wallkit.simulation.horizon``."""
    tangential, restitution = Double.of(keep[:, 0]), Double.of(keep[:, 1])
    part = tangential.plus(restitution).times(velocity.dot(normal)).over(normal.dot(normal))
    turned = velocity.times(tangential).minus(normal.times(part))
    chosen = [
        Double(np.where(bounces, one.high, other.high), np.where(bounces, one.low, other.low))
        for one, other in zip(turned, velocity, strict=True)
    ]
    return Vector(*chosen)


def _off_the_wall(gap: Gap, places: FloatArray, joins: NDArray[np.bool_]) -> FloatArray:
    """(n, 2) by how much places are off the wall, where the simulator puts them there: last bounces begin on it."""
    off, normal = gap.at(Vector.of(places))
    n = normal.rounded()
    part = np.where(joins, off.rounded() / (n * n).sum(axis=1), 0.0)
    return part[:, None] * n


class _Edges:
    """a, m and K of the edges that a ball has met, each worked out once."""

    def __init__(self, scene: Scene, edge: IntArray) -> None:
        walls, starts, ends = scene.walls, scene.walls.edge_starts, scene.walls.edge_ends
        met = np.zeros(len(starts), dtype=np.bool_)
        met[edge] = True
        used, number = np.flatnonzero(met), np.cumsum(met) - 1
        self._which = number[edge]
        start = starts[used]
        k = Double.of(walls.bulges[start] if walls.has_arcs else np.zeros(len(used)))
        self._a, b = Vector.of(walls.vertices[start]), Vector.of(walls.vertices[ends[used]])
        chord, square, one = b.minus(self._a), k.times(k), Double.of(np.ones(len(used)))
        size = chord.dot(chord).root().times(one.plus(square))
        right = Vector(chord.y, chord.x.scaled(-1.0)).times(one.minus(square))
        m = right.minus(chord.times(k.scaled(2.0)))
        self._m, self._bend = Vector(m.x.over(size), m.y.over(size)), k.scaled(4.0).over(size)

    def at(self, rows: IntArray) -> tuple[Vector, Vector, Double]:
        """Those of the edges of some contacts."""
        which = self._which[rows]

        def of(numbers: Double) -> Double:
            return Double(numbers.high[which], numbers.low[which])

        return Vector(*map(of, self._a)), Vector(*map(of, self._m)), of(self._bend)


def _gap(
    scene: Scene, own: NDArray[Any], edges: tuple[Vector, Vector, Double], normals: FloatArray, radius: float
) -> Gap:
    """What each contact's ball has met; for a row that is no bounce, something harmless."""
    (a, m, bend), corner = edges, own["edge"] < 0
    r = Double.of(np.full(len(own), radius))
    place = np.stack([own["x"], own["y"]], axis=1)
    out = m.rounded() + bend.rounded()[:, None] * (place - a.rounded())
    side = Double.of(np.sign((out * normals).sum(axis=1)))
    touch = side.times(r).plus(bend.times(r).times(r).scaled(0.5))
    if corner.any():
        vertex = Vector.of(scene.walls.vertices[_vertices_of(scene, own[corner], radius)])
        none = Double.of(np.zeros(np.count_nonzero(corner)))
        r = Double.of(np.full(np.count_nonzero(corner), radius))
        bent = Double.of(np.ones(len(r.high))).over(r)
        for mine, theirs in zip((*a, *m, bend, touch), (*vertex, none, none, bent, r.scaled(0.5)), strict=True):
            mine.high[corner], mine.low[corner] = theirs.high, theirs.low
    return Gap(a, m, bend, touch)


def _vertices_of(scene: Scene, own: NDArray[Any], radius: float) -> IntArray:
    """(n,) the vertex at which each contact is: the nearest one of its wall to the contact's point."""
    walls = scene.walls
    x, y = own["x"] - radius * own["nx"], own["y"] - radius * own["ny"]
    found = np.zeros(len(own), dtype=np.int64)
    for wall in distinct(own["wall"]).tolist():
        mine = np.flatnonzero(own["wall"] == wall)
        of_wall = np.arange(walls.offsets[wall], walls.offsets[wall + 1])
        places = walls.vertices[of_wall]
        for some in np.array_split(mine, 1 + len(mine) * len(of_wall) // MOST_DISTANCES):
            dx, dy = x[some, None] - places[None, :, 0], y[some, None] - places[None, :, 1]
            found[some] = of_wall[np.argmin(dx * dx + dy * dy, axis=1)]
    return found
