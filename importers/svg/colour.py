"""Colours of CSS, and what paints nothing at all."""

from __future__ import annotations

import re

import tinycss2
import tinycss2.color4

NOTHING = "none"  # what paints nothing: the word itself, and every colour without any opacity
_BLANKS = " \t\r\n\f"
# The two ways in which programs write most colours; read so, they take a tenth of the time or less
_HEX = re.compile(r"#[0-9a-fA-F]{6}")
_RGB = re.compile(r"rgb\( *+([0-9]{1,3}) *+, *+([0-9]{1,3}) *+, *+([0-9]{1,3}) *+\)")


def parse_colour(text: str) -> str | None:
    """Read a CSS colour to ``"#rrggbb"``, ``"none"`` where it is fully transparent; None for what is none."""
    if _HEX.fullmatch(text):
        return text.lower()
    if match := _RGB.fullmatch(text):
        return "#" + "".join(f"{min(255, int(part)):02x}" for part in match.groups())
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
