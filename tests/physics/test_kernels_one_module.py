"""Kernels are compiled with what they call, and without what is for arguments that are not there."""

import numpy as np
import pytest

from wallkit.kernels.jit import compiled, kernel, pass_kernel, rare_kernel


def beyond_numba():
    """Numba cannot compile this: whatever calls it must have been dropped."""
    return input()


@kernel
def with_or_without(x, present):
    if present is None:
        return beyond_numba() if x is None else -1.0
    if present is not None:
        return present[0] + x
    return beyond_numba()


@rare_kernel
def rooted(x):
    return np.sqrt(x) if x > 1.0 else x


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


@pytest.mark.parametrize(("present", "answer"), [(np.array([2.0]), 5.0), (None, -1.0)])
def test_branches_for_absent_arguments_are_not_compiled(present, answer):
    assert compiled(with_or_without)(3.0, present) == answer


def test_kernels_that_several_call_are_linked_once():
    values = np.random.default_rng(1).uniform(0.0, 9.0, (2, 8))
    interpreted, machine = values.copy(), values.copy()
    assert compiled(both_ways)(machine[0], machine[1]) == both_ways(interpreted[0], interpreted[1])
    assert machine.tobytes() == interpreted.tobytes()


def test_numba_goes_on_as_usual():
    numba = pytest.importorskip("numba")
    assert compiled(lowest_after)(np.array([9.0, 4.0])) == np.sqrt(2.0)
    assert numba.njit(lambda x: max(x, 1.0) + min(x, 3.0))(2.0) == 4.0
