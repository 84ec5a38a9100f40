"""What counts of balls tell: bounds on a share, on what was never seen, and on quantiles."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

BINS = 64
"""Bins an octave of a histogram: a time is known to 1.6 %."""
_SHIFT = 52 - 6


def share_bounds(hits: int, balls: int, level: float = 0.95) -> tuple[float, float]:
    """Give Clopper and Pearson's bounds on a share of which ``hits`` of ``balls`` were seen.

    The lower one is the p at which so many hits or more have the probability (1 - level) / 2, that is the quantile of a
    beta distribution; the upper one likewise with so many or fewer (Biometrika 26, 404, 1934). They hold whatever the
    share is. 0 and 1 are bounds where all or none were hits.
    """
    from scipy.special import betaincinv

    tail = (1.0 - level) / 2.0
    low = 0.0 if hits == 0 else float(betaincinv(hits, balls - hits + 1, tail))
    high = 1.0 if hits == balls else float(betaincinv(hits + 1, balls - hits, 1.0 - tail))
    return low, high


def never_bound(balls: int, level: float = 0.95) -> float:
    """Give the chance a ball, below which it is, of what none of so many did: (1 - p)^n = 1 - level."""
    return -math.expm1(math.log(1.0 - level) / balls)


def quantile_ranks(balls: int, part: float, level: float = 0.95) -> tuple[int, int]:
    """Give the ranks, from 1, of the order statistics that bound a quantile; 0 and ``balls`` + 1 are no bound.

    How many of n values are at most the quantile is binomial with n and ``part``: K. The value of rank r is at most the
    quantile if K >= r, and at least it if K < r (David and Nagaraja, Order Statistics, 7.1). The lower rank is the
    largest with P(K < r) within half of what the level leaves, the upper one the least with P(K >= r) within it.
    """
    from scipy.special import bdtr

    tail = (1.0 - level) / 2.0
    low = _first(1, balls, lambda rank: float(bdtr(rank - 1, balls, part)) > tail) - 1
    high = _first(1, balls, lambda rank: float(bdtr(rank - 1, balls, part)) >= 1.0 - tail)
    return low, high


def _first(low: int, high: int, holds: Callable[[int], bool]) -> int:
    """Give the first whole number in low to high for which a rising condition holds; high + 1 if none."""
    stop = high + 1
    while low < stop:
        middle = (low + stop) // 2
        if holds(middle):
            stop = middle
        else:
            low = middle + 1
    return low


def bins_of(values: NDArray[np.float64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Give the bins of values of 0 or more, and how many are in each; a bin is a value's exponent and six bits more."""
    codes = np.ascontiguousarray(values, dtype=np.float64).view(np.int64) >> _SHIFT
    bins, counts = np.unique(codes, return_counts=True)
    return bins.astype(np.int64), counts.astype(np.int64)


def bin_edges(code: int) -> tuple[float, float]:
    """Give the least value of a bin, and the least one beyond."""
    low, high = np.array([code << _SHIFT, (code + 1) << _SHIFT], dtype=np.int64).view(np.float64).tolist()
    return low, high


def add_bins(
    one: tuple[NDArray[np.int64], NDArray[np.int64]], other: tuple[NDArray[np.int64], NDArray[np.int64]]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Add two histograms."""
    codes = np.concatenate([one[0], other[0]])
    bins, place = np.unique(codes, return_inverse=True)
    counts = np.zeros(len(bins), dtype=np.int64)
    np.add.at(counts, place, np.concatenate([one[1], other[1]]))
    return bins.astype(np.int64), counts
