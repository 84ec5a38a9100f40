"""The report as one self-contained page: the diagram, every figure behind it, machine and versions in the foot."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

from wallkit.accuracy import tables
from wallkit.accuracy.contest import Contest
from wallkit.accuracy.report import Report
from wallkit.view.theme import Theme, colour
from wallkit.view.work_precision import work_precision_svg


def report_html(report: Report) -> str:
    """Write the page; it loads nothing and follows the reader's light or dark setting."""
    parts = [
        f"<figure>{work_precision_svg(report.contests)}</figure>",
        f"<h2>Every figure</h2><p>Error: units of the scene, after {tables.when(report.contests)}. s per s: processor "
        "seconds for a second of flight. First wrong: the bounce after which a ball is somewhere else, by 1 % of the "
        "scene.</p>",
        *(_contest(found, shown=len(report.contests) == 1) for found in report.contests),
    ]
    if report.departures:
        parts.append(_horizon(report))
    if report.costs:
        parts.append(_costs(report))
    body = "\n".join(parts)
    return (
        '<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width,initial-scale=1">'
        f"<title>wallkit: speed against error</title><style>{css()}</style></head>\n<body><main>\n{body}\n"
        f"<footer>{escape(report.foot())}</footer>\n</main></body></html>\n"
    )


def _contest(found: Contest, *, shown: bool) -> str:
    rows = [tables.point_row(point) for points in found.series().values() for point in points]
    opened = " open" if shown else ""
    figures = table(tables.POINT_HEAD, rows)
    return f"<details{opened}><summary>{escape(tables.title(found))}</summary>{figures}</details>"


def _horizon(report: Report) -> str:
    text = "Bounces good to 1e-6: as the run itself promises, and as a run with as many digits as it takes shows."
    rows = [tables.departure_row(row) for row in report.departures]
    return f"<h2>How far a run holds</h2><p>{text}</p>{table(tables.DEPARTURE_HEAD, rows)}"


def _costs(report: Report) -> str:
    rows = [tables.cost_row(row) for row in report.costs]
    return f"<h2>What each modelled thing costs</h2>{table(tables.COST_HEAD, rows)}"


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Write a table."""
    top = "".join(f"<th>{escape(word)}</th>" for word in head)
    body = "".join("<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in row) + "</tr>" for row in rows)
    return f'<div class="wide"><table><thead><tr>{top}</tr></thead><tbody>{body}</tbody></table></div>'


def css() -> str:
    """Give the style of a page of figures and tables."""
    rest = (
        "body{margin:0;background:var(--paper);color:var(--ink);font:15px/1.5 system-ui,sans-serif}"
        "main{max-width:1180px;margin:0 auto;padding:12px}figure{margin:0;overflow-x:auto}h2{margin:28px 12px 8px}"
        "p,details,.wide{margin:6px 12px}summary{cursor:pointer;padding:4px 0}.wide{overflow-x:auto}"
        "table{border-collapse:collapse;font-variant-numeric:tabular-nums}"
        "th,td{text-align:left;padding:3px 14px 3px 0;border-bottom:1px solid var(--line);white-space:nowrap}"
        "th{font-weight:600}footer{margin:28px 12px;color:var(--muted);font-size:13px}"
    )
    return f":root{{{_colours('light')}}}@media(prefers-color-scheme:dark){{:root{{{_colours('dark')}}}}}{rest}"


def _colours(theme: Theme) -> str:
    names = {"paper": "paper", "ink": "ink", "muted": "muted", "line": "hidden"}
    return "".join(f"--{name}:{colour(source, theme)};" for name, source in names.items())
