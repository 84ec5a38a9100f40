"""The state of a ball between two calls of the loop (``flight.py``): how it begins, is read, written and ends."""

from __future__ import annotations

from wallkit.kernels.jit import kernel
from wallkit.kernels.records import COUNT, LEFT_SCENE, STATE, TIME_REACHED

TOLERANCE = 2.0**-47
"""Positions are off by less than this part of the extent: p + t v by some 8 roundings (2^-53), (p - a).n by as many;
64 of them are on the safe side and still far below what a drawing can mean."""
FALLING_TOLERANCE = 2.0**-41
"""The same under gravity: |v| t and g t^2 / 2 come to eight times the extent each before they cancel (up and down
again in a room), and times are roots of polynomials: eight times eight as much."""
FALLING_OVER = FALLING_TOLERANCE / TOLERANCE


@kernel
def read_state(state, counts):
    """Read what ``fly`` needs: ball, clock, start, grip, then last, bounces, still and before of ``Counts``.

    A ball is (x, y, vx, vy, energy), a clock (time, what it lost), a start (x, y, vx, vy) of the last flight, a grip
    (held, hold, side, turns, changes) how a wall holds the ball, see ``Counts``.
    """
    ball = (state[STATE.x], state[STATE.y], state[STATE.vx], state[STATE.vy], state[STATE.energy])
    start = (state[STATE.from_x], state[STATE.from_y], state[STATE.from_vx], state[STATE.from_vy])
    grip = (
        counts[COUNT.held],
        counts[COUNT.hold],
        float(counts[COUNT.side]),
        counts[COUNT.turns],
        counts[COUNT.changes],
    )
    clock = (state[STATE.time], state[STATE.lost])
    return (
        ball,
        clock,
        start,
        grip,
        counts[COUNT.last],
        counts[COUNT.bounces],
        counts[COUNT.still],
        counts[COUNT.before],
    )


@kernel
def write_state(state, counts, ball, clock, start, grip, last, bounces, ending, still, before):
    """Write it back, so that the flight can go on later."""
    state[STATE.x], state[STATE.y], state[STATE.vx], state[STATE.vy], state[STATE.energy] = ball
    state[STATE.time], state[STATE.lost] = clock
    state[STATE.from_x], state[STATE.from_y], state[STATE.from_vx], state[STATE.from_vy] = start
    counts[COUNT.last], counts[COUNT.bounces], counts[COUNT.ending], counts[COUNT.still], counts[COUNT.before] = (
        last,
        bounces,
        ending,
        still,
        before,
    )
    counts[COUNT.held], counts[COUNT.hold], counts[COUNT.turns], counts[COUNT.changes] = (
        grip[0],
        grip[1],
        grip[3],
        grip[4],
    )
    counts[COUNT.side] = int(grip[2])


@kernel
def tolerance_of(x, y, extent):
    """How far positions of a flight that begins at (x, y) may be off by rounding, without gravity."""
    return TOLERANCE * max(max(abs(x), abs(y)), extent)


@kernel
def has_left(box, r, x, y, vx, vy):
    """Tell whether a ball is outside the box of the walls, by more than rounding, and flies away: ``is_gone``."""
    # Far beyond the rounding of places, so that a ball that touches the outermost wall is not gone.
    r += 2.0**-40 * max(max(abs(box[0]), abs(box[1])), max(abs(box[2]), abs(box[3])))
    out_x = (x > box[2] + r and vx >= 0.0) or (x < box[0] - r and vx <= 0.0)
    out_y = (y > box[3] + r and vy >= 0.0) or (y < box[1] - r and vy <= 0.0)
    return out_x or out_y


@kernel
def begin_all(position, velocity, balls, x0, y0, extent, states, counts, start):
    """Write the states of some balls at time 0, without gravity, and their counts; see ``initial_states``."""
    for i in range(len(balls)):
        ball, state = balls[i], states[i]
        x, y, vx, vy = position[ball, 0] - x0, position[ball, 1] - y0, velocity[ball, 0], velocity[ball, 1]
        state[STATE.x], state[STATE.y], state[STATE.vx], state[STATE.vy], state[STATE.time], state[STATE.lost] = (
            x,
            y,
            vx,
            vy,
            0.0,
            0.0,
        )
        # The squared speed is kept for the whole run: bounces scale to it, so that speeds do not drift.
        state[STATE.energy] = vx * vx + vy * vy
        state[STATE.from_x], state[STATE.from_y], state[STATE.from_vx], state[STATE.from_vy] = x, y, vx, vy
        state[STATE.tolerance] = tolerance_of(x, y, extent)
        for k in range(len(start)):
            counts[i, k] = start[k]


@kernel
def end_all(states, counts, radii, x0, y0, box, balls, outcome):
    """Read from states and counts where some balls ended, in the scene's coordinates; see ``Outcome``."""
    for i in range(len(balls)):
        ball, state = balls[i], states[i]
        x, y, vx, vy = state[STATE.x] + x0, state[STATE.y] + y0, state[STATE.vx], state[STATE.vy]
        outcome.position[ball, 0], outcome.position[ball, 1] = x, y
        outcome.velocity[ball, 0], outcome.velocity[ball, 1] = vx, vy
        outcome.time[ball] = state[STATE.time] + state[STATE.lost]
        outcome.bounces[ball] = counts[i, COUNT.bounces]
        # A ball that flew on until time was up may be beyond all walls by then.
        gone = counts[i, COUNT.ending] == TIME_REACHED and has_left(box, radii[i], x, y, vx, vy)
        outcome.ending[ball] = LEFT_SCENE if gone else counts[i, COUNT.ending]
