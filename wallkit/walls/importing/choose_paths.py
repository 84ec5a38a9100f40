"""Which paths of a drawing become walls; whatever does not is reported, counted by kind."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from fnmatch import fnmatchcase

from importers.drawing import Drawing, DrawnPath
from importers.problems import Problem
from wallkit.walls.import_options import ImportOptions
from wallkit.walls.importing.drawn_balls import DrawnBall, marks_a_ball
from wallkit.walls.roles import role_of
from wallkit.walls.walls import WallsError

_REASONS = {
    "guide": ("{} left out: a guide is not art", "turn guides into paths if they are meant as walls"),
    "clip": ("{} left out: it only clips other art", "release the clipping mask if it is meant as a wall"),
    "hidden": ("{} left out: hidden in the drawing", "show it in the drawing, or include hidden paths (--hidden)"),
    "balls": ("{} left out: read as balls", "rename the layer or group 'balls' if they are walls"),
    "marker": ("{} left out: a ring around a ball marks its place", "make it wider than two balls if it is a wall"),
    "unpainted": ("{} left out: neither filled nor stroked", "give it a fill or a stroke, or take it (--unpainted)"),
    "other-layer": ("{} left out: on none of the layers asked for", "add the layer (--layer)"),
}


def choose(drawing: Drawing, options: ImportOptions, balls: list[DrawnBall]) -> tuple[list[DrawnPath], list[Problem]]:
    """Take the paths that are walls.

    A path that paints nothing is none, unless no path that could be a wall is painted (pasted text, exported
    clipping paths). A ring that marks a ball is none, unless it is all that there is.

    Args:
        drawing: as read.
        options: ``layers``, ``hidden`` and ``unpainted`` are asked.
        balls: that are drawn, unscaled.

    Returns:
        The paths in the file's order, and one info problem for each reason why others were left out.

    Raises:
        WallsError: a glob fits no layer of the drawing.
    """
    _check_globs(drawing, options.layers)
    sorted_out = [(path, _reason(path, options)) for path in drawing.paths]
    candidates = [path for path, reason in sorted_out if reason in ("", "other-layer")]
    if not options.unpainted and any(_painted(path) for path in candidates):
        sorted_out = [(p, reason or ("" if _painted(p) else "unpainted")) for p, reason in sorted_out]
    marked = [(p, reason or ("marker" if marks_a_ball(p, balls) else "")) for p, reason in sorted_out]
    if any(not reason for _, reason in marked):
        sorted_out = marked
    left: Counter[str] = Counter(reason for _, reason in sorted_out if reason)
    first: dict[str, DrawnPath] = {}
    for path, reason in sorted_out:
        first.setdefault(reason, path)
    taken = [path for path, reason in sorted_out if not reason]
    return taken, [_problem(reason, count, first[reason]) for reason, count in left.items()]


def _painted(path: DrawnPath) -> bool:
    return path.fill is not None or path.stroke is not None


def _reason(path: DrawnPath, options: ImportOptions) -> str:
    if path.guide:
        return "guide"
    if path.clip:
        return "clip"
    if role_of(path) == "ball":
        return "balls"
    if options.layers is not None and not _on_layer(path, options.layers):
        return "other-layer"
    return "hidden" if not path.visible and not options.hidden else ""


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
