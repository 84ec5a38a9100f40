"""How far a run of balls that meet can be trusted: small errors of all of them are carried along together.

What one ball is off becomes what others are off, so errors of different balls are not independent. ``SAMPLES``
histories of roundings, drawn once and for all, are carried along to first order; their mean square is that of the
error, and ``SURE_TOGETHER`` times its root is promised. Between contacts and at walls an error (dx, dv) goes the way
that ``horizon`` states. At a contact of two discs with D = s n from the second centre to the first, their relative
velocity W, and the changes P U and -Q U of their velocities (P, Q the parts of the mass of the other one),

    U  = -(1 + e) (W.n) n - (1 - f) (W - (W.n) n)
    dt = -(dD.n) / (W.n),                          by which the neighbour touches later
    dn = (dD + W dt) / s,                          across n, for n.(dD + W dt) = 0
    dU = -(e + f) ((dW.n) n + (W.dn) n + (W.n) dn) - (1 - f) dW  (of hops: ``meeting_hops``)
    dx' = dx + (v - v') dt,    dv' = dv + g dt + P dU - g' dt      (-Q dU for the second)

Between two discs of the radius r an error grows by some 2 L / s at each contact, L the free path: chaos.

Where the first order ends, trust ends: where a disc passed another one, a corner or a wall by less than both may be
off, or grazed what it met by less. Nobody knows then whom it met, so what it may be off grows from there by twice the
largest speed; trust in others ends where that reaches them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.scene.scene import Scene
from wallkit.scene.start_overlaps import clearances
from wallkit.simulation.contact_errors import RMS_ROUNDING, drawing_errors
from wallkit.simulation.damping import damping_of
from wallkit.simulation.horizon import (
    VERTEX,
    ErrorSource,
    Horizon,
    bends,
    grazing_depths,
    trusted_until,
)
from wallkit.simulation.meeting_flights import Flights, in_turns, joined, least_gap, passing
from wallkit.simulation.meeting_hops import hop_speed, turned_errors
from wallkit.simulation.near_misses import NEAR_CORNER, FlightTable, near_misses
from wallkit.simulation.run import ContactKind, Ending, Run
from wallkit.simulation.shared_clock import SharedClock

SAMPLES = 64
SURE_TOGETHER = 6.0
"""Promised is this many times the root mean square: at a contact an error grows by about that, so it costs one."""
AT_ONCE = 64
"""Contacts at least that are looked at together."""


def trusted_together(run: Run, tolerance: float, source: ErrorSource) -> list[Horizon]:
    """Say for each ball up to where its contacts are good; see :meth:`wallkit.Run.trusted_until`."""
    discs = np.flatnonzero(run.scene.balls.radius > 0.0)
    found = _Trust(_on_a_free_clock(run), discs, tolerance, source).found()
    if run.scene.drag:
        clock = SharedClock(run.scene.drag)
        found = [replace(said, time=float(clock.time(np.array(said.time)))) for said in found]
    said = dict(zip(discs.tolist(), found, strict=True))
    alone = replace(run.scene, meeting=False)
    for point in np.flatnonzero(run.scene.balls.radius == 0.0).tolist():
        said[point] = trusted_until(alone, run.contacts_of(point), point, tolerance, source, run.final[point])
    return [said[ball] for ball in range(len(run.final))]


def _on_a_free_clock(run: Run) -> Run:
    """Give a run as it would be if drag slowed nothing down: the errors of places are the same."""
    if damping_of(run.scene) is None:
        return run
    clock = SharedClock(float(run.scene.drag or 0.0))
    contacts, final = run.contacts.copy(), run.final.copy()
    for table, names in ((contacts, ("vx", "vy", "other_vx", "other_vy")), (final, ("vx", "vy"))):
        table["time"] = np.minimum(-np.expm1(-clock.drag * table["time"]) / clock.drag, clock.whole)
        for name in names:
            table[name] /= clock.kept(table["time"])
    return replace(run, scene=replace(run.scene, drag=None), contacts=contacts, final=final)


@dataclass(slots=True, eq=False, repr=False)
class _Cloud:
    """The discs after their last contacts, and ``SAMPLES`` errors of each.

    Attributes:
        place: (n, 2) centres, in the scene's coordinates.
        velocity: (n, 2).
        pull: (n, 2) acceleration.
        time: (n,) of the last contact.
        contact: (n,) its row, or -1 - n for the start.
        off: (n, SAMPLES, 2) errors of the places.
        drift: (n, SAMPLES, 2) errors of the velocities.
        wide: (n,) promised for the place just after the contact.
    """

    place: FloatArray
    velocity: FloatArray
    pull: FloatArray
    time: FloatArray
    contact: IntArray
    off: FloatArray
    drift: FloatArray
    wide: FloatArray


@dataclass(eq=False, repr=False)
class _Trust:
    """What is known so far: per disc from which contact, and from which time on, nothing is promised, and why."""

    run: Run
    discs: IntArray
    tolerance: float
    source: ErrorSource
    bad: IntArray = field(init=False)
    why: list[str] = field(init=False)
    doubt: FloatArray = field(init=False)

    def __post_init__(self) -> None:
        scene, count = self.run.scene, len(self.discs)
        self.scene: Scene = scene
        rows = self.run.contacts
        number = np.full(len(self.run.final), -1, dtype=np.int64)
        number[self.discs] = np.arange(count)
        # Sensors change no flight, and points meet no disc.
        crossings = (rows["kind"] == ContactKind.ENTER) | (rows["kind"] == ContactKind.EXIT)
        self.rows: Any = rows[~crossings & (number[rows["ball"]] >= 0)]
        self.one = number[self.rows["ball"]]
        self.two = np.where(self.rows["other"] >= 0, number[self.rows["other"]], -1)
        self.radius, self.mass = scene.balls.radius[self.discs], scene.balls.mass[self.discs]
        self.bad = np.full(count, len(self.rows) + 1, dtype=np.int64)
        self.why, self.doubt = [""] * count, np.full(count, np.inf)
        self.random = np.random.default_rng(53)
        gravity = self.gravity = np.asarray(scene.gravity or (0.0, 0.0), dtype=np.float64)
        self.hop = hop_speed(scene, self.radius)
        zero, start = np.zeros((count, SAMPLES, 2)), self.run.start[self.discs]
        self.cloud = _Cloud(
            start[:, 0:2].copy(), start[:, 2:4].copy(), np.tile(gravity, (count, 1)), np.zeros(count),
            -1 - np.arange(count), zero, zero.copy(), np.zeros(count),
        )  # fmt: skip
        ended = np.array([ending in (Ending.COLLAPSE, Ending.AMBIGUOUS_CORNER) for ending in self.run.ending])
        final = self.run.final["time"]
        self.doubt[ended[self.discs]] = final[self.discs][ended[self.discs]]
        gone = np.array([ending == Ending.ABSORBED for ending in self.run.ending])
        self.gone = np.where(gone, final, np.inf)[self.discs]
        self.end = float(final[self.discs].max(initial=0.0))
        self._prepare_walls()

    def _prepare_walls(self) -> None:
        """What is asked of contacts with walls: curvature, restitution, new errors, depth of a graze."""
        from wallkit.simulation.modelled import local_origin

        walls, rows = self.scene.walls, self.rows
        self.origin = local_origin(walls.vertices, walls.box()) if len(walls) else np.zeros(2)
        self.bend, self.depth = np.zeros(len(rows)), np.full(len(rows), np.inf)
        self.keep, self.fresh = np.ones((len(rows), 2)), np.zeros((len(rows), 2))
        table = np.array([(m.tangential_restitution, m.restitution) for m in walls.materials]).reshape(-1, 2)
        at_wall = self.two < 0
        for ball in np.unique(rows["ball"][at_wall]).tolist():
            own = np.flatnonzero(at_wall & (rows["ball"] == ball))
            self.bend[own] = bends(self.scene, rows[own], ball)
            self.depth[own] = grazing_depths(self.scene, rows[own], ball)
            self.keep[own] = table[rows["wall"][own]]
        if self.source == "drawing":
            self.fresh[at_wall] = drawing_errors(self.scene, rows[at_wall])[:, 0:2]

    def found(self) -> list[Horizon]:
        """Go through the contacts, some at a time, until nothing is promised for any disc, and tell."""
        self._note_corners()
        step, begin = max(AT_ONCE, len(self.discs)), 0.0
        for first in range(0, max(len(self.rows), 1), step):
            last = min(first + step, len(self.rows))
            end = float(self.rows["time"][last]) if last < len(self.rows) else self.end
            self._go(first, last, begin, end)
            begin = end
            if (self.bad < first + step).all():
                break
        return [self._horizon(k) for k in range(len(self.discs))]

    def _horizon(self, k: int) -> Horizon:
        own = np.flatnonzero((self.one == k) | (self.two == k))
        good = own[own < self.bad[k]]
        kinds = self.rows["kind"][good]
        bounces = int(np.count_nonzero((kinds <= VERTEX) | (kinds == ContactKind.BALL)))
        whole = bool(self.bad[k] > len(self.rows))
        last = float(self.rows["time"][good[-1]]) if len(good) else 0.0
        time = float(self.run.final["time"][self.discs[k]]) if whole else last
        return Horizon(self.tolerance, bounces, time, whole, self.source, self.why[k])

    def _go(self, first: int, last: int, begin: float, end: float) -> None:
        """Carry errors through some contacts, then look what was passed closely up to a time."""
        closed = self._carried(first, last)
        flights = joined(closed, self._open(end))
        self._near_walls(closed if last < len(self.rows) else flights)
        pieces = flights.clipped(begin)
        while self._near_discs(pieces) or self._pass_on(first, last):
            pass

    def _note_corners(self) -> None:
        """A disc that ended in a corner, and is met where it stands, is in doubt from there."""
        for k in np.flatnonzero(self.doubt < math.inf).tolist():
            later = np.flatnonzero((self.rows["time"] > self.doubt[k]) & ((self.one == k) | (self.two == k)))
            self.bad[k], self.why[k] = (int(later[0]) if len(later) else len(self.rows)), "corner"

    def _lose(self, disc: int, row: int, time: float, why: str) -> bool:
        """Promise nothing for a disc from a contact, and from a time, on; tell whether that is new."""
        if row >= self.bad[disc] and time >= self.doubt[disc]:
            return False
        if row < self.bad[disc]:
            self.bad[disc], self.why[disc] = row, why
        self.doubt[disc] = min(self.doubt[disc], time)
        return True

    def _carried(self, first: int, last: int) -> Flights:
        """Carry errors through contacts: those that know nothing of one another at once. The flights that end there."""
        flights = []
        for group in in_turns(self.one[first:last], self.two[first:last], len(self.discs)):
            rows = first + group
            at_wall, met = rows[self.two[rows] < 0], rows[self.two[rows] >= 0]
            if len(at_wall):
                flights.append(self._at_walls(at_wall))
            if len(met):
                flights += self._meetings(met)
        if not flights:
            return self._open(0.0).take(slice(0, 0))
        return Flights(*(np.concatenate([getattr(f, name) for f in flights]) for name in Flights.__slots__))

    def _arrive(self, disc: IntArray, rows: IntArray) -> tuple[Flights, FloatArray, FloatArray, FloatArray]:
        """Take errors to the end of flights: (flights, velocity, errors of places, of velocities).

        p + v t + g t^2 / 2 is summed up of parts as large as the places, the way, and the fall: each is rounded.
        """
        cloud, t = self.cloud, self.rows["time"][rows] - self.cloud.time[disc]
        off = cloud.off[disc] + cloud.drift[disc] * t[:, None, None]
        velocity = cloud.velocity[disc] + cloud.pull[disc] * t[:, None]
        where = np.stack([self.rows[name][rows] for name in ("x", "y")], axis=1)
        if self.source == "rounding":
            reach = np.hypot(*(cloud.place[disc] - self.origin).T) + np.hypot(*(where - self.origin).T)
            reach += np.hypot(*cloud.velocity[disc].T) * t + np.hypot(*cloud.pull[disc].T) * t * t
            off = off + RMS_ROUNDING * reach[:, None, None] * self.random.normal(size=off.shape)
        wide = np.maximum(cloud.wide[disc], _promised(off))
        flights = Flights(
            disc, rows, cloud.contact[disc], cloud.time[disc], cloud.time[disc] + t, cloud.place[disc],
            cloud.velocity[disc], cloud.pull[disc], wide,
        )  # fmt: skip
        return flights, velocity, off, cloud.drift[disc]

    def _leave(
        self, disc: IntArray, rows: IntArray, place: FloatArray, velocity: FloatArray, pull: FloatArray,
        off: FloatArray, drift: FloatArray,
    ) -> None:  # fmt: skip
        """Note states and errors after contacts; a velocity is rounded too."""
        cloud = self.cloud
        if self.source == "rounding":
            drift = drift + RMS_ROUNDING * np.hypot(*velocity.T)[:, None, None] * self.random.normal(size=drift.shape)
        cloud.place[disc], cloud.velocity[disc], cloud.pull[disc] = place, velocity, pull
        cloud.time[disc], cloud.contact[disc] = self.rows["time"][rows], rows
        cloud.off[disc], cloud.drift[disc], cloud.wide[disc] = off, drift, _promised(off)

    def _at_walls(self, rows: IntArray) -> Flights:
        disc, seen = self.one[rows], self.rows[rows]
        flights, before, off, drift = self._arrive(disc, rows)
        place, after, n = (np.stack([seen[u], seen[v]], axis=1) for u, v in (("x", "y"), ("vx", "vy"), ("nx", "ny")))
        slides, leaves = seen["kind"] == ContactKind.SLIDE, seen["kind"] == ContactKind.LEAVE
        along = np.stack([-n[:, 1], n[:, 0]], axis=1)
        pull = np.where(slides[:, None], along * _dot(along, self.gravity[None])[:, None], self.gravity)
        across = _dot(before, n)
        bounces = ~slides & ~leaves
        with np.errstate(all="ignore"):
            new_off, new_drift, spot = self._bounced(rows, before, after, n, across, flights.pull, pull, off, drift)
        # Where a wall begins to hold a disc no neighbour touches earlier or later: what is along the wall stays.
        kept = np.where(slides[:, None, None], _dot(off, along[:, None])[..., None] * along[:, None], off)
        held = np.where(slides[:, None, None], _dot(drift, along[:, None])[..., None] * along[:, None], drift)
        shared = (bounces & (across < 0.0))[:, None, None]
        new_off = np.where(shared, new_off, np.where(bounces[:, None, None], np.inf, kept))
        new_drift = np.where(shared, new_drift, np.where(bounces[:, None, None], np.inf, held))
        self._leave(disc, rows, place, after, pull, new_off, new_drift)
        worst = np.where(bounces & (across < 0.0), _promised(spot), np.where(bounces, np.inf, _promised(kept)))
        for k, row, bad, graze in zip(
            disc.tolist(), rows.tolist(), ~(worst <= self.tolerance), self.depth[rows] <= flights.wide, strict=True
        ):
            if bad or graze:
                self._lose(k, row, float(self.rows["time"][row]) if graze else math.inf, "growth" if bad else "graze")
        return flights

    def _bounced(
        self, rows: IntArray, v: FloatArray, after: FloatArray, n: FloatArray, across: FloatArray, g: FloatArray,
        h: FloatArray, off: FloatArray, drift: FloatArray,
    ) -> tuple[FloatArray, FloatArray, FloatArray]:  # fmt: skip
        """Errors after bounces off walls, and those of the places where they touch; see ``horizon``."""
        f, e = self.keep[rows].T[:, :, None, None]
        shift, turn = self.fresh[rows, 0], self.fresh[rows, 1]
        if self.source == "rounding":
            turn = np.full(len(rows), RMS_ROUNDING)
        noise = self.random.normal(size=(*off.shape[:2], 2))
        n_, v_, speed = n[:, None], v[:, None], across[:, None]
        dt = (-_dot(off, n_) + shift[:, None] * noise[..., 0]) / speed
        spot = off + v_ * dt[..., None]
        w = drift + g[:, None] * dt[..., None]
        tangent = np.stack([-n[:, 1], n[:, 0]], axis=1)[:, None]
        dn = self.bend[rows][:, None, None] * spot + turn[:, None, None] * noise[..., 1:] * tangent
        turned = turned_errors((e, f), self.hop, speed, _dot(w, n_) + _dot(v_, dn), n_, (w, dn))
        new_drift = turned - h[:, None] * dt[..., None]
        return off + (v - after)[:, None] * dt[..., None], new_drift, spot

    def _meetings(self, rows: IntArray) -> list[Flights]:
        """Carry errors through contacts of two discs."""
        seen, ids = self.rows[rows], (self.one[rows], self.two[rows])
        places = [np.stack([seen[f"{o}x"], seen[f"{o}y"]], axis=1) for o in ("", "other_")]
        after = [np.stack([seen[f"{o}vx"], seen[f"{o}vy"]], axis=1) for o in ("", "other_")]
        (fa, va, xa, wa), (fb, vb, xb, wb) = (self._arrive(k, rows) for k in ids)
        with np.errstate(all="ignore"):
            d = places[0] - places[1]
            s = np.hypot(*d.T)
            n, w = (d / s[:, None])[:, None], (va - vb)[:, None]
            closing = _dot(w, n)
            dt = -_dot(xa - xb, n) / closing
            g = (fa.pull - fb.pull)[:, None]
            dw = wa - wb + g * dt[..., None]
            dn = (xa - xb + w * dt[..., None]) / s[:, None, None]
            kept = np.array([self.scene.ball_restitution, self.scene.ball_tangential_restitution])
            du = turned_errors((kept[:1], kept[1:]), self.hop, closing, _dot(dw, n) + _dot(w, dn), n, (dw, dn)) - dw
            whole = self.mass[ids[0]] + self.mass[ids[1]]
            parts = (self.mass[ids[1]] / whole, -self.mass[ids[0]] / whole)
            worst, grazing = np.zeros(len(rows)), s * _missing(closing[:, 0], np.hypot(*w[:, 0].T))
            for k, flights, v, u, off, drift, part, place in (
                (ids[0], fa, va, after[0], xa, wa, parts[0], places[0]),
                (ids[1], fb, vb, after[1], xb, wb, parts[1], places[1]),
            ):
                change = (flights.pull - self.gravity)[:, None] * dt[..., None]
                new_off = off + (v - u)[:, None] * dt[..., None]
                pull = np.tile(self.gravity, (len(rows), 1))
                self._leave(k, rows, place, u, pull, new_off, drift + change + part[:, None, None] * du)
                worst = np.maximum(worst, _promised(off + v[:, None] * dt[..., None]))
        near_wall = self._beside_walls((ids, places), (fa.wide, fb.wide)) if len(self.scene.walls) else None
        graze = ~(grazing > fa.wide + fb.wide)
        for m, (row, bad, grazes) in enumerate(zip(rows.tolist(), ~(worst <= self.tolerance), graze, strict=True)):
            beside = near_wall is not None and bool(near_wall[m])
            if bad or grazes or beside:
                time = float(self.rows["time"][row]) if grazes or beside else math.inf
                for k in (int(ids[0][m]), int(ids[1][m])):
                    self._lose(k, row, time, "growth" if bad else "graze" if grazes else "meeting")
        return [fa, fb]

    def _beside_walls(self, met: Any, wide: Any) -> NDArray[np.bool_]:
        """Tell where one of two discs that meet is so near to a wall that the wall might have come first."""
        found = np.zeros(len(wide[0]), dtype=np.bool_)
        for disc, place, error in zip(met[0], met[1], wide, strict=True):
            reach = self.radius[disc] + np.minimum(error, self.radius[disc])
            gap, _edge = clearances(self.scene.walls, place, reach)
            found |= gap <= reach
        return found

    def _open(self, end: float) -> Flights:
        """Flights of all discs from their last contacts to a time, or to where they are absorbed."""
        cloud, disc = self.cloud, np.arange(len(self.discs))
        until = np.maximum(np.minimum(end, self.gone), cloud.time)
        t = (until - cloud.time)[:, None, None]
        wide = np.maximum(cloud.wide, _promised(cloud.off + cloud.drift * t))
        everything = Flights(
            disc, self._next_rows(), cloud.contact.copy(), cloud.time.copy(), until, cloud.place.copy(),
            cloud.velocity.copy(), cloud.pull.copy(), wide,
        )  # fmt: skip
        return everything.take(self.gone > cloud.time)

    def _next_rows(self) -> IntArray:
        """(n,) row of the next contact of each disc, after its last one here; the number of all where there is none."""
        first = int(self.cloud.contact.max(initial=-1)) + 1
        rows = np.full(len(self.discs) + 1, len(self.rows), dtype=np.int64)
        later = np.arange(len(self.rows) - 1, first - 1, -1)
        rows[self.one[later]] = later
        two = later[self.two[later] >= 0]
        rows[self.two[two]] = np.minimum(rows[self.two[two]], two)
        found: IntArray = rows[:-1]
        return found

    def _near_walls(self, flights: Flights) -> None:
        """Find discs that passed a corner or the back of an arc by less than they may be off."""
        if not len(self.scene.walls):
            return
        still = flights.take((flights.row < self.bad[flights.disc]) & np.isfinite(flights.wide))
        for radius in np.unique(self.radius):
            own = still.take(self.radius[still.disc] == radius)
            if not len(own):
                continue
            pull = own.pull if own.pull.any() else None
            table = FlightTable(own.place, own.ends(), own.velocity, own.end - own.begin, pull)
            for which, clear, decides in near_misses(self.scene, table, float(radius), float(own.wide.max())):
                for k in which[clear <= own.wide[which]].tolist():
                    why = "corner" if decides == NEAR_CORNER else "graze"
                    self._lose(int(own.disc[k]), int(own.row[k]), float(own.begin[k]), why)

    def _near_discs(self, flights: Flights) -> bool:
        """Find discs that passed one another by less than both may be off; tell whether any is new.

        A disc in doubt for the time t may be off by twice the largest speed times t.
        """
        late = np.maximum(flights.end - self.doubt[flights.disc], 0.0)
        fastest = float(np.hypot(*self.cloud.velocity.T).max(initial=0.0)) + math.hypot(*self.gravity) * float(
            np.ptp(flights.end) if len(flights) else 0.0
        )
        size = float(np.ptp(flights.place, axis=0).max(initial=0.0)) + 1.0
        wide = flights.wide + np.where(late > 0.0, 2.0 * fastest * late, 0.0)
        wide = np.minimum(np.where(np.isfinite(wide), wide, np.inf), 2.0 * size)
        one, two = passing(flights, self.radius[flights.disc] + wide, len(self.rows))
        begin = np.maximum(flights.begin[one], flights.begin[two])
        span = np.minimum(flights.end[one], flights.end[two]) - begin
        clear = least_gap(flights, self.radius[flights.disc], one, two, begin, span)
        new = False
        near = clear <= wide[one] + wide[two]
        for a, b, time in zip(one[near].tolist(), two[near].tolist(), begin[near].tolist(), strict=True):
            for k in (a, b):
                new |= self._lose(int(flights.disc[k]), int(flights.row[k]), time, "meeting")
        return new

    def _pass_on(self, first: int, last: int) -> bool:
        """What is in doubt puts what it meets in doubt; tell whether that is new."""
        new = False
        for row in range(first, last):
            a, b = int(self.one[row]), int(self.two[row])
            if b < 0:
                continue
            for k, other in ((a, b), (b, a)):
                if self.bad[k] < row and self.bad[other] > row and self.doubt[k] < math.inf:
                    new |= self._lose(other, row, float(self.rows["time"][row]), "meeting")
        return new


def _promised(errors: FloatArray) -> FloatArray:
    """(k,) what is promised of (k, SAMPLES, 2) errors."""
    with np.errstate(all="ignore"):
        mean = np.sqrt((errors**2).sum(axis=(1, 2)) / errors.shape[1])
    promised: FloatArray = SURE_TOGETHER * np.where(np.isfinite(mean), mean, np.inf)
    return promised


def _missing(across: FloatArray, speed: FloatArray) -> FloatArray:
    """1 - sin of the angle at which two things meet: the part of s by which a neighbour may be off before it misses."""
    square = np.minimum((across / np.where(speed > 0.0, speed, 1.0)) ** 2, 1.0)
    missing: FloatArray = square / (1.0 + np.sqrt(1.0 - square))
    return missing


def _dot(a: FloatArray, b: FloatArray) -> FloatArray:
    dot: FloatArray = (a * b).sum(axis=-1)
    return dot
