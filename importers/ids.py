"""Ids as drawing programs spell them, back to the names that people gave."""

from __future__ import annotations

import re

_CODE = re.compile(r"_x([0-9A-Fa-f]{2,6})_")
_SECOND_USE = re.compile(r"_[0-9]+_$")


def decode_id(text: str, illustrator: bool = True) -> str:
    """Give an id as its owner wrote it: ``Left_x5F_hole_1_`` is ``Left_hole``, used a second time.

    Illustrator spells a character that an id cannot have as ``_xHH_`` and a blank as ``_``, and makes a name
    that it has used before unique with ``_1_``. The last two are only undone in what Illustrator wrote. A code
    that is no character stays as it stands.
    """
    if illustrator:
        text = _SECOND_USE.sub("", text)
    parts = _CODE.split(text)
    plain = [part.replace("_", " ") if illustrator else part for part in parts[0::2]]
    codes = [_character(code) for code in parts[1::2]]
    return "".join(piece for pair in zip(plain, [*codes, ""], strict=True) for piece in pair).strip()


def _character(code: str) -> str:
    number = int(code, 16)
    return chr(number) if 32 <= number <= 0x10FFFF and not 0xD800 <= number <= 0xDFFF else f"_x{code}_"
