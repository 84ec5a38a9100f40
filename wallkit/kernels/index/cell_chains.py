"""Monotone chains: joined edges that no straight flight in a certain octant, or the opposite one, meets twice.

The edges of one are joined, of one wall, and all their outward normals lie along all of an octant, or all against it.
Seen along any flight in that octant or the opposite one it is the graph of a function: a flight meets it once at most,
so one that leaves it never comes back to it.
"""

from __future__ import annotations

from wallkit.kernels.impact.arc_impact import is_wide, to_end
from wallkit.kernels.index.cell_entries import ALL_OCTANTS, octants_against
from wallkit.kernels.jit import kernel
from wallkit.kernels.records import OCTANTS

JOINED, ROUND = 1 << OCTANTS, 2 << OCTANTS
"""Bits beside those of octants, see ``_look_along``."""
MANY = -1
"""In place of a chain: what a cell lists is not of one, or none."""


@kernel
def chains_in_cells(lines, arcs, edge_wall, numbers, ids, along, chain, listing, chains):
    """For each pair of opposite octants (see ``pair_of``) and cell, find the one chain that all its edges belong to.

    Args:
        lines: see ``Model``, of points.
        arcs: likewise.
        edge_wall: likewise.
        numbers: four of each cell, see ``Table``, sorted.
        ids: that they list.
        along: (E,) to work with, of 16 bits: the octants that lie along all normals of an edge, and how it is joined.
        chain: (E,) to work with.
        listing: written: the cells that list something.
        chains: written, by pair and cell: the number of the chain, 0 where nothing is listed, MANY where it is of
            several, or none.

    Returns:
        How many cells list something.
    """
    _look_along(lines, arcs, edge_wall, along)
    cells, count = len(numbers) // 4 - 1, 0
    for cell in range(cells):
        if numbers[4 * cell] != numbers[4 * cell + 4]:
            listing[count] = cell
            count += 1
    for pair in range(len(chains) // cells):
        _number_chains(edge_wall, along, octant_of_pair(pair), chain)
        for k in range(count):
            cell = listing[k]
            first = numbers[4 * cell]
            one = chain[ids[first]]
            for at in range(first + 1, numbers[4 * cell + 4]):
                if chain[ids[at]] != one:
                    one = MANY
                    break
            chains[pair * cells + cell] = one
    return count


@kernel
def pair_of(octant):
    """Number the four pairs of opposite octants."""
    # Opposite octants differ in both signs. Their parity, and which component is the larger, name the pair.
    return ((octant ^ (octant >> 1)) & 1) + ((octant >> 2) << 1)


@kernel
def octant_of_pair(pair):
    """The lower one of a pair of octants; the other one differs from it by 3."""
    return (pair & 1) + ((pair >> 1) << 2)


@kernel
def _look_along(lines, arcs, edge_wall, along):
    """Find the octants that lie along all outward normals of each edge: their bits, none for what has no normal.

    Added is JOINED where an edge goes on from the one before, of its wall, and ROUND where the first one goes on from
    it.
    """
    first = 0
    for e in range(len(lines)):
        ux, uy = lines[e].nx, lines[e].ny
        wx, wy = ux, uy
        wide = False
        if arcs is not None:
            if arcs[e].radius > 0.0:
                fx, fy = to_end(arcs[e])
                per = (1.0 if arcs[e].sweep > 0.0 else -1.0) / arcs[e].radius
                ux, uy, wx, wy = per * arcs[e].sx, per * arcs[e].sy, per * fx, per * fy
                wide = is_wide(arcs[e].sweep)
        bits = 0 if wide else ALL_OCTANTS - octants_against(ux, uy, wx, wy)
        if e > 0 and edge_wall[e] == edge_wall[e - 1]:
            bits += JOINED * int((lines[e - 1].bx == lines[e].ax) & (lines[e - 1].by == lines[e].ay))
        else:
            first = e
        # Of the edges of a wall the last one that says so is asked.
        bits += ROUND * int((lines[e].bx == lines[first].ax) & (lines[e].by == lines[first].ay))
        along[e] = bits


@kernel
def _number_chains(edge_wall, along, octant, chain):
    """Number the chains of edges, from 1, for an octant and the opposite one: by edge, MANY for none."""
    first, latest, before = 0, 0, 0
    for e in range(len(edge_wall)):
        bits = int(along[e])
        side = _side(bits, octant)
        if edge_wall[e] != edge_wall[first]:
            first = e
        if bits & JOINED == 0 or side != before:
            latest += 1
        chain[e], before = latest if side > 0 else MANY, side
        ends = e + 1 == len(edge_wall) or edge_wall[e + 1] != edge_wall[first]
        if ends and bits & ROUND != 0 and chain[first] != MANY:
            # The last chain of a closed wall goes on in its first one, if both are on the same side.
            if _side(int(along[first]), octant) == side:
                k = e
                while chain[k] == latest and k > first:
                    chain[k] = chain[first]
                    k -= 1


@kernel
def _side(bits, octant):
    """Tell whether all normals of an edge are along an octant, 1, or against it, 2, or neither, 0."""
    return ((bits >> octant) & 1) + 2 * ((bits >> (octant ^ 3)) & 1)
