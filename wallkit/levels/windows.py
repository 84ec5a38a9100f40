"""Windows: intervals of directions, each with the word of walls that its shots bounce off on their way to a target."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, overload

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.walls import Walls

FORMAT, VERSION = "wallkit-aim", 1
NONE = np.iinfo(np.int64).min
"""In a word: behind its last letter."""
SAME = 2.0**-41
"""Radians, 4.5e-13: windows of one word that are as near are one; so narrow a beam between them is not followed."""


@dataclass(frozen=True, slots=True)
class Window:
    """All directions between two borders reach the target by one word.

    Attributes:
        low: radians from the x axis towards the y axis of the drawing, from -pi to pi.
        high: above ``low``; above pi where the window goes across that direction.
        bounces: before the target is reached.
        word: the walls bounced off, in order.
        edges: what of these walls, at the widest part of the window, by number over all walls: edge e of wall w is
            ``walls.edge_offsets[w] + e``. Below 0 it is a vertex, off which a disc may bounce: -1 - v for vertex v.
        searched: found by search, or a part of it; not by unfolding alone.
    """

    low: float
    high: float
    bounces: int
    word: tuple[int, ...]
    edges: tuple[int, ...]
    searched: bool = False

    @property
    def width(self) -> float:
        """Radians from border to border."""
        return self.high - self.low

    @property
    def middle(self) -> float:
        """The direction half-way, radians from -pi to pi."""
        middle = 0.5 * (self.low + self.high)
        return middle if middle < math.pi else middle - math.tau


@dataclass(frozen=True, eq=False, repr=False)
class Windows(Sequence[Window]):
    """The windows of one aim, in order of direction, and how they were found.

    Attributes:
        start: (x, y).
        target: (x, y, radius).
        radius: of the ball.
        most_bounces: K, that were allowed.
        low: (n,) radians, see :class:`Window`.
        high: (n,) radians.
        bounces: (n,) int64.
        searched: (n,) bool.
        words: (n, K) int64, the walls of each word and then ``NONE``.
        edges: (n, K) int64, see :class:`Window`, and then ``NONE``.
        searched_share: the part of all directions that could not be unfolded, 0 to 1. For the rest the windows are
            complete above 1e-12 radians.
        resolution: (radians, length) of the search: no window that is wider, between shots with the same word that pass
            as near one another, was missed; (0, 0) where nothing was searched.
        lost: radians, together, of beams narrower than 1.1e-13 that were not followed.
        beams: (K + 1,) beams followed, by bounces.
        shots: flown by the search.
        walls: of the scene.
    """

    start: tuple[float, float]
    target: tuple[float, float, float]
    radius: float
    most_bounces: int
    low: FloatArray
    high: FloatArray
    bounces: IntArray
    searched: NDArray[np.bool_]
    words: IntArray
    edges: IntArray
    walls: Walls
    searched_share: float = 0.0
    resolution: tuple[float, float] = (0.0, 0.0)
    lost: float = 0.0
    beams: IntArray = field(default_factory=lambda: np.zeros(1, dtype=np.int64))
    shots: int = 0

    def __len__(self) -> int:
        return len(self.low)

    @overload
    def __getitem__(self, index: int) -> Window: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[Window, ...]: ...
    def __getitem__(self, index: int | slice) -> Window | tuple[Window, ...]:
        """Give one window by its number, or several by a slice."""
        if isinstance(index, slice):
            return tuple(self[i] for i in range(*index.indices(len(self))))
        if not -len(self) <= index < len(self):
            raise IndexError(f"window {index} of {len(self)}")
        bounces = int(self.bounces[index])
        word, edges = (tuple(array[index, :bounces].tolist()) for array in (self.words, self.edges))
        return Window(float(self.low[index]), float(self.high[index]), bounces, word, edges, bool(self.searched[index]))

    def __iter__(self) -> Iterator[Window]:
        return (self[index] for index in range(len(self)))

    def __repr__(self) -> str:
        return f"<Windows: {self.sentence()}>"

    @property
    def width(self) -> FloatArray:
        """(n,) radians."""
        return self.high - self.low

    @property
    def total(self) -> float:
        """Width of all windows together, radians: over 2 pi, the chance of a blind shot."""
        return float(self.width.sum())

    @property
    def widest(self) -> Window | None:
        """The window that forgives most; None without any."""
        return self[int(np.argmax(self.width))] if len(self) else None

    @property
    def by_bounces(self) -> IntArray:
        """(K + 1,) windows by bounces."""
        return np.bincount(self.bounces, minlength=self.most_bounces + 1).astype(np.int64)

    def to_json(self) -> dict[str, Any]:
        """Give the ``wallkit-aim`` format of docs/aim.md."""
        angle, length = self.resolution
        return {
            "format": FORMAT,
            "version": VERSION,
            "source": {"file": self.walls.source_file, "sha256": self.walls.source_sha256},
            "start": list(self.start),
            "target": list(self.target),
            "radius": self.radius,
            "bounces": self.most_bounces,
            "total": self.total,
            "searched_share": self.searched_share,
            "resolution": {"angle": angle, "length": length},
            "lost": self.lost,
            "beams": self.beams.tolist(),
            "shots": self.shots,
            "windows": [self._window_json(window) for window in self],
        }

    def _window_json(self, window: Window) -> dict[str, Any]:
        offsets, vertices = self.walls.edge_offsets.tolist(), self.walls.offsets.tolist()
        edges = [
            {"wall": wall, "edge": letter - offsets[wall]}
            if letter >= 0
            else {"wall": wall, "vertex": -1 - letter - vertices[wall]}
            for wall, letter in zip(window.word, window.edges, strict=True)
        ]
        return {
            "low": window.low,
            "high": window.high,
            "degrees": math.degrees(window.middle),
            "width": window.width,
            "bounces": window.bounces,
            "word": list(window.word),
            "names": [self.walls.names[wall] for wall in window.word],
            "edges": edges,
            "searched": window.searched,
        }

    def sentence(self) -> str:
        """Say what was found, for people."""
        count = f"{len(self):,} window{'' if len(self) == 1 else 's'} within {self.most_bounces} bounces"
        if (widest := self.widest) is None:
            return count
        return (
            f"{count}, {self.total:.6g} rad in all; the widest {widest.width:.6g} rad at "
            f"{math.degrees(widest.middle):.6f} degrees ({widest.bounces} bounce{'' if widest.bounces == 1 else 's'})"
        )

    def certainty(self) -> str:
        """Say how sure it is that these are all."""
        if self.searched_share == 0.0:
            return "complete above 1e-12 rad, by unfolding"
        angle, length = self.resolution
        sure = "" if self.searched_share == 1.0 else "; complete above 1e-12 rad elsewhere, by unfolding"
        return (
            f"{100.0 * self.searched_share:.3g} % of the directions searched, by shots nowhere farther apart than "
            f"{length:.3g} or {angle:.3g} rad{sure}"
        )


def merged(low: FloatArray, high: FloatArray, bounces: IntArray, walls: IntArray) -> tuple[FloatArray, FloatArray, Any]:
    """Put windows of the same word that follow one another together, across the direction of 180 degrees too.

    Args:
        low: (n,) from -pi to pi.
        high: (n,) above low.
        bounces: (n,).
        walls: (n, K) words.

    Returns:
        Both borders, in order of ``low``, which is from -pi to below pi; and for each window the rows that it was made
        of.
    """
    order = np.lexsort((high, low))
    low, high = low[order], high[order]
    bounces, walls = bounces[order], walls[order]
    if not len(low):
        return low, high, []
    following = np.roll(np.arange(len(low)), -1)
    gap = low[following] - high
    gap[-1] += math.tau
    same = (gap <= SAME) & (bounces == bounces[following]) & (walls == walls[following]).all(axis=1)
    if same.all():
        return np.array([-math.pi]), np.array([math.pi]), [order]
    begin_at = int(np.flatnonzero(~same)[0]) + 1  # behind a border: then no window goes across the end of the list
    turn = np.roll(np.arange(len(low)), -begin_at)
    first = np.flatnonzero(np.roll(~same[turn], 1))
    last = np.append(first[1:], len(low)) - 1
    begin = low[turn][first]
    begin = np.where(begin >= math.pi, begin - math.tau, begin)
    end = high[turn][last]
    end = end - math.tau * np.round((end - begin - math.pi) / math.tau)  # begin < end <= begin + 2 pi
    rows = np.split(order[turn], first[1:])
    by_direction = np.argsort(begin, kind="stable")
    return begin[by_direction], end[by_direction], [rows[i] for i in by_direction.tolist()]
