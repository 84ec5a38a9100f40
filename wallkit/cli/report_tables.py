"""The report's tables as text: one line a series, one a promise, one a cost, one a known answer."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from wallkit.accuracy import tables

if TYPE_CHECKING:
    from wallkit.accuracy.cases import Case, Verdict
    from wallkit.accuracy.contest import Contest
    from wallkit.accuracy.report import Report


def lines(report: Report) -> list[str]:
    """Write the whole report for a terminal."""
    after = tables.when(report.contests)
    found = [f"Speed against error after {after}: of each series the setting with the least (--json: all)"]
    for contest in report.contests:
        found += ["", *_contest_lines(contest)]
    if report.departures:
        rows = map(tables.departure_row, report.departures)
        found += ["", "How far a run holds: bounces good to 1e-6, as promised and in truth"]
        found += table(tables.DEPARTURE_HEAD, rows, right=(1, 2, 3, 4))
    if report.costs:
        found += ["", "What each modelled thing costs"]
        found += table(tables.COST_HEAD, map(tables.cost_row, report.costs), right=(1, 2))
    return [*found, "", report.foot()]


def table(head: Sequence[str], rows: Iterable[Sequence[str]], right: Sequence[int]) -> list[str]:
    """Set rows in columns; those named in ``right`` are set to the right."""
    everything = [list(head), *map(list, rows)]
    widths = [max(len(row[column]) for row in everything) for column in range(len(head))]
    set_rows = []
    for row in everything:
        cells = [
            cell.rjust(width) if column in right else cell.ljust(width)
            for column, (cell, width) in enumerate(zip(row, widths, strict=True))
        ]
        set_rows.append(("  " + "  ".join(cells)).rstrip())
    return set_rows


def _contest_lines(contest: Contest) -> list[str]:
    rows = [tables.point_row(tables.best(points)) for points in contest.series().values()]
    return [tables.title(contest), *table(tables.POINT_HEAD, rows, right=(2, 3, 5))]


def case_line(case: Case, outcome: Verdict, seconds: float) -> str:
    """Write one known answer: expected, got, error, time."""
    verdict = "ok  " if outcome.holds else "FAIL"
    error = "exact" if outcome.error == 0 else f"error {outcome.error:.2g} of {outcome.tolerance:.2g}"
    return f"{verdict} {case.name:<38} expected {outcome.expected}; got {outcome.got}; {error}; {seconds:.2f} s"


def case_row(case: Case, outcome: Verdict, seconds: float) -> dict[str, Any]:
    """Give one known answer as plain data."""
    return {
        "name": case.name,
        "group": case.group,
        "story": case.story,
        "expected": outcome.expected,
        "got": outcome.got,
        "error": float(outcome.error) if math.isfinite(outcome.error) else None,
        "tolerance": float(outcome.tolerance),
        "why": outcome.why,
        "holds": outcome.holds,
        "seconds": seconds,
    }
