"""What a check of a level comes to: traps, resting places, findings with codes, JSON."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from importers.problems import Problem
from wallkit.levels.check_counts import LISTED, TRAPS, Fate

if TYPE_CHECKING:
    from wallkit.levels.check_level import LevelCheck, Quantile, Share

SHOWN_TRAPS = 20
"""Kinds of traps that are told one by one."""


@dataclass(frozen=True, slots=True)
class Trap:
    """Trapped balls of one kind: those at rest near one another, or those that met the same set of edges last.

    Attributes:
        fate: at rest, regular or repeats.
        balls: how many, of those listed.
        ball: number of the first, whose path can be shown.
        x: where that one was last, with y.
        y: see x.
        norm: of its tangent map, a bounce; inf where it is not known.
        period: edges of the word that it repeats, or 0.
    """

    fate: Fate
    balls: int
    ball: int
    x: float
    y: float
    norm: float
    period: int


def traps(check: LevelCheck) -> list[Trap]:
    """Group the traps that are listed, the most frequent kind first."""
    listed = check.counts.traps
    groups: dict[tuple[int, int], list[int]] = {}
    where = check.squares.at(np.stack([listed["x"], listed["y"]], axis=1)) if len(listed) else np.empty(0, np.int64)
    for row, (fate, word, square) in enumerate(
        zip(listed["fate"].tolist(), listed["word"].tolist(), where.tolist(), strict=True)
    ):
        groups.setdefault((fate, square if fate == Fate.AT_REST else word), []).append(row)
    found = []
    for rows in sorted(groups.values(), key=lambda rows: (-len(rows), rows[0])):
        ball, fate, x, y, norm, period, _word = listed[rows[0]].tolist()
        found.append(Trap(Fate(fate), len(rows), ball, x, y, norm, period))
    return found


def resting(check: LevelCheck) -> list[tuple[float, float, int]]:
    """Unite squares in which balls came to rest and that touch: (x, y, balls), the most first."""
    from scipy.ndimage import label

    rests, squares = check.counts.rests, check.squares
    regions, many = label(rests > 0, structure=np.ones((3, 3), dtype=np.int64))
    listed = check.counts.traps[check.counts.traps["fate"] == Fate.AT_REST]
    where = squares.at(np.stack([listed["x"], listed["y"]], axis=1)) if len(listed) else np.empty(0, np.int64)
    seen: dict[int, tuple[float, float]] = {}
    for square, x, y in zip(where.tolist(), listed["x"].tolist(), listed["y"].tolist(), strict=True):
        seen.setdefault(int(regions.flat[square]), (x, y))
    places = []
    for region in range(1, many + 1):
        row, column = (
            int(part[0]) for part in np.nonzero((regions == region) & (rests == rests[regions == region].max()))
        )
        middle = (squares.x0 + (column + 0.5) * squares.side, squares.y0 + (row + 0.5) * squares.side)
        places.append((*seen.get(region, middle), int(rests[regions == region].sum())))
    return sorted(places, key=lambda place: -place[2])


def problems(check: LevelCheck) -> list[Problem]:
    """Tell what is doubtful, the severe first."""
    return [*_about_balls(check), *_about_target(check), *_about_edges(check)]


def _about_balls(check: LevelCheck) -> list[Problem]:
    found, left, undecided = [], check.share(Fate.LEFT), check.share(Fate.UNDECIDED)
    if left.count:
        message = f"{share_words(left)} left the scene"
        found.append(
            Problem("balls-leave", "warning", message, "close the walls: wallkit check without --balls tells leaks")
        )
    if undecided.count:
        message = f"{share_words(undecided)} met a corner whose outcome depends on which wall comes first"
        found.append(Problem("undecided-corner", "info", message, "nothing to do; round the corner, or move the start"))
    return found


def _about_target(check: LevelCheck) -> list[Problem]:
    reached = check.reached
    if reached is None or check.goal is None:
        return []
    found = []
    if not reached.count:
        message = (
            f"none of {check.balls:,} balls reached {check.goal.words!r}: a ball's chance is below {check.chance:.4g}"
        )
        found.append(Problem("target-missed", "warning", message, "open a way, or give more --bounces"))
    trapped = sum(int(check.counts.fates[fate]) for fate in TRAPS)
    if trapped:
        kinds = ", ".join(
            f"{int(check.counts.fates[fate]):,} {fate.label}" for fate in TRAPS if check.counts.fates[fate]
        )
        from wallkit.levels.check_level import Share

        message = f"{share_words(Share.of(trapped, check.balls))} are trapped before {check.goal.words!r}: {kinds}"
        first = check.traps()[0]
        fix = "see the report (-o report.html); change the walls that they meet, or where balls start"
        found.append(Problem("trap", "warning", message, fix, x=first.x, y=first.y))
    slow = check.share(Fate.SLOW)
    if slow.count:
        message = f"{share_words(slow)} are slow: not at {check.goal.words!r} at the limit, and not trapped"
        found.append(Problem("slow-balls", "info", message, "give more --bounces, or --until"))
    return found


def _about_edges(check: LevelCheck) -> list[Problem]:
    never, certain = check.never, check.certain
    found = []
    edges = never[certain].tolist()
    if edges:
        message = f"no ball can hit {edge_words(check, edges)}: they lie outside of where balls can be"
        found.append(Problem("edges-out-of-reach", "info", message, "nothing to do for the outside of a wall"))
    edges = never[~certain].tolist()
    if edges:
        message = f"no ball hit {edge_words(check, edges)}: a ball's chance is below {check.chance:.4g}"
        found.append(Problem("edges-never-hit", "info", message, "give more --balls, or leave those walls out"))
    return found


def edge_words(check: LevelCheck, edges: list[int]) -> str:
    """Name edges by their walls: whole walls first."""
    walls = check.scene.walls
    offsets, mine = walls.edge_offsets, set(edges)
    whole, parts = [], []
    for index in sorted({int(np.searchsorted(offsets, edge, side="right")) - 1 for edge in edges}):
        own = range(int(offsets[index]), int(offsets[index + 1]))
        name = f" {walls.names[index]!r}" if walls.names[index] else ""
        missed = sum(edge in mine for edge in own)
        if missed == len(own):
            whole.append(f"wall {index}{name}")
        else:
            parts.append(f"{missed} of the {len(own)} edges of wall {index}{name}")
    told = [*whole, *parts]
    return ", ".join(told[:6]) + (f" and {len(told) - 6} more" if len(told) > 6 else "")


def fate_word(check: LevelCheck, fate: Fate) -> str:
    """Say what became of balls; where nothing was to be reached, those at the limit are not slow but fly on."""
    return "fly on" if fate is Fate.SLOW and check.goal is None else fate.label


def share_words(share: Share) -> str:
    """Say a share of balls with its bounds."""
    return f"{share.count:,} of {share.balls:,} balls ({share.value:.4g}, 95 %: {share.low:.4g} to {share.high:.4g})"


def quantile_words(quantiles: list[Quantile], unit: str) -> str:
    """Say quantiles with their bounds."""
    return "; ".join(f"{100 * one.part:g} % in {_span(one.low, one.high)} {unit}" for one in quantiles)


def _span(low: float, high: float) -> str:
    if math.isinf(high):
        return f"{low:.4g} or more"
    return f"{low:.4g} to {high:.4g}"


def to_json(check: LevelCheck) -> dict[str, Any]:
    """Give a check as JSON."""
    free, visited, by = check.coverage()
    never = [{"edge": int(edge), "certain": bool(sure)} for edge, sure in zip(check.never, check.certain, strict=True)]
    return {
        "balls": check.balls,
        "bounces": check.counts.bounces,
        "until": check.until,
        "bounce_limit": check.bounce_limit,
        "target": None if check.goal is None else check.goal.words,
        "fates": {fate.label: _share(check.share(fate)) for fate in Fate},
        "seconds_to_target": [_quantile(one) for one in check.times()],
        "bounces_to_target": [_quantile(one) for one in check.times(bounces=True)],
        "traps": [_trap(trap) for trap in check.traps()],
        "traps_listed": min(LISTED, len(check.counts.traps)),
        "resting": [{"x": x, "y": y, "balls": balls} for x, y, balls in check.resting()],
        "edge_hits": check.counts.counts.edge_hits.tolist(),
        "never_hit": never,
        "chance_below": check.chance,
        "coverage": {"squares": free, "visited": visited, "balls": by, "side": check.squares.side},
        "digest": check.counts.digest(),
    }


def _share(share: Share) -> dict[str, Any]:
    return {"balls": share.count, "share": share.value, "low": share.low, "high": share.high}


def _quantile(one: Quantile) -> dict[str, Any]:
    return {"part": one.part, "low": one.low, "high": None if math.isinf(one.high) else one.high}


def _trap(trap: Trap) -> dict[str, Any]:
    norm = None if math.isinf(trap.norm) else trap.norm
    return {
        "fate": trap.fate.label, "balls": trap.balls, "ball": trap.ball, "x": trap.x, "y": trap.y,
        "norm": norm, "period": trap.period,
    }  # fmt: skip
