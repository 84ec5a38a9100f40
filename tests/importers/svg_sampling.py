"""Points along segments, by formulas of their own: what the tests hold the readers' boxes and arcs against."""

import cmath
import math

import numpy as np


def points_along(segments, steps=256):
    """(n, 2) points along segments, ends of segments included."""
    points = []
    start = 0j
    for segment in segments:
        kind, numbers = segment[0], segment[1:]
        end = complex(*numbers[-2:])
        t = np.linspace(0.0, 1.0, steps + 1)
        if kind in "ML":
            points.append(np.array([end]))
        elif kind == "A":
            points.append(arc_points(start, *numbers[:5], end, t))
        else:
            control = [start, *(complex(x, y) for x, y in zip(numbers[0::2], numbers[1::2], strict=True))]
            degree = len(control) - 1
            points.append(sum(math.comb(degree, i) * t**i * (1 - t) ** (degree - i) * p for i, p in enumerate(control)))
        start = end
    whole = np.concatenate(points)
    return np.stack([whole.real, whole.imag], axis=1)


def arc_points(start, rx, ry, degrees, large, sweep, end, t):
    """SVG 2, appendix B.2.4, on the unit circle of complex numbers: the ellipse undone, the circle found."""
    turn = cmath.exp(1j * math.radians(degrees))

    def unit(z):
        z = z / turn
        return complex(z.real / rx, z.imag / ry)

    a, b = unit(start), unit(end)
    half = (b - a) / 2
    offset = math.sqrt(max(0.0, 1.0 - abs(half) ** 2))
    centre = (a + b) / 2 + half / abs(half) * 1j * offset * (-1 if large == sweep else 1)
    first, last = cmath.phase(a - centre), cmath.phase(b - centre)
    span = (last - first) % math.tau if sweep else -((first - last) % math.tau)
    circle = centre + np.exp(1j * (first + span * t))
    return (circle.real * rx + 1j * circle.imag * ry) * turn


def box(path):
    """Box of a DrawnPath by its sampled points; curves of 256 steps miss an extreme by less than size * 2e-5."""
    points = np.concatenate([points_along(sub.segments) for sub in path.subpaths])
    return [*points.min(axis=0), *points.max(axis=0)]


def distance_to(path, point):
    """Distance from a point to the nearest place on the sampled, closed-where-closed polylines of a DrawnPath."""
    nearest = math.inf
    for sub in path.subpaths:
        points = points_along(sub.segments)
        if sub.closed:
            points = np.concatenate([points, points[:1]])
        if len(points) == 1:
            nearest = min(nearest, float(np.hypot(*(points[0] - point))))
            continue
        a, d = points[:-1], np.diff(points, axis=0)
        length = np.maximum((d**2).sum(axis=1), 1e-300)
        t = np.clip(((point - a) * d).sum(axis=1) / length, 0.0, 1.0)
        nearest = min(nearest, float(np.hypot(*(a + t[:, None] * d - point).T).min()))
    return nearest
