"""Frame: where a place in the drawing lands on the screen, the right way up."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wallkit.geometry.arrays import FloatArray
from wallkit.walls import Walls
from wallkit.walls.sample import flattened

Box = tuple[float, float, float, float]


@dataclass(frozen=True, slots=True)
class Frame:
    """A map from drawing to screen: x' = left + s (x - x0), y' = top + s (y1 - y) or top + s (y - y0).

    Attributes:
        box: (x_min, y_min, x_max, y_max) of what is shown, in the drawing's units.
        scale: pixels a unit.
        left: pixels left of the box.
        top: pixels above it.
        up: the drawing's y axis points up, so the screen's is turned over.
    """

    box: Box
    scale: float
    left: float
    top: float
    up: bool

    @property
    def width(self) -> float:
        """Pixels that the box is wide."""
        return (self.box[2] - self.box[0]) * self.scale

    @property
    def height(self) -> float:
        """Pixels that the box is high."""
        return (self.box[3] - self.box[1]) * self.scale

    def points(self, points: FloatArray) -> FloatArray:
        """Map (n, 2) places to (n, 2) pixels."""
        result = np.empty_like(points, dtype=np.float64)
        result[:, 0] = self.left + (points[:, 0] - self.box[0]) * self.scale
        rise = self.box[3] - points[:, 1] if self.up else points[:, 1] - self.box[1]
        result[:, 1] = self.top + rise * self.scale
        return result

    def point(self, x: float, y: float) -> tuple[float, float]:
        """Map one place."""
        rise = self.box[3] - y if self.up else y - self.box[1]
        return self.left + (x - self.box[0]) * self.scale, self.top + rise * self.scale


def fit(box: Box, up: bool, *, width: float, max_height: float, margin: float, top: float = 0.0) -> Frame:
    """Make the frame that shows a box as large as width and height allow, centred, with a margin around.

    A box without width or height (a point, an upright line) is given room first, so that the scale is finite.
    """
    x0, y0, x1, y1 = box
    size = max(x1 - x0, y1 - y0)
    # Below the second figure the coordinates themselves are too coarse to show anything of that size.
    least = max(size * 1e-3, 1e-9 * max(map(abs, box)), 1e-300) if size > 0 else max(map(abs, box)) * 1e-3 or 1.0
    grow_x, grow_y = max(0.0, least - (x1 - x0)) / 2, max(0.0, least - (y1 - y0)) / 2
    x0, x1, y0, y1 = x0 - grow_x, x1 + grow_x, y0 - grow_y, y1 + grow_y
    scale = min((width - 2 * margin) / (x1 - x0), (max_height - 2 * margin) / (y1 - y0))
    left = (width - (x1 - x0) * scale) / 2
    return Frame((x0, y0, x1, y1), scale, left, top + margin, up)


def united(boxes: list[Box]) -> Box:
    """Give the smallest box around boxes; the unit square without any."""
    if not boxes:
        return 0.0, 0.0, 1.0, 1.0
    array = np.array(boxes)
    low, high = array[:, :2].min(axis=0), array[:, 2:].max(axis=0)
    return float(low[0]), float(low[1]), float(high[0]), float(high[1])


def walls_box(walls: Walls) -> Box:
    """Give the box around walls, arcs with their bow included (to 0.12 % of their radius)."""
    if not walls.has_arcs:
        return walls.box()
    points = np.concatenate([flattened(walls, index) for index in range(len(walls))])
    low, high = points.min(axis=0), points.max(axis=0)
    return float(low[0]), float(low[1]), float(high[0]), float(high[1])
