"""Subpaths in columns are moved as the same segments in a list are, and know how far they reach."""

import math

import numpy as np
import pytest

from importers.drawing import Subpath
from importers.subpaths import NUMBERS, settle
from importers.svg.matrix import transform, transformed

MATRICES = [
    (1.0, 0.0, 0.0, 1.0, 0.0, 0.0),
    (1.0, 0.0, 0.0, 1.0, -0.0, -0.0),
    (1.0, 0.0, 0.0, 1.0, 0.5, -0.25),
    (0.0, 1.0, -1.0, 0.0, 3.0, 0.1),
    (1e-3, 7.0, 0.3, -2e5, 1e8, -1 / 3),
    (1e300, 0.0, 0.0, 1e300, 0.0, 1.0),
]


def columns(random, segments):
    letters = "M" + "".join(random.choice(list("LCQ"), segments))
    numbers = random.choice([-0.0, 0.0, 1.0, *random.normal(0, 1e3, 20)], sum(NUMBERS[letter] for letter in letters))
    return letters.encode(), numbers


def bits(subpath):
    return [(segment[0], *map(float.hex, segment[1:])) for segment in subpath.segments]


@pytest.mark.parametrize("seed", range(5))
def test_columns_are_moved_as_lists_are(seed):
    random = np.random.default_rng(seed)
    drawn = [Subpath.of_columns(*columns(random, int(random.integers(0, 9))), bool(n % 2)) for n in range(40)]
    lists = [Subpath(list(subpath.segments), subpath.closed) for subpath in map(copied, drawn)]
    matrices = [MATRICES[n] for n in random.integers(0, len(MATRICES), len(drawn))]
    moved = [transformed(subpath, matrix) for subpath, matrix in zip(drawn, matrices, strict=True)]
    starts = [subpath.start for subpath in moved]
    settle(moved[::2])  # many at once, the others when they are asked
    for subpath, given, matrix, start in zip(moved, lists, matrices, starts, strict=True):
        wanted = transform(given.segments, matrix)
        assert bits(subpath) == bits(Subpath(wanted, given.closed))
        assert start == wanted[0][1:]
        assert subpath.closed == given.closed


def copied(subpath):
    letters, numbers = subpath.columns
    return Subpath.of_columns(letters, numbers.copy(), subpath.closed)


@pytest.mark.parametrize("seed", range(5))
def test_what_is_surely_within_bounds_is(seed):
    random = np.random.default_rng(seed)
    letters, numbers = columns(random, 6)
    subpath = Subpath.of_columns(letters, numbers, False, float(np.abs(numbers).max()))
    for matrix in MATRICES:
        moved = transformed(subpath, matrix)
        most = max(abs(number) for segment in transform(subpath.segments, matrix) for number in segment[1:])
        subpath = Subpath.of_columns(letters, numbers, False, float(np.abs(numbers).max()))
        assert not moved.surely_within(most * 0.999)
        assert moved.surely_within(1e4 * most + 1e10) == (most < math.inf)


def test_one_that_was_moved_leaves_the_first_as_it_was():
    letters, numbers = b"ML", np.array([0.0, 1.0, 2.0, 3.0])
    first = Subpath.of_columns(letters, numbers, False)
    twice = first.moved((2.0, 0.0, 0.0, 2.0, 1.0, 0.0)).moved((1.0, 0.0, 0.0, 1.0, 0.0, 5.0))
    assert twice.segments == [("M", 1.0, 7.0), ("L", 5.0, 11.0)]
    assert first.segments == [("M", 0.0, 1.0), ("L", 2.0, 3.0)]


def test_bounds_of_a_list_are_never_sure():
    assert not Subpath([("M", 0.0, 0.0)], False).surely_within(1.0)
