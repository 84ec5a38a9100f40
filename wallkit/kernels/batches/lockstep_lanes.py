"""What lockstep knows of its balls: one flat array, LANES for each number, so that nothing may alias.

Each name is where its numbers begin. Scenes that lack what acts leave the later ones alone.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from wallkit.kernels.flight.ball_state import has_left
from wallkit.kernels.jit import kernel
from wallkit.kernels.records import LEFT_SCENE, NO_HIT, TIME_REACHED

LANES = 64
"""Balls in step: so few that their numbers stay in the L1 cache, and a bit for each in 64."""
(
    X, Y, VX, VY, TIME, LOST, ENERGY, TOLERANCE, LAST, BOUNCES, STILL, BEST, ROW, ASK, ENDING, NX, NY, TWICE,
    FROM_X, FROM_Y, FROM_VX, FROM_VY, E, F, PASSED, KEPT, BEFORE, HOLD, HELD, SIDE, AX, AY,
    FAR, LEFT_X, RIGHT_X, LOW_Y, HIGH_Y, QX, QY, RX, RY, MOST, LENGTH,
) = (LANES * number for number in range(43))  # fmt: skip
"""Of a ball: its state (see ``STATE`` and ``COUNT``), what it has found so far and when, what it has still to ask, and
the record of what it meets: normal, 2 / (n.n), restitution. Where it is slowed down, what the flight takes and the part
of the speed that is kept; under gravity, what it met before, how it is held, the start and the length of the line that
it meets, and whether it may meet the far side of a line; of a falling disc, the hull of its flight (see
``gravity_impact.hull_of``): its box, its points but the first, and the squared reach."""
ROOM, REACH = FROM_X, FROM_Y
"""Of discs; points alone need to know where they came from."""
STOP = FAR
"""Of balls that fly straight: the time after which rolling friction stops them."""
PLAIN = 22 * LANES
"""Numbers where nothing acts."""
SCRATCH = 43 * LANES
ROW_SIZE = 9
"""Normal of a line or place of a corner, 2 / (n.n), count of bounces (``Model.edge_tally``), normal and tangential
restitution, start and length of a line: a row for each of ``model.ids``. Lanes name features so."""
NONE = float(NO_HIT)
ALONE = -2.0
"""In place of an ending: what happens to the ball is asked of ``flight.fly``."""
MANY = 2.0**20
"""Added to ASK by each corner that may be met, with its row: ASK is below twice this if it is only one."""


class Start(NamedTuple):
    """The balls of a survey at time 0, in the scene's coordinates.

    Position and velocity (n, 2); the origin (x0, y0) of the local coordinates, and their extent (see ``Model``); the
    box (x_min, y_min, x_max, y_max) of the walls.
    """

    position: Any
    velocity: Any
    origin: Any
    extent: float
    box: Any


class Outcome(NamedTuple):
    """Where each ball ended, in the scene's coordinates: see ``wallkit.simulation.survey.SurveyTotals``."""

    position: Any
    velocity: Any
    time: Any
    bounces: Any
    ending: Any


@kernel
def note_end(outcome, start, ball, radius, place, velocity, time, bounces, ending):
    """Write where a ball has ended, in the local coordinates of ``start``, and how: see ``Outcome``."""
    x, y, vx, vy = place[0] + start.origin[0], place[1] + start.origin[1], velocity[0], velocity[1]
    outcome.position[ball, 0], outcome.position[ball, 1] = x, y
    outcome.velocity[ball, 0], outcome.velocity[ball, 1] = vx, vy
    outcome.time[ball], outcome.bounces[ball] = time, bounces
    gone = ending == TIME_REACHED and has_left(start.box, 0.0 if radius is None else radius, x, y, vx, vy)
    outcome.ending[ball] = LEFT_SCENE if gone else ending


class Scratch(NamedTuple):
    """Memory to work in: contents do not matter. Integers are unsigned: no look whether they count from the end."""

    lanes: Any
    """SCRATCH floats."""
    balls: Any
    """LANES integers: the ball of each lane."""
    ended: Any
    """LANES + 1 integers."""
    met: Any
    """LANES integers: the row of what the ball of each lane meets."""
    rows: Any
    """(1 + lines + corners, ROW_SIZE) floats; numbers, whatever they are."""
    state: Any
    """STATE_SIZE floats."""
    counts: Any
    """As many signed integers as ``Counts`` has."""
    log: Any
    """No floats."""


@kernel
def feature_of(model, row):
    """Feature that a row stands for, see ``NO_HIT``."""
    k = int(row)
    if k < 0:
        return NO_HIT
    return int(model.ids[k]) if k < model.cells[0].corners else -2 - int(model.ids[k])


@kernel
def row_of(model, feature):
    """Row of a feature, or the number in place of one."""
    lines = model.cells[0].corners
    for k in range(model.cells[0].end):
        if (model.ids[k] if k < lines else -2 - model.ids[k]) == feature:
            return float(k)
    return float(feature)


@kernel
def is_one_way(one_sided, wall):
    """Tell whether a wall is solid from its outward side alone."""
    if one_sided is None:
        return False
    return one_sided[wall] != 0
