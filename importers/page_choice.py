"""Which page of a drawing is meant: one by its number, all, or what a reader takes when nobody says."""

from __future__ import annotations

from typing import Literal

from importers.drawing import Drawing, control_points
from importers.errors import DrawingError
from importers.problems import Problem

PageChoice = int | Literal["all"] | None


def check_page(page: object, file: str = "") -> None:
    """Raise DrawingError for what is no choice of a page: numbers begin with 1."""
    if page is None or page == "all" or (isinstance(page, int) and not isinstance(page, bool) and page >= 1):
        return
    raise DrawingError(f"{page!r} is no page", code="no-such-page", fix="give a number from 1, or all", file=file)


def page_choice(text: str, file: str = "") -> PageChoice:
    """Give the choice that a text such as ``"2"`` or ``"all"`` stands for; ``""`` chooses nothing.

    Raises:
        DrawingError: it stands for none.
    """
    if text in ("", "all"):
        return "all" if text else None
    page = int(text) if text.isascii() and text.isdigit() and len(text) < 10 else 0
    check_page(page or text, file)
    return page


def no_such_page(page: int, pages: int, file: str = "") -> DrawingError:
    """Make the error for a page that a drawing has not."""
    message = f"there is no page {page}: the drawing has {pages:,}" if pages != 1 else "the drawing has one page only"
    fix = f"give a number from 1 to {pages:,}, or all" if pages != 1 else "leave the page out"
    return DrawingError(message, code="no-such-page", fix=fix, file=file)


def keep_artboard(drawing: Drawing, page: int) -> None:
    """Leave out of a drawing what lies outside one of its artboards; what lies on two of them is on both.

    Args:
        drawing: what was read; a drawing without artboards is one page.
        page: the artboard's number, from 1.

    Raises:
        DrawingError: there is no such artboard.
    """
    drawing.page = page
    if not drawing.artboards and page == 1:
        return
    if page > len(drawing.artboards):
        raise no_such_page(page, max(len(drawing.artboards), 1), drawing.file)
    artboard = drawing.sheet = drawing.artboards[page - 1]
    kept = []
    for path in drawing.paths:
        points = [point for subpath in path.subpaths for point in control_points(subpath.segments)]
        xs, ys = [x for x, _ in points], [y for _, y in points]
        if (
            points
            and (max(xs) >= artboard.x_min and min(xs) <= artboard.x_max)
            and (max(ys) >= artboard.y_min and min(ys) <= artboard.y_max)
        ):
            kept.append(path)
    left_out = len(drawing.paths) - len(kept)
    if left_out:
        name = f"artboard {page}" + (f' "{artboard.name}"' if artboard.name else "")
        paths = "1 path is" if left_out == 1 else f"{left_out:,} paths are"
        message = f"{paths} outside {name} and left out"
        drawing.problems.append(Problem("other-artboards", "info", message, "choose all pages to have everything"))
    drawing.paths = kept
