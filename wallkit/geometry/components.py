"""What hangs together: nodes that links lead between."""

from __future__ import annotations

import numpy as np

from wallkit.geometry.arrays import IntArray


def components(one: IntArray, two: IntArray, count: int) -> IntArray:
    """For each of ``count`` nodes the least that links, (n,) from ``one`` to ``two``, lead to from it: (count,).

    All at once, in some log(count) rounds: each root that a link leads from hangs itself below the least root that
    it leads to, and then every node below its root (Y. Shiloach and U. Vishkin, 1982).
    """
    root = np.arange(count)
    while True:
        a, b = root[one], root[two]
        apart = a != b
        if not apart.any():
            return root
        one, two, a, b = one[apart], two[apart], a[apart], b[apart]
        np.minimum.at(root, np.maximum(a, b), np.minimum(a, b))
        while (root[root] != root).any():
            root = root[root]
