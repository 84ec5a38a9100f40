"""The work-precision diagram: error across, time up, both logarithmic; lower left is better."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

from wallkit.accuracy import tables
from wallkit.accuracy.contest import Contest, Point
from wallkit.view.theme import Theme, colour

WIDTH = 1180.0
_COLUMNS = 3
_PANEL_HEIGHT = 268.0
_LEFT, _TOP, _RIGHT, _GAP_X, _GAP_Y = 78.0, 104.0, 50.0, 46.0, 74.0
_FOOT = 58.0
_ENTRY = 25.0  # height of an entry of the legend
MINUS = "\N{MINUS SIGN}"


@dataclass(frozen=True, slots=True)
class Look:
    """How a series is drawn: colours on light and dark paper (after Okabe and Ito, 2008), and a marker's shape."""

    light: str
    dark: str
    marker: str


LOOKS = {
    "exact, lines": Look("#0072b2", "#56b4e9", "disc"),
    "exact, arcs": Look("#007a5a", "#2fd3a5", "square"),
    "step, exact": Look("#4477cc", "#88aaff", "diamond"),
    "step, stop": Look("#c98500", "#e69f00", "triangle"),
    "step, full-step": Look("#c1440e", "#ff8a50", "triangle-down"),
    "step, reflect-in-place": Look("#a3487a", "#e6a3c8", "cross"),
    "pymunk": Look("#1f242c", "#e8ebf0", "plus"),
    "Box2D 2.3": Look("#7a6a3a", "#cdbb7a", "star"),
    "billiards": Look("#5d6675", "#9aa4b5", "ring"),
    "pooltool": Look("#8a2be2", "#c79bff", "frame"),
}
_OTHER = Look("#5d6675", "#9aa4b5", "ring")


def work_precision_svg(contests: Sequence[Contest], foot: str = "") -> str:
    """Draw one panel a scene, all with the same axes, and one legend, as one SVG document.

    Args:
        contests: the results.
        foot: a line below: machine and versions.
    """
    series = dict.fromkeys(point.series for found in contests for point in found.points)
    present = [*(name for name in LOOKS if name in series), *(name for name in series if name not in LOOKS)]
    table = _Table.of(len(contests))
    below = _TOP + table.height(entries=len(present) + 1)
    height = below + (_FOOT if foot else 0.0)
    axes = _Axes.around([point for found in contests for point in found.points], table.panel)
    parts = [_heading(tables.when(contests))]
    for index, found in enumerate(contests):
        parts.append(_panel(found, axes, *table.corner(index), labelled=index % table.columns == 0))
    parts.append(_legend(present, table))
    parts += [
        f'<text class="note" x="{_LEFT - 50:g}" y="{below + 24 + 16 * k:g}" font-size="11">{escape(line)}</text>'
        for k, line in enumerate(_wrapped(foot, 185))
    ]
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH:g}" height="{height:g}" '
        f'viewBox="0 0 {WIDTH:g} {height:g}" role="img" font-family="system-ui, sans-serif">\n'
        f"<title>Speed against error</title>\n<style>{_css()}</style>\n"
        f'<rect class="paper" width="{WIDTH:g}" height="{height:g}"/>\n' + "\n".join(parts) + "\n</svg>\n"
    )


@dataclass(frozen=True, slots=True)
class _Table:
    """Where panels stand: row by row over the whole width; the legend takes what the last row leaves, or a row.

    Attributes:
        panels: how many there are.
        columns: how many stand in a row.
    """

    panels: int
    columns: int

    @classmethod
    def of(cls, panels: int) -> _Table:
        return cls(panels, min(panels + 1, _COLUMNS))

    @property
    def panel(self) -> float:
        """The width of a panel."""
        return (WIDTH - _LEFT - _RIGHT - (self.columns - 1) * _GAP_X) / self.columns

    @property
    def spare(self) -> int:
        """Columns that the legend has."""
        return self.columns - self.panels % self.columns

    def corner(self, index: int) -> tuple[float, float]:
        row, column = divmod(index, self.columns)
        return _LEFT + column * (self.panel + _GAP_X), _TOP + row * (_PANEL_HEIGHT + _GAP_Y)

    def height(self, entries: int) -> float:
        """The height of all, the legend's entries among it."""
        row = _PANEL_HEIGHT + _GAP_Y
        own = math.ceil(entries / self.columns) * _ENTRY if self.spare == self.columns else 0.0
        return math.ceil(self.panels / self.columns) * row + own


@dataclass(frozen=True, slots=True)
class _Axes:
    """Decades shown over a width: error from 10^low_x to 10^high_x, seconds from 10^low_y to 10^high_y."""

    low_x: int
    high_x: int
    low_y: int
    high_y: int
    width: float

    @classmethod
    def around(cls, points: Sequence[Point], width: float) -> _Axes:
        errors = [_shown(p.error) for p in points if math.isfinite(p.error)] or [1.0]
        seconds = [p.seconds for p in points if math.isfinite(p.seconds) and p.seconds > 0] or [1.0]
        return cls(
            math.floor(math.log10(min(errors))),
            max(math.ceil(math.log10(max(errors))), 0),
            math.floor(math.log10(min(seconds))),
            math.ceil(math.log10(max(seconds))),
            width,
        )

    def x(self, error: float) -> float:
        return (math.log10(_shown(error)) - self.low_x) / max(1, self.high_x - self.low_x) * self.width

    def y(self, seconds: float) -> float:
        part = (math.log10(seconds) - self.low_y) / max(1, self.high_y - self.low_y)
        return _PANEL_HEIGHT * (1 - part)


def _shown(error: float) -> float:
    return min(max(error, 1e-15), 1e4)  # a logarithmic axis has no place for 0


def _heading(after: str) -> str:
    return (
        f'<text class="ink" x="{_LEFT - 50:g}" y="36" font-size="22" font-weight="600">Speed against error</text>'
        f'<text class="note" x="{_LEFT - 50:g}" y="60" font-size="13">Across: how far the ball is from where it really '
        f"is after {after} (units). Up: processor seconds for one second of flight. Lower left is better.</text>"
    )


def _panel(found: Contest, axes: _Axes, x: float, y: float, *, labelled: bool) -> str:
    parts = [
        f'<g transform="translate({x:g} {y:g})">',
        f'<text class="ink" x="0" y="-12" font-size="14" font-weight="600">{escape(found.name)}'
        f'<tspan class="note" font-weight="400" font-size="12" dx="8">{escape(found.story)}</tspan></text>',
        f'<rect class="field" width="{axes.width:g}" height="{_PANEL_HEIGHT:g}"/>',
        _grid(axes, labelled=labelled),
    ]
    for series, points in found.series().items():
        parts.append(_series(series, points, axes))
    return "\n".join([*parts, "</g>"])


def _grid(axes: _Axes, *, labelled: bool) -> str:
    parts = []
    for power in range(axes.low_x, axes.high_x + 1):
        x = axes.x(10.0**power)
        parts.append(f'<path class="grid" d="M{x:.1f} 0V{_PANEL_HEIGHT:g}"/>')
        if (power - axes.high_x) % 3 == 0:
            parts.append(_tick(x, _PANEL_HEIGHT + 16, power, "middle"))
    for power in range(axes.low_y, axes.high_y + 1):
        y = axes.y(10.0**power)
        parts.append(f'<path class="grid" d="M0 {y:.1f}H{axes.width:g}"/>')
        parts.append(_tick(-6, y + 4, power, "end"))
    parts.append(
        f'<text class="note" x="{axes.width / 2:g}" y="{_PANEL_HEIGHT + 34:g}" font-size="11" '
        'text-anchor="middle">error, units</text>'
    )
    if labelled:
        parts.append(
            f'<text class="note" font-size="11" text-anchor="middle" '
            f'transform="translate(-44 {_PANEL_HEIGHT / 2:g}) rotate(-90)">seconds per simulated second</text>'
        )
    return "".join(parts)


def _tick(x: float, y: float, power: int, anchor: str) -> str:
    return (
        f'<text class="note" x="{x:.1f}" y="{y:.1f}" font-size="11" text-anchor="{anchor}">10'
        f'<tspan dy="-4" font-size="8">{str(power).replace("-", MINUS)}</tspan></text>'
    )


def _series(name: str, points: Sequence[Point], axes: _Axes) -> str:
    kept = [p for p in points if math.isfinite(p.error) and math.isfinite(p.seconds) and p.seconds > 0]
    if not kept:
        return ""
    places = [(axes.x(p.error), axes.y(p.seconds)) for p in kept]
    line = "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in places)
    parts = [f'<g class="{_class(name)}">', f'<path class="line" d="{line}"/>']
    for point, (x, y) in zip(kept, places, strict=True):
        parts.append(f"<g><title>{escape(_told(point))}</title>{_marker(_look(name).marker, x, y)}</g>")
        if point.escaped:
            parts.append(f'<circle class="escaped" cx="{x:.1f}" cy="{y:.1f}" r="8"/>')
    return "".join([*parts, "</g>"])


def _told(point: Point) -> str:
    words = [
        f"{point.series}, {point.setting}",
        f"error {point.error:.2g}",
        f"{point.seconds:.2g} s a simulated second",
        f"first wrong bounce: {point.wrong if point.wrong is not None else 'none'}",
        f"energy drift {point.drift:.1g}",
    ]
    return "; ".join([*words, "escaped"] if point.escaped else words)


def _marker(shape: str, x: float, y: float) -> str:
    r = 4.2
    if shape in ("disc", "ring"):
        return f'<circle class="{"mark" if shape == "disc" else "hollow"}" cx="{x:.1f}" cy="{y:.1f}" r="{r:g}"/>'
    if shape in ("cross", "plus", "star"):
        d = r * 0.75
        cross = f"M{x - d:.1f} {y - d:.1f}l{2 * d:.1f} {2 * d:.1f}m0 {-2 * d:.1f}l{-2 * d:.1f} {2 * d:.1f}"
        plus = f"M{x - r:.1f} {y:.1f}h{2 * r:.1f}M{x:.1f} {y - r:.1f}v{2 * r:.1f}"
        return f'<path class="hollow" d="{ {"cross": cross, "plus": plus, "star": cross + plus}[shape] }"/>'
    corners = {
        "frame": ((-0.85, -0.85), (0.85, -0.85), (0.85, 0.85), (-0.85, 0.85)),
        "square": ((-0.85, -0.85), (0.85, -0.85), (0.85, 0.85), (-0.85, 0.85)),
        "diamond": ((0, -1.2), (1.2, 0), (0, 1.2), (-1.2, 0)),
        "triangle": ((0, -1.15), (1.05, 0.8), (-1.05, 0.8)),
        "triangle-down": ((0, 1.15), (1.05, -0.8), (-1.05, -0.8)),
    }[shape]
    kind = "hollow" if shape == "frame" else "mark"
    return f'<path class="{kind}" d="M{"L".join(f"{x + r * a:.1f} {y + r * b:.1f}" for a, b in corners)}Z"/>'


_MEANINGS = {
    "exact, lines": "wallkit, curves as lines: finer from point to point",
    "exact, arcs": "wallkit, curves as arcs",
    "step, exact": "World in frames, exact within each",
    "step, stop": "World in frames, stop at the contact",
    "step, full-step": "World in frames, a full step after the contact",
    "step, reflect-in-place": "World in frames, turn where the ball is",
    "pymunk": "pymunk: smaller steps take more time",
    "Box2D 2.3": "Box2D 2.3: smaller steps take more time",
    "billiards": "billiards (Python, event-driven)",
    "pooltool": "pooltool (event-driven): friction towards 0",
}


def _legend(series: Sequence[str], table: _Table) -> str:
    """Say what the marks mean, column by column, in as many columns as the last row of panels leaves."""
    x, y = table.corner(table.panels)
    rows = math.ceil((len(series) + 1) / table.spare)
    parts = [f'<g transform="translate({x:g} {y:g})">']
    for index, name in enumerate([*series, ""]):
        column, row = divmod(index, rows)
        left, top = column * (table.panel + _GAP_X), 10 + _ENTRY * row
        mark = f'<path class="line" d="M{left:g} {top:g}h28"/>{_marker(_look(name).marker, left + 14, top)}'
        words = _MEANINGS.get(name, name)
        if not name:
            mark = f'<circle class="escaped" cx="{left + 14:g}" cy="{top:g}" r="8"/>'
            words = "a ball was outside the room at some time"
        parts.append(
            f'<g class="{_class(name)}">{mark}</g>'
            f'<text class="ink" x="{left + 38:g}" y="{top + 4:g}" font-size="12">{escape(words)}</text>'
        )
    return "".join([*parts, "</g>"])


def _look(name: str) -> Look:
    return LOOKS.get(name, _OTHER)


def _class(name: str) -> str:
    return f"s{list(LOOKS).index(name)}" if name in LOOKS else "s-other"


def _css() -> str:
    return f"{_rules(dark=False)}@media (prefers-color-scheme:dark){{{_rules(dark=True)}}}"


def _rules(*, dark: bool) -> str:
    theme: Theme = "dark" if dark else "light"
    rules = [
        f".paper{{fill:{colour('paper', theme)}}}.ink{{fill:{colour('ink', theme)}}}",
        f".note{{fill:{colour('muted', theme)}}}",
        f".field{{fill:none;stroke:{colour('muted', theme)}}}",
        f".grid{{stroke:{colour('muted', theme)};stroke-width:.5;opacity:.28}}",
        f".line{{fill:none;stroke-width:1.4;opacity:.75}}.mark{{stroke:{colour('paper', theme)};stroke-width:.6}}",
        f".hollow{{fill:none;stroke-width:1.8}}.escaped{{fill:none;stroke:{colour('error', theme)};stroke-width:1.6}}",
    ]
    for index, look in enumerate([*LOOKS.values(), _OTHER]):
        name = f".s{index}" if index < len(LOOKS) else ".s-other"
        hue = look.dark if dark else look.light
        rules.append(f"{name} .mark{{fill:{hue}}}{name} .line,{name} .hollow{{stroke:{hue}}}")
    return "".join(rules)


def _wrapped(text: str, width: int) -> list[str]:
    import textwrap

    return textwrap.wrap(text, width)
