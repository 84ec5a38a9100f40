"""Cubics to lines by compiled kernels: the bits of ``curves_to_lines`` by NumPy, in a fraction of the time."""

from __future__ import annotations

import numpy as np

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.ragged import numbered
from wallkit.kernels.fitting.chords import DEEPEST, chords, count_halvings, cut_evenly, cut_the_rest
from wallkit.kernels.jit import compiled


def halving_counts(cubics: FloatArray, tolerance: float, most: int) -> tuple[IntArray, int]:
    """How many cuts halving takes for each cubic (n,), and all of them; where they are above most it stops counting."""
    counts = np.zeros(len(cubics), dtype=np.int64)
    total = compiled(count_halvings)(cubics, tolerance, most, np.empty((DEEPEST, 11)), counts)
    return counts, int(total)


def fewest_cuts(
    cubics: FloatArray, tolerance: float, halvings: IntArray, samples: tuple[tuple[int, int], ...], at_once: int
) -> tuple[IntArray, FloatArray]:
    """Cut cubics (n, 4, 2) where that takes fewest of halving, equal shares and equal steps.

    Args:
        cubics: in rows, C order.
        tolerance: how far chords may be off.
        halvings: (n,) cuts by halving.
        samples: how many samples of the density, and from how many halvings on they are worth while.
        at_once: cubics that share a search, see ``chords.part_at``.

    Returns:
        How many cuts each cubic has (n,), and the cuts of all.
    """
    room = np.cumsum(halvings) - halvings
    cuts, counts = np.empty(int(halvings.sum())), np.full(len(cubics), -1, dtype=np.int64)
    for count, worth in samples:
        t, shares = np.linspace(0.0, 1.0, count), np.empty((at_once, count))
        rows = np.flatnonzero((halvings >= worth) & (counts < 0))
        for begin in range(0, len(rows), at_once):
            some = rows[begin : begin + at_once]
            compiled(cut_evenly)(cubics, some, t, tolerance, halvings, room, cuts, counts, shares)
    compiled(cut_the_rest)(cubics, tolerance, halvings, room, np.empty((DEEPEST, 11)), cuts, counts)
    which, rank = numbered(counts)
    return counts, cuts[room[which] + rank]


def measured_chords(
    cubics: FloatArray, counts: IntArray, cuts: FloatArray, looks: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Give the points at cuts (m, 2), and how far each piece is from its chord (m + n,), see ``chords.chords``."""
    points, far = np.empty((len(cuts), 2)), np.empty(len(cuts) + len(cubics))
    compiled(chords)(cubics, counts, cuts, looks, points, far)
    return points, far
