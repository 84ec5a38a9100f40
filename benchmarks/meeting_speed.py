"""Speed of discs that meet, and answers that take long, beside what is published.

    python benchmarks/meeting_speed.py            # speed by number of discs and packing
    python benchmarks/meeting_speed.py pi         # Galperin: contacts of masses 100^d : 1, d up to 7
    python benchmarks/meeting_speed.py room       # a room of 10,000 edges beside a box
    python benchmarks/meeting_speed.py soak [gas.npz [1e9 [SEED]]]   # overlap, energy, momentum; in portions
    python benchmarks/meeting_speed.py peer       # beside billiards 0.5 (pip install billiards)

Times are those of the processor, of one thread, without compiling.
"""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

import wallkit
from wallkit.kernels.jit import compiled
from wallkit.kernels.meeting.meet import meet
from wallkit.scene.start_overlaps import close_pairs
from wallkit.simulation.meeting import Meeting
from wallkit.simulation.simulate import START


def filled(count: int, packing: float, seed: int = 0) -> tuple[wallkit.Balls, float]:
    """Discs of radius 1/2 on a disturbed lattice in a square box: (discs, side of the box)."""
    random = np.random.default_rng(seed)
    side = math.sqrt(count * math.pi / 4.0 / packing)
    columns = math.ceil(math.sqrt(count))
    step = side / columns
    place = np.stack(np.meshgrid(np.arange(columns), np.arange(columns)), axis=-1).reshape(-1, 2)[:count]
    free = max(0.0, step / 2.0 - 0.5)
    position = (place + 0.5) * step + random.uniform(-0.99, 0.99, (count, 2)) * free
    velocity = random.normal(size=(count, 2))
    return wallkit.Balls(position, velocity - velocity.mean(axis=0), 0.5), side


def box(side: float, notches: int = 0) -> wallkit.Walls:
    """A square box, each of whose sides is cut into edges that bow out by a little."""
    corners = np.array([(0.0, 0.0), (0.0, side), (side, side), (side, 0.0)])
    if not notches:
        return wallkit.Walls.from_polylines([corners])
    ring: list[Any] = []
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        along = np.linspace(0.0, 1.0, notches + 1)[:-1, None]
        out = np.array([-(b - a)[1], (b - a)[0]]) / side
        ring += list(a + along * (b - a) + 0.02 * (np.arange(notches) % 2)[:, None] * out)
    return wallkit.Walls.from_polylines([ring])


def go(meeting: Meeting, contacts: int, until: float = math.inf) -> float:
    """Make so many contacts: the seconds of the processor."""
    model = meeting.modelled.model
    begun = time.process_time()
    compiled(meet)(model, None, meeting._discs, until, 2**31, meeting.hits, np.empty(0), contacts, 2**62)
    return time.process_time() - begun


def pairs_a_second(scene: wallkit.Scene, contacts: int) -> tuple[float, Meeting]:
    """Contacts of two discs a second, the best of five rounds after the first disorder."""
    meeting = Meeting(scene, START, mode="compiled")
    go(meeting, 10 * len(scene.balls))
    meeting._bring_into_order()
    best = 0.0
    for _ in range(5):
        before = meeting.hits.sum()
        seconds = go(meeting, contacts)
        best = max(best, (contacts - int(meeting.hits.sum() - before)) / seconds)
    return best, meeting


def speed(counts: tuple[int, ...] = (100, 1_000, 10_000, 100_000, 1_000_000)) -> None:
    for packing in (0.1, 0.3, 0.6):
        for count in counts:
            balls, side = filled(count, packing)
            best, meeting = pairs_a_second(wallkit.Scene(box(side), balls, meeting=True), max(200_000, count))
            discs = meeting._discs
            parts = (*(part for part in discs if part is not discs.link), *discs.queue)  # link is ball, seen otherwise
            size = sum(part.nbytes for part in parts if isinstance(part, np.ndarray)) / count
            words = f"{best / 1e6:.2f} M pairs a second, {size:.0f} bytes a disc"
            print(f"N {count:>9,}, packing {packing}: {words}", flush=True)


def pi() -> None:
    wall = wallkit.Walls.from_polylines([[(0, -5), (0, 5)]], closed=False)
    for digits in range(8):
        balls = wallkit.Balls([(2, 0), (4, 0)], [(0, 0), (-1, 0)], 0.5, mass=[1.0, 100.0**digits])
        meeting = Meeting(wallkit.Scene(wall, balls, meeting=True), START, mode="compiled")
        seconds = go(meeting, 10**9)
        met = int(meeting.bounces.sum() - meeting.hits.sum()) // 2 + int(meeting.hits.sum())
        known = int(math.pi * 10**digits)
        print(f"masses 100^{digits} : 1: {met:,} contacts in {seconds:.1f} s, floor(pi 10^{digits}) = {known:,}")


def soak(file: str = "", contacts: str = "1e9", seed: str = "0") -> None:
    """Fly 10,000 discs on and on: deepest overlap, drift of the energy, and of the momentum less what walls gave.

    Args:
        file: goes on from there, bit by bit, if it is there already; left there after every ten million contacts.
        contacts: to be made in all, those of earlier portions counted.
        seed: of the discs; another one goes with another file.
    """
    count, piece = 10_000, 10_000_000
    balls, side = filled(count, 0.3, int(seed))
    meeting = Meeting(wallkit.Scene(box(side), balls, meeting=True), START, mode="compiled")
    energy, (made, deepest, slip) = float((balls.velocity**2).sum()), _taken_up(meeting, file)
    while made < float(contacts):
        go(meeting, piece)
        before = meeting.states(meeting.next_time)[0]
        log = next(meeting.go(math.inf, 2**31, most=100_000))
        made += piece + len(log)
        states = meeting.states(meeting.next_time)[0]
        walls = log[log[:, 12] < 0.0]
        pushed = (2.0 * (walls[:, 3:5] * walls[:, 7:9]).sum(axis=1)[:, None] * walls[:, 7:9]).sum(axis=0)
        slip = max(slip, float(np.abs(states[:, 2:4].sum(axis=0) - before[:, 2:4].sum(axis=0) - pushed).max()))
        one, two = close_pairs(states[:, 0:2], 0.5)
        gap = np.hypot(*(states[one, 0:2] - states[two, 0:2]).T) - 1.0
        deepest = max(deepest, float(-gap.min()))
        drift = float((states[:, 2:4] ** 2).sum()) / energy - 1.0
        print(
            f"{made:,.0f} contacts: deepest overlap {deepest:.1e} diameters, energy {drift:.1e}, momentum {slip:.1e} "
            f"(of {count:,} discs, in 100,000 contacts)",
            flush=True,
        )
        if file:
            told = np.array([made, deepest, slip])
            np.savez(f"{file}.part.npz", told, meeting.numbers, meeting.hits, *_arrays(meeting._discs))
            Path(f"{file}.part.npz").replace(file)  # whole, or the one before


def _taken_up(meeting: Meeting, file: str) -> tuple[float, float, float]:
    """Take up a soak from its file: contacts made, deepest overlap, slip of the momentum so far."""
    if not file or not Path(file).exists():
        return 0.0, 0.0, 0.0
    kept = list(np.load(file).values())
    meeting.numbers, meeting.hits[:] = kept[1], kept[2]
    for own, value in zip(_arrays(meeting._discs), kept[3:], strict=True):
        own[...] = value
    made, deepest, slip = kept[0].tolist()
    return made, deepest, slip


def _arrays(value: Any) -> Iterator[Any]:
    """All arrays in tuples of tuples."""
    if isinstance(value, np.ndarray):
        yield value
    elif isinstance(value, tuple):
        for part in value:
            yield from _arrays(part)


def peer() -> None:
    """``billiards`` 0.5 beside this, 100 discs in a box: contacts of two discs a second."""
    import billiards

    balls, side = filled(100, 0.3)
    table = billiards.Billiard([billiards.obstacles.InfiniteWall(a, b) for a, b in _sides(side)])
    for place, velocity in zip(balls.position, balls.velocity, strict=True):
        table.add_ball(place, velocity, 0.5)
    begun = time.process_time()
    found = table.evolve(20.0)
    theirs = sum(isinstance(other, int) for _time, _ball, other in found) / (time.process_time() - begun)
    ours, _ = pairs_a_second(wallkit.Scene(box(side), balls, meeting=True), 500_000)
    words = f"billiards {billiards.__version__}: {theirs:,.0f} pairs a second; wallkit {ours:,.0f}"
    print(f"{words}: {ours / theirs:,.0f} times as many")


def _sides(side: float) -> list[Any]:
    corners = [(0.0, 0.0), (side, 0.0), (side, side), (0.0, side)]
    return list(zip(corners, corners[1:] + corners[:1], strict=True))


def room() -> None:
    balls, side = filled(10_000, 0.3)
    plain, _ = pairs_a_second(wallkit.Scene(box(side), balls, meeting=True), 500_000)
    drawn, _ = pairs_a_second(wallkit.Scene(box(side, 2_500), balls, meeting=True), 500_000)
    words = f"room of 10,000 edges {drawn / 1e6:.2f} M pairs a second: {plain / drawn:.2f} times slower"
    print(f"box {plain / 1e6:.2f}, {words}")


if __name__ == "__main__":
    if sys.argv[1:2] == ["soak"]:
        soak(*sys.argv[2:])
        sys.exit()
    {"pi": pi, "room": room, "peer": peer}.get("".join(sys.argv[1:2]), speed)()
