"""Biarcs: two circular arcs that leave one point and reach another along given tangents, joined without a corner.

From P along the unit tangent S to Q along T, v = Q - P. Go d along S from P and d back along T from Q; the joint J
is in the middle of these two points, J = (P + Q + d (S - T)) / 2, when they are 2 d apart:
|v - d (S + T)| = 2 d, that is 2 (1 - S.T) d^2 + 2 v.(S + T) d - v.v = 0 (K. M. Bolton, Biarc curves, 1975). Its
positive root without cancellation, which serves parallel tangents too, with 2 (1 - S.T) = |S - T|^2:
d = v.v / (v.(S + T) + sqrt((v.(S + T))^2 + |S - T|^2 v.v)).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wallkit.walls.strokes import FloatArray


@dataclass(slots=True)
class Biarcs:
    """n pairs of arcs: from ``p`` along ``s`` to ``joint``, on to ``q`` along ``t``.

    Attributes:
        p: (n, 2) where each begins.
        s: (n, 2) unit tangent there.
        q: (n, 2) where it ends.
        t: (n, 2) unit tangent there.
        joint: (n, 2).
        bulge: (n, 2) bulges of the two arcs.
        good: (n,) there is such a pair, and together they turn by at most half a turn each way.
    """

    p: FloatArray
    s: FloatArray
    q: FloatArray
    t: FloatArray
    joint: FloatArray
    bulge: FloatArray
    good: NDArray[np.bool_]


def join(p: FloatArray, s: FloatArray, q: FloatArray, t: FloatArray) -> Biarcs:
    """Make the biarcs of equal tangent lengths; all arguments (n, 2)."""
    v, both = q - p, s + t
    ahead, square = dot(v, both), dot(v, v)
    apart = dot(s - t, s - t)  # 2 (1 - S.T)
    with np.errstate(divide="ignore", invalid="ignore"):
        d = square / (ahead + np.sqrt(ahead * ahead + apart * square))
    good = (ahead > 0) & np.isfinite(d) & (square > 0)
    d = np.where(good, d, 0.0)[:, None]
    joint = (p + q + d * (s - t)) / 2
    first, second = joint - p, q - joint
    good &= (dot(first, s) > 0) & (dot(second, t) > 0)
    bulge = np.stack([_bulge(s, first), _bulge(second, t)], axis=1)
    turn = 4 * np.arctan(bulge)
    good &= np.abs(turn).sum(axis=1) <= np.pi * (1 + 1e-9)
    return Biarcs(p, s, q, t, joint, bulge, good)


def _bulge(one: FloatArray, two: FloatArray) -> FloatArray:
    """Tangent of half the angle from a tangent to the chord (or the chord to the tangent): sin / (1 + cos)."""
    size = np.hypot(one[:, 0], one[:, 1]) * np.hypot(two[:, 0], two[:, 1])
    with np.errstate(divide="ignore", invalid="ignore"):
        bulge: FloatArray = np.nan_to_num(cross(one, two) / (size + dot(one, two)), posinf=0.0, neginf=0.0)
    return bulge


def dot(a: FloatArray, b: FloatArray) -> FloatArray:
    """Dot products of rows (..., 2)."""
    product: FloatArray = a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1]
    return product


def cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """Cross products of rows (..., 2)."""
    product: FloatArray = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    return product


def deviation(biarcs: Biarcs, points: FloatArray, tangents: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Distance of curve points from their biarc, and the angle between the two tangents.

    The joint's normal parts the points of the first arc from those of the second. In the frame of an arc's end
    (x along its tangent, y to the left) a circle of curvature k through that end has
    distance = |k (x^2 + y^2) - 2 y| / (1 + sqrt((k x)^2 + (1 - k y)^2)), which serves k = 0 as well, and at the
    nearest point the tangent (1 - k y, k x). Points behind an end are measured from the end.

    Args:
        biarcs: n of them.
        points: (n, m, 2).
        tangents: (n, m, 2) unit tangents of the curve.

    Returns:
        Distances (n, m) and angles (n, m).
    """
    chord = biarcs.joint - biarcs.p
    joint_tangent = _turned_by(biarcs.s, 4 * np.arctan(biarcs.bulge[:, 0]))
    curvature = [
        _curvature(biarcs.bulge[:, 0], chord),
        _curvature(biarcs.bulge[:, 1], biarcs.q - biarcs.joint),
    ]
    before = dot(points - biarcs.joint[:, None], joint_tangent[:, None]) < 0
    first = _from_arc(points, tangents, biarcs.p, biarcs.s, curvature[0], 1.0)
    second = _from_arc(points, tangents, biarcs.q, biarcs.t, curvature[1], -1.0)
    return np.where(before, first[0], second[0]), np.where(before, first[1], second[1])


def _curvature(bulge: FloatArray, chord: FloatArray) -> FloatArray:
    """2 sin(angle / 2) / |chord| = 4 b / (1 + b^2) / |chord|."""
    length = np.hypot(chord[:, 0], chord[:, 1])
    return 4 * bulge / (1 + bulge * bulge) / np.where(length > 0, length, 1.0)


def _turned_by(vector: FloatArray, angle: FloatArray) -> FloatArray:
    cos, sin = np.cos(angle), np.sin(angle)
    return np.stack([vector[:, 0] * cos - vector[:, 1] * sin, vector[:, 0] * sin + vector[:, 1] * cos], axis=1)


def _from_arc(
    points: FloatArray, tangents: FloatArray, end: FloatArray, along: FloatArray, curvature: FloatArray, ahead: float
) -> tuple[FloatArray, FloatArray]:
    """Distance and tangent angle; ``ahead`` is 1 where the arc leaves ``end``, -1 where it arrives."""
    left = np.stack([-along[:, 1], along[:, 0]], axis=1)
    offset = points - end[:, None]
    x, y, k = dot(offset, along[:, None]), dot(offset, left[:, None]), curvature[:, None]
    size = np.sqrt((k * x) ** 2 + (1 - k * y) ** 2)
    distance = np.abs(k * (x * x + y * y) - 2 * y) / (1 + size)
    distance = np.where(x * ahead < 0, np.hypot(x, y), distance)
    tangent_x, tangent_y = dot(tangents, along[:, None]), dot(tangents, left[:, None])
    sine, cosine = (1 - k * y) * tangent_y - k * x * tangent_x, (1 - k * y) * tangent_x + k * x * tangent_y
    return distance, np.abs(np.arctan2(sine, cosine))
