"""The roots against 60-digit arithmetic: the first fall through zero, none missed, none invented."""

import itertools
import math

import mpmath
import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st

from wallkit.kernels.impact.polynomial_roots import NEVER, first_fall_quadratic, first_fall_quartic

mpmath.mp.dps = 60
EPS = 2.0**-52


def exact_first_fall(coefficients, t_max=math.inf):
    """The first t in [0, t_max] with f <= 0 and f falling, by 60-digit roots; the highest power comes first."""
    exact = [mpmath.mpf(c) for c in coefficients]
    while exact and exact[0] == 0:
        exact = exact[1:]
    if len(exact) < 2:
        return NEVER
    slope = [c * (len(exact) - 1 - i) for i, c in enumerate(exact[:-1])]
    turns = real_roots(slope) if len(slope) > 1 else []
    top = mpmath.mpf(t_max) if t_max < math.inf else 10 * (1 + sum(abs(c / exact[0]) for c in exact))
    cuts = [mpmath.mpf(0), *sorted(t for t in turns if 0 < t < top), top]
    for a, b in itertools.pairwise(cuts):
        if value(slope, (a + b) / 2) >= 0:
            continue
        if value(exact, a) <= 0:
            return a
        if value(exact, b) <= 0:
            inside = [t for t in real_roots(exact) if a <= t <= b * (1 + mpmath.mpf(10) ** -30)]
            return min(inside, key=lambda t: abs(t - (a + b) / 2)) if inside else b
    return NEVER


def value(polynomial, t):
    total = mpmath.mpf(0)
    for c in polynomial:
        total = total * t + c
    return total


def real_roots(polynomial):
    roots = mpmath.polyroots(polynomial[::-1], maxsteps=2000, extraprec=400, asc=True)
    scale = max((abs(r) for r in roots), default=1)
    return [mpmath.re(r) for r in roots if abs(mpmath.im(r)) <= scale * mpmath.mpf(10) ** -25]


def roundings_of(coefficients, t):
    """How far the root at t moves when each coefficient moves by a few roundings: its own conditioning."""
    n = len(coefficients) - 1
    noise = sum(abs(c) * t ** (n - i) for i, c in enumerate(coefficients)) * 16 * EPS
    slope = abs(sum(c * (n - i) * t ** (n - i - 1) for i, c in enumerate(coefficients[:-1])))
    return noise / slope if slope else math.inf


def check(solve, coefficients, t_max=math.inf):
    expected = exact_first_fall(coefficients, t_max)
    got = solve(*coefficients, t_max)
    if expected == NEVER or got == NEVER:
        # they may disagree only where f comes within rounding of zero without crossing (a touch), or where the root
        # is within rounding of t_max
        assert expected == got or touches(coefficients, expected if got == NEVER else got, t_max), (expected, got)
        return
    expected = float(expected)
    allowed = 4 * EPS * abs(expected) + roundings_of(coefficients, expected)
    assert abs(got - expected) <= allowed or touches(coefficients, min(got, expected), t_max), (expected, got)


def touches(coefficients, t, t_max):
    t = float(t)
    n = len(coefficients) - 1
    value = abs(sum(c * t ** (n - i) for i, c in enumerate(coefficients)))
    size = sum(abs(c) * t ** (n - i) for i, c in enumerate(coefficients))
    return value <= 64 * EPS * size or abs(t - t_max) <= 64 * EPS * t_max


numbers = st.floats(-1e3, 1e3, allow_subnormal=False).map(lambda x: x if abs(x) > 1e-9 else 0.0)


@given(numbers, numbers, numbers)
@example(0.0, 0.0, 0.0)
@example(-1.0, 0.0, 0.0)
@example(1.0, -2.0, 1.0)
def test_quadratic_falls_where_sixty_digits_say(a, b, c):
    check(first_fall_quadratic, (a, b, c))


@pytest.mark.parametrize("gravity", [1e-3, 1e-8, 1e-12, 1e-15, 1e-18, 0.0, -1e-15, -1e-12])
def test_quadratic_keeps_its_digits_as_gravity_vanishes(gravity):
    # a ball 87 above a wall, falling at 43.3: a naive solver divides rounding noise by gravity
    expected = float(exact_first_fall((gravity, -43.3, 87.0)))
    assert first_fall_quadratic(gravity, -43.3, 87.0, math.inf) == pytest.approx(expected, rel=4 * EPS)


def test_quadratic_ball_on_the_wall_thrown_up_comes_back():
    # up at 10 from the floor under 9.81: back after 2 v / g, and not at t = 0, where it recedes
    assert first_fall_quadratic(-4.905, 10.0, 0.0, math.inf) == pytest.approx(2 * 10 / 9.81, rel=4 * EPS)


def test_quadratic_overlap_that_recedes_is_no_event_and_one_that_approaches_is_now():
    assert first_fall_quadratic(0.0, 1.0, -1e-9, math.inf) == NEVER
    assert first_fall_quadratic(0.0, -1.0, -1e-9, math.inf) == 0.0


@given(numbers, numbers, numbers, numbers, numbers, st.sampled_from([0.5, 3.0, 100.0, math.inf]))
@example(0.0, 0.0, 0.0, 0.0, 0.0, math.inf)
@example(1.0, 0.0, 0.0, 0.0, -1.0, math.inf)
@example(-1.0, 0.0, 0.0, 0.0, 1.0, math.inf)
def test_quartic_falls_where_sixty_digits_say(c4, c3, c2, c1, c0, t_max):
    check(first_fall_quartic, (c4, c3, c2, c1, c0), t_max)


@given(
    st.floats(-100, 100),
    st.floats(-100, 100),
    st.floats(-50, 50),
    st.floats(-50, 50),
    st.floats(1e-6, 40),
    st.sampled_from([1e-12, 1e-6, 1e-3, 9.81, 981.0]),
)
def test_parabola_meets_circle_where_sixty_digits_say(x, y, vx, vy, radius, g):
    # |p + v t + g t^2 / 2|^2 = radius^2, p from the centre
    gap = math.hypot(x, y) - radius
    assume(gap > 1e-6)
    check(
        first_fall_quartic,
        (0.25 * g * g, -g * vy, vx * vx + vy * vy - g * y, 2 * (x * vx + y * vy), gap * (gap + 2 * radius)),
    )


@pytest.mark.parametrize("spread", [1e-1, 1e-2, 1e-4, 1e-6])
@pytest.mark.parametrize("at", [1e-6, 0.25, 3.0, 1e5])
def test_quartic_two_roots_close_together(spread, at):
    # (t - at)(t - at (1 + spread)) times a factor without real roots: falls through the first of the two
    roots = (mpmath.mpf(at), mpmath.mpf(at) * (1 + mpmath.mpf(spread)))
    p, q = -(roots[0] + roots[1]), roots[0] * roots[1]
    scale = mpmath.mpf(at)
    factor = (1, scale, scale * scale)  # t^2 + at t + at^2: complex roots only
    coefficients = [0.0] * 5
    for i, u in enumerate((1, p, q)):
        for j, w in enumerate(factor):
            coefficients[i + j] += u * w
    floats = tuple(float(c) for c in coefficients)
    got = first_fall_quartic(*floats, math.inf)
    # rounding the coefficients moves a root by about eps / spread, relatively; eight such roundings are allowed
    assert got == pytest.approx(at, rel=8 * EPS * 20 / spread)


@pytest.mark.parametrize("gap", [0.0, -1e-13, 1e-13])
def test_quartic_ball_that_comes_level_into_a_hollow_is_pressed_on_it_at_once(gap):
    # at the foot of a hollow, speed along it and none towards it: f' is 0 at first and negative ever after
    time = first_fall_quartic(-22500.0, 0.0, -84169.0, -0.0, gap, math.inf)
    assert time == pytest.approx(math.sqrt(max(gap, 0.0) / 84169.0), rel=1e-6)


def test_quartic_four_roots_takes_the_first_falling_one():
    # (t - 1)(t - 2)(t - 3)(t - 4) is positive at 0 and falls at 1 and 3; its negative falls at 2 and 4
    assert first_fall_quartic(1.0, -10.0, 35.0, -50.0, 24.0, math.inf) == pytest.approx(1.0, rel=64 * EPS)
    assert first_fall_quartic(-1.0, 10.0, -35.0, 50.0, -24.0, math.inf) == pytest.approx(2.0, rel=256 * EPS)


def test_quartic_beyond_the_horizon_is_never():
    assert first_fall_quartic(0.0, 0.0, 0.0, -1.0, 5.0, 4.999) == NEVER
    assert first_fall_quartic(0.0, 0.0, 0.0, -1.0, 5.0, 5.001) == pytest.approx(5.0, rel=EPS)


@given(st.integers(-200, 200), numbers, numbers, numbers, numbers)
def test_quartic_scaled_by_a_power_of_two_keeps_its_bits(power, c3, c2, c1, c0):
    scale = 2.0**power
    plain = first_fall_quartic(1.0, c3, c2, c1, c0, math.inf)
    scaled = first_fall_quartic(scale, c3 * scale, c2 * scale, c1 * scale, c0 * scale, math.inf)
    assert plain == scaled
