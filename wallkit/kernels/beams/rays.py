"""Single shots, many at a time: where each bounces, and whether it reaches a disc."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from wallkit.kernels.flight.flight import fly
from wallkit.kernels.flight.sensors import count_crossings, count_kept, set_pull
from wallkit.kernels.jit import kernel, rare_kernel
from wallkit.kernels.records import EDGE, LEFT_SCENE, LOG_STRIDE, NO_HIT, RUNNING, VERTEX

NEVER = -1
"""In place of the bounces after which a shot reaches the target; and behind the last bounce."""
MOST_ROWS = 64
"""Contacts for each bounce that is wanted, with those at which a ball begins and ends to keep to a wall: beyond it the
shot is given up."""


class Shots(NamedTuple):
    """What is written of n shots with at most K bounces."""

    reached: Any
    """(n,) bounces before the target is reached, or NEVER."""
    word: Any
    """(n, K + 1) features bounced off; NO_HIT behind the last."""
    places: Any
    """(n, 2 K + 2) x and y of the centre at each bounce; 0 behind the last."""
    miss: Any
    """(n, K + 1) how far left of the line of each flight the target's middle lies, below 0 for right; inf where it lies
    behind, or there is no such flight, and under gravity."""


class Scratch(NamedTuple):
    """Room to work in."""

    state: Any
    counts: Any
    start: Any
    """Integers of a ball that starts, see ``Counts``."""
    hits: Any
    log: Any
    """Of ``capacity`` contacts."""
    found: Any
    """(2,) crossings of the target inwards and outwards."""


@kernel
def shoot(model, gravity, pull, sensors, target, radius, begin, velocities, most, scratch, capacity, shots):
    """Fly shots from one point until they reach the target, have bounced once more than they may, or end.

    Args:
        model: the scene.
        gravity: ``model.gravity``.
        pull: scratch of 2 floats, None without gravity.
        sensors: the target as a sensor with the same local origin, None without gravity.
        target: (x, y, radius), local.
        radius: of the ball.
        begin: floats of a ball at the start; its velocity is not read.
        velocities: (n, 2).
        most: K.
        scratch: see ``Scratch``.
        capacity: contacts that its log holds, K + 2 at least.
        shots: written, see ``Shots``.
    """
    for shot in range(len(velocities)):
        _begin(gravity, begin, velocities[shot, 0], velocities[shot, 1], scratch)
        _follow(model, gravity, pull, sensors, target, radius, most, scratch, capacity, shots, shot)


@kernel
def _begin(gravity, begin, vx, vy, scratch):
    """Put a ball at the start."""
    state, counts = scratch.state, scratch.counts
    for i in range(len(state)):
        state[i] = begin[i]
    state[2], state[3], state[9], state[10] = vx, vy, vx, vy
    state[6] = vx * vx + vy * vy
    if gravity is not None:
        state[6] -= 2.0 * (gravity[0] * state[0] + gravity[1] * state[1])
    for i in range(len(counts)):
        counts[i] = scratch.start[i]


@kernel
def _follow(model, gravity, pull, sensors, target, radius, most, scratch, capacity, shots, shot):
    """Fly one shot, and look flight by flight whether it reaches the target."""
    state, counts, log = scratch.state, scratch.counts, scratch.log
    x, y, vx, vy, since = state[0], state[1], state[2], state[3], 0.0
    dx, dy = target.x - x, target.y - y
    shots.reached[shot] = 0 if dx * dx + dy * dy < target.radius * target.radius else NEVER
    set_pull(model, gravity, pull, EDGE, NO_HIT, vx, vy)
    feature, kind, nx, ny, bounces, rows = NO_HIT, EDGE, 0.0, 0.0, 0, 0
    while counts[2] == RUNNING and rows < MOST_ROWS * (most + 1) and shots.reached[shot] == NEVER:
        noted = fly(model, gravity, radius, state, counts, math.inf, most + 1, scratch.hits, log, capacity)
        rows += noted + 1
        for row in range(noted):
            o = LOG_STRIDE * row
            if bounces <= most and _reaches(
                model, gravity, pull, sensors, target, radius, feature, kind, nx, ny, x, y, vx, vy, since,
                log[o], log[o + 1], log[o + 2], scratch.found, shots.miss, shot, bounces,
            ):  # fmt: skip
                shots.reached[shot] = bounces
                return
            since, x, y, vx, vy = log[o], log[o + 1], log[o + 2], log[o + 3], log[o + 4]
            nx, ny, feature, kind = log[o + 7], log[o + 8], int(log[o + 9]), int(log[o + 10])
            set_pull(model, gravity, pull, kind, feature, vx, vy)
            if kind in (EDGE, VERTEX) and bounces <= most:
                shots.word[shot, bounces] = feature
                shots.places[shot, 2 * bounces], shots.places[shot, 2 * bounces + 1] = x, y
                bounces += 1
    if shots.reached[shot] == NEVER and bounces <= most:
        end, end_x, end_y = state[4] + state[5], state[0], state[1]
        if counts[2] == LEFT_SCENE:
            end, end_x, end_y = math.inf, math.inf, math.inf
        if _reaches(
            model, gravity, pull, sensors, target, radius, feature, kind, nx, ny, x, y, vx, vy, since,
            end, end_x, end_y, scratch.found, shots.miss, shot, bounces,
        ):  # fmt: skip
            shots.reached[shot] = bounces


@rare_kernel
def _reaches(
    model, gravity, pull, sensors, target, radius, feature, kind, nx, ny, x, y, vx, vy, since, end, end_x, end_y, found,
    miss, shot, bounces,
):  # fmt: skip
    """Tell whether one flight, from (x, y) at ``since`` to (end_x, end_y) at ``end``, enters the target."""
    if gravity is None:
        return _passes(target, x, y, vx, vy, end_x, end_y, miss, shot, bounces)
    found[0] = found[1] = 0
    if not count_kept(model, gravity, sensors, radius, feature, kind, nx, ny, x, y, vx, vy, since, end, found, 0):
        count_crossings(sensors, pull, x, y, vx, vy, since, end, found, 0)
    return found[0] > 0


@kernel
def _passes(target, x, y, vx, vy, end_x, end_y, miss, shot, bounces):
    """Tell whether a straight flight enters the target, and note how it passes: w x v / |v| with w to its middle."""
    wx, wy = target.x - x, target.y - y
    speed = math.sqrt(vx * vx + vy * vy)
    if speed == 0.0:
        return False
    along, off = (wx * vx + wy * vy) / speed, (vx * wy - vy * wx) / speed
    length = math.inf if end_x == math.inf else math.sqrt((end_x - x) ** 2 + (end_y - y) ** 2)
    if along <= 0.0:
        return False
    miss[shot, bounces] = off
    inside = target.radius * target.radius - off * off
    return inside > 0.0 and along - math.sqrt(inside) < length
