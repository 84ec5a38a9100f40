"""Which paths of a drawing become walls; whatever does not is reported, counted by kind."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from fnmatch import fnmatchcase

from importers.drawing import Drawing, DrawnPath
from importers.problems import Problem
from wallkit.walls.walls import WallsError

BALLS_LAYER = "balls"

_REASONS = {
    "guide": ("{} left out: a guide is not art", "turn guides into paths if they are meant as walls"),
    "clip": ("{} left out: it only clips other art", "release the clipping mask if it is meant as a wall"),
    "hidden": ("{} left out: hidden in the drawing", "show it in the drawing, or include hidden paths (--hidden)"),
    "balls": ("{} left out: layer 'balls' is read as balls", "rename the layer if they are walls"),
    "other-layer": ("{} left out: on none of the layers asked for", "add the layer (--layer)"),
}


def choose(drawing: Drawing, layers: Sequence[str] | None, hidden: bool) -> tuple[list[DrawnPath], list[Problem]]:
    """Take the paths that are walls.

    Args:
        drawing: as read.
        layers: globs (case counts) on the names of a path's layer and of the groups around it; None for all.
        hidden: take hidden paths too.

    Returns:
        The paths in the file's order, and one info problem for each reason why others were left out.

    Raises:
        WallsError: a glob fits no layer of the drawing.
    """
    _check_globs(drawing, layers)
    taken: list[DrawnPath] = []
    left: Counter[str] = Counter()
    first: dict[str, DrawnPath] = {}
    for path in drawing.paths:
        reason = _reason(path, layers, hidden)
        if reason:
            left[reason] += 1
            first.setdefault(reason, path)
        else:
            taken.append(path)
    return taken, [_problem(reason, count, first[reason]) for reason, count in left.items()]


def _reason(path: DrawnPath, layers: Sequence[str] | None, hidden: bool) -> str:
    if path.guide:
        return "guide"
    if path.clip:
        return "clip"
    if layers is None and path.layer == BALLS_LAYER:
        return "balls"
    if layers is not None and not _on_layer(path, layers):
        return "other-layer"
    return "hidden" if not path.visible and not hidden else ""


def _on_layer(path: DrawnPath, globs: Sequence[str]) -> bool:
    return any(fnmatchcase(name, glob) for name in (path.layer, *path.groups) for glob in globs)


def _check_globs(drawing: Drawing, globs: Sequence[str] | None) -> None:
    if globs is None:
        return
    names = {layer.name for layer in drawing.layers}.union(*((p.layer, *p.groups) for p in drawing.paths))
    for glob in globs:
        if not any(fnmatchcase(name, glob) for name in names):
            known = ", ".join(repr(name) for name in sorted(names) if name) or "none"
            raise WallsError(f"no layer fits {glob!r}", code="no-such-layer", fix=f"the layers are: {known}")


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
