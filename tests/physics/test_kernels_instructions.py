"""What stands in for some functions in machine code does what they do in Python."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wallkit.kernels.intrinsics import AT_ONCE, claim, fetch, look_up, lowest, pair_up, prefetch, prefetch_far
from wallkit.kernels.jit import compiled, kernel
from wallkit.kernels.records import CORNER, LINE


@kernel
def lowest_of(bits):
    return lowest(bits)


@kernel
def look_up_all(table, places, found):
    for i in range(0, len(places), AT_ONCE):
        look_up(table, places, i, found, i)


SOME = ((0, 64), (3, 0), (4, 32))
"""The id, and two of the numbers that lines and corners have, into columns of 32; the last one stays as it is."""


@kernel
def fetch_some(records, ids, columns, at_once):
    for i in range(0, len(ids), at_once):
        prefetch(records, 10**9)
        prefetch_far(records, 10**9)
        fetch(records, ids, i, columns, i, SOME)


@kernel
def pair_all(ids, pairs):
    for i in range(0, len(ids), AT_ONCE):
        pair_up(ids, i, i + 7, pairs, i, len(ids) + i)


@kernel
def claim_twice(counter):
    return claim(counter, 3), claim(counter, 4)


@given(st.integers(1, 2**63 - 1))
def test_the_lowest_bit(bits):
    assert bits % 2 ** lowest_of(bits) == 0
    assert bits >> lowest_of(bits) & 1 == 1
    assert compiled(lowest_of)(bits) == lowest_of(bits)


def test_numbers_are_claimed_one_after_the_other():
    for run in (claim_twice, compiled(claim_twice)):
        counter = np.array([5])
        assert run(counter) == (5, 8)
        assert counter[0] == 12


@pytest.mark.parametrize("kind", [np.int16, np.uint32])
def test_numbers_are_looked_up(kind):
    random = np.random.default_rng(1)
    table = random.integers(0, 2**15 - 1, 100).astype(kind)
    places = random.integers(0, 100, 32).astype(np.uint32)
    for run in (look_up_all, compiled(look_up_all)):
        found = np.zeros(32, dtype=np.uint32)
        run(table, places, found)
        assert (found == table[places]).all()


@pytest.mark.parametrize("kind", [LINE, CORNER])
def test_records_become_columns(kind):
    random = np.random.default_rng(2)
    size = len(kind.names)
    records = random.normal(size=(20, size)).view(kind).reshape(-1)
    ids = random.integers(0, 20, 32).astype(np.uint32)
    numbers = records[ids].view(np.float64).reshape(-1, size).T
    expected = np.concatenate([numbers[2], numbers[3], ids, np.full(32, 7.0)])
    for run, table in ((fetch_some, records.tolist()), (compiled(fetch_some), records)):
        columns = np.full(4 * 32, 7.0)
        run(table, ids, columns, size)
        assert columns.tobytes() == expected.tobytes()


def test_ids_are_paired_with_who_asks():
    ids = np.random.default_rng(3).integers(0, 2**32, 4 * AT_ONCE).astype(np.uint32)
    asking = [7 + first for first in range(0, len(ids), AT_ONCE) for _ in range(AT_ONCE)]
    for run in (pair_all, compiled(pair_all)):
        pairs = np.zeros(2 * len(ids), dtype=np.uint32)
        run(ids, pairs)
        assert pairs.tolist() == ids.tolist() + asking
