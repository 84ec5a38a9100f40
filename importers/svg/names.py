"""What people call things: names of objects and layers, decoded, and tags."""

from __future__ import annotations

import re
from typing import Any

INKSCAPE = "{http://www.inkscape.org/namespaces/inkscape}"
SODIPODI = "{http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd}"

_CODE = re.compile(r"_x([0-9A-Fa-f]{2,6})_")
_DOUBLE = re.compile(r"_[0-9]+_$")


def decode_id(text: str, illustrator: bool = False) -> str:
    """Give an id as its owner wrote it.

    Illustrator spells a character that an id cannot have as ``_xHH_`` and a blank as ``_``, and makes a name
    that it has used before unique with ``_1_``. The last two are only undone in a file that Illustrator wrote.
    """
    if illustrator:
        text = _DOUBLE.sub("", text)
    parts = _CODE.split(text)
    plain = [part.replace("_", " ") if illustrator else part for part in parts[0::2]]
    codes = [chr(int(code, 16)) if int(code, 16) < 0x110000 else f"_x{code}_" for code in parts[1::2]]
    return "".join(piece for pair in zip(plain, [*codes, ""], strict=True) for piece in pair)


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
