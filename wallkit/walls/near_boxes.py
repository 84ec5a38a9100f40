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
_ROOM = 8
"""Pairs a question that there is room for at first."""


class NearBoxes(BoxTree):
    """A tree of boxes that asks a compiled kernel where it is large, once that is compiled."""

    def query(self, low: FloatArray, high: FloatArray) -> tuple[IntArray, IntArray]:
        """Pairs of a box in question, (2, m) corners, and a box of the tree that meet, both rising."""
        return self.by_kernel(low, high) if self._is_large() else super().query(low, high)

    def among(self, first: int, stop: int) -> tuple[IntArray, IntArray]:
        """The same for the boxes of the tree itself from the number ``first`` to before ``stop``."""
        if not self._is_large():
            return super().among(first, stop)
        question, box = self.by_kernel(self.low[:, first:stop], self.high[:, first:stop])
        return question + first, box

    def _is_large(self) -> bool:
        return self.low.shape[1] >= _KERNEL_PAYS and at_hand(ask_a_few)

    def by_kernel(self, low: FloatArray, high: FloatArray) -> tuple[IntArray, IntArray]:
        """Answer questions about boxes, (2, m) corners: pairs, both rising."""
        low, high = np.ascontiguousarray(low), np.ascontiguousarray(high)
        state, waiting = np.zeros(3, dtype=np.int64), np.empty((2, WIDTH * DEEPEST), dtype=np.int64)
        none = np.empty(0, dtype=np.int64)
        room, questions, boxes = _ROOM * low.shape[1] + WIDTH, [none], [none]
        while state[0] < low.shape[1]:
            question, box = np.empty(room, dtype=np.int64), np.empty(room, dtype=np.int64)
            state[1] = 0
            compiled(boxes_met)(*self._packed, self._order, low, high, state, waiting, question, box)
            questions.append(question[: state[1]])
            boxes.append(box[: state[1]])
            room *= 2
        question, box = np.concatenate(questions), np.concatenate(boxes)
        if state[2]:
            key = np.sort(question * len(self._order) + box)
            question, box = np.divmod(key, len(self._order))
        return question, box

    @cached_property
    def _packed(self) -> tuple[FloatArray, IntArray]:
        """The boxes of all levels in one array, and the first row of each level."""
        corners = np.concatenate([np.stack(level.corners, axis=1) for level in self._levels])
        return corners, np.cumsum([0, *(level.rows for level in self._levels[:-1])])


def ask_a_few() -> None:
    """Ask a tree by the kernel: the task of its compiling."""
    low = np.arange(2.0 * WIDTH).reshape(2, WIDTH)
    NearBoxes(low, low).by_kernel(low, low)
