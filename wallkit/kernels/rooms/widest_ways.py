"""How free space hangs together, see ``walls.checking.widest_ways``; arguments are arrays, or lists if interpreted."""

from __future__ import annotations

from wallkit.kernels.jit import kernel


@kernel
def unite(one, two, width, roomy, narrow, least, parent, used, rooms):
    """Unite nodes from the widest way down; the root of a part is the node with its roomiest circle.

    Args:
        one: (n,) the node that each way leads from, the widest way first.
        two: (n,) the node that it leads to.
        width: (n,) of each.
        roomy: (m,) radius of the circle of each node; 0 without one, infinite outside.
        narrow: over a way up to this part as wide as its roomiest circle a room is joined.
        least: smaller circles are no rooms.
        parent: (m,) that of each node, itself at first; written.
        used: (m,) written, the ways that joined what was apart.
        rooms: (3 m,) written, for each room that was joined the way, its root, and the root that it was joined to.

    Returns:
        How many ways are used, and how many rooms were joined.
    """
    joined, found = 0, 0
    for way in range(len(width)):
        a, b = one[way], two[way]
        while parent[a] != a:  # to its root, with the path halved on the way
            parent[a] = parent[parent[a]]
            a = parent[a]
        while parent[b] != b:
            parent[b] = parent[parent[b]]
            b = parent[b]
        if a == b:
            continue
        used[joined] = way
        joined += 1
        if roomy[a] < roomy[b]:
            a, b = b, a
        if 2 * narrow * roomy[b] >= width[way] > 0 and roomy[b] > least:
            rooms[3 * found], rooms[3 * found + 1], rooms[3 * found + 2] = way, b, a
            found += 1
        parent[b] = a
    return joined, found


@kernel
def walk_out(first, other, way, width, count, before, step, narrowest, reached):
    """Walk a tree of nodes from those outside, breadth first.

    Args:
        first: (m + 1,) where the neighbours of each node begin in ``other`` and ``way``.
        other: the neighbours.
        way: the ways that lead to them.
        width: of each way.
        count: how many nodes are outside.
        before: (m,) written, the next node on the way out, -1 at first.
        step: (m,) written, the way that leads there, -1 at first.
        narrowest: (m,) written, width of the narrowest way to the outside: infinite there and 0 elsewhere at first.
        reached: (m,) to work with, the nodes outside first.
    """
    done = 0
    while done < count:
        node = reached[done]
        done += 1
        for k in range(first[node], first[node + 1]):
            beyond = other[k]
            if narrowest[beyond] == 0:
                before[beyond], step[beyond] = node, way[k]
                narrowest[beyond] = min(narrowest[node], width[way[k]])
                reached[count] = beyond
                count += 1
