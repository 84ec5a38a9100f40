"""Kernels, compiled or interpreted, and what they are given in either case."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from wallkit.kernels.jit import compiled
from wallkit.kernels.records import in_lists


class Kernels:
    """Calls kernels: compiled ones with arrays, interpreted ones with lists, which are several times faster there."""

    def __init__(self, machine_code: bool) -> None:
        self.machine_code = machine_code

    def given(self, value: Any) -> Any:
        """Arrays, or tuples of such, as what kernels read."""
        return value if self.machine_code else in_lists(value)

    def zeros(self, size: int, kind: Any) -> Any:
        """So many zeros to write into."""
        return np.zeros(size, dtype=kind) if self.machine_code else [0] * size

    def room(self, size: int, kind: Any) -> Any:
        """Room for so many numbers, whatever is in it."""
        return np.empty(size, dtype=kind) if self.machine_code else [0] * size

    def run(self, kernel: Callable[..., Any], *arguments: Any) -> Any:
        """Call a kernel."""
        return (compiled(kernel) if self.machine_code else kernel)(*arguments)
