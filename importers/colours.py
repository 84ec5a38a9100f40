"""Device colours as ``#rrggbb``: the plain formulas, since no wall depends on a printing profile."""

from __future__ import annotations

from collections.abc import Sequence


def rgb(red: float, green: float, blue: float) -> str:
    """Give a colour from its parts, each 0 to 1 (what lies outside counts as the nearest end)."""
    parts = (round(255 * min(max(part, 0.0), 1.0)) for part in (red, green, blue))
    return "#{:02x}{:02x}{:02x}".format(*parts)


def gray(level: float) -> str:
    """Give a gray, 0 black to 1 white."""
    return rgb(level, level, level)


def cmyk(cyan: float, magenta: float, yellow: float, black: float) -> str:
    """Give an ink colour: (1 - ink)(1 - black) for each of red, green and blue."""
    light = 1.0 - min(max(black, 0.0), 1.0)
    return rgb((1.0 - cyan) * light, (1.0 - magenta) * light, (1.0 - yellow) * light)


def from_components(components: Sequence[float]) -> str | None:
    """Give the colour that 1 (gray), 3 (RGB) or 4 (CMYK) components stand for, None for any other number."""
    if len(components) == 1:
        return gray(components[0])
    if len(components) == 3:
        return rgb(*components)
    if len(components) == 4:
        return cmyk(*components)
    return None
