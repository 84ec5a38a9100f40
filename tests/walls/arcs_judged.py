"""A judge of arcs against the exact curve: Bernstein sums, circles by their centres, and shapely on dense points."""

import math

import numpy as np
import shapely

# Points are sampled this densely on both sides; distances are taken to the chords between the samples.
DENSE = 1500


def bezier(control, t):
    """Bernstein sum of any degree at t, as (n, 2)."""
    control, n = np.asarray(control, dtype=float), len(control) - 1
    weights = [math.comb(n, k) * t**k * (1 - t) ** (n - k) for k in range(n + 1)]
    return np.stack(weights, axis=1) @ control


def arc_points(a, b, bulge, count):
    """Points of a bulge edge by its centre and radius, from a to b."""
    part = np.linspace(0, 1, count)
    if bulge == 0:
        return a + (b - a) * part[:, None]
    angle = 4 * math.atan(bulge)
    a, b = complex(*a), complex(*b)
    centre = a + (b - a) / (1 - np.exp(1j * angle)) if abs(angle) > 1e-9 else None
    if centre is None:  # too flat for a centre: its height is bulge / 2 of the chord, a parabola to rounding
        z = a + (b - a) * (part - 2j * bulge * part * (1 - part))
    else:
        z = centre + (a - centre) * np.exp(1j * angle * part)
    return np.stack([z.real, z.imag], axis=1)


def directions(vertices, bulges):
    """Directions of each edge at its start and its end, in radians."""
    chord = np.diff(vertices, axis=0)
    middle, half = np.arctan2(chord[:, 1], chord[:, 0]), 2 * np.arctan(bulges)
    return middle - half, middle + half


def to_line(points, line):
    """Largest distance of points to the line through ``line``, by shapely's tree over its pieces."""
    tree = shapely.STRtree(shapely.linestrings(np.stack([line[:-1], line[1:]], axis=1)))
    _, distance = tree.query_nearest(shapely.points(points), return_distance=True, all_matches=False)
    return distance.max()


def hausdorff(exact, vertices, bulges):
    """Largest distance both ways between dense points of the curve and of the arcs."""
    each = max(200, DENSE // len(bulges))
    arcs = np.vstack([arc_points(vertices[i], vertices[i + 1], bulges[i], each) for i in range(len(bulges))])
    return max(to_line(exact, arcs), to_line(arcs, exact))


def sampling_error(points):
    """How far a curve may be from the chords between its samples: an eighth of the largest second difference."""
    return np.abs(np.diff(points, 2, axis=0)).max() if len(points) > 2 else 0.0


def check_smooth(vertices, bulges, cusps_allowed=0):
    """No kink between edges beyond 1e-9 and what the rounding of vertices does to short chords.

    An edge without a length, which a cusp at the very end of a curve may leave, has no direction: those around count.
    """
    some = np.diff(vertices, axis=0).any(axis=1)
    vertices, bulges = np.vstack([vertices[:1], vertices[1:][some]]), bulges[some]
    start, end = directions(vertices, bulges)
    kink = np.abs((start[1:] - end[:-1] + math.pi) % (2 * math.pi) - math.pi)
    chord = np.hypot(*np.diff(vertices, axis=0).T)
    size = np.abs(vertices).max()
    allowed = 1e-9 + 4 * np.finfo(float).eps * size * (1 / chord[1:] + 1 / chord[:-1])
    assert np.count_nonzero(kink > allowed) <= cusps_allowed


def cusps(control):
    """How often the velocity all but vanishes inside, among the places where the derivative of its square is 0.

    Roots near 0 have more digits than those near 1, so the curve is asked from both ends.
    """
    return max(_cusps(control), _cusps(control[::-1]))


def _cusps(control):
    d = 3 * np.diff(np.asarray(control, dtype=float), axis=0)
    powers = np.stack([d[0], 2 * (d[1] - d[0]), d[0] - 2 * d[1] + d[2]])
    slope = sum(np.polynomial.Polynomial(p) * np.polynomial.Polynomial(p).deriv() for p in powers.T)
    t = slope.roots() if slope.coef.any() else np.empty(0)
    t = t[np.abs(t.imag) < 1e-6].real
    t = t[(t > 1e-9) & (t < 1 - 1e-9)]
    return np.count_nonzero(np.hypot(*bezier(d, t).T) <= 1e-6 * np.abs(d).max())
