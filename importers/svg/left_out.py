"""What is said about the elements that draw nothing, or not all of what they mean to draw."""

from __future__ import annotations

import contextlib
from typing import Any

from importers.drawing import DrawnPath
from importers.numbers import NumberError
from importers.regions import EVERYWHERE, Region, reach_of
from importers.svg.matrix import Matrix, transform
from importers.svg.names import INKSCAPE, SODIPODI, SVG_NS
from importers.svg.notes import Notes
from importers.svg.references import References
from importers.svg.shapes import Lengths, Shape
from importers.svg.units import parse_length
from importers.svg.viewbox import parse_aspect, parse_view_box

_NEVER = frozenset(("defs", "clipPath", "mask", "pattern", "marker", "symbol"))
_SILENT = frozenset(
    (
        "title",
        "desc",
        "metadata",
        "style",
        "linearGradient",
        "radialGradient",
        "filter",
        "view",
        "cursor",
        "font",
        "font-face",
        "solidcolor",
        "color-profile",
        "hatch",
        "meshgradient",
        "missing-glyph",
        "glyph",
    )
)
# What is seen but has no outlines: the code of its problem, and what to do
NO_GEOMETRY = {
    "text": ("text-left-out", "to make walls of letters, convert the text to paths before saving"),
    "image": ("image-left-out", "trace the image if its shapes are to be walls"),
    "foreignObject": ("object-left-out", "draw its content as shapes if it is to be walls"),
}


def note_skipped(tag: str, element: Any, notes: Notes, references: References) -> None:
    """Say that an element of SVG draws nothing by itself."""
    if tag in NO_GEOMETRY:
        code, fix = NO_GEOMETRY[tag]
        notes.count(code, "info", f"<{tag}> has no outlines and is left out", element, fix=fix)
    elif tag in _NEVER:
        references.kept_back.setdefault(element)
    elif tag in ("script", "animate", "animateTransform", "animateMotion", "animateColor", "set"):
        message = f"<{tag}> is not run: the drawing is read as it is at the start"
        notes.count("not-run", "info", message, element)
    elif tag not in _SILENT:
        notes.count("unknown-element", "info", f"<{tag[:60]}> is unknown to SVG, browsers skip it", element)


def note_foreign(element: Any, notes: Notes) -> None:
    """Say that an element is not SVG."""
    tag = str(element.tag)
    if tag[0] != "{":
        fix = f'give it the namespace "{SVG_NS}"'
        message = f"<{tag[:60]}> is in no namespace, so browsers skip it"
        notes.count("unknown-element", "warning", message, element, fix=fix)
    elif not tag.startswith((INKSCAPE, SODIPODI, "{http://ns.adobe.com/", "{&ns_", "{http://www.w3.org/1999/02/")):
        message = f"<{tag.rpartition('}')[2][:60]}> is not SVG and is left out"
        notes.count("foreign-element", "info", message, element)


def note_lengths(element: Any, lengths: Lengths, layer: str, name: str, notes: Notes) -> None:
    """Say which attributes that were asked for are no lengths."""
    for attribute in lengths.invalid:
        note_length(element, attribute, "is no length and is not used", notes, layer, name)


def note_length(element: Any, attribute: str, words: str, notes: Notes, layer: str = "", name: str = "") -> None:
    """Say that an attribute is not what it has to be."""
    message = f"{attribute}={str(element.get(attribute))[:40]!r} {words}"
    notes.add("bad-length", "warning", message, element, attribute=attribute, layer=layer, name=name)


def note_viewport(element: Any, lengths: tuple[str, ...], notes: Notes) -> None:
    """Say which of a viewBox, how it is fitted, and some lengths of an element that makes a viewport cannot be read."""
    aspect = element.get("preserveAspectRatio") or ""
    if parse_aspect(aspect) is None and element.get("viewBox") is not None:
        message = f"preserveAspectRatio={aspect[:40]!r} is no such thing as 'xMidYMid meet', which is used instead"
        notes.add("bad-value", "warning", message, element, attribute="preserveAspectRatio")
    for name in ("viewBox", *lengths):
        text = (element.get(name) or "").strip()
        if text in ("", "auto"):
            continue
        with contextlib.suppress(NumberError):  # whoever uses it says that a number is too large
            if name == "viewBox" and parse_view_box(text) is None:
                note_length(element, name, "is no x, y, width and height, and is not used", notes)
            elif name != "viewBox" and parse_length(text) is None:
                note_length(element, name, "is no length and is not used", notes)


def note_shape(
    tag: str, element: Any, shape: Shape, lengths: Lengths, layer: str, name: str, matrix: Matrix, notes: Notes
) -> None:
    """Say what is wrong with a shape: its lengths, its data, or that it draws nothing."""
    note_lengths(element, lengths, layer, name, notes)
    if lengths.assumed:
        message = f"<{tag}> is measured in a window or a font, which a file does not have"
        fix = "write its lengths in px or mm"
        notes.count("assumed-unit", "warning", message, element, fix=fix)
    if shape.fault is not None:
        at = None
        if shape.subpaths:
            end = shape.subpaths[-1].segments[-1][-2:]
            at = transform([("L", *end)], matrix)[0][1:]
        fix = "what stands before it is used" if shape.subpaths else "nothing of it is drawn"
        notes.add(
            "bad-path-data" if shape.attribute == "d" else "bad-points",
            "error",
            shape.fault.message,
            element,
            fix=f"{fix}; correct the {shape.attribute} attribute here",
            attribute=shape.attribute,
            offset=shape.fault.offset,
            layer=layer,
            name=name,
            at=at,
        )
    elif not shape.subpaths:
        notes.count("nothing-drawn", "info", f"<{tag}> draws nothing: {shape.nothing}", element)


def note_unseen(tag: str, element: Any, path: DrawnPath, page: Region, clip: Region, notes: Notes) -> None:
    """Say that not all of a shape, or nothing of it, is seen for a clip, a mask or the end of the picture.

    A clip that cuts it is noted at the path.

    Args:
        tag: of the element.
        element: the shape.
        path: what it draws.
        page: what the picture and the viewports in it show.
        clip: what clips and masks leave of it.
        notes: to say it to.
    """
    x, y = start = path.subpaths[0].start
    if clip.box == EVERYWHERE and clip.exact and not page.misses((x, y, x, y)):
        return  # its first point is seen, and nothing cuts it
    wide = reach_of(path)
    if wide is None:
        return
    if clip.misses(wide):
        message = f"<{tag}> is wholly outside its clip, so nothing of it is seen"
        fix = "delete it if it is to be no wall"
        notes.add("outside-clip", "warning", message, element, fix=fix, layer=path.layer, name=path.name, at=start)
    elif page.misses(wide):
        message = f"<{tag}> is wholly outside the picture, so nothing of it is seen"
        fix = "delete it if it is to be no wall, or make the picture larger"
        notes.add("outside-picture", "warning", message, element, fix=fix, layer=path.layer, name=path.name, at=start)
    if not clip.cuts(wide):
        return
    if clip.known:
        path.clipped = clip.clip
        fix = "cut it there (--apply-clips), or in the drawing program, if its walls are to end there"
        notes.count("clip-not-applied", "warning", "a shape under a clip path is taken whole", element, fix=fix)
    else:
        message = "a shape under a mask, or a clip that is no clipPath, is taken whole"
        fix = "cut it in the drawing program if its walls are to end there"
        notes.count("mask-not-applied", "warning", message, element, fix=fix)
