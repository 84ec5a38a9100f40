"""Numbers with twice the digits against fractions."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wallkit.geometry.double_double import Double

FLOATS = st.floats(-1e30, 1e30).filter(lambda x: x == 0.0 or abs(x) > 1e-30)
DOUBLES = st.tuples(FLOATS, st.floats(-1.0, 1.0)).map(lambda parts: (parts[0], parts[0] * 2.0**-54 * parts[1]))


def double(parts):
    return Double(*(np.array([part]) for part in parts))


def exact(number):
    return Fraction(float(number.high[0])) + Fraction(float(number.low[0]))


@given(DOUBLES, DOUBLES)
def test_each_operation_is_off_by_a_few_roundings_of_twice_the_digits(one, other):
    a, b = double(one), double(other)
    x, y = exact(a), exact(b)
    most = 2.0**-100  # of some 2^-104 an operation
    assert abs(exact(a.plus(b)) - (x + y)) <= most * (abs(x) + abs(y))
    assert abs(exact(a.minus(b)) - (x - y)) <= most * (abs(x) + abs(y))
    assert abs(exact(a.times(b)) - x * y) <= most * abs(x * y)
    if y:
        assert abs(exact(a.over(b)) - x / y) <= most * abs(x / y)
    if x > 0:
        assert abs(exact(a.root()) ** 2 - x) <= 2 * most * x


def test_the_root_of_nothing_is_nothing():
    assert Double.of(np.zeros(1)).root() == (0.0, 0.0)


@pytest.mark.parametrize("power", [-1.0, 0.5, 4.0])
def test_powers_of_two_round_nothing(power):
    third = Double.of(np.ones(1)).over(Double.of(np.full(1, 3.0)))
    assert exact(third.scaled(power)) == Fraction(power) * exact(third)
