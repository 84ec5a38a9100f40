"""Pressure of discs that meet, by two ways, beside published equations of state.

    python benchmarks/meeting_pressure.py 0.6 --seconds 60
    python benchmarks/meeting_pressure.py 0.7 --start hexagonal --seconds 250 --keep gas.npz   # goes on from gas.npz

Discs of the diameter 1 and the mass 1 in a square box with hard walls; two pressures P* = P d^2 / kT are told:

- *inside*: the virial of the contacts in the middle of the box, P = n kT + sum of d |dp| / (2 A t);
- *walls*: what the middle half of each wall is given, a second and length.

In equilibrium both are the same, and that of the density in the middle: walls draw discs to them, so that the packing
of the middle, not that of the box, is compared. Each figure has the standard error of the mean of its blocks of time.
"""

from __future__ import annotations

import argparse
import math
import time
from pathlib import Path
from typing import NamedTuple

import numpy as np
from meeting_speed import box, filled

import wallkit
from wallkit.geometry.arrays import FloatArray
from wallkit.simulation.meeting import Meeting
from wallkit.simulation.simulate import START

VIRIAL = (1.0, 1.0, 0.78200442, 0.53223180, 0.33355604, 0.1988425, 0.1148728, 0.0649930, 0.0362193, 0.0199537)
"""B_k / B_2^(k-1) of hard discs, k = 1 to 10 (N. Clisby, B. M. McCoy 2006, J. Stat. Phys. 122:15); with the packing y,
Z = sum of B_k / B_2^(k-1) (2 y)^(k-1)."""


class Block(NamedTuple):
    """What a block of time tells: packing of the middle, its kT, its pressure over kT, that on the walls."""

    packing: float
    heat: float
    inside: float
    walls: float


def hexagonal(count: int, packing: float, seed: int = 0) -> tuple[wallkit.Balls, float]:
    """Discs of radius 1/2 on a disturbed triangular lattice in a square box: (discs, side of the box)."""
    random = np.random.default_rng(seed)
    side = math.sqrt(count * math.pi / 4.0 / packing)
    # Rows of c discs, sqrt(3) / 2 steps apart: the step is the widest at which all fit.
    columns = next(c for c in range(1, count + 1) if c * _rows(c, side) >= count)
    step, rows = (side - 1.0) / (columns - 0.5), _rows(columns, side)
    place = np.stack(np.meshgrid(np.arange(columns), np.arange(rows)), axis=-1).reshape(-1, 2)
    place = place[np.sort(random.permutation(len(place))[:count])]  # what is too much is vacancies
    position = np.stack([(place[:, 0] + place[:, 1] % 2 / 2.0) * step, place[:, 1] * (side - 1.0) / (rows - 1)], axis=1)
    velocity = random.normal(size=(count, 2))
    free = 0.49 * (min(step, math.hypot(step / 2.0, (side - 1.0) / (rows - 1))) - 1.0)
    position = np.clip(position + 0.5 + random.uniform(-free, free, (count, 2)) / 1.5, 0.5, side - 0.5)
    return wallkit.Balls(position, velocity - velocity.mean(axis=0), 0.5), side


def _rows(columns: int, side: float) -> int:
    """Rows of a triangular lattice with so many discs in a row."""
    return int((side - 1.0) / ((side - 1.0) / (columns - 0.5) * math.sqrt(0.75))) + 1


def liu(packing: float) -> float:
    """Z of the stable fluid, (1 + y^2 / 8 + y^3 / 18 - 4 y^4 / 21) / (1 - y)^2, H. Liu 2020, arXiv:2010.10624."""
    y = packing
    return (1.0 + y**2 / 8.0 + y**3 / 18.0 - 4.0 * y**4 / 21.0) / (1.0 - y) ** 2


def luding(packing: float) -> float:
    """Z = 1 + 2 y g of hard discs, fitted to simulations within some 0.1 % up to the packing y = 0.67.

    g = (1 - 7 y / 16) / (1 - y)^2 - (y / 2)^3 / (16 (1 - y)^4), S. Luding 2001, Phys. Rev. E 63:042201.
    """
    y = packing
    g = (1.0 - 7.0 * y / 16.0) / (1.0 - y) ** 2 - y**3 / 128.0 / (1.0 - y) ** 4
    return 1.0 + 2.0 * y * g


COEXISTING = 9.185
"""P* where liquid and hexatic coexist, at a packing of 0.700 to 0.716 (E. P. Bernard, W. Krauth 2011, Phys. Rev. Lett.
107:155704; M. Engel et al. 2013, Phys. Rev. E 87:042134)."""


def block(meeting: Meeting, side: float, middle: float, pieces: int, each: int) -> Block:
    """Fly a block of time; the middle is a square of half the side ``middle``."""
    centre = side / 2.0 - meeting.modelled.origin
    begun, pushed, given, inside, heat = meeting.next_time, 0.0, 0.0, [], []
    for _ in range(pieces):
        log = next(meeting.go(math.inf, 2**62, most=each))
        met, at_walls = log[log[:, 12] >= 0.0], log[log[:, 12] < 0.0]
        n, w = met[:, 1:3] - met[:, 13:15], met[:, 3:5] - met[:, 15:17]
        within = np.abs((met[:, 1:3] + met[:, 13:15]) / 2.0 - centre).max(axis=1) < middle
        pushed += float((np.abs((n * w).sum(axis=1)) / np.hypot(*n.T))[within].sum())
        along = np.abs(((at_walls[:, 5:7] - centre) * at_walls[:, [8, 7]]).sum(axis=1)) < side / 4.0
        given += float(2.0 * np.abs((at_walls[:, 3:5] * at_walls[:, 7:9]).sum(axis=1))[along].sum())
        states, _codes = meeting.states(meeting.next_time)
        here = states[np.abs(states[:, 0:2] - centre).max(axis=1) < middle]
        inside.append(len(here))
        heat.append(float(((here[:, 2:4] - here[:, 2:4].mean(axis=0)) ** 2).sum() / 2.0 / (len(here) - 1)))
    span, area, kt = meeting.next_time - begun, (2.0 * middle) ** 2, float(np.mean(heat))
    density = float(np.mean(inside)) / area
    # 4 walls, the middle half of each: 2 sides of length altogether.
    return Block(
        density * math.pi / 4.0, kt, density + pushed / (2.0 * area * span) / kt, given / (2.0 * side * span) / kt
    )


def mean(values: FloatArray) -> str:
    """A mean with its standard error."""
    return f"{values.mean():.4f} +- {values.std(ddof=1) / math.sqrt(len(values)):.4f}" if len(values) > 1 else "-"


def main() -> None:
    parser = argparse.ArgumentParser(description="Pressure of discs that meet.")
    parser.add_argument("packing", type=float, nargs="+")
    parser.add_argument("--count", type=int, default=10_000)
    parser.add_argument("--start", choices=("square", "hexagonal"), default="square")
    parser.add_argument("--inner", type=float, default=10.0, help="what is nearer to a wall, in diameters, is left out")
    parser.add_argument("--settle", type=float, default=0.3, help="part of the seconds before anything is measured")
    parser.add_argument("--seconds", type=float, default=20.0, help="of the processor, for each packing")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--keep", type=Path, help="go on from this file where it is there, and leave the end in it")
    asked = parser.parse_args()
    for packing in asked.packing:
        one(packing, asked)


def one(packing: float, asked: argparse.Namespace) -> None:
    """Settle and measure one packing, and tell it."""
    balls, side = (filled if asked.start == "square" else hexagonal)(asked.count, packing, asked.seed)
    if asked.keep and asked.keep.exists():
        kept = np.load(asked.keep)
        balls = wallkit.Balls(kept["position"], kept["velocity"], 0.5)
    meeting = Meeting(wallkit.Scene(box(side), balls, meeting=True), START, mode="compiled")
    begun, blocks, contacts = time.process_time(), [], 0
    while time.process_time() - begun < asked.seconds:
        found = block(meeting, side, side / 2.0 - asked.inner, 10, 2 * asked.count)
        contacts += 20
        if time.process_time() - begun > asked.settle * asked.seconds:
            blocks.append(found)
    table = np.array(blocks).reshape(-1, 4)
    y = float(table[:, 0].mean())
    said = ", ".join(f"{name} {mean(column)}" for name, column in zip(Block._fields, table.T, strict=True))
    series = sum(b * (2.0 * y) ** k for k, b in enumerate(VIRIAL))
    z = table[:, 2].mean() * math.pi / 4.0 / y
    known = f"Z {z:.4f}; Liu {liu(y):.4f}, Luding {luding(y):.4f}, virial series {series:.4f}"
    if y > 0.69:
        known += f", coexistence {COEXISTING * math.pi / 4.0 / y:.4f}"
    print(f"packing {packing} from {asked.start}, {contacts} contacts a disc: {said}; {known}", flush=True)
    if asked.keep:
        states, _codes = meeting.states(meeting.next_time)
        np.savez(asked.keep, position=states[:, 0:2] + meeting.modelled.origin, velocity=states[:, 2:4])


if __name__ == "__main__":
    main()
