"""Whether a ball's motion is regular: by the tangent map over its last contacts, and by the word of its edges."""

from __future__ import annotations

import math

from wallkit.kernels.flight.error_growth import derivative
from wallkit.kernels.flight.flight import wall_of
from wallkit.kernels.jit import kernel
from wallkit.kernels.records import LOG, LOG_STRIDE, NO_HIT, SLIDE, VERTEX

PERIODS, LONGEST = 10, 64
"""A word of edges repeats if it comes so often in a row; of so many edges at most."""
LASTS = 1e4
"""Periods that a repeated word must still have before the drift of its contacts takes one to the end of its edge."""
STANDS = 2.0**-36
"""A drift a period of less than this part of the scene is rounding."""
CHAOTIC = math.inf


@kernel
def bend_at(arcs, radius, feature, x, y, nx, ny):
    """Curvature, at a contact, of the line that a ball's centre at (x, y) cannot cross: above 0 where it is convex.

    It is 1 over the distance to the centre of the arc or to the vertex, and below 0 inside an arc: the normal, towards
    the ball, then points to the centre.
    """
    if feature < 0:
        return 1.0 / radius if radius > 0.0 else 0.0
    if arcs is not None:
        arc = arcs[feature]
        if arc.radius > 0.0:
            ex, ey = x - (arc.ax - arc.sx), y - (arc.ay - arc.sy)
            distance = math.sqrt(ex * ex + ey * ey)
            if distance == 0.0:
                return 0.0
            return 1.0 / distance if ex * nx + ey * ny > 0.0 else -1.0 / distance
    return 0.0


@kernel
def kept_at(restitution, wall):
    """(tangential, normal) restitution of a wall."""
    if restitution is None:
        return 1.0, 1.0
    return restitution[2 * wall + 1], restitution[2 * wall]


@kernel
def falls(gravity):
    """Acceleration in flight."""
    if gravity is None:
        return 0.0, 0.0
    return gravity[0], gravity[1]


@kernel
def _way(log, rows, filled, count):
    """Length of the way over the last ``count`` contacts, from the place of the one before, and how long it took."""
    o = LOG_STRIDE * ((filled - count - 1) % rows)
    length, p = 0.0, o
    for k in range(filled - count, filled):
        q = LOG_STRIDE * (k % rows)
        length += math.sqrt((log[q + LOG.x] - log[p + LOG.x]) ** 2 + (log[q + LOG.y] - log[p + LOG.y]) ** 2)
        p = q
    return length, log[p + LOG.time] - log[o + LOG.time]


@kernel
def tangent_norm(model, gravity, radius, log, rows, filled, count):
    """Norm of the tangent map over the last contacts of a ball, and how many of them were on curves.

    The map takes an error across the way, of place (dx) or of velocity (dv), just after one contact to just after the
    last: dx' = dx + t dv in flight, and at each bounce ``error_growth.derivative``. Lengths count in mean flights and
    times in mean times of flight, so that n free flights give about n. It is Frobenius' norm over sqrt(2): 1 for no
    contact at all.

    Args:
        model: the scene.
        gravity: ``model.gravity``.
        radius: of the ball.
        log: ring of ``rows`` contacts.
        rows: how many it holds.
        filled: contacts that were written to it.
        count: how many of the last ones to take; there must be one more before them.

    Returns:
        (norm, contacts on curves); the norm is inf where the ball slid, or where it is no number.
    """
    o, curved = LOG_STRIDE * ((filled - count - 1) % rows), 0
    length, lasted = _way(log, rows, filled, count)
    start = math.sqrt(log[o + LOG.vx] * log[o + LOG.vx] + log[o + LOG.vy] * log[o + LOG.vy])
    if not (length > 0.0 and lasted > 0.0 and start > 0.0):
        return CHAOTIC, 0
    length, speed = length / count, length / lasted
    ex, ey = -log[o + LOG.vy] / start, log[o + LOG.vx] / start  # across the way
    x, y, u, w = length * ex, length * ey, 0.0, 0.0
    x2, y2, u2, w2 = 0.0, 0.0, speed * ex, speed * ey
    p = o
    for k in range(filled - count, filled):
        q = LOG_STRIDE * (k % rows)
        if log[q + LOG.kind] > VERTEX or log[p + LOG.kind] >= SLIDE:
            return CHAOTIC, 0
        t, pull = log[q + LOG.time] - log[p + LOG.time], falls(gravity)
        x, y, x2, y2 = x + t * u, y + t * w, x2 + t * u2, y2 + t * w2
        vx, vy, nx, ny = log[p + LOG.vx] + t * pull[0], log[p + LOG.vy] + t * pull[1], log[q + LOG.nx], log[q + LOG.ny]
        across = vx * nx + vy * ny
        if across > 0.0:
            nx, ny = -nx, -ny
        if across == 0.0:
            return CHAOTIC, 0
        feature = int(log[q + LOG.feature])
        bend = bend_at(model.arcs, radius, feature, log[q + LOG.x], log[q + LOG.y], nx, ny)
        curved += 1 if bend != 0.0 else 0
        kept = kept_at(model.restitution, wall_of(model, feature))
        _S, A, B, M = derivative(vx, vy, log[q + LOG.vx], log[q + LOG.vy], nx, ny, kept, bend, pull, pull)
        u, w = B[0] * x + B[1] * y + M[0] * u + M[1] * w, B[2] * x + B[3] * y + M[2] * u + M[3] * w
        x, y = A[0] * x + A[1] * y, A[2] * x + A[3] * y
        u2, w2 = B[0] * x2 + B[1] * y2 + M[0] * u2 + M[1] * w2, B[2] * x2 + B[3] * y2 + M[2] * u2 + M[3] * w2
        x2, y2 = A[0] * x2 + A[1] * y2, A[2] * x2 + A[3] * y2
        if not abs(x) + abs(y) + abs(x2) + abs(y2) < 1e150 * length:
            return CHAOTIC, curved
        p = q
    places = (x * x + y * y + x2 * x2 + y2 * y2) / (length * length)
    norm = math.sqrt(0.5 * (places + (u * u + w * w + u2 * u2 + w2 * w2) / (speed * speed)))
    return (norm if norm < CHAOTIC else CHAOTIC), curved


@kernel
def period_of(model, log, rows, filled):
    """Length of the word of edges that the last contacts repeat, and keep to for ``LASTS`` periods more; or 0."""
    for period in range(1, LONGEST + 1):
        if PERIODS * period > filled or PERIODS * period > rows:
            return 0
        same = True
        k = filled - 1
        while same and k >= filled - (PERIODS - 1) * period:
            o, before = LOG_STRIDE * (k % rows), LOG_STRIDE * ((k - period) % rows)
            same = (
                log[o + LOG.feature] == log[before + LOG.feature]
                and log[o + LOG.feature] >= 0.0
                and log[o + LOG.kind] < SLIDE
            )
            k -= 1
        if same:
            return period if lasts(model, log, rows, filled, period) else 0
    return 0


@kernel
def lasts(model, log, rows, filled, period):
    """Tell whether a repeated word stays: no place of contact drifts off its edge within ``LASTS`` periods."""
    for k in range(filled - period, filled):
        o, before = LOG_STRIDE * (k % rows), LOG_STRIDE * ((k - (PERIODS - 1) * period) % rows)
        dx, dy = (
            (log[o + LOG.px] - log[before + LOG.px]) / (PERIODS - 1),
            (log[o + LOG.py] - log[before + LOG.py]) / (PERIODS - 1),
        )
        drift = math.sqrt(dx * dx + dy * dy)
        if drift <= STANDS * model.extent:
            continue
        line = model.lines[int(log[o + LOG.feature])]
        ahead = dx * (line.bx - line.ax) + dy * (line.by - line.ay) > 0.0
        ex, ey = (line.bx, line.by) if ahead else (line.ax, line.ay)
        room = math.sqrt((ex - log[o + LOG.px]) ** 2 + (ey - log[o + LOG.py]) ** 2)
        if room < LASTS * drift:
            return False
    return True


@kernel
def word_of(log, rows, filled, count, marks, mark):
    """Number that stands for the set of features of the last contacts; the same for the same set.

    Args:
        log: ring of contacts.
        rows: how many it holds.
        filled: how many were written.
        count: of the last ones.
        marks: by edge and vertex, scratch.
        mark: a number that was not used in ``marks`` before.
    """
    number, edges = 0, len(marks) // 2
    for k in range(max(filled - count, 0), filled):
        feature = int(log[LOG_STRIDE * (k % rows) + LOG.feature])
        slot = feature if feature >= 0 else edges + (NO_HIT - 1 - feature)
        if marks[slot] != mark:
            marks[slot] = mark
            number = (number + (feature * 2654435761 + 97) % 2147483647) % 2147483647
    return number
