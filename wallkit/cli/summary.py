"""What a run comes to, in words: one line each, for people."""

from __future__ import annotations

import math
from collections import Counter
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from wallkit.simulation.run import Run
    from wallkit.walls import Walls


def counted(number: int, word: str) -> str:
    """Give ``1 wall``, ``2 walls``."""
    return f"{number:,} {word}{'' if number == 1 else 's'}"


def wall_words(walls: Walls) -> str:
    """Say how many walls and edges there are, and how large the whole is."""
    open_ones = int(np.count_nonzero(~walls.closed))
    arcs = int(np.count_nonzero(walls.bulges))
    x0, y0, x1, y1 = walls.box()
    parts = [counted(len(walls), "wall") + (f" ({open_ones} open)" if open_ones else "")]
    parts.append(counted(len(walls.edge_starts), "edge") + (f" ({counted(arcs, 'arc')})" if arcs else ""))
    parts.append(f"{x1 - x0:.6g} x {y1 - y0:.6g} {walls.units}".rstrip())
    return ", ".join(parts)


def ball_words(run: Run) -> str:
    """Say how many balls there are, how large and how fast at the start."""
    radius = np.broadcast_to(np.asarray(run.scene.balls.radius, dtype=np.float64), len(run.ending))
    speed = np.hypot(*np.asarray(run.scene.balls.velocity, dtype=np.float64).reshape(-1, 2).T)
    if not len(radius):
        return "none"
    return f"{len(radius):,}, radius {_range(radius)}, speed {_range(speed)}"


def _range(values: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> str:
    low, high = f"{values.min():.6g}", f"{values.max():.6g}"
    return low if low == high else f"{low} to {high}"


def bounce_words(run: Run) -> str:
    """Say how many bounces there were, in what time, and how many of them at corners."""
    from wallkit.simulation.run import ContactKind

    kinds = run.contacts["kind"]
    corners, met = int(np.count_nonzero(kinds == ContactKind.VERTEX)), int(np.count_nonzero(kinds == ContactKind.BALL))
    crossings = int(np.count_nonzero((kinds == ContactKind.ENTER) | (kinds == ContactKind.EXIT)))
    last = float(run.final["time"].max(initial=0.0))
    words = f"{int(run.bounces.sum()):,} in {last:.6g} s" + (f", {corners:,} of them at corners" if corners else "")
    words += f"; balls met {counted(met, 'time')}" if run.scene.meeting else ""
    return words + (f"; {counted(crossings, 'crossing')} of sensors" if crossings else "")


def ending_words(run: Run) -> str:
    """Say how the balls ended, the most frequent ending first."""
    counts = Counter(ending.label for ending in run.ending)
    if len(run.ending) == 1:
        return next(iter(counts))
    return ", ".join(f"{word} {count:,}" for word, count in counts.most_common()) or "no balls"


def energy_words(run: Run) -> str:
    """Say what became of the energy of all balls together, per mass; where balls meet, each weighs its mass.

    Under gravity it is kinetic and potential energy, the potential one above the lowest place that each ball can reach,
    see :func:`wallkit.simulation.energy.energies`.
    """
    from wallkit.simulation.energy import energies, mass_parts

    before, change = (float(each @ mass_parts(run)) for each in energies(run))
    gravity = np.array(run.scene.gravity or (0.0, 0.0))
    if before <= 0:
        return "none, the balls do not move" if change == 0 else f"{change:+.6g} per mass"
    part = change / before
    measured = " (kinetic and potential)" if gravity.any() else ""
    if abs(part) < 1e-9:
        return f"kept{measured}, to {abs(part):.1e}"
    return f"{1 + part:.2%} left{measured}" if part < 0 else f"gained {part:.2%}{measured}"


def drawing_words(run: Run) -> list[str]:
    """Say from which bounce on the walls' own distance from the drawn curves shows; nothing where there is none."""
    walls = run.scene.walls
    if walls.measured_error == 0 or not len(run.contacts):
        return []
    x0, y0, x1, y1 = walls.box()
    seen = float(f"{0.01 * math.hypot(x1 - x0, y1 - y0):.0e}")
    units = walls.units or "units"
    worst = min(run.trusted_until(seen, "drawing"), key=lambda horizon: (horizon.whole, horizon.bounces))
    when = "it never shows" if worst.whole else f"it may show (by {seen:g} {units}) after bounce {worst.bounces}"
    return [f"edges are within {walls.measured_error:.2g} {units} of the drawn curves; {when} (--tolerance)"]
