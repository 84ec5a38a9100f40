"""The page's looks and parts: colours of the pictures' theme, and the files in static/."""

from __future__ import annotations

from functools import cache
from importlib.resources import files

from wallkit.view.theme import MATERIALS, RAMP_STEPS, Theme, colour, ramp

# Scripts in the order in which they build on one another.
SHARED_SCRIPTS = ("pendulum.js", "motion.js", "units.js", "quantities.js", "stage.js", "walls.js", "player.js",
                  "readout.js", "numbers.js", "graphs.js", "rulers.js", "controls.js", "lesson.js", "legend.js",
                  "sheet.js")  # fmt: skip
SHARED_STYLES = ("look.css", "numbers.css")

_NAMES = ("paper", "ink", "muted", "outline", "hidden", "normal", "error", "warning", "info",
          *(f"material{index}" for index in range(MATERIALS)))  # fmt: skip
_THEMES: tuple[Theme, Theme] = ("light", "dark")

# Surfaces and lines of the page itself; the drawing's paper stays the pictures' own.
_SURFACES = {
    "panel": ("#f4f2ec", "#1b1f26"),
    "raised": ("#ffffff", "#262b34"),
    "line": ("#d8d5cc", "#39414d"),
    "on-accent": ("#ffffff", "#0d141c"),
}


def colours() -> dict[str, dict[str, str | list[str]]]:
    """Give the colours that the canvas draws with, by theme."""
    return {
        theme: {
            **{name: colour(name, theme) for name in _NAMES},
            "ramp": [ramp(step, theme) for step in range(RAMP_STEPS)],
        }
        for theme in _THEMES
    }


def theme_css() -> str:
    """Give the colours as CSS variables: as the reader prefers, or as ``data-theme`` on the root says."""
    rules = []
    for index, theme in enumerate(_THEMES):
        values = {name: colour(name, theme) for name in _NAMES}
        values |= {name: pair[index] for name, pair in _SURFACES.items()}
        values["accent"] = values["info"]
        body = "".join(f"--{name}:{value};" for name, value in values.items()) + f"color-scheme:{theme};"
        told = f':root[data-theme="{theme}"]{{{body}}}'
        preferred = f":root{{{body}}}" if theme == "light" else f"@media (prefers-color-scheme:dark){{:root{{{body}}}}}"
        rules.append((preferred, told))
    return "\n".join([*(preferred for preferred, _ in rules), *(told for _, told in rules)]) + "\n"


@cache
def part(name: str) -> str:
    """Read a file of static/ as text."""
    return files("wallkit.view.page").joinpath("static", name).read_text(encoding="utf-8")


def filled(template: str, values: dict[str, str]) -> str:
    """Put values and the named parts of static/ into a template; each ``{{name}}`` once, nothing twice over."""
    pieces = part(template).split("{{")
    out = [pieces[0]]
    for piece in pieces[1:]:
        name, rest = piece.split("}}", 1)
        out += [values[name] if name in values else part(f"{name}.html"), rest]
    return "".join(out)
