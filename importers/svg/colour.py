"""Colours of CSS, and what paints nothing at all."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any

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
        parts = _srgb(colour)
        return "#" + "".join(f"{min(255, max(0, round(part * 255))):02x}" for part in parts)
    except (NotImplementedError, ValueError, TypeError, AttributeError, OverflowError):
        return None


# Of light, as CSS Color 4 has them: XYZ to linear sRGB, XYZ of white D50 to D65 (Bradford), linear Display P3 to XYZ
_SRGB = (
    (3.24096994, -1.53738318, -0.49861076),
    (-0.96924364, 1.8759675, 0.04155506),
    (0.05563008, -0.20397696, 1.05697151),
)
_WHITE = ((0.9555766, -0.0230393, 0.0631636), (-0.0282895, 1.0099416, 0.0210077), (0.0122982, -0.020483, 1.3299098))
_P3 = ((0.48657095, 0.26566769, 0.19821729), (0.22897456, 0.69173852, 0.07928691), (0.0, 0.04511338, 1.04394437))
Light = tuple[float, float, float]


def _times(matrix: tuple[Light, Light, Light], light: Iterable[float]) -> Light:
    x, y, z = light
    first, second, third = (a * x + b * y + c * z for a, b, c in matrix)
    return first, second, third


def _encoded(light: float) -> float:
    """Give what sRGB and Display P3 write for linear light."""
    return 12.92 * light if light <= 0.0031308 else 1.055 * light ** (1 / 2.4) - 0.055


def _linear(written: float) -> float:
    return written / 12.92 if written <= 0.04045 else float(((written + 0.055) / 1.055) ** 2.4)


def _srgb(colour: Any) -> Iterable[float]:
    """Give red, green and blue from 0 to 1, beyond them where sRGB lacks the colour.

    Raises:
        NotImplementedError: its space is none of those that are known here.
    """
    space, parts = colour.space, [float(part or 0.0) for part in colour.coordinates[:3]]
    if space in ("srgb", "hsl", "hwb"):
        return [float(part) for part in colour.to("srgb").coordinates[:3]]
    if space == "srgb-linear":
        return map(_encoded, parts)
    if space == "display-p3":
        xyz = _times(_P3, map(_linear, parts))
    elif space in ("lab", "lch", "xyz-d50"):
        xyz = _times(_WHITE, colour.to("xyz-d50").coordinates)
    else:
        xyz = colour.to("xyz-d65").coordinates
    return map(_encoded, _times(_SRGB, xyz))


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
