"""Flights of discs that meet: which of them passed one another, and how closely."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import shapely

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.simulation.near_misses import FlightTable, closest


@dataclass(slots=True, eq=False, repr=False)
class Flights:
    """Flights of one or many discs: who, between which contacts, from where, and what is promised on the way.

    Attributes:
        disc: (k,).
        row: (k,) of the contact at its end, or the number of all where there is none.
        since: (k,) row of the contact at its start, or below 0.
        begin: (k,) time.
        end: (k,) time.
        place: (k, 2) at ``begin``.
        velocity: (k, 2) at ``begin``.
        pull: (k, 2).
        wide: (k,) promised for the place at any time of it.
    """

    disc: IntArray
    row: IntArray
    since: IntArray
    begin: FloatArray
    end: FloatArray
    place: FloatArray
    velocity: FloatArray
    pull: FloatArray
    wide: FloatArray

    def __len__(self) -> int:
        return len(self.disc)

    def take(self, which: Any) -> Flights:
        """Give some of them."""
        return Flights(*(getattr(self, name)[which] for name in self.__slots__))

    def clipped(self, begin: float) -> Flights:
        """Give them from a time on, those that end before left out."""
        kept = self.take(self.end >= begin)
        t = np.maximum(begin - kept.begin, 0.0)[:, None]
        place = kept.place + kept.velocity * t + 0.5 * kept.pull * t * t
        return replace(
            kept, begin=kept.begin + t[:, 0], place=place, velocity=kept.velocity + kept.pull * t, since=kept.since
        )

    def ends(self) -> FloatArray:
        """(k, 2) places at their ends."""
        t = (self.end - self.begin)[:, None]
        place: FloatArray = self.place + self.velocity * t + 0.5 * self.pull * t * t
        return place


def joined(one: Flights, two: Flights) -> Flights:
    """Give the flights of both."""
    return Flights(*(np.concatenate([getattr(one, name), getattr(two, name)]) for name in one.__slots__))


def in_turns(one: IntArray, two: IntArray, count: int) -> list[IntArray]:
    """Split contacts into groups, in each of which no disc appears twice, and which keep the order of each disc."""
    last = [0] * count
    turns: list[list[int]] = []
    for row, (a, b) in enumerate(zip(one.tolist(), two.tolist(), strict=True)):
        turn = max(last[a], last[b]) if b >= 0 else last[a]
        last[a] = turn + 1
        if b >= 0:
            last[b] = turn + 1
        if turn == len(turns):
            turns.append([])
        turns[turn].append(row)
    return [np.array(turn, dtype=np.int64) for turn in turns]


def passing(flights: Flights, reach: FloatArray, last: int) -> tuple[IntArray, IntArray]:
    """Pairs of flights whose boxes overlap, at times that do; but for two that begin or end with a common contact.

    Two discs that part, or come to their contact, do so along a straight line: their distance is least at the contact.
    """
    ends, t = flights.ends(), flights.end - flights.begin
    sag = (np.hypot(*flights.pull.T) * t * t / 8.0 + reach)[:, None]
    low, high = np.minimum(flights.place, ends) - sag, np.maximum(flights.place, ends) + sag
    boxes = shapely.box(low[:, 0], low[:, 1], high[:, 0], high[:, 1])
    one, two = shapely.STRtree(boxes).query(boxes)
    both = (one < two) & (flights.disc[one] != flights.disc[two])
    both &= (flights.begin[one] <= flights.end[two]) & (flights.begin[two] <= flights.end[one])
    both &= ~((flights.since[one] == flights.since[two]) & (flights.since[one] >= 0))
    both &= (flights.row[one] != flights.since[two]) & (flights.since[one] != flights.row[two])
    both &= (flights.row[one] != flights.row[two]) | (flights.row[one] == last)
    return one[both], two[both]


def least_gap(
    flights: Flights, radius: FloatArray, one: IntArray, two: IntArray, begin: FloatArray, span: FloatArray
) -> FloatArray:
    """(k,) least distance between the rims of two discs while both fly."""
    places, velocities = [], []
    for side in (one, two):
        t = (begin - flights.begin[side])[:, None]
        places.append(flights.place[side] + flights.velocity[side] * t + 0.5 * flights.pull[side] * t * t)
        velocities.append(flights.velocity[side] + flights.pull[side] * t)
    apart, pull = places[0] - places[1], flights.pull[one] - flights.pull[two]
    table = FlightTable(apart, apart, velocities[0] - velocities[1], span, pull if pull.any() else None)
    _when, distance = closest(table, np.arange(len(one)), np.zeros((len(one), 2)))
    return distance - radius[one] - radius[two]
