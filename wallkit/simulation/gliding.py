"""Where a ball is that keeps to a wall, between contacts: on a line, along an arc, or about a vertex."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.bulge_arcs import offset_of, radius_of
from wallkit.kernels.flight.pendulum import swing, turned
from wallkit.kernels.flight.slowed_contact import pull_ahead, slows, swing_on
from wallkit.kernels.impact.drag_motion import carried
from wallkit.kernels.records import GOES_ON
from wallkit.simulation.damping import Slowing
from wallkit.walls import Walls

SLIDE = 2
"""The kind of the contact from which on a ball keeps to the wall: ``wallkit.simulation.run.ContactKind.SLIDE``."""


def edges_of(walls: Walls, contacts: NDArray[Any]) -> IntArray:
    """(n,) number, over all walls, of the edge of each contact; of one at a vertex, the first of its wall."""
    edges: IntArray = walls.edge_offsets[contacts["wall"]] + np.maximum(contacts["edge"], 0)
    return edges


def guides(walls: Walls, contacts: NDArray[Any]) -> FloatArray:
    """Give the signed radius of the circle on which each contact puts the centre of its ball; 0 for no circle.

    Above 0 the circle's centre lies behind the wall, against the contact's normal (on the back of an arc, R + r, and
    about a vertex, r); below 0 it lies on the ball's side (in a hollow, R - r). Contacts from which on the ball flies,
    and slides on lines, have 0.
    """
    bent = np.zeros(len(contacts))
    kept = np.flatnonzero(contacts["kind"] == SLIDE)
    if not len(kept):
        return bent
    own = contacts[kept]
    radius = np.hypot(own["x"] - own["px"], own["y"] - own["py"])
    found = np.where(own["edge"] < 0, radius, 0.0)
    edge = edges_of(walls, own)
    start, end = walls.edge_starts[edge], walls.edge_ends[edge]
    bulge = np.where(own["edge"] < 0, 0.0, walls.bulges[start])
    chord = walls.vertices[end] - walls.vertices[start]
    length = np.hypot(chord[:, 0], chord[:, 1])
    round_ = np.flatnonzero((np.abs(bulge) > 2.0**-44) & (length > 0.0))
    if len(round_):
        b, d, n = bulge[round_], chord[round_], np.stack([own["nx"], own["ny"]], axis=1)[round_]
        curve = radius_of(length[round_], b)
        # the outward normal at the foot: that of the chord, turned by what the arc has turned there
        foot = np.stack([own["px"], own["py"]], axis=1)[round_] - walls.vertices[start[round_]]
        back = offset_of(length[round_], b)
        side = np.stack([d[:, 1], -d[:, 0]], axis=1) / length[round_][:, None]
        out = foot - 0.5 * d + back[:, None] * side
        outside = (out * n).sum(axis=1) > 0.0
        found[round_] = np.where(outside, curve + radius[round_], radius[round_] - curve)
    bent[kept] = found
    return bent


def glide(
    gravity: FloatArray, slowing: Slowing, state: FloatArray, normal: FloatArray, bent: float, span: float
) -> FloatArray:
    """Give x, y, vx, vy a time after a contact from which on a ball keeps to a wall.

    Args:
        gravity: (2,).
        slowing: rolling friction and drag, of :func:`wallkit.simulation.damping.slowing_of`.
        state: (4,) x, y, vx, vy just after the contact.
        normal: (2,) unit, towards the ball.
        bent: signed radius of the centre's circle, see :func:`guides`; 0 for a straight wall.
        span: seconds since then.
    """
    (x, y, vx, vy), (gx, gy), (nx, ny) = state.tolist(), gravity.tolist(), normal.tolist()
    if bent == 0.0:
        ax, ay = pull_along(gravity, slowing, state[2:4], normal).tolist()
        return np.array(carried(slowing.drag, x, y, vx, vy, ax, ay, span))
    ex, ey = math.copysign(nx, nx * bent), math.copysign(ny, ny * bent)
    rho = abs(bent)
    v = vy * ex - vx * ey
    if slows(*slowing):
        fx, fy, speed, dx, dy = _slowed(slowing, rho, math.copysign(1.0, bent), gx, gy, ex, ey, v, span)
    else:
        fx, fy, speed, dx, dy = swing(rho, gx, gy, ex, ey, v, span)
    return np.array([x + rho * dx, y + rho * dy, -speed * fy, speed * fx])


def _slowed(
    slowing: Slowing, rho: float, away: float, gx: float, gy: float, ex: float, ey: float, v: float, span: float
) -> tuple[float, float, float, float, float]:
    """``swing`` for a ball that is slowed down: it goes one way, for where it turns there is another contact."""
    pull = gy * ex - gx * ey
    turn = 1.0 if v > 0.0 or (v == 0.0 and pull > 0.0) else -1.0
    speed, dx, dy = abs(v), 0.0, 0.0
    while span > 0.0:
        tx, ty = -turn * ey, turn * ex
        u, speed, time, event = swing_on(*slowing, rho, away, ex, ey, tx, ty, gx, gy, speed, 1.0, span)
        sine = 2.0 * u / (1.0 + u * u)
        dx, dy = dx + sine * (tx - u * ex), dy + sine * (ty - u * ey)
        ex, ey, _ux, _uy = turned(ex, ey, tx, ty, u)
        span -= time
        if event != GOES_ON:
            break
    return ex, ey, turn * speed, dx, dy


def pull_along(gravity: FloatArray, slowing: Slowing, velocity: FloatArray, normal: FloatArray) -> FloatArray:
    """Acceleration, drag aside, of a ball that keeps to a straight wall: gravity's part along it, less friction.

    Args:
        gravity: (2,).
        slowing: see :func:`glide`.
        velocity: (2,) of the ball; where it stands it sets out to where gravity pulls it.
        normal: (2,) unit, towards the ball.
    """
    along = np.array([-normal[1], normal[0]])
    pull = float(along @ gravity)
    if not slows(*slowing):
        return along * pull
    moves = float(along @ velocity) or pull
    if moves < 0.0:
        along = -along
    return along * float(pull_ahead(*slowing, *along.tolist(), *gravity.tolist()))
