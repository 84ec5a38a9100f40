"""The one home of compiler flags: one source, interpreted as it stands or compiled by Numba on request.

``@kernel`` marks a function and leaves it an ordinary Python function, so that importing the kernels costs
nothing and a small run never waits for a compiler. :func:`compiled` gives the machine-code twin of an entry
point; kernels that it calls are compiled with it. No fastmath: both forms give the same bits.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

Function = TypeVar("Function", bound=Callable[..., Any])

_marked: list[Callable[..., Any]] = []


def kernel(function: Function) -> Function:
    """Mark a function of floats and arrays as one that may be compiled."""
    _marked.append(function)
    return function
