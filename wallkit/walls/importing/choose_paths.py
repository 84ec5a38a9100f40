"""Which paths of a drawing become walls; whatever does not is reported, counted by kind."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import NamedTuple

from importers.drawing import Drawing, DrawnPath
from importers.limits import Work
from importers.problems import Problem
from wallkit.globs import fits, steps_of
from wallkit.walls.import_options import ImportOptions
from wallkit.walls.importing.drawn_balls import DrawnBall, marks_a_ball
from wallkit.walls.roles import plain_name, role_of, tag_problems
from wallkit.walls.walls import WallsError

_REASONS = {
    "guide": ("{} left out: a guide is not art", "turn guides into paths if they are meant as walls"),
    "clip": ("{} left out: it only clips other art", "release the clipping mask if it is meant as a wall"),
    "hidden": ("{} left out: hidden in the drawing", "show it in the drawing, or include hidden paths (--hidden)"),
    "ignored": ("{} left out: said to be ignored", "remove the word 'ignore' if it is meant as a wall"),
    "balls": ("{} left out: read as balls", "rename the layer or group 'balls' if they are walls"),
    "marker": ("{} left out: a ring around a ball marks its place", "make it wider than two balls if it is a wall"),
    "unpainted": ("{} left out: neither filled nor stroked", "give it a fill or a stroke, or take it (--unpainted)"),
    "other-layer": ("{} left out: on none of the layers asked for", "add the layer (--layer)"),
}
_ELSEWHERE = {"ball": "balls", "ignore": "ignored"}
"""Why a path of such a role is left out here."""
_TAGGED = ("sensor", "target", "spawn")


class Chosen(NamedTuple):
    """Which paths become what, each in the file's order.

    Attributes:
        walls: paths that are walls.
        sensors: paths that report a ball, targets among them.
        places: paths that are spawns and targets.
        problems: one info problem for each reason why others were left out, and for each word that means nothing.
    """

    walls: list[DrawnPath]
    sensors: list[DrawnPath]
    places: list[DrawnPath]
    problems: list[Problem]


def choose(drawing: Drawing, options: ImportOptions, balls: list[DrawnBall]) -> Chosen:
    """Take the paths that are walls, sensors or places.

    A path that paints nothing is none, unless no path that could be a wall is painted (pasted text, exported
    clipping paths). A ring that marks a ball is none, unless it is all that there is. What words make a sensor or a
    place is taken from all layers, painted or not, unless it is hidden.

    Args:
        drawing: as read.
        options: ``layers``, ``hidden`` and ``unpainted`` are asked.
        balls: that are drawn, unscaled.

    Raises:
        WallsError: a glob fits no layer of the drawing.
        LimitError: globs times names are more work than a file may ask for.
    """
    layers = None if options.layers is None else _fitting(drawing, options.layers)
    sorted_out = [(path, _reason(path, options, layers)) for path in drawing.paths]
    told = [(path, reason) for path, reason in sorted_out if reason in _TAGGED]
    sorted_out = [pair for pair in sorted_out if pair[1] not in _TAGGED]
    candidates = [path for path, reason in sorted_out if reason in ("", "other-layer")]
    if not options.unpainted and any(_painted(path) for path in candidates):
        sorted_out = [(p, reason or ("" if _painted(p) else "unpainted")) for p, reason in sorted_out]
    if balls:
        marked = [(p, reason or ("marker" if marks_a_ball(p, balls) else "")) for p, reason in sorted_out]
        if any(not reason for _, reason in marked):
            sorted_out = marked
    left: Counter[str] = Counter(reason for _, reason in sorted_out if reason)
    first: dict[str, DrawnPath] = {}
    for path, reason in sorted_out:
        first.setdefault(reason, path)
    taken = [path for path, reason in sorted_out if not reason]
    problems = [_problem(reason, count, first[reason]) for reason, count in left.items()]
    sensors = [path for path, role in told if role in ("sensor", "target")]
    places = [path for path, role in told if role in ("spawn", "target")]
    return Chosen(taken, sensors, places, problems + tag_problems([*taken, *(path for path, _ in told)]))


def _painted(path: DrawnPath) -> bool:
    return path.fill is not None or path.stroke is not None


def _reason(path: DrawnPath, options: ImportOptions, layers: frozenset[str] | None) -> str:
    """Give why a path is left out; layers: names of layers and groups that are taken, None for all."""
    if path.guide:
        return "guide"
    if path.clip:
        return "clip"
    role = role_of(path)
    if role in _ELSEWHERE:
        return _ELSEWHERE[role]
    if role in _TAGGED:
        return role if path.visible or options.hidden else "hidden"
    if layers is not None and path.layer not in layers and layers.isdisjoint(path.groups):
        return "other-layer"
    return "hidden" if not path.visible and not options.hidden else ""


def _fitting(drawing: Drawing, globs: Sequence[str]) -> frozenset[str]:
    """Give the names of layers and groups that globs fit, with the words in them or without; each is matched once."""
    names = {layer.name for layer in drawing.layers}.union(*((p.layer, *p.groups) for p in drawing.paths))
    plain = {name: plain_name(name) for name in names}
    work = Work(elements=len(drawing.paths))
    steps = steps_of(plain) + steps_of(plain.values())
    fitting: set[str] = set()
    for glob in globs:
        work.charge("names of layers and groups matched with globs (--layer)", steps)
        fit = [name for name in names if fits(name, glob) or fits(plain[name], glob)]
        if not fit:
            known = ", ".join(repr(name) for name in sorted(names) if name) or "none"
            raise WallsError(f"no layer fits {glob!r}", code="no-such-layer", fix=f"the layers are: {known[:500]}")
        fitting.update(fit)
    return frozenset(fitting)


def _problem(reason: str, count: int, path: DrawnPath) -> Problem:
    message, fix = _REASONS[reason]
    x, y = path.subpaths[0].segments[0][1:3] if path.subpaths and path.subpaths[0].segments else (None, None)
    return Problem(
        code=f"left-out-{reason}",
        severity="info",
        message=message.format("1 path" if count == 1 else f"{count} paths"),
        fix=fix,
        layer=path.layer,
        name=path.name,
        line=path.line,
        x=x,
        y=y,
    )
