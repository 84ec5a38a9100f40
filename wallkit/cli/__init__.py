"""The command line: one module a command. It talks to people and holds no physics."""

from __future__ import annotations

import atexit
import gc
import os

__all__ = ["main"]

BETWEEN_COLLECTIONS = 100_000
"""New objects after which Python looks for cycles. Modules and what a drawing holds make hundreds of thousands, which
stay: with the usual 700 a tenth of a small command's time went into looking at them."""


def main() -> None:
    """Run the command line; end with 0 fine, 1 findings, 2 unreadable input or usage, 3 a limit, 130 interrupted."""
    # NumPy's algebra begins a thread a core as it is imported, and they wait busily: 0.05 to 0.1 s of a small command
    # on two cores. Commands have no matrices that would need them.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    gc.set_threshold(BETWEEN_COLLECTIONS, *gc.get_threshold()[1:])
    atexit.register(gc.freeze)  # to look for cycles once more as Python ends took a seventh of a small command
    from wallkit.cli.app import run  # from here on much is made

    run()
