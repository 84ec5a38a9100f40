"""Bounds: what one question of the page may cost, in one place, and how a process is held to them."""

from __future__ import annotations

import contextlib
import sys
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True, slots=True)
class Bounds:
    """What a worker's answer may cost.

    Attributes:
        seconds: of one answer, counted from when the worker begins it; None for no bound.
        memory: bytes that a worker may take beyond what it has when it starts. Kept where the system has such a
            limit for address space (Linux); elsewhere the time alone is bounded.
    """

    seconds: float | None
    memory: int = 2 * 2**30


HEAVY = Bounds(20.0)
"""Of files that are opened, imports, long runs and what is saved."""
LIGHT = Bounds(20.0)
"""Of what is asked while somebody aims."""
LIGHT_CONTACTS = 1_000
"""A run of at most so many contacts, of all balls together, is light; aiming asks for 24."""
TICK = 0.05
"""Seconds between two looks at whether the asker is still there."""
PAUSE = 0.5
"""Seconds until a question is asked again that waits for a compiler."""


def hold_memory(more: int) -> None:
    """Let this process take so many bytes of address space beyond what it has; nothing where that cannot be said."""
    if sys.platform != "linux":
        return
    import resource

    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0])
    limit = pages * resource.getpagesize() + more
    _, hard = resource.getrlimit(resource.RLIMIT_AS)
    if hard != resource.RLIM_INFINITY:
        limit = min(limit, hard)
    with contextlib.suppress(ValueError, OSError):  # a system that refuses leaves the bound on time
        resource.setrlimit(resource.RLIMIT_AS, (limit, hard))


def in_words(memory: int) -> str:
    """Give ``2 GiB`` or ``300 MiB``."""
    return f"{memory / 2**30:g} GiB" if memory >= 2**30 else f"{memory / 2**20:.0f} MiB"
