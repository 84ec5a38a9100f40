"""Sorting within kernels."""

from __future__ import annotations

from wallkit.kernels.jit import kernel


@kernel
def put_in_order(values, first, stop):
    """Sort a few values, or ones that are nearly in order, from ``first`` to before ``stop``: by insertion."""
    for k in range(first + 1, stop):
        value, at = values[k], k
        while (at > first) and (values[at - 1] > value):
            values[at] = values[at - 1]
            at -= 1
        values[at] = value
