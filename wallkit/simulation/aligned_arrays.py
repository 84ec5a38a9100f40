"""Arrays that begin where a line of the processor's cache does."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

CACHE_LINE = 64
"""Bytes in a line of the cache, and in the longest vector."""


def on_cache_lines(count: int, kind: Any) -> NDArray[Any]:
    """Make room for records, or numbers, whatever is in it: what is no longer than a line then lies in one."""
    size = count * np.dtype(kind).itemsize
    room = np.empty(size + CACHE_LINE, dtype=np.uint8)
    first = -room.ctypes.data % CACHE_LINE
    return room[first : first + size].view(kind)
