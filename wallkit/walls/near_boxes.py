"""A tree of very many boxes, asked by a compiled kernel: the same pairs as by NumPy, in a fraction of the time."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.box_tree import BoxTree
from wallkit.kernels.compile_aside import at_hand
from wallkit.kernels.index.box_pairs import DEEPEST, WIDTH, boxes_met
from wallkit.kernels.jit import compiled

_KERNEL_PAYS = 1 << 14
"""Boxes of a tree that take NumPy longer than a kernel that has to be loaded."""
_ROOM = 4
"""Pairs a question that there is room for at first."""


class NearBoxes(BoxTree):
    """A tree of boxes that asks a compiled kernel where it is large, once that is compiled."""

    def _answers(self, asked: IntArray, low: FloatArray, high: FloatArray) -> tuple[IntArray, IntArray]:
        if self.low.shape[1] < _KERNEL_PAYS or not at_hand(ask_a_few):
            return super()._answers(asked, low, high)
        return self.by_kernel(asked, low, high)

    def by_kernel(self, asked: IntArray, low: FloatArray, high: FloatArray) -> tuple[IntArray, IntArray]:
        """Answer questions of the numbers ``asked`` (m,) about boxes, (2, m) corners: pairs, both rising."""
        low, high = np.ascontiguousarray(low), np.ascontiguousarray(high)
        state, waiting = np.zeros(2, dtype=np.int64), np.empty((2, WIDTH * DEEPEST), dtype=np.int64)
        meets = np.empty(WIDTH, dtype=np.bool_)
        room, found = _ROOM * len(asked) + WIDTH, [np.empty(0, dtype=np.int64)]
        while state[0] < len(asked):
            question, place = np.empty(room, dtype=np.int64), np.empty(room, dtype=np.int64)
            state[1] = 0
            compiled(boxes_met)(*self._packed, low, high, state, waiting, meets, question, place)
            question, place = question[: state[1]], place[: state[1]]
            found.append(asked[question] * len(self._order) + self._order[place])
            room *= 2
        key = np.sort(np.concatenate(found))
        which = key // len(self._order)
        return which, key - which * len(self._order)

    @cached_property
    def _packed(self) -> tuple[FloatArray, IntArray]:
        """The boxes of all levels in one array, and the first row of each level."""
        corners = np.concatenate([np.stack(level.corners, axis=1) for level in self._levels])
        return corners, np.cumsum([0, *(level.rows for level in self._levels[:-1])])


def ask_a_few() -> None:
    """Ask a tree by the kernel: the task of its compiling."""
    low = np.arange(2.0 * WIDTH).reshape(2, WIDTH)
    NearBoxes(low, low).by_kernel(np.arange(WIDTH), low, low)
