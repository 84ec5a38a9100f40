"""Put the signatures into docs/api.md as the code has them: python docs/make_api.py, from the repository's root."""

from __future__ import annotations

import enum
import inspect
import re
from pathlib import Path

import wallkit

PAGE = Path(__file__).parent / "api.md"
SECTION = re.compile(r"^### (\S+)\n\n(?:`[^\n]*`\n\n)?", re.MULTILINE)


def signature(name: str) -> str:
    """Write how a name is called, without types; "" for what nobody calls."""
    thing = getattr(wallkit, name)
    if isinstance(thing, type) and issubclass(thing, Exception | enum.Enum):
        return ""
    if not callable(thing) or not (inspect.isclass(thing) or inspect.isfunction(thing)):
        return ""
    words: list[str] = []
    for one in inspect.signature(thing).parameters.values():
        if one.kind is one.KEYWORD_ONLY and "*" not in words:
            words.append("*")
        words.append(_parameter(one))
    text = ", ".join(words)
    back = inspect.signature(thing).return_annotation
    told = back if inspect.isfunction(thing) and isinstance(back, str) else ""
    return f"{name}({text})" + (f" -> {told}" if told else "")


def _parameter(one: inspect.Parameter) -> str:
    if one.kind is one.VAR_KEYWORD:
        return f"**{one.name}"
    if one.default is one.empty:
        return one.name
    plain = isinstance(one.default, bool | int | float | str | tuple) or one.default is None
    return f"{one.name}={one.default!r}" if plain and not callable(one.default) else f"{one.name}=..."


def filled(text: str) -> str:
    """Renew the line of code under each heading."""

    def renewed(found: re.Match[str]) -> str:
        name = found[1].replace("\\", "")
        told = signature(name) if name in wallkit.__all__ else ""
        return f"### {found[1]}\n\n" + (f"`{told}`\n\n" if told else "")

    return SECTION.sub(renewed, text)


if __name__ == "__main__":
    PAGE.write_text(filled(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
