"""Print the table of docs/walls.md: edges per curve and tolerance, as lines and as arcs, with the measured order.

python benchmarks/walls_table.py
"""

from __future__ import annotations

import math
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from importers.drawing import Subpath
from wallkit.walls.arcs import fit_arcs
from wallkit.walls.flatten import flatten
from wallkit.walls.strokes import Strokes, gather

TOLERANCES = [1.0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6]
CURVES = 300


def cubics() -> Strokes:
    """Random cubics in a square of side 100, near-cusps and loops among them (seed 1)."""
    points = np.random.default_rng(1).uniform(0, 100, (CURVES, 4, 2))
    return gather(Subpath([("M", *p[0].tolist()), ("C", *p[1:].ravel().tolist())], False) for p in points)


def ellipses() -> Strokes:
    """Whole ellipses of half axes 50 and 5 to 45."""
    rings = []
    for short in np.linspace(5, 45, 20).tolist():
        rings.append(
            [("M", 50.0, 0.0), ("A", 50.0, short, 0, 0, 1, -50.0, 0.0), ("A", 50.0, short, 0, 0, 1, 50.0, 0.0)]
        )
    return gather(Subpath(list(ring), True) for ring in rings)


def rows(strokes: Strokes, curves: int) -> list[tuple[float, float | None, float, float, float]]:
    """Tolerance; edges a curve as lines (None above the vertex limit) and as arcs; errors of the arcs."""
    found = []
    for tolerance in TOLERANCES:
        arcs = fit_arcs(strokes, tolerance)
        lines = float(flatten(strokes, tolerance).counts.sum()) / curves if tolerance >= 1e-5 else None
        found.append((tolerance, lines, arcs.counts.sum() / curves, arcs.error / tolerance, arcs.normal_error or 0.0))
    return found


def main() -> None:
    """Print both tables."""
    for name, strokes, curves in (("random cubic", cubics(), CURVES), ("ellipse", ellipses(), 20)):
        print(f"\n| tolerance | lines a {name} | order | arcs a {name} | order | error / tolerance | normals, rad |")
        print("|---|---|---|---|---|---|---|")
        before: tuple[float | None, float] | None = None
        for tolerance, lines, arcs, error, normals in rows(strokes, curves):
            orders = ["", ""]
            if before is not None:
                orders = [order(before[0], lines), order(before[1], arcs)]
            told = "-" if lines is None else f"{lines:.1f}"
            print(f"| {tolerance:g} | {told} | {orders[0]} | {arcs:.1f} | {orders[1]} | {error:.3f} | {normals:.2g} |")
            before = (lines, arcs)


def order(few: float | None, many: float | None) -> str:
    """The order of convergence between two tolerances ten apart: log 10 / log of the ratio of edges."""
    return "" if few is None or many is None or many <= few else f"{math.log(10) / math.log(many / few):.2f}"


if __name__ == "__main__":
    main()
