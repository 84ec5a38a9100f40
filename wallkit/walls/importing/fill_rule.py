"""Fill rules: which rings of a painted path are edges of its material."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from importers.problems import Problem
from wallkit.geometry.arrays import IntArray
from wallkit.walls.copies import copies
from wallkit.walls.edge_tree import Edges
from wallkit.walls.importing.outlines import Outlines
from wallkit.walls.nesting import depths


def material_rings(outlines: Outlines, edges: Edges, crossing: IntArray) -> tuple[NDArray[np.bool_], list[Problem]]:
    """Mark what stays a wall: all but the rings of nonzero-filled paths with paint on both sides.

    The winding number just inside a ring is that outside plus the ring's own turn; there is paint where it is
    not 0. With the even-odd rule every ring parts paint from none. Rings that cross each other are left to
    repair.

    Args:
        outlines: as drawn, not turned yet.
        edges: their straight edges.
        crossing: (n, 2) pairs of outlines that cross.
    """
    keep = np.ones(len(outlines), dtype=np.bool_)
    rings = _in_question(outlines)
    if not rings.any():
        return keep, []
    whole = copies(edges, outlines.closed & (np.diff(outlines.offsets) >= 3))
    rings &= ~np.isin(whole, whole[crossing])  # a copy crosses what the first one does
    depth, parent = depths(edges, crossing, outlines.owner)
    area = edges.areas
    first = copies(edges, rings, outlines.owner)
    turns = np.zeros(len(outlines), dtype=np.int64)
    np.add.at(turns, first[rings], np.sign(area[rings]).astype(np.int64))
    inside = np.zeros(len(outlines), dtype=np.int64)
    for level in range(int(depth[rings].max(initial=-1)) + 1):
        rows = np.flatnonzero(rings & (depth == level))
        outside = np.where(parent[rows] >= 0, inside[parent[rows]], 0)
        inside[rows] = outside + turns[first[rows]]
        keep[rows] = (inside[rows] != 0) != (outside != 0)
    problems = [
        outlines.problem(
            index,
            "inside-fill",
            "info",
            "a ring of a filled path has paint on both sides: no wall (fill rule nonzero)",
            "reverse the ring, or use the even-odd fill rule, if it should be a hole",
        )
        for index in np.flatnonzero(~keep).tolist()
    ]
    return keep, problems


def _in_question(outlines: Outlines) -> NDArray[np.bool_]:
    """Closed outlines of nonzero-filled paths that have several."""
    nonzero = np.array([p.fill is not None and p.fill_rule == "nonzero" for p in outlines.paths], dtype=np.bool_)
    several = np.bincount(outlines.owner[outlines.closed], minlength=len(outlines.paths)) > 1
    return outlines.closed & (nonzero & several)[outlines.owner] if len(outlines) else outlines.closed.copy()
