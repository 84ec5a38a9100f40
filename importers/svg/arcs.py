"""Elliptic arcs between two points: SVG's rules for what a written arc means."""

from __future__ import annotations

import math

from importers.drawing import Segment

# An arc this near to half its ellipse (as the sine of what is missing) is cut at its middle: its centre would
# come from the root of a difference that is all rounding, so that 1e-16 in a coordinate moves it by 1e-8.
_NEAR_HALF = 1e-3


def arc_segments(
    x0: float,
    y0: float,
    rx: float,
    ry: float,
    degrees: float,
    large: bool,
    sweep: bool,
    x: float,
    y: float,
) -> list[Segment]:
    """Give what a written arc draws: nothing, a line, or one or two arcs whose radii reach.

    With x' the half chord in the axes of the ellipse, scaled to its unit circle, |x'| is the sine of half the
    angle: more than 1 scales the radii up until they reach (SVG 2, 9.5.1), near 1 the arc is a half one and is
    given as its two halves. Radii count without their sign, a radius of 0 gives the line, an arc that ends
    where it begins gives nothing.
    """
    if x0 == x and y0 == y:
        return []
    rx, ry = abs(rx), abs(ry)
    if rx == 0.0 or ry == 0.0:
        return [("L", x, y)]
    cosine, sine = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    dx, dy = (x0 - x) / 2, (y0 - y) / 2
    ux, uy = (cosine * dx + sine * dy) / rx, (cosine * dy - sine * dx) / ry
    reach = math.hypot(ux, uy)
    if not math.isfinite(reach):  # radii so small that their quotient overflows: the line is right to any digit
        return [("L", x, y)]
    if reach > 1.0:
        rx, ry, reach = rx * reach, ry * reach, 1.0
    rotation = math.fmod(degrees, 360.0)
    if 1.0 - reach > _NEAR_HALF**2 / 2:
        return [("A", rx, ry, rotation, int(large), int(sweep), x, y)]
    mx, my = _middle(x0, y0, x, y, rx, ry, cosine, sine, large, sweep)
    return [("A", rx, ry, rotation, 0, int(sweep), mx, my), ("A", rx, ry, rotation, 0, int(sweep), x, y)]


def _middle(
    x0: float, y0: float, x: float, y: float, rx: float, ry: float, cosine: float, sine: float, large: bool, sweep: bool
) -> tuple[float, float]:
    """Give the middle of a nearly half arc, in the unit circle of its ellipse: at right angles to the chord."""
    dx, dy = (x - x0) / 2, (y - y0) / 2
    ux, uy = (cosine * dx + sine * dy) / rx, (cosine * dy - sine * dx) / ry
    half = math.hypot(ux, uy)  # sine of half the angle
    square = 1.0 - half * half
    # distance from the chord to the centre; within a few roundings of 1 the chord is a diameter, as it was meant
    depth = math.sqrt(square) if square > 1e-15 else 0.0
    rise = 1.0 + depth if large else 1.0 - depth  # from the chord to the arc's middle
    side = 1.0 if sweep else -1.0  # a sweep of 1 bows to (uy, -ux)
    vx, vy = side * uy / half * rise, -side * ux / half * rise
    vx, vy = vx * rx, vy * ry
    return (x0 + x) / 2 + cosine * vx - sine * vy, (y0 + y) / 2 + sine * vx + cosine * vy


def full_ellipse(cx: float, cy: float, rx: float, ry: float) -> list[Segment]:
    """Give a whole ellipse as browsers draw it: four quarters from its right, in the direction of the y axis."""
    return [
        ("M", cx + rx, cy),
        ("A", rx, ry, 0.0, 0, 1, cx, cy + ry),
        ("A", rx, ry, 0.0, 0, 1, cx - rx, cy),
        ("A", rx, ry, 0.0, 0, 1, cx, cy - ry),
        ("A", rx, ry, 0.0, 0, 1, cx + rx, cy),
    ]
