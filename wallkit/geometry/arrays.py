"""The arrays that geometry is made of."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def distinct(numbers: IntArray) -> IntArray:
    """Give whole numbers in order, each once.

    numpy.unique without indices asks whether its array is masked, and so imports what makes masked arrays: some 15 ms,
    in a command that is to start at once.
    """
    ordered = np.sort(numbers)
    return ordered[np.flatnonzero(np.diff(ordered, prepend=ordered[:1] - 1))]
