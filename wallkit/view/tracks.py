"""Tracks: a run as stretches of free flight, ball after ball, for everything that draws motion."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.scene.scene import falls
from wallkit.simulation.gliding import guides
from wallkit.simulation.motion import Motion
from wallkit.simulation.run import ContactKind, Ending, one_a_ball, turns_in

if TYPE_CHECKING:
    from wallkit.scene.scene import Balls
    from wallkit.simulation.run import Run

CHORD = 0.1
"""Radians, or parts of the time of a small swing, of a stretch on a circle: a parabola is off by 1e-4 rho at most."""
FINE = 0.03
"""Parts of 1 / k of a stretch under gravity and drag k: a parabola is off by g (FINE / k)^2 / 200 at most."""
MOST_CHORDS = 400


@dataclass(slots=True, eq=False)
class Tracks:
    """Stretches between contacts: p + v s + a s^2 / 2 for the time s since the stretch began.

    With drag k it is p + v (1 - exp(-k s)) / k. Crossings of sensors are no contacts here.

    Attributes:
        offsets: (n + 1,) the stretches of ball b are ``offsets[b]`` to ``offsets[b + 1]``; the first begins at the
            start, each other at a contact.
        time: (m,) when a stretch begins.
        until: (m,) when it ends.
        position: (m, 2) of the centre where it begins.
        target: (m, 2) where it ends: the next contact's centre, or the ball's last place.
        velocity: (m, 2) with which it begins.
        pull: (m, 2) acceleration: gravity, or the part of it along the wall on which the ball slides, or rolling
            friction, against the velocity. Where a ball glides along an arc, or pivots about a vertex, its stretch
            is cut into short ones, each a parabola, and only the first of them begins with a contact; so is a flight
            under gravity and drag.
        drag: the rate k, or 0; 0 under gravity.
        contact: (m,) index into ``contacts`` of the contact it begins with, -1 for the start.
        contacts: those of the run, with a row for each of two balls that meet.
        radius: (n,) of the balls.
        whole: the number of stretches before thinning.
    """

    offsets: IntArray
    time: FloatArray
    until: FloatArray
    position: FloatArray
    target: FloatArray
    velocity: FloatArray
    pull: FloatArray
    drag: float
    contact: IntArray
    contacts: NDArray[Any]
    radius: FloatArray
    whole: int

    @property
    def ball(self) -> IntArray:
        """(m,) the ball of each stretch."""
        return np.repeat(np.arange(len(self.offsets) - 1, dtype=np.int64), np.diff(self.offsets))

    @property
    def thinned(self) -> bool:
        """Some stretches were left out."""
        return len(self.time) < self.whole


def tracks(run: Run, limit: int | None = None) -> Tracks:
    """Cut a run into stretches.

    Args:
        run: the run.
        limit: the most stretches wanted; each ball then keeps its first ones, the same number each at most, and
            the balls beyond the limit keep none.
    """
    start, velocity, radius = arrays_of(run.scene.balls)
    count = len(start)
    contacts = one_a_ball(run.contacts)
    turns = np.flatnonzero(turns_in(contacts))
    # Contacts come in order of time; a stable sort by ball keeps that for each.
    order = turns[np.argsort(contacts["ball"][turns], kind="stable")]
    per_ball = np.bincount(contacts["ball"][turns], minlength=count).astype(np.int64) + 1
    whole = int(per_ball.sum())
    keep = per_ball if limit is None or whole <= limit else _fair(per_ball, limit)
    first = np.concatenate([[0], np.cumsum(per_ball - 1)])[:-1]
    offsets = np.concatenate([[0], np.cumsum(keep)]).astype(np.int64)
    step = np.arange(offsets[-1]) - np.repeat(offsets[:-1], keep)
    ball = np.repeat(np.arange(count), keep)
    contact = np.where(step > 0, _taken(order, first[ball] + step - 1), -1)
    following = np.where(step + 1 < per_ball[ball], _taken(order, first[ball] + step), -1)
    final, final_time = _ends(run)

    def column(names: tuple[str, ...], index: IntArray, otherwise: FloatArray) -> FloatArray:
        if not len(contacts):
            return otherwise
        found = np.stack([contacts[name][index] for name in names], axis=1)
        return np.where((index >= 0)[:, None], found, otherwise)

    position, velocity = column(("x", "y"), contact, start[ball]), column(("vx", "vy"), contact, velocity[ball])
    motion = _motion(run, contacts[contact] if len(contacts) else None, contact, np.hstack([position, velocity]))
    flights = Tracks(
        offsets=offsets,
        time=column(("time",), contact, np.zeros((len(ball), 1)))[:, 0],
        until=column(("time",), following, final_time[ball][:, None])[:, 0],
        position=position,
        target=column(("x", "y"), following, final[ball]),
        velocity=velocity,
        pull=_pulls(run, motion),
        drag=0.0 if falls(run.scene) else run.scene.drag or 0.0,
        contact=contact.astype(np.int64),
        contacts=contacts,
        radius=radius,
        whole=whole,
    )
    return _in_chords(flights, motion) if motion.bend.any() or motion.slowing.drag is not None else flights


def _in_chords(flights: Tracks, motion: Motion) -> Tracks:
    """Cut stretches on circles into short ones that a parabola each comes near.

    With drag all others are cut, too. One that goes to and fro for long is cut so for its first turns only, and stands
    at its end after that.
    """
    bent, drag = motion.bend, motion.slowing.drag
    rho = np.where(bent == 0.0, 1.0, np.abs(bent))
    span = flights.until - flights.time
    rate = np.maximum(np.hypot(*flights.velocity.T) / rho, np.sqrt(float(np.hypot(*motion.gravity)) / rho))
    straight = 1.0 if drag is None else np.ceil(span * drag / FINE)
    pieces = np.clip(np.where(bent == 0.0, straight, np.ceil(rate * span / CHORD)), 1, MOST_CHORDS).astype(np.int64)
    own = np.repeat(np.arange(len(span)), pieces)
    rank = np.arange(len(own)) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    step = np.minimum(span / pieces, np.where(bent == 0.0, np.inf, CHORD / rate))[own]
    time, until = flights.time[own] + rank * step, flights.time[own] + (rank + 1) * step
    position, velocity, target = flights.position[own], flights.velocity[own].copy(), flights.target[own].copy()
    pull, last = flights.pull[own].copy(), rank == pieces[own] - 1
    until[last] = flights.until[own[last]]

    cut = np.flatnonzero(((bent != 0.0) | (drag is not None))[own] & (span[own] > 0.0))
    first = np.asarray((rank * step)[cut], dtype=np.float64)
    begins, ends = motion.at(own[cut], first), motion.at(own[cut], first + step[cut])
    for index, begin, end in zip(cut.tolist(), begins, ends, strict=True):
        if last[index] and until[index] - time[index] > 2.0 * step[index]:
            begin, end = np.concatenate([target[index], (0.0, 0.0)]), np.concatenate([target[index], (0.0, 0.0)])
        position[index], velocity[index] = begin[0:2], begin[2:4]
        if not last[index]:
            target[index] = end[0:2]
        lasts = max(float(until[index] - time[index]), 1e-300)
        pull[index] = 2.0 * ((target[index] - position[index]) / lasts - velocity[index]) / lasts
    return replace(
        flights,
        offsets=np.concatenate([[0], np.cumsum(pieces)])[flights.offsets].astype(np.int64),
        time=time,
        until=until,
        position=position,
        target=target,
        velocity=velocity,
        pull=pull,
        contact=np.where(rank == 0, flights.contact[own], -1),
        whole=flights.whole + len(own) - len(span),
    )


def _motion(run: Run, begun: NDArray[Any] | None, contact: IntArray, state: FloatArray) -> Motion:
    """Give what balls do in each stretch; ``begun`` has the contacts that begin them, but for -1 in ``contact``."""
    motion = Motion.of(run.scene, state)
    if begun is not None:
        held = np.flatnonzero((contact >= 0) & (begun["kind"] == ContactKind.SLIDE))
        own = begun[held]
        motion.hold(held, np.stack([own["nx"], own["ny"]], axis=1), guides(run.scene.walls, own))
    return motion


def _pulls(run: Run, motion: Motion) -> FloatArray:
    if falls(run.scene) or run.scene.rolling_friction is None:
        return motion.pull
    velocity = motion.state[:, 2:4]
    speed = np.hypot(*velocity.T)[:, None]
    direction: FloatArray = np.divide(velocity, speed, out=np.zeros_like(velocity), where=speed > 0)
    return -run.scene.rolling_friction * direction


def _taken(order: IntArray, index: IntArray) -> IntArray:
    return order[np.clip(index, 0, len(order) - 1)] if len(order) else np.full(len(index), -1, dtype=np.int64)


def _fair(counts: IntArray, limit: int) -> IntArray:
    """Give each ball as many as it has up to one common number, so that the sum stays within the limit."""
    if len(counts) >= limit:
        return (np.arange(len(counts)) < limit).astype(np.int64)
    low, high = 1, int(counts.max())
    while low < high:
        middle = (low + high + 1) // 2
        low, high = (middle, high) if int(np.minimum(counts, middle).sum()) <= limit else (low, middle - 1)
    return np.minimum(counts, low)


def arrays_of(balls: Balls) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Give position (n, 2), velocity (n, 2) and radius (n,) of balls as arrays."""
    position = np.asarray(balls.position, dtype=np.float64).reshape(-1, 2)
    velocity = np.asarray(balls.velocity, dtype=np.float64).reshape(-1, 2)
    return position, velocity, np.broadcast_to(np.asarray(balls.radius, dtype=np.float64), len(position))


def _ends(run: Run) -> tuple[FloatArray, FloatArray]:
    """Give each ball's last place and time. A ball that left the scene is followed until it is well out of sight."""
    final = np.stack([run.final["x"], run.final["y"]], axis=1)
    time = run.final["time"].astype(np.float64)
    velocity = np.stack([run.final["vx"], run.final["vy"]], axis=1)
    x0, y0, x1, y1 = run.scene.walls.box()
    reach = 1.5 * float(np.hypot(x1 - x0, y1 - y0)) + float(np.abs(final).max(initial=0.0) > 0)
    touched, free = np.zeros(len(time)), Motion.of(run.scene, np.hstack([final, velocity]))
    contacts = one_a_ball(run.contacts)
    np.maximum.at(touched, contacts["ball"], contacts["time"])
    for ball, ending in enumerate(run.ending):
        speed = float(np.hypot(*velocity[ball]))
        if ending is Ending.LEFT_SCENE and speed > 0 and time[ball] == touched[ball]:
            span = reach / speed
            final[ball] = free.at(np.array([ball]), np.array([span]))[0, 0:2]
            time[ball] += span
    return final, time
