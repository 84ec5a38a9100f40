"""What people call things: names of objects and layers, decoded, titles, descriptions and tags."""

from __future__ import annotations

from typing import Any

from importers.drawing import Level, LevelKind
from importers.ids import decode_id

SVG_NS = "http://www.w3.org/2000/svg"
INKSCAPE = "{http://www.inkscape.org/namespaces/inkscape}"
SODIPODI = "{http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd}"


def label_of(attributes: dict[str, str]) -> str:
    """Give the name that somebody gave an element: Inkscape's label or ``data-name``; ``""`` without any."""
    return attributes.get(INKSCAPE + "label") or attributes.get("data-name") or ""


def name_of(element: Any, attributes: dict[str, str], illustrator: bool) -> str:
    """Give an element's name: Inkscape's label, ``data-name``, its id decoded, its title; ``""`` without any."""
    name = label_of(attributes)
    if name:
        return name
    own = attributes.get("id")
    if own:
        return decode_id(own, illustrator)
    return title_of(element)


def title_of(element: Any) -> str:
    """Give the text of an element's ``title``, ``""`` without one."""
    return _text_of(element, "title")


def _text_of(element: Any, tag: str) -> str:
    if not len(element):  # as nearly all shapes are
        return ""
    for child in element.iterchildren(f"{{*}}{tag}", tag):
        return " ".join("".join(child.itertext()).split())
    return ""


def tags_of(attributes: dict[str, str]) -> dict[str, str]:
    """Give the tags of an element: its ``data-*`` attributes without that prefix."""
    return {key[5:]: value for key, value in attributes.items() if key.startswith("data-") and key != "data-name"}


def level_of(element: Any, attributes: dict[str, str], name: str, kind: LevelKind) -> Level:
    """Give what an element says of itself and all in it; Inkscape shows its id with a # where it has no label."""
    name = "" if name == f"#{attributes.get('id')}" else name
    return Level(kind, name, tags_of(attributes), _text_of(element, "desc"))


def merged(levels: tuple[Level, ...]) -> dict[str, str]:
    """Give the tags of all levels, those of a nearer one over those of a farther one."""
    result: dict[str, str] = {}
    for level in levels:
        result |= level.tags
    return result
