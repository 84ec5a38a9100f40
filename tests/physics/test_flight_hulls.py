"""Hulls of falling flights only save work: what they rule out is never met, by points of the flight in 40 digits."""

import mpmath
import numpy as np
import pytest
import shapely

from wallkit.kernels.impact.arc_fall import _only_rises
from wallkit.kernels.impact.gravity_impact import _misses, hull_of, strays
from wallkit.simulation.edge_records import lines_of

TOLERANCE = 1e-11


def flights(seed, drag, count=40):
    """Flights that fall, and the times between which they are looked at: some hundreds of units in some seconds."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        x, y, vx, vy, gx = (float(v) for v in rng.uniform(-200, 200, 5))
        start = float(rng.choice([0.0, rng.uniform(0, 2)]))
        stop = start + float(10 ** rng.uniform(-3, 0.5))
        k = float(10 ** rng.uniform(-4, 1)) if drag else None
        yield rng, k, (x, y, vx, vy, gx, -100.0), start, stop


def places(k, flight, start, stop, count=30):
    """(count, 2) places of a flight, from its closed form in 40 digits: rounded once."""
    x, y, vx, vy, gx, gy = flight
    found = []
    with mpmath.workdps(40):
        for n in range(count):
            t = mpmath.mpf(start) + (mpmath.mpf(stop) - start) * n / (count - 1)
            free, second = t, t * t / 2
            if k is not None:
                free = -mpmath.expm1(-mpmath.mpf(k) * t) / k
                second = (t - free) / k
            found.append([float(x + vx * free + gx * second), float(y + vy * free + gy * second)])
    return np.array(found)


@pytest.mark.parametrize("drag", [False, True])
def test_a_flight_lies_in_its_hull(drag):
    for _rng, k, flight, start, stop in flights(1, drag):
        px, py, qx, qy, rx, ry, margin, _size = hull_of(k, *flight, start, stop, TOLERANCE)
        hull = shapely.convex_hull(shapely.MultiPoint([(px, py), (qx, qy), (rx, ry)]))
        away = shapely.distance(hull, shapely.points(places(k, flight, start, stop)))
        assert away.max() <= margin


@pytest.mark.parametrize("drag", [False, True])
def test_a_flight_that_strays_from_a_place_keeps_as_far_from_it(drag):
    told = 0
    for rng, k, flight, start, stop in flights(2, drag):
        *hull, margin, size = hull_of(k, *flight, start, stop, TOLERANCE)
        there = places(k, flight, start, stop)
        for _ in range(10):
            radius = 10 ** rng.uniform(-2, 1)
            cx, cy = there[rng.integers(len(there))] + rng.normal(size=2) * 10 ** rng.uniform(-1, 2)
            if strays(*hull, cx, cy, radius * radius + margin * (4 * radius + size)):
                told += 1
                assert np.hypot(there[:, 0] - cx, there[:, 1] - cy).min() > radius
    assert told > 100  # of 400: the test tells what it is for


def test_a_flight_with_drag_that_misses_a_line_keeps_off_it():
    told = 0
    for rng, k, flight, start, stop in flights(3, True):
        *hull, margin, _size = hull_of(k, *flight, start, stop, TOLERANCE)
        there = places(k, flight, start, stop)
        for _ in range(10):
            radius = float(rng.choice([0.0, 1.0, 10.0]))
            ends = there[rng.integers(len(there))] + rng.normal(size=(2, 2)) * 10 ** rng.uniform(0, 2)
            (line,) = lines_of(ends, np.array([0, 2]), np.array([False]), np.zeros(2)).records.view(np.recarray)
            if _misses(line, radius, TOLERANCE, *hull, margin):
                told += 1
                along, length = (ends[1] - ends[0]) / np.hypot(*(ends[1] - ends[0])), np.hypot(*(ends[1] - ends[0]))
                u, d = (there - ends[0]) @ along, (there - ends[0]) @ (-along[1], along[0])
                assert not np.any((abs(d) <= radius) & (u >= 0.0) & (u <= length))
                # chords of the flight lie in its hull, too
                assert not shapely.intersects(shapely.LineString(ends), shapely.LineString(there))
    assert told > 100


@pytest.mark.parametrize("drag", [False, True])
def test_a_gap_that_only_rises_does_not_fall(drag):
    # |e + v f + g s|^2 - |e|^2, and the negative of that: a ball that has just met a circle about (0, 0)
    told = 0
    for rng, k, (x, y, vx, vy, gx, gy), _start, _stop in flights(4, drag, 400):
        side, span = float(rng.choice([-1.0, 1.0])), float(10 ** rng.uniform(-3, 0))
        ax, ay = (gx, gy) if k is None else (gx - k * vx, gy - k * vy)
        c4, c3 = 0.25 * side * (ax * ax + ay * ay), side * (vx * ax + vy * ay)
        c2, c1 = side * (vx * vx + vy * vy + x * ax + y * ay), side * 2.0 * (x * vx + y * vy)
        if not _only_rises(k, c4, c3, c2, c1, 0.0, abs(x * ax) + abs(y * ay), span):
            continue
        told += 1
        there = places(k, (x, y, vx, vy, gx, gy), 0.0, span)
        gap = side * ((there**2).sum(axis=1) - (x * x + y * y))
        assert gap[1:].min() > 0.0
    assert told > 20
