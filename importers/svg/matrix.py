"""Matrices of the plane, and what they do to segments; elliptic arcs stay exact.

A matrix is SVG's (a, b, c, d, e, f): x' = a x + c y + e, y' = b x + d y + f.
"""

from __future__ import annotations

import math

from importers.subpaths import Matrix as Matrix
from importers.subpaths import Segment, Subpath

IDENTITY: Matrix = (1.0, 0.0, 0.0, 1.0, 0.0, 0.0)


def multiply(outer: Matrix, inner: Matrix) -> Matrix:
    """Give the matrix that applies ``inner`` first, then ``outer``."""
    a, b, c, d, e, f = outer
    p, q, r, s, t, u = inner
    return (a * p + c * q, b * p + d * q, a * r + c * s, b * r + d * s, a * t + c * u + e, b * t + d * u + f)


def translation(x: float, y: float) -> Matrix:
    """Give the matrix that moves by (x, y)."""
    return (1.0, 0.0, 0.0, 1.0, x, y)


def rotation(degrees: float) -> Matrix:
    """Give the matrix of x' = x cos - y sin, y' = x sin + y cos; quarter turns are exact."""
    turned = math.fmod(degrees, 360.0)
    exact = {0.0: (1.0, 0.0), 90.0: (0.0, 1.0), 180.0: (-1.0, 0.0), 270.0: (0.0, -1.0)}.get(turned % 360.0)
    cosine, sine = exact or (math.cos(math.radians(turned)), math.sin(math.radians(turned)))
    return (cosine, sine, -sine, cosine, 0.0, 0.0)


def mean_scale(matrix: Matrix) -> float:
    """Give the geometric mean of the two scales: the square root of |determinant|."""
    a, b, c, d, _, _ = matrix
    return math.sqrt(abs(a * d - b * c))


def transform(segments: list[Segment], matrix: Matrix) -> list[Segment]:
    """Apply a matrix to segments; an arc becomes the arc of the transformed ellipse, not an approximation.

    A matrix without an inverse flattens an ellipse to a line: such an arc becomes the line to its end, which
    is all that its ends still say.
    """
    if matrix == IDENTITY:
        return segments
    a, b, c, d, e, f = matrix
    if matrix[:4] == IDENTITY[:4]:
        return [_moved(segment, e + 0.0, f + 0.0) for segment in segments]  # 0 for -0: -0 moved by 0 is 0
    result: list[Segment] = []
    add = result.append
    for segment in segments:
        if len(segment) == 3:
            kind, x, y = segment
            add((kind, a * x + c * y + e, b * x + d * y + f))
        elif segment[0] == "C":
            _, x1, y1, x2, y2, x, y = segment
            add(
                (
                    "C",
                    a * x1 + c * y1 + e,
                    b * x1 + d * y1 + f,
                    a * x2 + c * y2 + e,
                    b * x2 + d * y2 + f,
                    a * x + c * y + e,
                    b * x + d * y + f,
                )
            )
        elif segment[0] == "Q":
            _, x1, y1, x, y = segment
            add(("Q", a * x1 + c * y1 + e, b * x1 + d * y1 + f, a * x + c * y + e, b * x + d * y + f))
        else:
            add(_transform_arc(segment, matrix))
    return result


def transformed(subpath: Subpath, matrix: Matrix) -> Subpath:
    """Apply a matrix to a subpath, as :func:`transform` does; one of columns stays one."""
    if subpath.in_columns:  # of lines and Bezier curves
        return subpath.moved(matrix)
    return Subpath(transform(subpath.segments, matrix), subpath.closed)


def _moved(segment: Segment, e: float, f: float) -> Segment:
    """Move a segment."""
    if len(segment) == 7:
        kind, x1, y1, x2, y2, x, y = segment
        return kind, x1 + e, y1 + f, x2 + e, y2 + f, x + e, y + f
    if len(segment) == 3:
        kind, x, y = segment
        return kind, x + e, y + f
    if len(segment) == 5:
        kind, x1, y1, x, y = segment
        return kind, x1 + e, y1 + f, x + e, y + f
    return _transform_arc(segment, (1.0, 0.0, 0.0, 1.0, e, f))


def _transform_arc(segment: Segment, matrix: Matrix) -> Segment:
    """Map an arc: the two axis vectors of its ellipse go through the matrix, then an SVD finds the new axes.

    The ellipse is centre + E (cos t, sin t) with E = rotation * diag(rx, ry). Through the linear part L it is
    L E (cos t, sin t). With L E = U diag(s1, s2) V, V only shifts t (and turns it round when the determinant
    is negative), so s1, s2 are the new radii and U's angle the new rotation.
    """
    _, rx, ry, degrees, large, sweep, x, y = segment
    a, b, c, d, e, f = matrix
    end = (a * x + c * y + e, b * x + d * y + f)
    p, q, r, s, _, _ = multiply((a, b, c, d, 0.0, 0.0), rotation(degrees))
    p, q, r, s = p * rx, q * rx, r * ry, s * ry
    # SVD of [[p, r], [q, s]] in closed form (Blinn, "Consider the lowly 2x2 matrix", 1996)
    plus, cross = math.hypot(p + s, q - r) / 2, math.hypot(p - s, q + r) / 2
    major, minor = plus + cross, abs(plus - cross)
    determinant = a * d - b * c
    if determinant == 0.0 or minor == 0.0 or not math.isfinite(major):
        return ("L", *end)
    minor = abs(p * s - q * r) / major  # without the cancellation of plus - cross
    if cross <= 1e-15 * plus:  # a circle to the last bit: any rotation is right, none is plainest
        angle, major, minor = 0.0, plus, plus
    else:
        angle = math.degrees((math.atan2(q + r, p - s) + math.atan2(q - r, p + s)) / 2)
    return ("A", major, minor, angle, large, sweep if determinant > 0 else 1 - sweep, *end)
