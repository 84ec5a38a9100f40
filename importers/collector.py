"""Python's cycle collector, paused where much is made and nothing is thrown away."""

from __future__ import annotations

import contextlib
import gc
from collections.abc import Iterator


@contextlib.contextmanager
def collector_paused() -> Iterator[None]:
    """Pause the cycle collector: it would look through growing lists over and over, and find nothing.

    What was made meanwhile counts as old, so that it is not looked through at once when the pause is over.
    """
    running = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if running:
            if gc.get_freeze_count() == 0:  # nobody else has put objects aside
                gc.freeze()
                gc.unfreeze()  # to the oldest generation
            gc.enable()
