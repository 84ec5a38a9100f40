"""How many edges curves cost per tolerance, as lines and as arcs, and the order of convergence.

    python benchmarks/arcs_per_tolerance.py [CURVES]

prints the table of docs/arcs.md. The order between two rows is log(ratio of tolerances) / log(ratio of edges):
2 for lines, 3 for arcs.
"""

from __future__ import annotations

import math
import sys
import time

import numpy as np

from importers.drawing import Subpath
from wallkit.walls.importing.arc_fitting.curves_to_arcs import fit_arcs
from wallkit.walls.importing.curves_to_lines import flatten
from wallkit.walls.importing.segments import Segments, gather

TOLERANCES = [10.0**-k for k in range(7)]
FEWEST_FOR_LINES = 1e-4  # below it lines take millions of edges


def cubics(count: int) -> Segments:
    """Random cubics in a square of 100: a third of them with loops, cusps nearly so, and inflections."""
    points = np.random.default_rng(1).uniform(0, 100, (count, 4, 2))
    return gather(Subpath([("M", *p[0].tolist()), ("C", *p[1:].ravel().tolist())], False) for p in points)


def ellipses(count: int) -> Segments:
    """Half ellipses of 100 by 10 to 90, turned at random."""
    rng = np.random.default_rng(2)
    subpaths = []
    for ry, turn in zip(rng.uniform(10, 90, count), rng.uniform(0, 180, count), strict=True):
        end = 100 * np.exp(1j * math.radians(turn))
        arc = ("A", 100.0, float(ry), float(turn), 0, 1, float(end.real), float(end.imag))
        subpaths.append(Subpath([("M", float(-end.real), float(-end.imag)), arc], False))
    return gather(subpaths)


def flower(count: int) -> tuple[Segments, float]:
    """The closed line r = 200 (1 + 0.15 cos 3a + 0.07 sin 5a) as Hermite cubics, and what the least of arcs needs.

    Returns:
        The line; the integral of (sqrt(3) / 216 |dk/ds|)^(1/3) ds, which divided by the cube root of a
        tolerance is the least number of arcs that join (docs/arcs.md).
    """
    a = 2 * np.pi * np.arange(count + 1) / count
    r = 200 * (1 + 0.15 * np.cos(3 * a) + 0.07 * np.sin(5 * a))
    first = 200 * (-0.45 * np.sin(3 * a) + 0.35 * np.cos(5 * a))
    second = 200 * (-1.35 * np.cos(3 * a) - 1.75 * np.sin(5 * a))
    turn = np.exp(1j * a)
    point, velocity = r * turn, (first + 1j * r) * turn
    point[-1] = point[0]
    bend = (velocity.conj() * (second + 2j * first - r) * turn).imag / np.abs(velocity) ** 3
    need = float((np.cbrt(math.sqrt(3) / 216 * np.abs(np.diff(bend))) * np.abs(np.diff(point)) ** (2 / 3)).sum())
    arm = velocity * (2 * np.pi / count / 3)
    corners = np.stack([point[:-1] + arm[:-1], point[1:] - arm[1:], point[1:]], axis=1)
    rows = np.stack([corners.real, corners.imag], axis=2).reshape(count, 6).tolist()
    begin = ("M", float(point[0].real), float(point[0].imag))
    return gather([Subpath([begin, *(("C", *row) for row in rows)], True)]), need


def order(few: float, many: float) -> str:
    return f"{math.log(10) / math.log(many / few):.2f}" if few and many > few else ""


def table(name: str, strokes: Segments, count: int) -> None:
    print(f"\n{name}\n")
    heads = [
        "tolerance",
        "lines a curve",
        "order",
        "arcs a curve",
        "order",
        "largest distance",
        "normals off by",
        "s per 10,000",
    ]
    print("| " + " | ".join(heads) + " |")
    print("|---" * len(heads) + "|")
    lines = arcs = 0.0
    for tolerance in TOLERANCES:
        begin = time.perf_counter()
        fitted = fit_arcs(strokes, tolerance)
        seconds = (time.perf_counter() - begin) / count * 10_000
        before, arcs = arcs, len(fitted.ends) / count
        cells = ["", ""]
        if tolerance >= FEWEST_FOR_LINES * 0.99:
            lines_before, lines = lines, len(flatten(strokes, tolerance).ends) / count
            cells = [f"{lines:.1f}", order(lines_before, lines)]
        print(
            f"| {tolerance:g} | {cells[0]} | {cells[1]} | {arcs:.1f} | {order(before, arcs)} | {fitted.error:.3g} "
            f"| {fitted.normal_error:.2g} | {seconds:.2f} |"
        )


def flower_table(count: int) -> None:
    strokes, need = flower(count)
    print(f"\nA smooth closed line of {count:,} cubics\n")
    print("| tolerance | arcs | order | least | largest distance |\n|---|---|---|---|---|")
    arcs = 0
    for tolerance in [0.15, 0.015, 0.0015, 0.00015, 0.000015, 0.0000015]:
        fitted = fit_arcs(strokes, tolerance)
        before, arcs = arcs, len(fitted.ends)
        least = need / math.cbrt(tolerance)
        print(f"| {tolerance:g} | {arcs} | {order(before, arcs)} | {least:.1f} | {fitted.error:.3g} |")


if __name__ == "__main__":
    curves = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    table("Random cubics", cubics(curves), curves)
    table("Half ellipses", ellipses(curves), curves)
    flower_table(3000)
