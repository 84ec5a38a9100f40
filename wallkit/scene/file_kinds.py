"""What a file is, by its content: a drawing, walls or a scene; readers of what it is not stay on the disk."""

from __future__ import annotations

import re
from typing import Literal

FileKind = Literal["drawing", "walls", "scene"]

_TOML_START = re.compile(r"(?:\s|#[^\n]*\n)*(?:\[{1,2}\s*[A-Za-z_\"]|[A-Za-z_][A-Za-z0-9_.-]*\s*=)")


def kind_of(data: bytes) -> FileKind:
    """Tell by its content whether a file holds walls, a scene or (whatever else it is) a drawing.

    JSON that names its format is believed; TOML is a text whose first line that is no comment sets a key or opens
    a table, which no drawing's does. A saved run counts as a scene: it holds the one that it was made of.
    """
    head = data[:4096].decode("utf-8", "replace").lstrip("\ufeff")
    if head.lstrip().startswith("{"):
        named = re.search(r'"format"\s*:\s*"wallkit-(walls|scene|run)"', data.decode("utf-8", "replace"))
        return "walls" if named and named[1] == "walls" and _format_of(data) == "wallkit-walls" else "scene"
    return "scene" if _TOML_START.match(head) else "drawing"


def _format_of(data: bytes) -> str:
    import json  # late: drawings do not need it

    try:
        return str(json.loads(data.decode("utf-8-sig")).get("format", ""))
    except (ValueError, RecursionError, AttributeError):
        return ""
