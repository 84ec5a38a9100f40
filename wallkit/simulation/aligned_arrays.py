"""Memory of arrays: those that begin where a line of the processor's cache does, and what is freed and taken again."""

from __future__ import annotations

from functools import cache
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


FREED = 1 << 22
"""Bytes that an index of some ten thousand edges takes, with what it is made in."""


@cache
def keep_freed_memory() -> None:
    """Let the allocator keep as much as FREED for what comes next, once in a process.

    GNU's malloc returns freed memory to the system beyond twice the largest block that it has mapped alone and freed
    (mallopt(3), M_TRIM_THRESHOLD). To take it again costs a page fault for each 4 KiB, 0.2 to 2 us: up to a fifth of a
    survey that makes its index. So one block is mapped and freed, which is never touched and so never takes memory.
    """
    np.empty(FREED, dtype=np.uint8)
