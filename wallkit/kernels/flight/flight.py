"""The loop: search the first contact, move there, turn the velocity, note it; until something ends the flight."""

from __future__ import annotations

import math

from wallkit.kernels.flight.ball_state import read_state, write_state
from wallkit.kernels.flight.damping import free_time, last_flight, slowed
from wallkit.kernels.flight.falling_back import fallen_back, falls_back
from wallkit.kernels.flight.gravity import bounce, facing, fall, first_contact, kept_energy, lifted
from wallkit.kernels.flight.guide import guide
from wallkit.kernels.flight.joints import AT_VERTEX, NO_END, end_at, next_face
from wallkit.kernels.flight.motion import advance
from wallkit.kernels.flight.point_in_corner import settle
from wallkit.kernels.flight.resting import held_after, keep, side_of, stopped_between
from wallkit.kernels.flight.vertex import first_face, order_shows, rests_anyhow
from wallkit.kernels.impact.contact_normal import normal_at
from wallkit.kernels.impact.polynomial_roots import NEVER
from wallkit.kernels.jit import kernel
from wallkit.kernels.records import (
    ABSORBED,
    AMBIGUOUS,
    AMBIGUOUS_CORNER,
    AT_REST,
    BOUNCE_LIMIT,
    COLLAPSE,
    COLLAPSES,
    EDGE,
    FALLS_BACK,
    JOINING,
    LEAVING,
    LEFT,
    LEFT_SCENE,
    LOG,
    LOG_STRIDE,
    NO_HIT,
    NO_ROW,
    PASSING,
    RUNNING,
    SLIDING,
    STARTING,
    STATE,
    TIME_REACHED,
    VERTEX,
    WEDGED,
)

HOLDS = (JOINING, PASSING, SLIDING, LEAVING, STARTING)
"""How a ball is held that a wall, not a flight, moves on: see ``resting.keep``."""


@kernel
def fly(model, gravity, radius, state, counts, until, limit, hits, log, capacity):
    """Fly one ball until its time, its bounce limit, an ending, or a full log.

    Args:
        model: the scene, see ``Model``.
        gravity: ``model.gravity``, given by itself so that what it is not needed for is dropped.
        radius: of the ball; 0 for a point.
        state: floats of the ball (``STATE_SIZE``), read and written, so that a flight can go on later.
        counts: integers of the ball, see ``Counts``.
        until: time at which to stop, or inf.
        limit: number of bounces at which to stop.
        hits: counts of bounces, see ``Model.edge_tally``, added to.
        log: flat floats, ``LOG_STRIDE`` a contact; empty to keep no contacts.
        capacity: contacts that fit in ``log``.

    Returns:
        Number of contacts in the log. The flight goes on from here if ``counts`` says RUNNING.
    """
    ball, clock, start, grip, last, bounces, still, before = read_state(state, counts)
    tolerance, noted, ending = state[STATE.tolerance], 0, RUNNING
    while ending == RUNNING and noted < capacity:
        face, fate, ending = 0.0, RUNNING, ending_at_once(gravity, ball[4], bounces, limit)
        if ending != RUNNING:
            break
        remaining = (until - clock[0]) - clock[1]
        if gravity is not None and grip[1] in HOLDS:
            ball, clock, start, grip, last, t, feature, ending, noted = kept_to_wall(
                model, gravity, radius, ball, clock, start, grip, last, tolerance, remaining, until, log, noted
            )
            passed = t
        else:
            t, feature = contact_ahead(model, gravity, radius, ball, start, grip, last, still, tolerance, remaining)
            if feature in (NO_HIT, AMBIGUOUS) or (feature == COLLAPSES and (gravity is None or before == NO_HIT)):
                ending = ending_without(model.damping, feature, until)
                break
            if gravity is not None:
                if feature == FALLS_BACK:
                    ball, clock, start, grip, last = back_on_wall(model, gravity, ball, clock, grip, t)
                    continue
            passed, slower = slowed(model.damping, ball[4], t, remaining)
            if gravity is None:  # a collapse is where the last bounce was: the ball has not moved there yet
                still = still_now(model.restitution, feature, still, clock, passed, t, ball, tolerance)
                if still > still_limit(model.restitution):
                    ending = COLLAPSE
                    break
            ball, clock, start, grip, last, still, feature, face, fate = arrived(
                model, gravity, radius, ball, clock, start, grip, last, still, feature, t, passed, slower, tolerance
            )
        if feature == NO_HIT:
            continue
        ball, grip, last, bounces, still, before, ending, noted = met(
            model, gravity, radius, ball, clock, start, grip, last, bounces, still, before, feature, face, fate, t,
            passed, tolerance, hits, log, noted,
        )  # fmt: skip
    ball, clock, start, ending = flown_on(model, gravity, ball, clock, start, ending, until)
    write_state(state, counts, ball, clock, start, grip, last, bounces, ending, still, before)
    return noted


@kernel
def kept_to_wall(model, gravity, radius, ball, clock, start, grip, last, tolerance, remaining, until, log, noted):
    """Let a ball go on that a wall holds, see ``keep``, and note what happens.

    Returns:
        (ball, clock, start, grip, last, time that it took, feature off which it bounces or NO_HIT, ending or RUNNING,
        row of the log for the next contact).
    """
    x, y, vx, vy, energy = ball
    held, hold, side, turns, changes = grip
    # Whether it keeps to the wall now; one that only joins or leaves it has its flight's start to remember.
    keeps = hold in (SLIDING, LEAVING)
    x, y, vx, vy, t, energy, last, held, hold, side, turns, changes, kind, feature, ending = keep(
        model,
        gravity,
        radius,
        x,
        y,
        vx,
        vy,
        energy,
        last,
        held,
        hold,
        side,
        turns,
        changes,
        start,
        tolerance,
        remaining,
    )
    ball, grip = (x, y, vx, vy, energy), (held, hold, side, turns, changes)
    clock = (until, 0.0) if ending == TIME_REACHED else advance(clock[0], clock[1], t)
    if kind != NO_ROW:
        _rho, _away, nx, ny = guide(model, model.arcs, held, side, radius, x, y)
        noted = note(log, noted, clock, ball, nx, ny, radius, held, kind)
    if keeps:  # it came back along the wall, on its side of that
        from_vx, from_vy = lifted(model, gravity, radius, held, hold, side, x, y, -vx, -vy)
        start = (x, y, from_vx, from_vy)
    return ball, clock, start, grip, last, t, feature, ending, noted


@kernel
def contact_ahead(model, gravity, radius, ball, start, grip, last, still, tolerance, remaining):
    """Find what ends a flight: (free time until then, feature); a point in a corner may get out of it at once."""
    x, y, vx, vy, energy = ball
    best = free_time(model.damping, energy, remaining)  # in which t is: as if nothing slowed the ball down
    back, best = back_before(model, gravity, radius, ball, grip, tolerance, best)
    t, feature, touched = first_contact(
        model, gravity, radius, x, y, vx, vy, energy, last, grip[0], grip[1], grip[2], tolerance, best
    )
    return settled(model, ball, start, grip, last, still, tolerance, t, feature, touched, back)


@kernel
def settled(model, ball, start, grip, last, still, tolerance, t, feature, touched, back):
    """What ends a flight that has found a contact: a point in a corner may get out of it at once.

    One that has found none falls back on a wall's end, at the time ``back`` (see ``back_before``).
    """
    if touched > 0 and last >= 0:
        # Within rounding of another edge a point has no side of it; where it came from tells.
        x, y, vx, vy, _energy = ball
        side = grip[2] if grip[0] == last else 0.0
        met = settle(model, last, side, x, y, vx, vy, start[0], start[1], start[2], start[3], tolerance, still)
        if met != NO_HIT:
            t, feature = 0.0, met
    return (back, FALLS_BACK) if feature == NO_HIT and back < NEVER else (t, feature)


@kernel
def back_before(model, gravity, radius, ball, grip, tolerance, best):
    """When a point falls back along a wall that it left, NEVER if not before ``best``, and until when to look ahead.

    Nearer to the wall's end than rounding nothing else is met.
    """
    if gravity is None:
        return NEVER, best
    held, hold, side, _turns, _changes = grip
    if radius > 0.0 or hold != LEFT or held < 0:
        return NEVER, best
    x, y, vx, vy, _energy = ball
    back = falls_back(model, gravity, held, side, x, y, vx, vy, tolerance)
    if back > best or back == NEVER:
        return NEVER, best
    _x, _y, vx, vy = fall(gravity, model.drag, x, y, vx, vy, back)
    return back, max(back - AT_VERTEX * tolerance / (abs(vx) + abs(vy)), 0.0)


@kernel
def back_on_wall(model, gravity, ball, clock, grip, t):
    """Put a point on the end of a wall to which it has fallen back: (ball, clock, start, grip, last)."""
    held, _hold, side, turns, changes = grip
    ball = fallen_back(model, gravity, held, ball, t)
    x, y, vx, vy, _energy = ball
    from_vx, from_vy = lifted(model, gravity, 0.0, held, PASSING, side, x, y, vx, vy)
    start = (x, y, from_vx, from_vy)
    return ball, advance(clock[0], clock[1], t), start, (held, PASSING, side, turns, changes), held


@kernel
def flown(model, gravity, radius, ball, clock, grip, t, passed, slower):
    """Take a ball along its flight for the free time t, which takes ``passed``: (ball, clock, start)."""
    x, y, vx, vy, energy = ball
    from_vx, from_vy = lifted(model, gravity, radius, grip[0], grip[1], grip[2], x, y, vx, vy)
    start = (x, y, from_vx, from_vy)
    x, y, vx, vy = fall(gravity, model.drag, x, y, vx, vy, t)
    return (x, y, slower * vx, slower * vy, slower * slower * energy), advance(clock[0], clock[1], passed), start


@kernel
def arrived(model, gravity, radius, ball, clock, start, grip, last, still, feature, t, passed, slower, tolerance):
    """Take a ball to what it meets: (ball, clock, start, grip, last, still, feature, face, fate).

    See ``at_vertex``; ``fate`` is what an exact hit leads to, where no digit tells from which wall it goes on (see
    ``order_shows``): an ending, or else RUNNING.
    """
    face, fate = 0.0, RUNNING
    if t > 0.0:
        ball, clock, start = flown(model, gravity, radius, ball, clock, grip, t, passed, slower)
    if gravity is not None:
        feature, face, ball, grip, last = at_vertex(
            model, gravity, radius, feature, ball, start, grip, last, t, tolerance
        )
        if feature == NO_HIT:  # it flies past a vertex, and not without end
            still += 1
            feature = COLLAPSES if still > still_limit(model.restitution) else NO_HIT
        elif face != 0.0 and t > 0.0 and order_shows(model, feature, face, ball, tolerance):
            fate = AT_REST if rests_anyhow(model, gravity, feature, face, ball, tolerance) else AMBIGUOUS_CORNER
    return ball, clock, start, grip, last, still, feature, face, fate


@kernel
def met(
    model, gravity, radius, ball, clock, start, grip, last, bounces, still, before, feature, face, fate, t, passed,
    tolerance, hits, log, noted,
):  # fmt: skip
    """Let a ball that has come to a feature, after the free time t, bounce off it, and count and note that.

    Returns:
        (ball, grip, last, bounces, still, before, ending or RUNNING, row of the log for the next contact).
    """
    if gravity is not None:
        still = still_now(model.restitution, feature, still, clock, passed, t, ball, tolerance)
        if still > still_limit(model.restitution):
            ball, grip, still, ending = caught(model, gravity, radius, ball, start, grip, last, before, tolerance)
            return ball, grip, last, bounces, still, before, ending, noted
    ball, nx, ny, wall = turned(model, gravity, radius, feature, face, ball)
    before, last, bounces = (before if feature == last else last), feature, bounces + 1
    hits[tally_of(model, feature)] += 1
    noted = note(log, noted, clock, ball, nx, ny, radius, feature, EDGE if feature >= 0 else VERTEX)
    ball, grip, ending = after_bounce(model, gravity, radius, feature, wall, fate, ball, grip, nx, ny, tolerance)
    return ball, grip, last, bounces, still, before, ending, noted


@kernel
def at_vertex(model, gravity, radius, feature, ball, start, grip, last, t, tolerance):
    """Which face a point meets that has come within rounding of a vertex: (feature, face, ball, grip, last).

    Rounding does not tell (see ``vertex``). The face is the side of the wall, 0 where the way of the ball tells it; the
    feature is NO_HIT for one that flies past the vertex. If it does so along an edge, it leaves that, on that side.
    """
    if radius > 0.0 or feature < 0:
        return feature, 0.0, ball, grip, last
    end = end_at(model, feature, ball[0], ball[1], tolerance)
    if end == NO_END:
        return feature, 0.0, ball, grip, last
    if t == 0.0:  # it is there already, and bounces off one edge after the other
        face = 0.0
        if last >= 0 and last == grip[0] and last != feature:
            joined, face = next_face(model, last, grip[2], feature, ball[0], ball[1], tolerance)
            feature = NO_HIT if joined and face == 0.0 else feature
        return feature, face, ball, grip, last
    feature, face, beside, side = first_face(model, gravity, feature, end, last, ball, start, tolerance)
    if beside != NO_HIT:
        grip, last = (beside, LEFT, side, grip[3], grip[4]), beside
        if ball[2] == 0.0 and ball[3] == 0.0:
            vx, vy = fallen(gravity, tolerance)
            ball = (ball[0], ball[1], vx, vy, ball[4])
    return feature, face, ball, grip, last


@kernel
def still_now(restitution, feature, still, clock, passed, t, ball, tolerance):
    """How many contacts in a row, with this one, passed neither time nor space; a collapse counts as too many."""
    # A bounce that moves the clock or the ball by more than rounding starts the count anew.
    still = 0 if passes(clock[0], passed, t, ball[2], ball[3], tolerance) else still + 1
    return still + still_limit(restitution) if feature == COLLAPSES else still


@kernel
def caught(model, gravity, radius, ball, start, grip, last, before, tolerance):
    """What becomes of a ball under gravity whose contacts pass neither time nor space: (ball, grip, still, ending).

    Without restitution nothing takes its speed, and the run ends. Else that is gone, and walls may hold the ball.
    """
    if model.restitution is None:
        return ball, grip, 0, COLLAPSE
    # Endless bounces in no time take all speed at a wall with restitution: what is left is where forces push it.
    x, y = ball[0], ball[1]
    # The side is that of what holds it, or of what it met last.
    one, other = (last, before) if grip[0] in (NO_HIT, last) else (grip[0], last)
    held, hold, side, ending = stopped_between(model, gravity, radius, one, grip[2], other, x, y, start, tolerance)
    vx, vy = fallen(gravity, tolerance) if hold == LEFT else (0.0, 0.0)
    return (x, y, vx, vy, kept_energy(gravity, x, y, vx, vy)), (held, hold, side, grip[3], grip[4]), 0, ending


@kernel
def fallen(gravity, tolerance):
    """Velocity of a ball that has fallen from rest for next to no time: which way it goes from walls that it touches.

    A point at rest on a wall lies on the side from which it is pressed; one that falls out of a corner does not. It
    falls the tolerance in sqrt(2 tolerance / g); 2^-40 of that is far below the rounding of any clock.
    """
    strength = math.sqrt(gravity[0] * gravity[0] + gravity[1] * gravity[1])
    time = 2.0**-40 * math.sqrt(2.0 * tolerance / strength)
    return time * gravity[0], time * gravity[1]


@kernel
def turned(model, gravity, radius, feature, face, ball):
    """Turn the velocity of a ball at what it has reached: (ball, normal towards it, of any length, wall).

    ``face`` is the side of the wall that it meets, where that is known, else 0.
    """
    x, y, vx, vy, energy = ball
    nx, ny, twice, wall = normal_of(model, feature, x, y)
    # The stored normal is that of the edge; a two-sided wall turns the ball back to where it came from.
    if face == 0.0:
        nx, ny = facing(model, gravity, radius, feature, x, y, vx, vy, nx, ny)
    elif side_of(model, model.arcs, feature, x, y, nx, ny) != face:
        nx, ny = -nx, -ny
    vx, vy, energy = bounce(model, gravity, wall, nx, ny, twice, x, y, vx, vy, energy)
    return (x, y, vx, vy, energy), nx, ny, wall


@kernel
def after_bounce(model, gravity, radius, feature, wall, fate, ball, grip, nx, ny, tolerance):
    """What a bounce leads to: (ball, grip, ending or RUNNING); a wall may absorb the ball, or hold it from now on.

    ``fate`` is what it leads to by itself, see ``arrived``.
    """
    ending = ABSORBED if absorbs(model.restitution, wall) else fate
    x, y, vx, vy, energy = ball
    held, hold, side = grip[0], grip[1], grip[2]
    if gravity is not None:
        held, hold, side = held_after(
            model, gravity, radius, feature, held, hold, side, x, y, vx, vy, nx, ny, tolerance
        )
        if hold == WEDGED or ending == AT_REST:
            hold, ending, vx, vy = WEDGED, AT_REST, 0.0, 0.0
    return (x, y, vx, vy, energy), (held, hold, side, 0, 0), ending


@kernel
def flown_on(model, gravity, ball, clock, start, ending, until):
    """Take a ball whose time is up to that time, or to where damping stops it before: (ball, clock, start, ending)."""
    if ending != TIME_REACHED or (until - clock[0]) - clock[1] <= 0.0:
        return ball, clock, start, ending
    x, y, vx, vy, energy = ball
    start = (x, y, vx, vy)
    t, slower, time, lost = last_flight(model.damping, energy, clock[0], clock[1], until)
    x, y, vx, vy = fall(gravity, model.drag, x, y, vx, vy, t)
    vx, vy, energy = slower * vx, slower * vy, slower * slower * energy
    if slower == 0.0:
        ending, vx, vy = AT_REST, 0.0, 0.0
    return (x, y, vx, vy, energy), (time, lost), start, ending


@kernel
def ending_at_once(gravity, energy, bounces, limit):
    """What ends the run of a ball that is about to fly: an ending, or RUNNING."""
    if gravity is None:
        if energy <= 0.0:
            return AT_REST
    return BOUNCE_LIMIT if bounces >= limit else RUNNING


@kernel
def ending_without(damping, feature, until):
    """What ends the run of a ball for which no contact was found that it gets out of."""
    if feature == AMBIGUOUS:
        return AMBIGUOUS_CORNER
    if feature == COLLAPSES:
        return COLLAPSE
    if damping is None:
        if until == math.inf:
            return LEFT_SCENE
    return TIME_REACHED


@kernel
def passes(time, passed, t, vx, vy, tolerance):
    """Tell whether a flight passes time and space by more than their rounding; t is its free time."""
    # 2^-6 of the tolerance: bounces so near are in a wedge or a hollow, and real ones are far longer.
    return time + passed > time and t * (abs(vx) + abs(vy)) > tolerance * 2.0**-6


@kernel
def normal_of(model, feature, x, y):
    """Normal at a contact, any length and way, 2 / (n.n), and the wall."""
    if feature >= 0:
        nx, ny, twice = normal_at(model, model.arcs, feature, x, y)
        return nx, ny, twice, wall_of(model, feature)
    # A disc touches a vertex along the line from it to the centre.
    corner = model.corners[-2 - feature]
    nx, ny = x - corner.x, y - corner.y
    return nx, ny, 2.0 / (nx * nx + ny * ny), wall_of(model, feature)


@kernel
def wall_of(model, feature):
    """Wall of an edge or a corner."""
    return model.edge_wall[feature] if feature >= 0 else model.corner_wall[-2 - feature]


@kernel
def tally_of(model, feature):
    """Which count of bounces one off an edge or a corner is added to."""
    return model.edge_tally[feature] if feature >= 0 else model.corner_tally[-2 - feature]


@kernel
def absorbs(restitution, wall):
    """Tell whether a wall leaves a ball no speed at all."""
    if restitution is None:
        return False
    return restitution[2 * wall] == 0.0 and restitution[2 * wall + 1] == 0.0


@kernel
def still_limit(restitution):
    """Contacts in a row that rounding does not tell apart, in time or place, after which a ball is caught.

    Caught between walls, or rolling into a hollow; with restitution, losing its speed in a wedge.
    """
    return 1000 if restitution is None else 100


@kernel
def fly_all(model, gravity, radii, states, counts, until, limit, hits, log, capacity):
    """Fly balls one after the other, with an empty log, or one ball with a log; see ``fly``."""
    noted = 0
    for ball in range(len(radii)):
        noted = fly(model, gravity, radii[ball], states[ball], counts[ball], until, limit, hits, log, capacity)
    return noted


@kernel
def note(log, row, clock, ball, nx, ny, radius, feature, kind):
    """Write one contact to the log, the normal made a unit and pointing to the ball: the row for the next one."""
    if len(log) == 0:
        return row
    x, y, vx, vy, _energy = ball
    length = math.sqrt(nx * nx + ny * ny)
    nx, ny = nx / length, ny / length
    # The contact point is r from the centre, against the normal.
    o = LOG_STRIDE * row
    log[o + LOG.time], log[o + LOG.x], log[o + LOG.y] = clock[0] + clock[1], x, y
    log[o + LOG.vx], log[o + LOG.vy] = vx, vy
    log[o + LOG.px], log[o + LOG.py] = x - radius * nx, y - radius * ny
    log[o + LOG.nx], log[o + LOG.ny] = nx, ny
    log[o + LOG.feature], log[o + LOG.kind] = float(feature), float(kind)
    return row + 1
