"""Endless bounces on a circle that takes speed along itself, summed up, against forty digits."""

import math

import mpmath
import pytest

from wallkit.kernels.flight.last_bounces import _last_bounces

G, RHO = 9.81, 3.0


def one_by_one(away, slope, u, w, e, f):
    """Time and way of bounces on a circle about (0, 0), each a parabola that is met with it by Newton's steps."""
    mp = mpmath.mp.clone()
    mp.dps = 40
    n = [mp.sin(slope), mp.cos(slope)]
    p, v, time, first = [away * RHO * c for c in n], [w * n[0] - u * n[1], w * n[1] + u * n[0]], mp.mpf(0), w
    start = list(p)
    while w > first * mp.mpf(10) ** -14:
        n = [away * c / mp.sqrt(p[0] ** 2 + p[1] ** 2) for c in p]
        w, u = v[0] * n[0] + v[1] * n[1], v[1] * n[0] - v[0] * n[1]
        t = 2 * w / (mp.mpf(G) * n[1] - away * u * u / RHO)
        for _step in range(8):
            x, y = p[0] + v[0] * t, p[1] + v[1] * t - mp.mpf(G) * t * t / 2
            t -= (x * x + y * y - RHO * RHO) / (2 * (x * v[0] + y * (v[1] - mp.mpf(G) * t)))
        p = [p[0] + v[0] * t, p[1] + v[1] * t - mp.mpf(G) * t * t / 2]
        v, time = [v[0], v[1] - mp.mpf(G) * t], time + t
        n = [away * c / RHO for c in p]
        w, u = v[0] * n[0] + v[1] * n[1], v[1] * n[0] - v[0] * n[1]
        v, w = [-f * u * n[1] - e * w * n[0], f * u * n[0] - e * w * n[1]], -e * w
    turn = mp.asin((start[0] * p[1] - start[1] * p[0]) / RHO**2)
    return float(time), float(away * RHO * turn)


@pytest.mark.parametrize(("e", "f"), [(0.094, 0.83), (0.5, 0.7), (0.8, 0.3)])
@pytest.mark.parametrize(("away", "u"), [(-1.0, 2.8), (-1.0, -2.8), (1.0, 1.5), (1.0, -1.5)])
@pytest.mark.parametrize("w", [1e-4, 1e-5])
def test_bounces_on_a_circle_take_the_time_and_the_way_that_they_take_one_by_one(w, away, u, e, f):
    # What is left out is of the square of the angle by which the wall turns under a bounce, some u w / p rho.
    slope = 0.6
    time, way = _last_bounces((0.0, -G), RHO, away, math.sin(slope), math.cos(slope), u, w, e, f)
    true_time, true_way = one_by_one(away, slope, u, w, e, f)
    angle = abs(u) * w / RHO
    assert time == pytest.approx(true_time, rel=1e-9 + 10 * angle**2, abs=0.0)
    assert way == pytest.approx(true_way, rel=1e-9 + 10 * angle**2, abs=0.0)
