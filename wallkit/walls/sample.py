"""Curves as short chords, for what is looked at or measured roughly; walls are made by ``wallkit.walls``."""

from __future__ import annotations

import numpy as np

from wallkit.geometry.arrays import FloatArray
from wallkit.geometry.bulge_arcs import ARC_STEP, arc_points
from wallkit.walls import Walls


def flattened(walls: Walls, index: int, step: float = ARC_STEP) -> FloatArray:
    """Give one wall's points with arcs cut into short chords; a closed wall does not repeat its first point."""
    span = slice(walls.offsets[index], walls.offsets[index + 1])
    vertices, bulges = walls.vertices[span], walls.bulges[span]
    if not bulges.any():
        return vertices
    ends = np.roll(vertices, -1, axis=0)  # the last of an open wall has the bulge 0 and gives its point alone
    return np.concatenate([arc_points(a, b, float(k), step) for a, b, k in zip(vertices, ends, bulges, strict=True)])
