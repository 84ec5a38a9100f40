"""Work that threads share out among themselves."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import Executor, ThreadPoolExecutor
from functools import cache
from typing import TypeVar

Result = TypeVar("Result")


def in_threads(work: Callable[[], Result], threads: int, executor: Executor | None = None) -> list[Result]:
    """Run the same work in several threads at once, the calling one among them: what each gave.

    Args:
        work: takes what is left to do from where all threads find it, and ends when nothing is.
        threads: how many; those that find no room before all is done are left out.
        executor: threads to use instead of our own; the calling one waits.
    """
    if executor is not None:
        return [future.result() for future in [executor.submit(work) for _ in range(threads)]]
    helpers = [_helpers().submit(work) for _ in range(threads - 1)]
    own = work()
    return [own, *(helper.result() for helper in helpers if not helper.cancel())]


@cache
def cores() -> int:
    """Processors of this machine: asked once, for the answer takes a while."""
    return os.cpu_count() or 1


@cache
def _helpers() -> ThreadPoolExecutor:
    """Threads that stay: to start some takes as long as a small survey. They are made when they are needed."""
    return ThreadPoolExecutor(max_workers=1024, thread_name_prefix="wallkit")


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_helpers.cache_clear)  # threads do not come along
