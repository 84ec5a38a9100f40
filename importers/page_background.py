"""The page behind a drawing: a painted rectangle of its size that no one means as a wall."""

from __future__ import annotations

from importers.boxes import Box, box_of
from importers.drawing import Drawing, DrawnPath
from importers.problems import Problem

# Programs round the size of a page to their own units: a px of 1/96 inch, a point, a tenth of a mm
_NEAR = 0.01  # of the page's larger side


def page_background(drawing: Drawing) -> DrawnPath | None:
    """Give the first painted path where it is a filled upright rectangle of the page's size; None otherwise.

    LibreOffice, matplotlib, Graphviz and others paint their page before all else. As a wall it would lie around
    everything, and every depth would be one more than it looks.

    Args:
        drawing: with its page or artboards; without any there is no background.
    """
    painted = (path for path in drawing.paths if is_painted(path))
    first = next(painted, None)
    if first is None or first.fill is None or len(first.subpaths) != 1 or next(painted, None) is None:
        return None
    box = _rectangle(first)
    boards = drawing.artboards if drawing.sheet is None else [drawing.sheet, *drawing.artboards]
    pages = [(board.x_min, board.y_min, board.x_max, board.y_max) for board in boards]
    return first if box is not None and any(_same(box, page) for page in pages) else None


def _same(box: Box, page: Box) -> bool:
    near = _NEAR * max(page[2] - page[0], page[3] - page[1])
    return all(abs(a - b) <= near for a, b in zip(box, page, strict=True))


def is_painted(path: DrawnPath) -> bool:
    """Tell whether anything of a path is seen."""
    return path.visible and not path.clip and (path.fill is not None or path.stroke is not None)


def _rectangle(path: DrawnPath) -> Box | None:
    """Give the box of a path that is an upright rectangle."""
    corners = [segment[1:] for segment in path.subpaths[0].segments]
    if any(segment[0] not in ("M", "L") for segment in path.subpaths[0].segments):
        return None
    if len(corners) == 5 and corners[4] == corners[0]:
        corners.pop()
    box = box_of([path])
    if box is None or len(corners) != 4 or len(set(corners)) != 4:
        return None
    upright = all(x in (box[0], box[2]) and y in (box[1], box[3]) for x, y in corners)
    return box if upright else None


def note_background(drawing: Drawing) -> None:
    """Add the problem that names the rectangle of the page's size behind everything."""
    path = page_background(drawing)
    if path is None:
        return
    left, top = path.subpaths[0].segments[0][1:]
    drawing.problems.append(
        Problem(
            "page-background",
            "info",
            "a filled rectangle of the page's size lies behind everything, and is a wall around it all",
            "delete it if it is only the paper, or take the walls by their layer (--layer)",
            layer=path.layer,
            name=path.name,
            line=path.line,
            x=left,
            y=top,
        )
    )
