"""Paint: CSS colours and paint servers, and which of them paint nothing at all."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import tinycss2
import tinycss2.color4

NOTHING = "none"  # what paints nothing: the word itself, and every colour without any opacity
_BLANKS = " \t\r\n\f"

# Gives the declarations of an element that is not drawn itself (a gradient's stop), the element that another's
# href names (or None), and the element of an id (or None).
Declarations = Callable[[Any], dict[str, Any]]
Target = Callable[[Any], Any]
Lookup = Callable[[str], Any]


def parse_colour(text: str) -> str | None:
    """Read a CSS colour to ``"#rrggbb"``, ``"none"`` where it is fully transparent; None for what is none."""
    try:
        colour = tinycss2.color4.parse_color(text.strip())
    except (ValueError, TypeError, ZeroDivisionError, OverflowError):
        return None
    if colour is None or isinstance(colour, str):
        return "currentcolor" if colour == "currentcolor" else None
    if colour.alpha is not None and colour.alpha <= 0:
        return NOTHING
    try:
        srgb = colour.to("srgb")
        return "#" + "".join(f"{min(255, max(0, round(float(v or 0) * 255))):02x}" for v in srgb.coordinates[:3])
    except (NotImplementedError, ValueError, TypeError, AttributeError, OverflowError):
        return None


def split_url(text: str) -> tuple[str, str] | None:
    """Give the address in ``url(...)`` and what stands behind it; None where the text is no such thing."""
    text = text.strip(_BLANKS)
    if text[:4].lower() != "url(":
        return None
    inside = text[4:].lstrip(_BLANKS)
    if inside[:1] in ('"', "'"):
        address, quote, rest = inside[1:].partition(inside[0])
        gap, bracket, rest = rest.partition(")")
        return (address.strip(_BLANKS), rest.strip(_BLANKS)) if quote and bracket and not gap.strip(_BLANKS) else None
    address, bracket, rest = inside.partition(")")
    return (address.strip(_BLANKS), rest.strip(_BLANKS)) if bracket else None


class Paints:
    """Gives the word for each paint of a document; each text and each paint server is looked at once."""

    def __init__(self, lookup: Lookup, target: Target, declarations: Declarations) -> None:
        self._lookup, self._target, self._declarations = lookup, target, declarations
        self._words: dict[str, str | None] = {}
        self._seen: dict[Any, bool] = {}  # paint servers: does it paint anything

    def word(self, paint: str | None) -> str | None:
        """Give ``"#rrggbb"``, ``"gradient"`` or ``"pattern"``, None for what paints nothing.

        Args:
            paint: a colour, or ``url(...)`` with what stands in for a paint server that is not there.
        """
        if paint is None or paint[0] == "#":
            return paint
        if paint not in self._words:
            self._words[paint] = self._server(paint)
        return self._words[paint]

    def _server(self, paint: str) -> str | None:
        parts = split_url(paint)
        if parts is None:
            return None
        address, instead = parts
        server = self._lookup(address)
        tag = _local_name(server) if server is not None else ""
        if tag in ("linearGradient", "radialGradient"):
            return "gradient" if self._paints(server, self._has_colour) else None
        if tag == "pattern":
            return "pattern" if self._paints(server, _has_content) else None
        colour = parse_colour(instead) if instead else None
        return None if colour == NOTHING else colour

    def _paints(self, server: Any, tell: Callable[[Any], bool | None]) -> bool:
        """Tell whether a server paints anything, by itself or by the first it refers to that says so.

        What is found is noted on the whole chain, so that each server is looked at once.
        """
        chain: list[Any] = []
        passed: set[Any] = set()
        answer: bool | None = None
        while server is not None and server not in passed:
            answer = self._seen.get(server)
            if answer is None:
                chain.append(server)
                passed.add(server)
                answer = tell(server)
            if answer is not None:
                break
            server = self._target(server)
        for server in chain:
            self._seen[server] = bool(answer)
        return bool(answer)

    def _has_colour(self, gradient: Any) -> bool | None:
        """Tell whether any stop has opacity; None without stops: then those that its href names count."""
        stops = [child for child in gradient.iterchildren("*") if _local_name(child) == "stop"]
        if not stops:
            return None
        return any(self._stop_paints(stop) for stop in stops)

    def _stop_paints(self, stop: Any) -> bool:
        declared = self._declarations(stop)
        opacity = declared.get("stop-opacity", 1.0)
        return declared.get("stop-color") != NOTHING and not (isinstance(opacity, float) and opacity <= 0)


def _has_content(pattern: Any) -> bool | None:
    return True if len(pattern) else None


def _local_name(element: Any) -> str:
    return str(element.tag).rpartition("}")[2]
