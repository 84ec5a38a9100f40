"""Windows by search: single shots, more and more where neighbours part, until borders are known to rounding."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from importers.errors import LimitError
from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.kernels.beams.rays import NEVER, Scratch, Shots, shoot
from wallkit.kernels.beams.wedges import Target
from wallkit.kernels.compile_aside import at_hand
from wallkit.kernels.jit import compile_for, compiled
from wallkit.kernels.records import LOG_STRIDE, NO_HIT
from wallkit.kernels.signatures import kinds_of
from wallkit.scene.scene import Balls, Scene
from wallkit.simulation.modelled import Modelled
from wallkit.simulation.sensors import modelled_sensors
from wallkit.simulation.simulate import START, initial_states
from wallkit.walls import Walls

FIRST_STEP = 2.0 * math.pi / 16384
"""Radians between the first shots, at most."""
APART, ON_CURVES = 2.0**-9, 2.0**-4
"""Of the walls' size: neighbouring shots bounce nowhere farther apart, 0.2 %; and of the radius of a curve, or of the
ball at a vertex: so they do not part by more than 7 degrees in one bounce."""
ON_TARGET = 0.25
"""Of the target's radius: neighbouring shots that pass it, or would, are no farther apart there."""
FINEST = 1e-7
"""Radians between neighbouring shots that differ, at the least, where neither reaches the target."""
POLISHED = 1e-14
"""Radians to which the borders of a window are known."""
CHUNK, MOST_FLIGHTS = 1024, 1 << 23
"""First pairs that are worked on together, and flights of all shots that they may come to: 32 bytes each in memory. Of
more, fewer pairs are worked on together."""


class Searched(NamedTuple):
    """Windows that were searched, a row each, as :class:`wallkit.levels.unfolding.Unfolded` has them.

    Attributes:
        low: (n,) radians.
        high: (n,) radians, not below low.
        bounces: (n,) int.
        words: (n, K) features bounced off, NO_HIT behind the last.
        shots: how many were flown.
    """

    low: FloatArray
    high: FloatArray
    bounces: IntArray
    words: IntArray
    shots: int


@dataclass(frozen=True, eq=False)
class Shooter:
    """A scene in which shots are flown from one point.

    Attributes:
        modelled: what the kernels see of it.
        begin: floats of a ball at the start.
        target: local.
        sensors: the target as a sensor, None without gravity.
        radius: of the ball.
        speed: of the ball.
        bounces: K.
        apart: by feature, length by which neighbours may be apart where they bounce off it: edges from 0 on, and from
            the end backwards NO_HIT and vertices.
    """

    modelled: Modelled
    begin: FloatArray
    target: Target
    sensors: Any
    radius: float
    speed: float
    bounces: int
    apart: FloatArray

    @staticmethod
    def of(
        scene: Scene,
        start: tuple[float, float],
        target: tuple[float, float, float],
        bounces: int,
        radius: float,
        speed: float,
    ) -> Shooter:
        """Make ready to shoot; the balls of the scene play no part."""
        scene = replace(scene, balls=Balls([start], [(speed, 0.0)], radius))
        modelled = Modelled(scene)
        begin = initial_states(modelled, scene.balls.position, scene.balls.velocity)[0]
        local = Target(target[0] - modelled.origin[0], target[1] - modelled.origin[1], target[2])
        sensors = None
        if modelled.model.gravity is not None:
            sensors = modelled_sensors(scene, _disc(target), modelled.origin).model
        x0, y0, x1, y1 = modelled.box
        most = APART * max(x1 - x0, y1 - y0)
        if sensors is not None:
            most = min(most, ON_TARGET * target[2])  # under gravity no side tells that the target was passed over
        apart = np.full(len(modelled.model.lines) + len(scene.walls.vertices) + 1, most)
        if (arcs := modelled.model.arcs) is not None:
            curved = np.flatnonzero(arcs["radius"] > 0.0)
            apart[curved] = np.minimum(most, ON_CURVES * (arcs["radius"][curved] + radius))
        apart[len(modelled.model.lines) : -1] = min(most, ON_CURVES * radius)
        return Shooter(modelled, begin, local, sensors, radius, speed, bounces, apart)

    def fly(self, angle: FloatArray) -> Shots:
        """Fly a shot in each direction, in radians."""
        velocities = self.speed * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        arguments, shots = self._arguments(velocities)
        compiled(shoot)(*arguments)
        return shots

    def machine_code_at_hand(self) -> bool:
        """Tell whether shots can be flown at once; where not, the kernel is being compiled aside from now on."""
        return at_hand(compile_for, shoot, *self._kinds())

    def warm(self) -> None:
        """Compile the kernel of shots, or load it."""
        compile_for(shoot, *self._kinds())

    def _kinds(self) -> tuple[Any, ...]:
        return kinds_of(self._arguments(np.ones((1, 2)))[0])

    def _arguments(self, velocities: FloatArray) -> tuple[tuple[Any, ...], Shots]:
        """Give what the kernel is called with for shots, and where it writes them."""
        n, most, model = len(velocities), self.bounces, self.modelled.model
        shots = Shots(
            np.full(n, NEVER, dtype=np.int64),
            np.full((n, most + 1), NO_HIT, dtype=np.int64),
            np.zeros((n, 2 * most + 2)),
            np.full((n, most + 1), np.inf),
        )
        capacity = most + 2
        counts, start = (np.array(START, dtype=np.int64) for _ in range(2))
        hits = np.zeros(max(1, len(model.edge_wall)), dtype=np.int64)
        log, found = np.empty(capacity * LOG_STRIDE), np.zeros(2, dtype=np.int64)
        scratch = Scratch(self.begin.copy(), counts, start, hits, log, found)
        pull = None if model.gravity is None else np.zeros(2)
        arguments = (model, model.gravity, pull, self.sensors, self.target, self.radius, self.begin, velocities, most,
                     scratch, capacity, shots)  # fmt: skip
        return arguments, shots


def _disc(target: tuple[float, float, float]) -> Walls:
    """Make the target a sensor: its outward normals point away from its middle."""
    x, y, r = target
    return Walls.from_polylines([[(x - r, y), (x + r, y)]], bulges=[[1.0, 1.0]])


def search(
    shooter: Shooter,
    intervals: FloatArray,
    most_shots: int,
    finest: float = FINEST,
    progress: Callable[[int], None] | None = None,
) -> Searched:
    """Search intervals of directions.

    Neighbouring shots get another one between them as long as

    * one reaches the target and the other does not, or both by other words: down to POLISHED;
    * neither does, and the target lies between their lines after the same bounces: down to ON_TARGET of its radius;
    * they bounce off different walls, or off the same one too far apart: down to ``finest``.

    Args:
        shooter: flies the shots.
        intervals: (n, 2) radians.
        most_shots: a limit.
        finest: radians.
        progress: called now and then with the shots so far.

    Raises:
        LimitError: it takes more shots.
    """
    angle, interval = _first_shots(intervals)
    found, flown, chunks = [], 0, [(first, CHUNK) for first in range(0, len(angle) - 1, CHUNK)][::-1]
    while chunks:
        first, size = chunks.pop()
        last = first + size + 1  # neighbouring chunks share a shot
        part = _refined(shooter, angle[first:last], interval[first:last], finest, most_shots - flown)
        if part is None:
            half = size // 2
            chunks += [(first + half, size - half), (first, half)]
            continue
        flown += len(part[0])
        found.append(_windows(*part))
        if progress is not None:
            progress(flown)
    if not found:
        return Searched(np.empty(0), np.empty(0), np.empty(0, np.int64), np.empty((0, shooter.bounces), np.int64), 0)
    low, high, bounces, words = (np.concatenate(parts) for parts in zip(*found, strict=True))
    return Searched(low, high, bounces, words, flown)


def _first_shots(intervals: FloatArray) -> tuple[FloatArray, IntArray]:
    """Choose the first directions, in rising order, both ends of each interval among them; and the interval of each."""
    counts = [max(2, math.ceil((high - low) / FIRST_STEP)) + 1 for low, high in intervals.tolist()]
    angles = [np.linspace(low, high, count) for (low, high), count in zip(intervals.tolist(), counts, strict=True)]
    angle = np.concatenate(angles) if angles else np.empty(0)
    return angle, np.repeat(np.arange(len(counts)), counts)


def _refined(
    shooter: Shooter, angle: FloatArray, interval: IntArray, finest: float, most: int
) -> tuple[FloatArray, IntArray, Shots] | None:
    """Fly shots in directions in rising order, and more between them: all directions, their intervals, and the shots.

    A pair is looked at once: when it is divided two new ones take its place. None if it comes to more than memory may
    hold, and there are pairs that may be worked on one by one.
    """
    shots, count, pairs = shooter.fly(angle), len(angle), len(angle) - 1
    left = np.flatnonzero(interval[1:] == interval[:-1])
    right = left + 1
    while True:
        divide = _differ(shooter, angle[right] - angle[left], _rows(shots, left), _rows(shots, right), finest)
        left, right = left[divide], right[divide]
        if not len(left):
            order = np.lexsort((angle[:count], interval[:count]))
            return angle[order], interval[order], _rows(shots, order)
        more = count + len(left)
        held = more > MOST_FLIGHTS // (shooter.bounces + 1)
        if held and pairs > 1:
            return None
        if held or more > most:
            raise LimitError(
                "more shots than are allowed for the directions that cannot be unfolded",
                code="too-many-shots",
                fix="allow fewer bounces, or more beams (most_beams=, --most-beams)",
            )
        if more > len(angle):
            angle, interval = _with_room(angle, 2 * more), _with_room(interval, 2 * more)
            shots = Shots(*(_with_room(column, 2 * more) for column in shots))
        angle[count:more] = 0.5 * (angle[left] + angle[right])
        interval[count:more] = interval[left]
        for column, new in zip(shots, shooter.fly(angle[count:more]), strict=True):
            column[count:more] = new
        middle = np.arange(count, more)
        left, right, count = np.concatenate([left, middle]), np.concatenate([middle, right]), more


def _with_room(array: Any, rows: int) -> Any:
    """Give a copy with room for so many rows."""
    larger = np.empty((rows, *array.shape[1:]), dtype=array.dtype)
    larger[: len(array)] = array
    return larger


def _rows(shots: Shots, rows: IntArray) -> Shots:
    return Shots(*(column[rows] for column in shots))


def _differ(shooter: Shooter, width: FloatArray, one: Shots, other: Shots, finest: float) -> NDArray[np.bool_]:
    """Tell which pairs of shots, so far apart in direction, are to have another one between them."""
    r, most = shooter.target.radius, shooter.bounces
    reached = np.stack([one.reached, other.reached])
    hit = (reached >= 0).any(axis=0)
    # bounces before either reaches the target; else all, and under gravity, where no miss is known, one more
    matter = np.where(reached < 0, most + (shooter.sensors is not None), reached).min(axis=0)
    counts = np.arange(most + 1)[None, :] < matter[:, None]
    same = one.word == other.word
    same_word = (same | ~counts).all(axis=1)
    other_fate = hit & ((one.reached != other.reached) | ~same_word)
    dx, dy = ((one.places - other.places)[:, axis::2] for axis in (0, 1))
    far = (counts & same & (dx * dx + dy * dy > shooter.apart[one.word] ** 2)).any(axis=1)
    together = np.logical_and.accumulate(np.column_stack([np.ones(len(width), np.bool_), same[:, :-1]]), axis=1)
    with np.errstate(invalid="ignore"):  # inf - inf: no flight of either passes the target
        passes = (np.minimum(one.miss, other.miss) < r) & (np.maximum(one.miss, other.miss) > -r)
        passes &= np.abs(one.miss - other.miss) > ON_TARGET * r
    passed = ~hit & (together & passes & np.isfinite(one.miss) & np.isfinite(other.miss)).any(axis=1)
    divided: NDArray[np.bool_] = ((other_fate | passed) & (width > POLISHED)) | ((~same_word | far) & (width > finest))
    return divided


def _windows(angle: FloatArray, interval: IntArray, shots: Shots) -> tuple[FloatArray, FloatArray, IntArray, IntArray]:
    """Put neighbouring shots of an interval that reach the target by the same word together."""
    hit = np.flatnonzero(shots.reached >= 0)
    bounces = shots.reached[hit]
    words = np.where(np.arange(shots.word.shape[1] - 1)[None, :] < bounces[:, None], shots.word[hit][:, :-1], NO_HIT)
    same = (
        (np.diff(hit) == 1)
        & (np.diff(interval[hit]) == 0)
        & (bounces[1:] == bounces[:-1])
        & (words[1:] == words[:-1]).all(axis=1)
    )
    if not len(hit):
        return np.empty(0), np.empty(0), bounces, words
    first = np.flatnonzero(np.concatenate([[True], ~same]))
    last = np.append(first[1:], len(hit)) - 1
    return angle[hit[first]], angle[hit[last]], bounces[first], words[first]
