"""What a path only just missed: corners and walls that a small error would have it hit, or pass on the other side.

All between two contacts: a straight flight, or a parabola under gravity. A disc is the path of its centre, and what it
misses is widened by its radius.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray
from wallkit.geometry.bulge_arcs import circles
from wallkit.scene.scene import Scene
from wallkit.simulation.damping import flown_on

NEAR_CORNER, NEAR_GRAZE = 1, 2
_ALL_PAIRS = 1 << 14
"""Of a flight and a thing, so many are all looked at: importing shapely for a tree takes longer."""
Near = tuple[NDArray[np.int64], FloatArray, int]
"""Which flights, by how much they missed, and what: CORNER or GRAZE."""


class FlightTable(NamedTuple):
    """The flights of one ball from contact to contact.

    Attributes:
        start: (n, 2) where each begins.
        end: (n, 2) where it ends.
        velocity: (n, 2) at its start.
        time: (n,) how long it takes.
        pull: (n, 2) acceleration, drag aside, or None where there is none.
        drag: rate of drag under gravity, or 0.
    """

    start: FloatArray
    end: FloatArray
    velocity: FloatArray
    time: FloatArray
    pull: FloatArray | None
    drag: float = 0.0

    @property
    def pulls(self) -> FloatArray:
        """(n, 2) acceleration, zeros where there is none."""
        return np.zeros_like(self.velocity) if self.pull is None else self.pull

    def at(self, which: NDArray[np.int64], when: FloatArray) -> FloatArray:
        """(k, 2) centres of some flights at times since their start."""
        return self.states(which, when)[0]

    def states(self, which: NDArray[np.int64], when: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """(k, 2) centres, velocities and accelerations of some flights at times since their start."""
        t, velocity, pull = when[:, None], self.velocity[which], self.pulls[which]
        if self.drag == 0.0:
            return self.start[which] + velocity * t + 0.5 * pull * t * t, velocity + pull * t, pull
        flown = flown_on(self.drag, self.start[which], velocity, pull, t)
        return flown[:, 0:2], flown[:, 2:4], pull - self.drag * flown[:, 2:4]


def near_misses(scene: Scene, flights: FlightTable, radius: float, reach: float) -> Iterator[Near]:
    """Find what the flights pass by no more than ``reach``.

    Args:
        scene: the walls.
        flights: of one ball.
        radius: of it.
        reach: the largest error that matters.
    """
    yield _near_corners(scene, flights, radius, reach)
    if scene.walls.has_arcs:
        yield _near_arcs(scene, flights, radius, reach)
    if flights.pull is not None:
        yield _near_lines(scene, flights, radius, reach)


def _near_corners(scene: Scene, flights: FlightTable, radius: float, reach: float) -> Near:
    """Flights that pass a corner by no more than ``reach``."""
    corners = _turning_corners(scene)
    found, corner = _pairs(flights, len(corners), lambda shapely: shapely.points(corners), radius + reach)
    along, clear = closest(flights, found, corners[corner])
    # A disc rolls from an edge on to its corner without a jump: only a corner passed in full flight decides.
    # For a point the hit itself counts; where it started is the last flight's end and was judged there.
    decides = (along > 0) & ((along < 1) | (radius == 0)) & (clear - radius <= reach)
    # A disc that pivoted on a corner, or bounced off it, begins at its radius from there, and was judged there.
    off = flights.start[found] - corners[corner]
    decides &= np.hypot(off[:, 0], off[:, 1]) - radius > reach
    return found[decides], np.maximum(0.0, clear[decides] - radius), NEAR_CORNER


def _turning_corners(scene: Scene) -> FloatArray:
    """(m, 2) vertices where a wall ends, or turns: at the others a hit to the left or right is the same."""
    walls = scene.walls
    start, end = walls.edge_starts, walls.edge_ends
    d = walls.vertices[end] - walls.vertices[start]
    chord = np.arctan2(d[:, 1], d[:, 0])
    half = 2 * np.arctan(walls.bulges[start])  # an arc leaves its chord by half its angle
    leaving = np.full(len(walls.vertices), np.nan)
    arriving = np.full(len(walls.vertices), np.nan)
    leaving[start], arriving[end] = chord - half, chord + half
    turn = leaving - arriving
    straight = np.abs(np.remainder(turn + math.pi, math.tau) - math.pi) < 1e-12
    return np.asarray(walls.vertices[~straight], dtype=np.float64)


def _near_arcs(scene: Scene, flights: FlightTable, radius: float, reach: float) -> Near:
    """Flights that pass the convex side of an arc by no more than ``reach``."""
    walls = scene.walls
    edges = np.flatnonzero(walls.bulges[walls.edge_starts])
    a, b = walls.vertices[walls.edge_starts[edges]], walls.vertices[walls.edge_ends[edges]]
    bulge = walls.bulges[walls.edge_starts[edges]]
    centre, curve = circles(a, b, bulge)
    around = np.stack([centre - curve[:, None], centre + curve[:, None]], axis=1).reshape(-1, 4)
    found, arc = _pairs(flights, len(around), lambda shapely: shapely.box(*around.T), radius + reach)
    along, distance = closest(flights, found, centre[arc])
    chord = b - a
    middle = np.sign(bulge)[:, None] * np.stack([chord[:, 1], -chord[:, 0]], axis=1)
    middle /= np.maximum(np.hypot(middle[:, 0], middle[:, 1]), 1e-300)[:, None]
    cos_half = np.cos(2 * np.arctan(np.abs(bulge)))
    outward = flights.at(found, along * flights.time[found]) - centre[arc]
    beside = (outward * middle[arc]).sum(axis=1) >= cos_half[arc] * np.maximum(distance, 1e-300)
    clear = distance - curve[arc] - radius
    keep = beside & (along > 0) & (along < 1) & (clear >= 0) & (clear <= reach)
    return found[keep], clear[keep], NEAR_GRAZE


def _near_lines(scene: Scene, flights: FlightTable, radius: float, reach: float) -> Near:
    """Falling flights whose parabola turns round just before a line: +-d(t) - r has its least value at -vn / gn."""
    walls = scene.walls
    edges = np.flatnonzero(walls.bulges[walls.edge_starts] == 0)
    a, b = walls.vertices[walls.edge_starts[edges]], walls.vertices[walls.edge_ends[edges]]
    ends = np.stack([a, b], axis=1)
    found, line = _pairs(flights, len(ends), lambda shapely: shapely.linestrings(ends), radius + reach)
    along = (b - a)[line]
    length = np.hypot(along[:, 0], along[:, 1])
    normal = np.stack([along[:, 1], -along[:, 0]], axis=1) / np.maximum(length, 1e-300)[:, None]
    across = (flights.velocity[found] * normal).sum(axis=1)
    pull = (flights.pulls[found] * normal).sum(axis=1)
    with np.errstate(over="ignore"):  # an infinite time is beyond the flight
        turn = np.divide(-across, pull, out=np.full(len(found), -1.0), where=pull != 0)
    if flights.drag > 0.0:  # -v / g is the time in which a speed would turn, (e^(k t) - 1) / k that in which it does
        turn = np.where(turn > 0, np.log1p(flights.drag * np.maximum(turn, 0.0)) / flights.drag, turn)
    inside = np.clip(turn, 0.0, flights.time[found])
    offset = flights.at(found, inside) - a[line]
    side = (offset * normal).sum(axis=1)
    clear = np.abs(side) - radius
    foot = (offset * along).sum(axis=1)
    nearest = (turn > 0) & (turn < flights.time[found]) & (side * pull > 0)  # not the top of a hop off the floor
    keep = nearest & (foot >= 0) & (foot <= length * length) & (clear >= 0) & (clear <= reach)
    return found[keep], clear[keep], NEAR_GRAZE


def _pairs(
    flights: FlightTable, count: int, made: Callable[[Any], NDArray[Any]], distance: float
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Which flights may come how near to which of ``count`` things, that shapely makes; those that do are among them.

    By distance, or for parabolas by the box around them.
    """
    if len(flights.time) * count <= _ALL_PAIRS:
        found, thing = np.indices((len(flights.time), count)).reshape(2, -1)
        return found, thing
    import shapely

    tree = shapely.STRtree(made(shapely))
    if flights.pull is None:
        lines = shapely.linestrings(np.stack([flights.start, flights.end], axis=1))
        found, thing = tree.query(lines, predicate="dwithin", distance=distance)
    else:
        # a parabola stays within |g| t^2 / 8 of its chord; with drag the acceleration is largest at the start
        bend = flights.pulls - flights.drag * flights.velocity
        sag = np.hypot(bend[:, 0], bend[:, 1]) * flights.time**2 / 8 + distance
        low, high = np.minimum(flights.start, flights.end), np.maximum(flights.start, flights.end)
        boxes = shapely.box(low[:, 0] - sag, low[:, 1] - sag, high[:, 0] + sag, high[:, 1] + sag)
        found, thing = tree.query(boxes, predicate="intersects")
    return found, thing


def closest(flights: FlightTable, found: NDArray[np.int64], points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Where in its time (0 to 1) a flight is closest to a point, and how far it is from there."""
    time = np.maximum(flights.time[found], 1e-300)
    if flights.pull is None:
        start, velocity = flights.start[found] - points, flights.velocity[found]
        speed2 = np.maximum((velocity * velocity).sum(axis=1), 1e-300)
        when = np.clip(-(start * velocity).sum(axis=1) / speed2, 0.0, time)
    else:
        when = _closest_of_parabola(flights, found, points, time)
    away = flights.at(found, when) - points
    return when / time, np.hypot(away[:, 0], away[:, 1])


def _closest_of_parabola(
    flights: FlightTable, found: NDArray[np.int64], points: FloatArray, time: FloatArray
) -> FloatArray:
    """Least distance of a point from a flight in [0, time]: the best of 65 moments, then Newton on the derivative."""
    parts = np.linspace(0.0, 1.0, 65)
    when = np.zeros(len(time))
    least = np.full(len(time), np.inf)
    for part in parts:
        distance = ((flights.at(found, part * time) - points) ** 2).sum(axis=1)
        better = distance < least
        when[better], least[better] = (part * time)[better], distance[better]
    for _ in range(8):
        place, speed, pull = flights.states(found, when)
        place = place - points
        slope = (place * speed).sum(axis=1)
        bend = (speed * speed).sum(axis=1) + (place * pull).sum(axis=1)
        when = np.clip(when - np.divide(slope, bend, out=np.zeros_like(slope), where=bend > 0), 0.0, time)
    return when
