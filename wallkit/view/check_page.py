"""A check of a level as one page: what the balls found out, with pictures of where they were and what traps them."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

import numpy as np

from wallkit.levels.check_counts import Fate
from wallkit.levels.check_level import LevelCheck
from wallkit.levels.findings import Trap
from wallkit.levels.reachable import edge_points
from wallkit.view.canvas import Bitmap, Canvas, Command, Disc, Shape
from wallkit.view.frame import Frame, walls_box
from wallkit.view.outline import wall_path
from wallkit.view.picture import WIDTH, draw_walls, finish, started
from wallkit.view.report_page import css, table
from wallkit.view.run_picture import run_canvas
from wallkit.view.theme import RAMP_STEPS
from wallkit.walls import Walls

TRAPS = 3
"""Kinds of traps that are shown with a path."""


def check_html(check: LevelCheck, rows: Sequence[tuple[str, str]], title: str = "") -> str:
    """Write the page; it loads nothing and follows the reader's light or dark setting.

    Args:
        check: what is told.
        rows: it in words: (a word, the rest).
        title: of the level.
    """
    parts = [
        f"<h1>{escape(title or 'The level')}: {check.balls:,} balls</h1>",
        table(("", "what the balls found out"), rows),
        _findings(check),
        f"<h2>Where balls were</h2><p>{escape(_places_words(check))}</p>",
        f"<figure>{places_canvas(check).to_svg()}</figure>",
        *_trapped(check),
    ]
    body = "\n".join(parts)
    return (
        '<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width,initial-scale=1">'
        f"<title>{escape(title)}: checked with {check.balls:,} balls</title>"
        f"<style>{css()}td{{white-space:normal}}</style></head>\n<body><main>\n{body}\n<footer>{escape(_foot(check))}</footer>\n</main></body></html>\n"
    )


def places_canvas(check: LevelCheck, width: float = WIDTH) -> Canvas:
    """Draw how many balls were in each square, edges that none hit, the target, and where balls rest."""
    walls, squares = check.scene.walls, check.squares
    canvas, frame = started(walls_box(walls), walls.y_axis == "up", title="", width=width)
    canvas.title = f"where {min(check.balls, 1000)} balls were"
    visits = check.counts.visits
    steps = np.where(visits > 0, np.ceil(np.sqrt(visits / max(int(visits.max()), 1)) * (RAMP_STEPS - 1)), -1).astype(
        np.int64
    )
    up = walls.y_axis == "up"
    x, y = frame.point(squares.x0, squares.y0 + (squares.rows * squares.side if up else 0.0))
    draw_walls(canvas, walls, frame, normals=False, free=check.draw(0, 1).position)
    canvas.items.insert(0, Bitmap(x, y, squares.side * frame.scale, (steps[::-1] if up else steps).tolist(), 0.9))
    for edge in check.never[~check.certain].tolist():
        canvas.add(Shape("way", _edge(walls, edge, frame), title=f"edge {edge}: no ball hit it"))
    _draw_goal(canvas, check, frame)
    for rest_x, rest_y, balls in check.resting()[:20]:
        px, py = frame.point(rest_x, rest_y)
        canvas.add(Disc("warning", px, py, 7.0, title=f"{balls:,} balls rest here"))
    finish(canvas, frame, walls.units)
    return canvas


def _draw_goal(canvas: Canvas, check: LevelCheck, frame: Frame) -> None:
    goal = check.goal
    if goal is None:
        return
    paths = [_edge(check.scene.walls, edge, frame) for edge in goal.edges]
    if goal.sensors is not None:
        paths += [wall_path(goal.sensors, index, frame) for index in range(len(goal.sensors))]
    for path in paths:
        canvas.add(Shape("hidden", path, title=f"target {goal.words}"))


def _edge(walls: Walls, edge: int, frame: Frame) -> list[Command]:
    points = edge_points(walls, int(walls.edge_starts[edge]), int(walls.edge_ends[edge]))
    return [("L" if index else "M", *frame.point(x, y)) for index, (x, y) in enumerate(points.tolist())]


def _places_words(check: LevelCheck) -> str:
    free, visited, by = check.coverage()
    return (
        f"The brighter, the more of the first {by:,} balls were there; {visited:,} of {free:,} free squares were "
        "visited. Red and dashed is what no ball hit and geometry does not rule out, grey and dashed the target; discs "
        "mark where balls came to rest."
    )


def _findings(check: LevelCheck) -> str:
    found = check.problems()
    if not found:
        return "<p>No findings.</p>"
    rows = [(problem.severity, problem.code, problem.message, problem.fix) for problem in found]
    return f"<h2>Findings</h2>{table(('', 'code', 'what', 'what to do'), rows)}"


def _trapped(check: LevelCheck) -> list[str]:
    traps = check.traps() if check.goal is not None else []
    if not traps:
        return []
    head = ("balls", "how", "last of the first one", "growth a bounce", "period")
    rows = [_trap_row(trap) for trap in traps[:20]]
    parts = [
        f"<h2>What traps balls</h2><p>Of the first {len(check.counts.traps):,} that are trapped.</p>",
        table(head, rows),
    ]
    for trap in traps[:TRAPS]:
        if trap.fate is not Fate.AT_REST or check.counts.bounces:
            run = check.example(trap.ball)
            parts.append(f"<figure>{run_canvas(run, title=f'ball {trap.ball}: {trap.fate.label}').to_svg()}</figure>")
    return parts


def _trap_row(trap: Trap) -> tuple[str, ...]:
    norm = "" if np.isinf(trap.norm) else f"{trap.norm:.3g}"
    return f"{trap.balls:,}", trap.fate.label, f"({trap.x:.6g}, {trap.y:.6g})", norm, str(trap.period or "")


def _foot(check: LevelCheck) -> str:
    from wallkit.version import __version__

    limits = [] if check.until is None else [f"{check.until:g} s"]
    limits += [] if check.bounce_limit is None else [f"{check.bounce_limit:,} bounces"]
    walls = check.scene.walls
    return (
        f"wallkit {__version__} · limits: {', '.join(limits)} · balls: {_drawn(check)} · digest "
        f"{check.counts.digest()[:16]} · file {walls.source_sha256[:16] or 'of numbers'}"
    )


def _drawn(check: LevelCheck) -> str:
    words = [
        f"{name} {getattr(check.draw, name):g}" for name in ("speed", "radius", "seed") if hasattr(check.draw, name)
    ]
    return ", ".join(words) or "as drawn"
