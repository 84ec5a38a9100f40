"""What people call things: names of objects and layers, decoded, and tags."""

from __future__ import annotations

from typing import Any

from importers.ids import decode_id

SVG_NS = "http://www.w3.org/2000/svg"
INKSCAPE = "{http://www.inkscape.org/namespaces/inkscape}"
SODIPODI = "{http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd}"


def name_of(element: Any, attributes: dict[str, str], illustrator: bool) -> str:
    """Give an element's name: Inkscape's label, ``data-name``, its id decoded, its title; ``""`` without any."""
    name = attributes.get(INKSCAPE + "label") or attributes.get("data-name")
    if name:
        return name
    own = attributes.get("id")
    if own:
        return decode_id(own, illustrator)
    for child in element.iterchildren("{*}title", "title"):
        return " ".join("".join(child.itertext()).split())
    return ""


def tags_of(attributes: dict[str, str], around: dict[str, str]) -> dict[str, str]:
    """Give the tags of an element: its ``data-*`` attributes without that prefix, over those of what is around."""
    own = {key[5:]: value for key, value in attributes.items() if key.startswith("data-") and key != "data-name"}
    return {**around, **own} if own else around
