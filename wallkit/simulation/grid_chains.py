"""Monotone chains: joined edges that no straight flight in a certain octant, or the opposite one, meets twice."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import IntArray
from wallkit.kernels.index.empty_rectangles import MANY
from wallkit.kernels.records import Model


def chains_in_cells(
    model: Model, along: NDArray[np.uint8], numbers: NDArray[Any], ids: NDArray[Any], listing: IntArray
) -> NDArray[np.int32]:
    """For each pair of opposite octants (see ``pair_of``) and cell, the one chain that all its edges belong to.

    Args:
        model: of points.
        along: of each edge, see ``octants_along``.
        numbers: (cells + 1, 4) of cells, see ``Table``.
        ids: that they list.
        listing: the cells that list something.

    Returns:
        By pair and cell the number of the chain, 0 where nothing is listed, MANY where it is of several, or none.
    """
    cells = len(numbers) - 1
    found = np.zeros(4 * cells, dtype=np.int32)
    first = numbers[listing, 0]
    for pair, chain in enumerate(_chains(model, along) if len(listing) else ()):
        listed = chain[ids]
        low = np.minimum.reduceat(listed, first)
        found[pair * cells + listing] = np.where(low == np.maximum.reduceat(listed, first), low, MANY)
    return found


def _chains(model: Model, along: NDArray[np.uint8]) -> Iterator[NDArray[np.int32]]:
    """Number the chains of edges for each pair of opposite octants: by edge, MANY for none.

    The edges of one are joined, of one wall, and all their outward normals lie along all of an octant, or all against
    it. Seen along any flight in that octant or the opposite one it is the graph of a function: a flight meets it once
    at most, so one that leaves it never comes back to it.
    """
    lines, wall = model.lines, model.edge_wall
    ends = np.flatnonzero(np.diff(wall, append=-1))
    starts = np.concatenate([[0], ends[:-1] + 1])
    after = np.arange(1, len(lines) + 1)
    after[ends] = starts
    joined = (lines["bx"] == lines["ax"][after]) & (lines["by"] == lines["ay"][after])
    for octant in (0, 1, 4, 5):
        side = ((along >> octant) & 1).astype(np.int8) - ((along >> (octant ^ 3)) & 1).astype(np.int8)
        goes_on = joined & (side == side[after])
        begins = np.ones(len(lines), dtype=np.bool_)
        begins[1:] = ~goes_on[:-1]
        begins[starts] = True
        chain = np.cumsum(begins, dtype=np.int32)
        round_again = goes_on[ends]
        same = np.arange(len(lines) + 1, dtype=np.int32)
        same[chain[starts[round_again]]] = chain[ends[round_again]]
        yield np.where(side != 0, same[chain], np.int32(MANY))
