"""How a wall comes to hold a ball under gravity, takes it on from edge to edge, and lets it go again.

With restitution e < 1 a ball that leaves a wall at the normal speed w, pressed back by p, bounces without end in the
time 2 w / (p (1 - e)). When the height it reaches, w^2 / (2 p), is below the rounding of positions, these bounces are
taken at once, and after that it *keeps* to the wall (see ``contact_state``). p is -g.n, and on a curve with v^2 / rho,
less on its back and more in its hollow: what is taken at once moves it by no more than rounding, so p is that of now.

At the end of an edge the walls' own topology says what comes next (see ``wallkit.simulation.joints``):

* a smooth joint, or one of no more turn than rounding: it goes on, with its speed;
* a hollow one: it bounces off the next edge, and goes on along it if that leaves it less than rounding;
* a joint that falls away: a point leaves; so does a disc with v^2 > g r cos, and else it pivots about the vertex.
"""

from __future__ import annotations

import math

from wallkit.kernels.flight.contact_state import stretch
from wallkit.kernels.flight.gravity import LEVEL, kept_energy
from wallkit.kernels.flight.guide import STRAIGHT, ahead_of, guide, off_guide, outside, press
from wallkit.kernels.flight.joints import following, leading_along, next_face, one_sided, side_after
from wallkit.kernels.flight.last_bounces import join
from wallkit.kernels.flight.obstacles import SMOOTH_JOINT
from wallkit.kernels.flight.pendulum import period
from wallkit.kernels.flight.point_in_corner import came_from, touching
from wallkit.kernels.flight.slowed_contact import slows
from wallkit.kernels.flight.vertex import free_side
from wallkit.kernels.impact.contact_normal import is_middle, normal_at
from wallkit.kernels.impact.leaving import LEVEL_SPEED
from wallkit.kernels.index.grid import home
from wallkit.kernels.jit import kernel, rare_kernel
from wallkit.kernels.records import (
    AT_REST,
    COLLAPSE,
    END_OF_EDGE,
    FREE,
    GOES_ON,
    JOINING,
    LEAVE,
    LEAVING,
    LEFT,
    LIFTS,
    NO_HIT,
    NO_ROW,
    PASSING,
    RUNNING,
    SLIDE,
    SLIDING,
    STARTING,
    SWINGING,
    TIME_IS_UP,
    TIME_REACHED,
    TURNS,
    WEDGED,
)

SAME_WAY = 1.0 - 2.0**-20
"""Cosine of the angle between two walls, one of which goes on from the other."""
MOST_CHANGES = 4096
"""Changes from edge to edge, without a bounce and an end in time, after which a ball is said to swing for ever."""
MOST_STRETCHES = 65_536
"""Stretches of a ball that friction or drag slows down, without a bounce, after which that is said of it, too."""
MOULD = 2.0**-20
"""A disc whose radius is that of an arc, less this part, fits into it as into a mould, and cannot move along it."""


@rare_kernel
def keep(
    model, gravity, radius, x, y, vx, vy, energy, last, held, hold, side, turns, changes, start_of, tolerance, span
):
    """Let a ball that a wall holds, begins to hold or lets go, go on until the next thing happens.

    Returns:
        (x, y, vx, vy, the time it takes, energy, last, held, hold, side, turns, changes, kind of the contact to be
        noted or NO_ROW, feature off which it bounces or NO_HIT, ending or RUNNING).
    """
    if hold == STARTING:
        edge, laid = _laid_on(model, gravity, radius, x, y, vx, vy, last, tolerance)
        if edge != NO_HIT:
            return x, y, vx, vy, 0.0, energy, edge, edge, PASSING, laid, 0, changes, NO_ROW, NO_HIT, RUNNING
        feature = _struck(model, radius, x, y, vx, vy, gravity, last, tolerance)
        return x, y, vx, vy, 0.0, energy, last, held, FREE, side, 0, changes, NO_ROW, feature, RUNNING
    if hold == LEAVING:
        return x, y, vx, vy, 0.0, energy, last, held, LEFT, side, 0, changes, LEAVE, NO_HIT, RUNNING
    if hold in (JOINING, PASSING):
        x, y, vx, vy, time, hold = join(
            model, gravity, radius, held, hold, side, last, x, y, vx, vy, start_of, tolerance
        )
        energy = kept_energy(gravity, x, y, vx, vy)
        ending = AT_REST if hold == SLIDING and stays(model, gravity, radius, held, side, x, y, vx, vy) else RUNNING
        return x, y, vx, vy, time, energy, last, held, hold, side, 0, changes + 1, SLIDE, NO_HIT, ending
    slowed = slows(model.rolling, model.drag)
    if changes > MOST_STRETCHES if slowed else span == math.inf and (turns > 2 or changes > MOST_CHANGES):
        return x, y, vx, vy, 0.0, energy, last, held, hold, side, turns, changes, NO_ROW, NO_HIT, SWINGING
    x, y, vx, vy, time, event = stretch(
        model, gravity, radius, held, side, last, x, y, vx, vy, start_of, tolerance, span
    )
    feature, ending, kind = NO_HIT, RUNNING, NO_ROW
    if slowed:
        energy, changes = kept_energy(gravity, x, y, vx, vy), changes + 1
    if event == TIME_IS_UP:
        ending = TIME_REACHED
    elif event == TURNS:
        turns += 1
        if stays(model, gravity, radius, held, side, x, y, vx, vy):
            ending = AT_REST
        elif slowed:
            kind = SLIDE  # what slows it down is turned round with it
        elif turns > 2:
            time += _whole_swings(model, gravity, radius, held, side, x, y, span - time)
    elif event == LIFTS:
        last, hold = held, LEAVING
    elif event == END_OF_EDGE:
        held, hold, side, last, feature = _pass_on(model, gravity, radius, held, side, last, x, y, vx, vy, tolerance)
        if hold == WEDGED:
            vx, vy, ending = 0.0, 0.0, AT_REST
    elif event != GOES_ON:
        feature = event
    return x, y, vx, vy, time, energy, last, held, hold, side, turns, changes, kind, feature, ending


@rare_kernel
def _laid_on(model, gravity, radius, x, y, vx, vy, last, tolerance):
    """Edge on which a ball starts along it, pressed on it, and the side on which it is: (edge, side) or (NO_HIT, 1).

    What it is off by rounding would be a fall, and a bounce whose restitution along the wall takes its speed. A ball
    beside a line along gravity keeps to that, too; for the side of a point on it see ``free_side``.
    """
    if last != NO_HIT:
        return NO_HIT, 1.0
    cell = model.cells[home(model, model.grid, x, y)]
    for k in range(cell.first, cell.corners):
        edge = int(model.ids[k])
        if is_middle(model.arcs, edge, x, y):
            continue
        nx, ny, _twice = normal_at(model, model.arcs, edge, x, y)
        out = 1.0 if radius == 0.0 else _is_out(model, model.arcs, edge, x, y)
        if radius == 0.0:  # a point is on the side from which it is pressed
            if _is_plumb(model, gravity, radius, edge, 1.0, x, y):
                out = free_side(model, gravity, edge)
            elif gravity[0] * nx + gravity[1] * ny > 0.0:
                out = -1.0
        side = side_of(model, model.arcs, edge, x, y, out * nx, out * ny)
        if side < 0.0 and one_sided(model.one_sided, model.edge_wall[edge]):
            continue
        if abs(off_guide(model, model.arcs, edge, side, radius, x, y)) > tolerance:
            continue
        length = out * math.sqrt(nx * nx + ny * ny)
        foot_x, foot_y = x - radius * nx / length, y - radius * ny / length
        if not touching(model, model.arcs, edge, foot_x, foot_y, 2.0 * tolerance)[0]:
            continue
        if abs(vx * nx + vy * ny) > LEVEL_SPEED * (abs(vx) + abs(vy)) * abs(length):
            continue
        plumb = _is_plumb(model, gravity, radius, edge, side, x, y)
        if plumb or _clings(model, gravity, radius, edge, side, x, y, vx, vy, tolerance):
            return edge, side
    return NO_HIT, 1.0


@rare_kernel
def _struck(model, radius, x, y, vx, vy, gravity, last, tolerance):
    """Edge on which a point starts, pressed on it by gravity, with a velocity into it; or NO_HIT.

    A point on a wall is on neither side of it; it is taken to lie on the one from which it is pressed.
    """
    if radius > 0.0 or last != NO_HIT:
        return NO_HIT
    cell = model.cells[home(model, model.grid, x, y)]
    for k in range(cell.first, cell.corners):
        edge = int(model.ids[k])
        if not touching(model, model.arcs, edge, x, y, tolerance)[0]:
            continue
        nx, ny, _twice = normal_at(model, model.arcs, edge, x, y)
        # It flies at the edge and is pulled at it from the same side.
        into, pull = vx * nx + vy * ny, gravity[0] * nx + gravity[1] * ny
        if into * pull > 0.0 and not (into > 0.0 and one_sided(model.one_sided, model.edge_wall[edge])):
            return edge
    return NO_HIT


@kernel
def stays(model, gravity, radius, held, side, x, y, vx, vy):
    """Tell whether a ball that keeps to a wall rests: it stands, and no more pulls it along than friction holds."""
    if vx != 0.0 or vy != 0.0:
        return False
    _rho, _away, nx, ny = guide(model, model.arcs, held, side, radius, x, y)
    # Coulomb's law: it stands while the pull along the wall is at most the coefficient times what presses it.
    along, pressed = abs(gravity[1] * nx - gravity[0] * ny), -(gravity[0] * nx + gravity[1] * ny)
    least = LEVEL * (abs(gravity[0]) + abs(gravity[1]))
    grip = _grip(model, model.static_friction, held)
    return along <= least or along <= _holding(model.rolling, grip) * pressed


@kernel
def _holding(rolling, grip):
    """What holds a ball that stands: rolling friction, too."""
    if rolling is None:
        return grip
    return max(rolling, grip)


@kernel
def _grip(model, static_friction, feature):
    """Coefficient of the static friction of a feature."""
    if static_friction is None:
        return 0.0
    return static_friction[model.edge_wall[feature] if feature >= 0 else model.corner_wall[-2 - feature]]


@kernel
def _whole_swings(model, gravity, radius, held, side, x, y, span):
    """Time of the full swings, there and back, that a ball at its turning point on a circle does within a span."""
    rho, away, nx, ny = guide(model, model.arcs, held, side, radius, x, y)
    if rho == STRAIGHT or span == math.inf:
        return 0.0
    pull = math.sqrt(gravity[0] * gravity[0] + gravity[1] * gravity[1])
    ex, ey = away * nx, away * ny
    # From here to the bottom it falls by rho (1 - cos): v^2 = 2 rho (g - e.g) there.
    drop = rho * (pull - (ex * gravity[0] + ey * gravity[1]))
    whole = period(rho, pull, 2.0 * drop)
    return math.floor(span / whole) * whole if whole < span else 0.0


@rare_kernel
def _pass_on(model, gravity, radius, held, side, last, x, y, vx, vy, tolerance):
    """Take a ball on at the end of an edge, or of a vertex: (held, hold, side, last, feature off which it bounces)."""
    if held < 0:
        held, side = _edge_at(model, held, x, y)
        return held, _if_pressed(model, gravity, radius, held, side, x, y, vx, vy), side, held, NO_HIT
    rho, away, nx, ny = guide(model, model.arcs, held, side, radius, x, y)
    dx, dy, speed = ahead_of(rho, away, nx, ny, vx, vy, gravity[0], gravity[1])
    end = 0 if dx * model.joints[2 * held].tx + dy * model.joints[2 * held].ty < 0.0 else 1
    if rho != STRAIGHT:
        end = 1 if _runs_on(model.arcs, held, away * (nx * dy - ny * dx)) else 0
    joint = model.joints[2 * held + end]
    next_end = int(following(joint, end, side))
    other, next_side = next_end >> 1, side_after(next_end, end, side)
    free = next_end == 2 * held + end
    free = free or (next_side < 0.0 and one_sided(model.one_sided, model.edge_wall[other]))
    there = model.joints[next_end]
    # The next edge goes off by `rise` towards the ball's side: above 0 the joint is hollow, below 0 it falls away.
    rise, ahead = there.tx * nx + there.ty * ny, there.tx * dx + there.ty * dy
    square = speed * speed
    if not free and rise > 0.0:  # in a hollow it rests, where what pulls it in on either side is more than its speed
        back, on = -(gravity[0] * there.tx + gravity[1] * there.ty), gravity[0] * dx + gravity[1] * dy
        if back > 0.0 and on > 0.0 and square <= 2.0 * min(back, on) * tolerance:
            return held, WEDGED, side, last, NO_HIT
    if not free and ahead > 0.0 and rise < SMOOTH_JOINT and rise > -0.5:
        other_rho, other_away, mx, my = guide(model, model.arcs, other, next_side, radius, x, y)
        pressed = press(gravity, other_rho, other_away, mx, my, square)
        level = LEVEL * (abs(gravity[0]) + abs(gravity[1]))
        # Turned by the angle `rise` it has the speed v rise off the wall; pressed back by p it would rise by
        # (v rise)^2 / 2 p, and the place of a disc's centre jumps by r rise^2. Below rounding both are no bounce.
        flat = square * rise * rise <= 2.0 * max(pressed, 0.0) * tolerance and radius * rise * rise <= tolerance
        plumb = other_rho == STRAIGHT and abs(pressed) <= level and abs(rise) < SMOOTH_JOINT
        if (pressed > level and flat) or plumb:
            return other, PASSING, next_side, held, NO_HIT
        if pressed <= level and abs(rise) < SMOOTH_JOINT:
            return other, LEAVING, next_side, held, NO_HIT  # it is in touch with both
    if not free and rise > 0.0:
        return held, SLIDING, side, last, other
    if radius == 0.0:
        return held, LEAVING, side, held, NO_HIT
    # A disc pivots about the vertex while gravity can turn it: v^2 / r below -g.n.
    corner = -2 - int(joint.vertex)
    pressed = press(gravity, radius, 1.0, nx, ny, square)
    if pressed > LEVEL * (abs(gravity[0]) + abs(gravity[1])):
        return corner, PASSING, 1.0, held, NO_HIT
    return held, LEAVING, side, corner, NO_HIT


@kernel
def _runs_on(arcs, held, counter):
    """Tell whether the way round an arc, counter-clockwise where ``counter`` is above 0, is that of its wall."""
    if arcs is None:
        return True
    return (counter > 0.0) == (arcs[held].sweep > 0.0)


@kernel
def _edge_at(model, corner, x, y):
    """Edge beside which a disc is that has pivoted about a vertex, and on which side of it: (edge, side)."""
    vertex = model.corners[-2 - corner]
    px, py = x - vertex.x, y - vertex.y
    # Of the edges around the vertex the one along which the centre is farthest: it is square to the normal there.
    found = leading_along(model, int(model.spokes[-2 - corner]), px, py)
    joint = model.joints[found]
    to_right = px * joint.ty - py * joint.tx > 0.0
    return found >> 1, 1.0 if to_right == (found & 1 == 0) else -1.0


@kernel
def _if_pressed(model, gravity, radius, held, side, x, y, vx, vy):
    """PASSING where a ball is pressed on the wall to which it comes, else LEAVING."""
    rho, away, nx, ny = guide(model, model.arcs, held, side, radius, x, y)
    pressed = press(gravity, rho, away, nx, ny, vx * vx + vy * vy)
    return PASSING if pressed > LEVEL * (abs(gravity[0]) + abs(gravity[1])) else LEAVING


@rare_kernel
def held_after(model, gravity, radius, feature, held, hold, side, x, y, vx, vy, nx, ny, tolerance):
    """What holds a ball after a bounce off a feature (normal n towards it), and how: (feature, hold, side).

    It goes on along the wall to which it kept until now, where its speed off that is less than rounding. It is wedged
    where the pull along either presses it on the other, and its speed takes it no farther than rounding up either.
    Else it keeps to what it has met.
    """
    length = math.sqrt(nx * nx + ny * ny)
    nx, ny = nx / length, ny / length
    w = vx * nx + vy * ny
    level = LEVEL * (abs(gravity[0]) + abs(gravity[1]))
    other_side = side_of(model, model.arcs, feature, x, y, nx, ny)
    clings = _clings(model, gravity, radius, feature, other_side, x, y, vx, vy, tolerance)
    if hold == SLIDING and feature != held:
        _rho, _away, mx, my = guide(model, model.arcs, held, side, radius, x, y)
        # Wedged: the pull along either wall presses it on the other, and v^2 <= 2 a tolerance takes it up neither.
        on, back = _pushed(gravity, mx, my, nx, ny), _pushed(gravity, nx, ny, mx, my)
        least = min(abs(gravity[1] * mx - gravity[0] * my), abs(gravity[1] * nx - gravity[0] * ny))
        if min(on, back) > 2.0**8 * level and vx * vx + vy * vy <= 2.0 * least * tolerance:
            return held, WEDGED, side
        if _clings(model, gravity, radius, held, side, x, y, vx, vy, tolerance):
            if clings and on > 2.0**8 * level and back <= 0.0:
                return feature, PASSING, other_side  # it is less steep there, and goes on
            if not (clings and mx * nx + my * ny > SAME_WAY):
                return held, PASSING, side
    if _fits(model, model.arcs, feature, other_side, radius):
        if vx * vx + vy * vy <= -2.0 * (gravity[0] * nx + gravity[1] * ny) * tolerance:
            return feature, WEDGED, other_side
        return feature, FREE, other_side
    dead = w <= LEVEL_SPEED * (abs(vx) + abs(vy))
    if clings or (dead and _is_plumb(model, gravity, radius, feature, other_side, x, y)):
        return feature, PASSING if dead else JOINING, other_side
    return feature, LEFT if dead else FREE, other_side


@kernel
def _pushed(gravity, nx, ny, mx, my):
    """What the pull along a wall with unit normal n presses a ball with on another one with unit normal m."""
    # (g.t) t is the pull along the wall, t = (-ny, nx); its part against m is what presses there.
    pull = gravity[1] * nx - gravity[0] * ny
    return -pull * (nx * my - ny * mx)


@kernel
def _clings(model, gravity, radius, feature, side, x, y, vx, vy, tolerance):
    """Pressed against a feature, a ball rises less than the tolerance."""
    rho, away, nx, ny = guide(model, model.arcs, feature, side, radius, x, y)
    if _fits(model, model.arcs, feature, side, radius):
        return False
    pressed = press(gravity, rho, away, nx, ny, vx * vx + vy * vy)
    # Thrown up at w it rises by w^2 / 2 p.
    w = vx * nx + vy * ny
    return pressed > LEVEL * (abs(gravity[0]) + abs(gravity[1])) and w * w <= 2.0 * pressed * tolerance


@kernel
def _is_plumb(model, gravity, radius, feature, side, x, y):
    """Tell whether a feature is a line along gravity: a ball in touch with it keeps to it as if it were free."""
    rho, _away, nx, ny = guide(model, model.arcs, feature, side, radius, x, y)
    pressed = gravity[0] * nx + gravity[1] * ny
    return rho == STRAIGHT and abs(pressed) <= LEVEL * (abs(gravity[0]) + abs(gravity[1]))


@kernel
def _fits(model, arcs, feature, side, radius):
    """Tell whether a disc fits into the hollow of an arc as into a mould."""
    if feature < 0 or arcs is None:
        return False
    arc = arcs[feature]
    return arc.radius > 0.0 and not outside(arc, side) and arc.radius - radius < MOULD * arc.radius


@kernel
def side_of(model, arcs, feature, x, y, nx, ny):
    """Side of a feature's wall to which a normal points: 1 its outward one, -1 the other."""
    if feature < 0:
        return 1.0
    mx, my, _twice = normal_at(model, arcs, feature, x, y)
    out = mx * nx + my * ny > 0.0
    if arcs is not None:
        arc = arcs[feature]
        if arc.radius > 0.0:
            return 1.0 if out == (arc.sweep > 0.0) else -1.0
    return 1.0 if out else -1.0


@rare_kernel
def stopped_between(model, gravity, radius, one, one_side, other, x, y, start_of, tolerance):
    """What becomes of a ball whose speed endless bounces between two features, in no time, have taken.

    Returns:
        (feature, hold, side, ending): it rests where each of the two presses it on the other, slides along the one that
        holds it, or falls, by the forces alone.
    """
    if other == NO_HIT:
        return one, FREE, one_side, COLLAPSE
    _rho, _away, ax, ay = guide(model, model.arcs, one, one_side, radius, x, y)
    other_side = _side_now(model, radius, one, one_side, other, x, y, start_of, tolerance)
    _rho, _away, bx, by = guide(model, model.arcs, other, other_side, radius, x, y)
    gx, gy = gravity[0], gravity[1]
    on_one, on_other = -(gx * ax + gy * ay), -(gx * bx + gy * by)
    # It has no speed: it slides along the wall on which the pull leads away from the other.
    if on_one > 0.0 and _pushed(gravity, ax, ay, bx, by) <= 0.0:
        return one, PASSING, one_side, RUNNING
    if on_other > 0.0 and _pushed(gravity, bx, by, ax, ay) <= 0.0:
        return other, PASSING, other_side, RUNNING
    if on_one <= 0.0 and on_other <= 0.0:
        return one, LEFT, one_side, RUNNING
    return one, WEDGED, one_side, AT_REST


@kernel
def _side_now(model, radius, one, one_side, feature, x, y, start_of, tolerance):
    """Side of a feature's wall on which a ball is that has just bounced off it: a point's is told by where it went."""
    if feature < 0:
        return 1.0
    if radius == 0.0 and one >= 0:
        _joined, face = next_face(model, one, one_side, feature, x, y, tolerance)
        if face != 0.0:
            return face
    nx, ny, _twice = normal_at(model, model.arcs, feature, x, y)
    if radius > 0.0:
        out = _is_out(model, model.arcs, feature, x, y)
    else:
        from_x, from_y, from_vx, from_vy = start_of
        out = came_from(model, feature, x, y, from_x, from_y, from_vx, from_vy, tolerance)
    return side_of(model, model.arcs, feature, x, y, out * nx, out * ny)


@kernel
def _is_out(model, arcs, feature, x, y):
    """1 where a centre is on the side of an edge to which ``normal_at`` points, else -1."""
    if arcs is not None:
        arc = arcs[feature]
        if arc.radius > 0.0:
            ex, ey = x - arc.ax + arc.sx, y - arc.ay + arc.sy
            return 1.0 if ex * ex + ey * ey > arc.radius * arc.radius else -1.0
    line = model.lines[feature]
    return 1.0 if (x - line.ax) * line.nx + (y - line.ay) * line.ny > 0.0 else -1.0
