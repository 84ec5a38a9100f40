"""Colours and strokes of every picture, once, for light and for dark; nothing is told by colour alone.

The ramp is viridis (Smith and van der Walt, matplotlib, CC0): its lightness rises all the way, so it reads in grey
and with any colour blindness. On light paper its yellow end is cut off, on dark paper its violet end.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Theme = Literal["light", "dark"]

RAMP_STEPS = 32

_VIRIDIS = (
    (68, 1, 84), (71, 44, 122), (59, 82, 139), (44, 114, 142), (33, 145, 140),
    (40, 174, 128), (94, 201, 98), (173, 220, 48), (253, 231, 37),
)  # fmt: skip
_CUT = {"light": (0.0, 0.82), "dark": (0.28, 1.0)}

_COLOURS: dict[str, tuple[str, str]] = {  # name: light, dark
    "paper": ("#fcfbf8", "#14171c"),
    "ink": ("#1f242c", "#e8ebf0"),
    "muted": ("#5d6675", "#9aa4b5"),
    "outline": ("#3c4553", "#a9b4c6"),
    "normal": ("#b4540a", "#e8a35c"),
    "error": ("#b3261e", "#ff8a80"),
    "warning": ("#8a5a00", "#f2c14e"),
    "info": ("#1f66ad", "#7db8f2"),
    "hidden": ("#a3abb8", "#596273"),
    # Fills of materials: neutral first, then tints after Okabe and Ito (2008), apart for all kinds of sight.
    "material0": ("#cdd2da", "#3a4350"),
    "material1": ("#f3c98b", "#7a5523"),
    "material2": ("#a9d6ee", "#2b5d78"),
    "material3": ("#9fdcc6", "#226651"),
    "material4": ("#e6bcd5", "#6d4560"),
    "material5": ("#f0e79a", "#6b6425"),
}
MATERIALS = 6


@dataclass(frozen=True, slots=True)
class Style:
    """How a shape is drawn: names of colours, or None, and the stroke's width in pixels."""

    fill: str | None = None
    stroke: str | None = None
    width: float = 1.0
    dash: tuple[float, float] | None = None


STYLES: dict[str, Style] = {
    "paper": Style(fill="paper"),
    "outline": Style(stroke="outline", width=1.5),
    "open": Style(stroke="outline", width=2.5),
    "hidden": Style(stroke="hidden", width=1.0, dash=(5, 4)),
    "way": Style(stroke="error", width=1.6, dash=(6, 4)),
    "normal": Style(stroke="normal", width=1.0),
    "path": Style(width=1.3),
    "beam": Style(fill="info", stroke="info", width=0.6),
    "target": Style(stroke="error", width=1.8),
    "trail": Style(width=2.2),
    "exact": Style(stroke="muted", width=1.4),
    "apart": Style(stroke="error", width=2.0),
    "apart-words": Style(fill="error"),
    "ghost": Style(width=1.0),
    "ball": Style(fill="paper", stroke="ink", width=1.8),
    "arrow": Style(stroke="ink", width=1.8),
    "end": Style(fill="ink", stroke="paper", width=1.0),
    "scale": Style(stroke="muted", width=1.5),
    "error": Style(fill="error", stroke="paper", width=1.2),
    "warning": Style(fill="warning", stroke="paper", width=1.2),
    "info": Style(fill="info", stroke="paper", width=1.2),
    "title": Style(fill="ink"),
    "text": Style(fill="ink"),
    "note": Style(fill="muted"),
    "number": Style(fill="paper"),
    **{f"material{index}": Style(fill=f"material{index}") for index in range(MATERIALS)},
}


def colour(name: str, theme: Theme) -> str:
    """Give a colour's ``#rrggbb`` in a theme."""
    return _COLOURS[name][theme == "dark"]


def ramp(step: int, theme: Theme) -> str:
    """Give the ramp's colour at a step from 0 to RAMP_STEPS - 1."""
    low, high = _CUT[theme]
    place = (low + (high - low) * step / (RAMP_STEPS - 1)) * (len(_VIRIDIS) - 1)
    index = min(int(place), len(_VIRIDIS) - 2)
    part = place - index
    mixed = (round(a + (b - a) * part) for a, b in zip(_VIRIDIS[index], _VIRIDIS[index + 1], strict=True))
    return "#" + "".join(f"{channel:02x}" for channel in mixed)


def css() -> str:
    """Give the style sheet of the SVG pictures: light, and dark where the reader prefers it."""
    return f"{_rules('light')}@media (prefers-color-scheme:dark){{{_rules('dark')}}}"


def _rules(theme: Theme) -> str:
    rules = []
    for name, style in STYLES.items():
        fill = colour(style.fill, theme) if style.fill else "none"
        stroke = f"stroke:{colour(style.stroke, theme)};" if style.stroke else ""
        dash = f"stroke-dasharray:{style.dash[0]} {style.dash[1]};" if style.dash else ""
        rules.append(f".wk-{name}{{fill:{fill};{stroke}stroke-width:{style.width:g};{dash}}}")
    for step in range(RAMP_STEPS):
        hue = ramp(step, theme)
        rules.append(f".wk-s{step}{{stroke:{hue}}}.wk-f{step}{{fill:{hue}}}")
    return "".join(rules)
