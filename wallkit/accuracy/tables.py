"""The report's figures as rows of words, the same on a terminal and on a page."""

from __future__ import annotations

import math
from collections.abc import Sequence

from wallkit.accuracy.contest import BOUNCES, MEETINGS, Contest, Point
from wallkit.accuracy.costs import Cost
from wallkit.accuracy.departure import Departure

Row = tuple[str, ...]

POINT_HEAD: Row = ("series", "setting", "error", "s per s", "first wrong", "energy", "")
DEPARTURE_HEAD: Row = ("scene", "r", "promised", "in truth", "ratio")
COST_HEAD: Row = ("modelled", "a bounce", "more")


def title(contest: Contest) -> str:
    """Name a scene, its ball and its size."""
    return f"{contest.name}: {contest.story} (r = {contest.radius:g}, size {contest.size:.4g})"


def when(contests: Sequence[Contest]) -> str:
    """Say after what the error is taken: of one ball, of balls that meet, or of both."""
    one, met = f"{BOUNCES} bounces", f"{MEETINGS} contacts of balls"
    if not any(contest.balls > 1 for contest in contests):
        return one
    return met if all(contest.balls > 1 for contest in contests) else f"{one}, or {met}"


def point_row(point: Point) -> Row:
    """Give one contestant's figures, under :data:`POINT_HEAD`."""
    wrong = f"bounce {point.wrong}" if point.wrong is not None else f"none in {point.reached}"
    escaped = "left the room" if point.escaped else ""
    figures = (number(point.error), number(point.seconds), wrong, number(point.drift), escaped)
    return (point.series, point.setting, *figures)


def best(points: Sequence[Point]) -> Point:
    """Choose the point with the least error; of those within a factor 2 of it, the fastest."""
    known = [point for point in points if math.isfinite(point.error)] or list(points)
    least = min(point.error for point in known)
    close = [point for point in known if not point.error > 2 * least] or known
    return min(close, key=lambda point: point.seconds)


def departure_row(row: Departure) -> Row:
    """Give one promise beside the truth, under :data:`DEPARTURE_HEAD`."""
    everything = f"all {row.bounces}"
    promised = str(row.promised) if row.promised < row.bounces else everything
    real = str(row.real) if row.real is not None else everything
    return row.name, f"{row.radius:g}", promised, real, f"{row.ratio:.2f}" if row.ratio is not None else ""


def cost_row(row: Cost) -> Row:
    """Give one thing's cost, under :data:`COST_HEAD`."""
    return row.what, f"{row.nanoseconds:.0f} ns", f"{100 * row.more:+.0f} %" if row.more is not None else ""


def number(value: float) -> str:
    """Write a figure shortly; a dash for none."""
    return "-" if not math.isfinite(value) else f"{value:.2g}"
