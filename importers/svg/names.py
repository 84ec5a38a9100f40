"""What people call things: names of objects and layers, decoded, titles, descriptions and tags."""

from __future__ import annotations

from typing import Any

from importers.drawing import Level
from importers.ids import decode_id

SVG_NS = "http://www.w3.org/2000/svg"
INKSCAPE = "{http://www.inkscape.org/namespaces/inkscape}"
_LABEL = INKSCAPE + "label"
SODIPODI = "{http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd}"


def label_of(attributes: dict[str, str]) -> str:
    """Give the name that somebody gave an element: Inkscape's label or ``data-name``; ``""`` without any."""
    return attributes.get(_LABEL) or attributes.get("data-name") or ""


def name_of(attributes: dict[str, str], title: str, illustrator: bool) -> str:
    """Give an element's name: Inkscape's label, ``data-name``, its id decoded, its title; ``""`` without any."""
    own = label_of(attributes)
    if own:
        return own
    own = attributes.get("id", "")
    return decode_id(own, illustrator) if own else title


def title_of(element: Any) -> str:
    """Give the text of an element's ``title``, ``""`` without one."""
    return words_of(element)[0]


def words_of(element: Any) -> tuple[str, str]:
    """Give the texts of an element's ``title`` and ``desc``, the first of each; ``""`` for what it has not."""
    found: dict[str, str] = {}
    if len(element):  # nearly all shapes are empty
        for child in element.iterchildren("{*}title", "{*}desc"):
            tag = child.tag.rpartition("}")[2]
            if tag not in found:
                found[tag] = " ".join("".join(child.itertext()).split())
                if len(found) == 2:
                    break
    return found.get("title", ""), found.get("desc", "")


def tags_of(attributes: dict[str, str]) -> dict[str, str]:
    """Give the tags of an element: its ``data-*`` attributes without that prefix."""
    return {key[5:]: attributes[key] for key in attributes if key[:5] == "data-" and key != "data-name"}


def shown_name(attributes: dict[str, str], name: str) -> str:
    """Give the name that somebody gave an element; Inkscape shows its id with a # where it has no label."""
    return "" if name[:1] == "#" and name[1:] == attributes.get("id") else name


def merged(levels: tuple[Level, ...]) -> dict[str, str]:
    """Give the tags of all levels, those of a nearer one over those of a farther one."""
    result: dict[str, str] = {}
    for level in levels:
        result |= level.tags
    return result
