"""Monotone chains: joined edges that no straight flight in a certain octant, or the opposite one, meets twice.

The edges of one are joined, of one wall, and all their outward normals lie along all of an octant, or all against it.
Seen along any flight in that octant or the opposite one it is the graph of a function: a flight meets it once at most,
so one that leaves it never comes back to it.
"""

from __future__ import annotations

from wallkit.kernels.impact.arc_impact import is_wide, to_end
from wallkit.kernels.index.cell_entries import ALL_OCTANTS, octants_against
from wallkit.kernels.jit import kernel

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
        along: (E,) to work with: the octants that lie along all normals of an edge.
        chain: (E,) to work with.
        listing: written: the cells that list something.
        chains: written, by pair and cell: the number of the chain, 0 where nothing is listed, MANY where it is of
            several, or none.

    Returns:
        How many cells list something.
    """
    _octants_along(lines, arcs, along)
    cells, count = len(numbers) // 4 - 1, 0
    for cell in range(cells):
        if numbers[4 * cell] != numbers[4 * cell + 4]:
            listing[count] = cell
            count += 1
    for pair in range(4):
        _number_chains(lines, edge_wall, along, octant_of_pair(pair), chain)
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
def _octants_along(lines, arcs, along):
    """Find the octants that lie along all outward normals of each edge: their bits, none for what has no normal."""
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
        along[e] = 0 if wide else ALL_OCTANTS - octants_against(ux, uy, wx, wy)


@kernel
def _number_chains(lines, edge_wall, along, octant, chain):
    """Number the chains of edges, from 1, for an octant and the opposite one: by edge, MANY for none."""
    start, latest = 0, 0
    for e in range(len(lines)):
        if e > start and edge_wall[e] != edge_wall[start]:
            start = e
        goes_on = e > start and _goes_on(lines, along, octant, e - 1, e)
        latest += 0 if goes_on else 1
        chain[e] = latest
        ends = e + 1 == len(lines) or edge_wall[e + 1] != edge_wall[start]
        if ends and chain[start] != latest and _goes_on(lines, along, octant, e, start):
            # The last chain of a closed wall goes on in its first one.
            k = e
            while chain[k] == latest:
                chain[k] = chain[start]
                k -= 1
    for e in range(len(lines)):
        if _side(along[e], octant) == 0:
            chain[e] = MANY


@kernel
def _goes_on(lines, along, octant, before, after):
    """Tell whether an edge is joined to the one before, and on the same side."""
    joined = (lines[before].bx == lines[after].ax) & (lines[before].by == lines[after].ay)
    return joined and _side(along[before], octant) == _side(along[after], octant)


@kernel
def _side(along, octant):
    """1 for an edge whose normals lie along an octant, -1 for one whose normals lie against it, else 0."""
    return ((int(along) >> octant) & 1) - ((int(along) >> (octant ^ 3)) & 1)
