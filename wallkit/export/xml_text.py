"""Text in XML: quoted, and without the characters that XML cannot hold."""

from __future__ import annotations

import re

_ILLEGAL = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_NAMED = {"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "\t": "&#9;", "\n": "&#10;", "\r": "&#13;"}
_QUOTED = str.maketrans(_NAMED)


def clean(text: str) -> str:
    """Put ``_`` in the place of what no XML may hold, such as most control characters."""
    return _ILLEGAL.sub("_", text)


def quoted(text: str) -> str:
    """Give a text as an attribute's value, quotes included; it reads back as :func:`clean` gives it."""
    return f'"{clean(text).translate(_QUOTED)}"'
