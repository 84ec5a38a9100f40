"""Kernels do in machine code what they do in Python, to the bit, and are compiled without what is not there."""

import math
from typing import NamedTuple

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wallkit.kernels.compiler import whole
from wallkit.kernels.compiler.values import UnknownError
from wallkit.kernels.jit import MachineCode, compiled, kernel, pass_kernel, rare_kernel
from wallkit.kernels.signatures import kinds_of

RECORD = np.dtype([("a", np.float64), ("b", np.uint32)])
LIMITS = (1, 3, 8)
NUMBERS = st.floats(allow_nan=True, allow_infinity=True)
SMALL = st.integers(-50, 50)


def unknown_to_kernels():
    """Whatever calls it must have been dropped."""
    return input()


@kernel
def with_or_without(x, present):
    if present is None:
        return unknown_to_kernels() if x is None else -1.0
    if present is not None:
        return present[0] + x
    return unknown_to_kernels()


@pytest.mark.parametrize(("present", "answer"), [(np.array([2.0]), 5.0), (None, -1.0)])
def test_branches_for_absent_arguments_are_not_compiled(present, answer):
    assert compiled(with_or_without)(3.0, present) == answer


@kernel
def asks(x):
    return unknown_to_kernels() if x > 0.0 else x


def test_what_no_kernel_can_do_is_refused_by_name():
    with pytest.raises(UnknownError, match=r"asks: a call of <function unknown_to_kernels"):
        compiled(asks)(1.0)


@rare_kernel
def rooted(x):
    return math.sqrt(x) if x > 1.0 else x


@pass_kernel
def root_all(numbers):
    for i in range(len(numbers)):
        numbers[i] = rooted(numbers[i])


@kernel
def lowest_after(numbers):
    root_all(numbers)
    return min(rooted(numbers[0]), max(rooted(numbers[1]), 0.5))


@kernel
def both_ways(numbers, again):
    root_all(again)
    return lowest_after(numbers) + rooted(again[0])


def test_passes_and_rare_kernels_that_several_call():
    values = np.random.default_rng(1).uniform(0.0, 9.0, (2, 8))
    interpreted, machine = values.copy(), values.copy()
    assert compiled(both_ways)(machine[0], machine[1]) == both_ways(interpreted[0], interpreted[1])
    assert machine.tobytes() == interpreted.tobytes()


def test_a_kernel_is_optimised_once_with_all_that_it_calls_and_each_pass_alone(tmp_path, monkeypatch):
    optimised = []
    optimise = whole.optimise

    def counted(module):
        optimised.append(len([one for one in module.functions if not one.is_declaration]))
        optimise(module)

    monkeypatch.setattr(whole, "optimise", counted)
    monkeypatch.setenv("WALLKIT_CACHE_DIR", str(tmp_path))
    assert MachineCode(both_ways)(np.array([16.0, 4.0]), np.array([4.0, 9.0])) == 2.0 * math.sqrt(2.0)
    assert optimised == [2, 5]  # the pass and what it calls; then both kernels, both passes' one, rooted, and the entry


@kernel
def whole_numbers(a, b):
    return a // b, a % b, (a << 3) ^ b, a >> 1, a & b, a | b, abs(a), max(a, b), min(a, b), -a, a**2, ~a


@given(SMALL, SMALL.filter(bool))
def test_whole_numbers(a, b):
    assert compiled(whole_numbers)(a, b) == whole_numbers(a, b)


@kernel
def real_numbers(a, b):
    finite = math.isfinite(a)
    return (
        a + b, a - b, a * b, -a, abs(a), max(a, b), min(a, b), a < b, a <= b, a == b, a != b, finite,
        math.copysign(a, b), math.floor(a) if finite and abs(a) < 1e15 else 0, a if a > b else b,
    )  # fmt: skip


@given(NUMBERS, NUMBERS)
def test_real_numbers_to_the_bit(a, b):
    for one, other in zip(compiled(real_numbers)(a, b), real_numbers(a, b), strict=True):
        assert type(one) is type(other)
        assert np.float64(one).tobytes() == np.float64(other).tobytes() or one != one


@kernel
def guarded(numbers, i, low, high):
    """Nothing beyond the array is looked at: a later test is made where those before it hold."""
    inside = 0 <= i < len(numbers) and low < numbers[i] < high
    found = 0
    if i < 0 or i >= len(numbers) or not numbers[i] > low:
        found = 1
    return inside, found, i in LIMITS, i not in (2, 5), numbers[-1], LIMITS[found]


@given(st.integers(-3, 1000), NUMBERS, NUMBERS)
def test_tests_are_made_in_turn(i, low, high):
    numbers = np.linspace(-2.0, 2.0, 7)
    assert compiled(guarded)(numbers, i, low, high) == guarded(numbers, i, low, high)


@kernel
def looped(numbers, step, stop_at):
    """Loops of each kind, left early or not; variables that begin as whole numbers and become others."""
    total, last, turns = 0, -1, 0
    for i in range(len(numbers) - 1, -1, -2):
        if numbers[i] < 0.0:
            continue
        if numbers[i] > stop_at:
            break
        total, last = total + numbers[i], i
    for k in range(0, 3 * step, step):
        for sign in (-1.0, 1.0):
            if sign * k > 4:
                continue
            total = total + sign * k
    for number in numbers:
        total += number
    while True:
        turns += 1
        if turns * turns > stop_at or turns > 9:
            return total, last, turns


@given(st.lists(st.floats(-5, 5), min_size=1, max_size=9), st.sampled_from([-2, 1, 3]), st.floats(-1, 5))
def test_loops(numbers, step, stop_at):
    numbers = np.array(numbers)
    assert compiled(looped)(numbers, step, stop_at) == looped(numbers, step, stop_at)


class Pair(NamedTuple):
    left: float
    right: float


@kernel
def taken_apart(pair):
    (a, b), both = pair, (pair.right, pair[0])
    return swapped(*both, a > b)


@rare_kernel
def swapped(a, b, swaps):
    pair = Pair(a, b) if swaps else Pair(b, a)
    rest = (pair, 1, 2)[1:]
    return pair, pair.left - pair.right, rest[swaps * 1]


@given(st.floats(-9, 9), st.floats(-9, 9))
def test_tuples(a, b):
    assert compiled(taken_apart)(Pair(a, b)) == taken_apart(Pair(a, b))


@kernel
def written(records, table, words, tail):
    records[0] = records[1]
    records[2].b, records[2].a = 7, records[2].a * 2.0
    table[1, 2] += table[0][1]
    words[0] = 2.75 if table[1, 2] > 0.0 else 1
    words[1] += 3
    tail[2:][0] = float(words[0]) + records[0].b
    return len(tail[1:]), len(tail[9:]), int(words[1])


def test_memory_is_read_and_written_alike():
    def arguments():
        records = np.zeros(3, dtype=RECORD).view(np.recarray)
        records["a"], records["b"] = (1.0, 2.0, 3.0), (4, 5, 6)
        return records, np.arange(6.0).reshape(2, 3), np.array([9, 4], dtype=np.uint32), np.zeros(4)

    here, there = arguments(), arguments()
    assert compiled(written)(*here) == written(*there)
    assert [one.tobytes() for one in here] == [one.tobytes() for one in there]


@kernel
def turned(values, angle):
    turn = complex(math.sqrt(1.0 - angle * angle), angle)
    values[1] = (values[0] - turn) * turn + 2.0 * values[1] - (1 - 0.5j * values[0]) / 2
    return values[1].real, values[1].imag


def test_complex_numbers():
    here, there = np.array([1.0 + 2.0j, 3.0j]), np.array([1.0 + 2.0j, 3.0j])
    assert compiled(turned)(here, 0.6) == turned(there, 0.6)
    assert here.tobytes() == there.tobytes()


def test_one_kernel_for_several_kinds_in_one_process():
    machine = compiled(real_numbers)
    for a, b in ((3, -2), (7.5, 5), (-2, 0.5), (0.25, 0.75)):
        assert machine(a, b) == real_numbers(a, b)


@kernel
def sized(table, x, y):
    rows, columns = table.shape
    return rows * columns, math.ceil(x) + rows, np.hypot(x, y), np.floor(y)


@given(st.floats(-1e9, 1e9), st.floats(-1e9, 1e9))
def test_shapes_and_roundings(x, y):
    table = np.zeros((2, 5))
    assert compiled(sized)(table, x, y) == sized(table, x, y)


def test_a_kernel_takes_only_what_it_uses():
    program = whole.Program({with_or_without: "inline"})
    kinds = tuple(map(whole.type_of, kinds_of((3.0, np.zeros((2, 2))))))
    assert program.of(with_or_without, (kinds[0], whole.type_of(kinds_of((np.zeros(2),))[0]))).used == (0, 1)
