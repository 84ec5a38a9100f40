"""What the file says about a wall beyond its shape, and the places that it names."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

ORIGIN_KEYS = ("title", "groups", "fill", "stroke", "tags")


@dataclass(frozen=True, slots=True)
class Origin:
    """Where a wall comes from, in the words of the file; empty for a wall given as numbers.

    Attributes:
        title: what the file calls it to people who look at it.
        groups: names of the groups around it, outermost first.
        fill: its colour, ``"#rrggbb"`` or the name of another paint; None where it is not filled.
        stroke: the same for its outline.
        tags: words that its author gave it, or the groups and the layer around it (docs/tags.md), by key.
    """

    title: str = ""
    groups: tuple[str, ...] = ()
    fill: str | None = None
    stroke: str | None = None
    tags: Mapping[str, str] = field(default_factory=dict)

    @property
    def colour(self) -> str | None:
        """What it is painted with: its fill, or its stroke where it is not filled."""
        return self.fill if self.fill is not None else self.stroke

    def to_json(self) -> dict[str, Any]:
        """Give what there is as optional keys of a wall in the ``wallkit-walls`` format."""
        told: dict[str, Any] = {
            "title": self.title,
            "groups": list(self.groups),
            "fill": self.fill,
            "stroke": self.stroke,
            "tags": dict(self.tags),
        }
        return {key: value for key, value in told.items() if value}

    @staticmethod
    def of_json(entry: Mapping[str, Any]) -> Origin:
        """Read the optional keys of a wall.

        Raises:
            TypeError: a key holds something else than text, or a table or list of texts.
        """
        title, groups, tags = entry.get("title", ""), entry.get("groups", []), entry.get("tags", {})
        fill, stroke = entry.get("fill"), entry.get("stroke")
        if not isinstance(groups, list) or not isinstance(tags, dict):
            raise TypeError("groups is a list of texts, tags a table of texts")
        if not all(isinstance(word, str) for word in (title, *groups, *tags.values(), fill or "", stroke or "")):
            raise TypeError("title, groups, fill, stroke and tags are texts")
        if not (title or groups or tags or fill or stroke):
            return NOWHERE
        return Origin(title, tuple(groups), fill, stroke, tags)


NOWHERE = Origin()
"""Of a wall given as numbers."""

MarkerKind = Literal["spawn", "target"]


@dataclass(frozen=True, slots=True)
class Marker:
    """A named place of the level.

    Attributes:
        kind: ``"spawn"``, where a ball starts if none is drawn; ``"target"``, the middle of a sensor to be reached.
        name: given by its word (``spawn:left``), or that of its object.
        x: of its middle.
        y: of its middle.
        radius: of the circle that is drawn there; 0 for anything else.
    """

    kind: MarkerKind
    name: str
    x: float
    y: float
    radius: float = 0.0

    def to_json(self) -> dict[str, Any]:
        """Give it as the ``wallkit-walls`` format has it."""
        return {"kind": self.kind, "name": self.name, "x": self.x, "y": self.y, "radius": self.radius}

    @staticmethod
    def of_json(entry: Mapping[str, Any]) -> Marker:
        """Read one.

        Raises:
            ValueError: the kind is none, or a number is not finite.
        """
        if entry["kind"] not in ("spawn", "target"):
            raise ValueError(f"a marker's kind is {entry['kind']!r}, not spawn or target")
        x, y, radius = float(entry["x"]), float(entry["y"]), float(entry.get("radius", 0))
        if not all(map(math.isfinite, (x, y, radius))):
            raise ValueError(f"a marker is at {x}, {y} with radius {radius}")
        return Marker(entry["kind"], str(entry.get("name", "")), x, y, radius)
