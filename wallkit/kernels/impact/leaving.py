"""The gap to what a ball has just left, along it: 0 now, and rising; not what rounding makes of it."""

from __future__ import annotations

from wallkit.kernels.jit import kernel

LEVEL_SPEED = 2.0**-40
"""A smaller part of the speed, towards a wall or from it, may be rounding: that of v + g t and of a product with n."""


@kernel
def left_along(c2, c1, c0, reach, slack, vx, vy, gx, gy, from_behind):
    """Correct the first coefficients of a gap in time, |e|^2 - L^2 or the negative, to what the ball has just left.

    A ball that leaves a circle along it (a corner, an arc, or the end of one) has c0 = c1 = 0 there; as rounded they
    may have it fall back at once. Where nothing presses it any longer c2 = 0 too, and c3 > 0. Where c2 < 0 it goes on
    behind the circle, past the end of the arc, and meets it only after it has come back. One that has bounced off
    recedes by far more than rounding, and is let alone; so is one that is off the circle by now.

    Args:
        c2: of t^2.
        c1: of t, twice e.v.
        c0: the gap now.
        reach: L.
        slack: rounding of places.
        vx: velocity of the ball, with vy.
        vy: see vx.
        gx: gravity, with gy.
        gy: see gx.
        from_behind: whether it is behind the circle anyway.

    Returns:
        (c2, c1, c0, from_behind).
    """
    # c1 = 2 e.v and |e| = L: below 2 L LEVEL_SPEED |v| the ball goes along the circle, but for rounding.
    speed = abs(vx) + abs(vy)
    if abs(c1) > 2.0 * reach * LEVEL_SPEED * speed or abs(c0) > 2.0 * reach * slack:
        return c2, c1, c0, from_behind
    # c2 = v.v + e.g is how fast it parts from the circle: 0, to rounding, where nothing presses it any longer.
    if abs(c2) <= LEVEL_SPEED * (speed * speed + reach * (abs(gx) + abs(gy))):
        return 0.0, 0.0, 0.0, from_behind
    return c2, 0.0, 0.0, from_behind or c2 < 0.0
