"""Paint: which word stands for a paint, and which paint servers paint nothing at all."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from importers.limits import MAX_COORDINATE
from importers.numbers import NumberError
from importers.svg.cascade import Cascade
from importers.svg.colour import NOTHING, parse_colour, split_url
from importers.svg.inheritance import Style
from importers.svg.notes import Notes
from importers.svg.references import References
from importers.svg.source import Source
from importers.svg.units import LONGEST, Viewport, check_numbers, to_px

_INITIAL = Style()
_NUMBERS_OF_SERVERS = (
    *("gradientTransform", "patternTransform", "x1", "y1", "x2", "y2", "cx", "cy", "r", "fx", "fy", "fr"),
    *("x", "y", "width", "height", "viewBox"),
)


class Paints:
    """Gives the word for each paint of a document; each text and each paint server is looked at once."""

    def __init__(self, references: References, cascade: Cascade, source: Source, notes: Notes) -> None:
        self._references, self._cascade, self._source, self._notes = references, cascade, source, notes
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

    def stroke(self, style: Style, viewport: Viewport, scale: float, element: Any) -> tuple[str | None, float | None]:
        """Give the paint and the width of a stroke that is seen; a stroke without width paints nothing.

        Args:
            style: of the shape.
            viewport: the nearest, for percentages.
            scale: of the shape's coordinates.
            element: the shape.
        """
        stroke = self.word(style.stroke) if style.stroke_seen else None
        if stroke is None:
            return None, None
        try:
            width = to_px(style.stroke_width, viewport.diagonal, style.font)
        except NumberError as error:
            width = error.value
        if not width > 0:
            return None, None
        if width * scale > MAX_COORDINATE:
            message = f"the stroke is {width:g} wide, and counts as the widest that browsers draw"
            self._notes.count("bad-number", "error", message, element, fix="write a smaller stroke-width")
            width = min(width, LONGEST)
        return stroke, min(width * scale, MAX_COORDINATE)

    def _server(self, paint: str) -> str | None:
        parts = split_url(paint)
        if parts is None:
            return None
        address, instead = parts
        server = self._references.at(address)
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
                self._look_at_numbers(server)
                answer = tell(server)
            if answer is not None:
                break
            server = self._references.referred(server)
        for server in chain:
            self._seen[server] = bool(answer)
        return bool(answer)

    def _look_at_numbers(self, server: Any) -> None:
        """Say which numbers of a paint server are too large: they change the paint, and no outline."""
        attributes = self._source.attributes(server)
        for name in _NUMBERS_OF_SERVERS:
            try:
                check_numbers(attributes.get(name, ""))
            except NumberError as error:
                message = f"{name} has a number that is too large; it changes no outline"
                self._notes.add("bad-number", "info", message, server, attribute=name, offset=error.offset)

    def _has_colour(self, gradient: Any) -> bool | None:
        """Tell whether any stop has opacity; None without stops: then those that its href names count."""
        stops = [child for child in gradient.iterchildren("*") if _local_name(child) == "stop"]
        if not stops:
            return None
        return any(self._stop_paints(stop) for stop in stops)

    def _stop_paints(self, stop: Any) -> bool:
        declared = self._cascade.declared(stop, self._source.attributes(stop), _INITIAL)
        opacity = declared.get("stop-opacity", 1.0)
        return declared.get("stop-color") != NOTHING and not (isinstance(opacity, float) and opacity <= 0)


def _has_content(pattern: Any) -> bool | None:
    return True if len(pattern) else None


def _local_name(element: Any) -> str:
    return str(element.tag).rpartition("}")[2]
