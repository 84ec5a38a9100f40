"""The one home of compiler flags: one source, interpreted as it stands or compiled by Numba on request.

``@kernel`` marks a function and leaves it an ordinary Python function, so that importing the kernels costs
nothing and a small run never waits for a compiler. :func:`compiled` gives the machine-code twin of an entry
point; kernels that it calls are compiled with it. No fastmath: both forms give the same bits.
"""

from __future__ import annotations

import hashlib
import os
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

Function = TypeVar("Function", bound=Callable[..., Any])

_marked: list[Callable[..., Any]] = []
_rare: list[Callable[..., Any]] = []


def kernel(function: Function) -> Function:
    """Mark a function of floats and arrays as one that may be compiled."""
    _marked.append(function)
    return function


def rare_kernel(function: Function) -> Function:
    """Mark a kernel that is seldom called: it stays a call, which keeps compiling short."""
    _rare.append(function)
    return function


def claim(counter: Any, count: int) -> int:
    """Take the next ``count`` numbers of a counter in an array, which threads may share: the first of them."""
    first = int(counter[0])
    counter[0] += count
    return first


def prefetch(_records: Any, _place: int) -> None:
    """Ask memory for an item of an array that is read soon, so that machine code need not wait for it then.

    It changes no result, and the place may be anywhere, also beyond the array.
    """


@cache
def compiled(entry: Callable[..., Any]) -> Callable[..., Any]:
    """Give the machine-code twin of a kernel; the first call of a new signature compiles, or loads from disk.

    Numba's cache notices an edited entry point, but not an edited kernel that it calls from another file, so
    the cache lives in a folder named by a digest of all kernel sources. ``WALLKIT_CACHE_DIR`` moves it; where
    no folder can be written, compiled code lasts as long as the process.
    """
    import numba  # no kernel allocates, so none counts references (_nrt): that alone is a factor of two
    from numba import config
    from numba.extending import register_jitable

    _register_all(register_jitable)
    _register_instructions()
    options: dict[str, Any] = {"nogil": True, "error_model": "numpy", "_nrt": False}
    theirs = getattr(config, "CACHE_DIR", "")
    setattr(config, "CACHE_DIR", str(_cache_folder()))  # noqa: B010 - numba makes its settings at run time
    try:
        return numba.njit(cache=True, **options)(entry)  # type: ignore[no-any-return]
    except RuntimeError:  # numba's word for "no folder can be written"
        return numba.njit(**options)(entry)  # type: ignore[no-any-return]
    finally:
        setattr(config, "CACHE_DIR", theirs)  # noqa: B010


def _register_all(register: Callable[..., Any]) -> None:
    """Tell Numba of the kernels marked since the last time: some modules are imported after the first compiling."""
    while _marked:
        register(forceinline=True, _nrt=False)(_marked.pop())
    while _rare:
        register(_nrt=False)(_rare.pop())


@cache
def _register_instructions() -> None:
    """Let machine code do by one instruction what Python cannot.

    It counts without a gap between reading and writing, so that no two threads take the same number, and asks memory
    for what it reads later.
    """
    from llvmlite import ir
    from numba import types
    from numba.core import cgutils
    from numba.extending import intrinsic, overload
    from numba.np.arrayobj import make_array

    def data_of(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        return make_array(signature.args[0])(context, builder, values[0]).data

    @intrinsic
    def fetch_and_add(_context: Any, counter: Any, _count: Any) -> Any:
        def emit(context: Any, builder: Any, signature: Any, values: Any) -> Any:
            place = data_of(context, builder, signature, values)
            return builder.atomic_rmw("add", place, values[1], "monotonic")

        return types.int64(counter, types.int64), emit

    @intrinsic
    def ask(_context: Any, records: Any, _place: Any) -> Any:
        def emit(context: Any, builder: Any, signature: Any, values: Any) -> Any:
            word, byte = ir.IntType(32), ir.IntType(8).as_pointer()
            kind = ir.FunctionType(ir.VoidType(), [byte, word, word, word])
            function = cgutils.get_or_insert_function(builder.module, kind, "llvm.prefetch")
            place = builder.gep(data_of(context, builder, signature, values), [values[1]])
            builder.call(function, [builder.bitcast(place, byte), word(0), word(3), word(1)])
            return context.get_dummy_value()

        return types.none(records, types.uint64), emit

    def stand_in(function: Callable[..., Any], instruction: Any) -> None:
        options: Any = {"forceinline": True, "_nrt": False}

        @overload(function, jit_options=options)
        def _chosen(array: Any, number: int) -> Any:
            def at_once(array: Any, number: int) -> Any:
                return instruction(array, number)

            return at_once

    stand_in(claim, fetch_and_add)
    stand_in(prefetch, ask)


def _cache_folder() -> Path:
    digest = hashlib.sha256()
    for path in sorted(Path(__file__).parent.glob("*.py")):
        digest.update(path.read_bytes())
    return _cache_home() / f"kernels-{digest.hexdigest()[:16]}"


def _cache_home() -> Path:
    if folder := os.environ.get("WALLKIT_CACHE_DIR"):
        return Path(folder)
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA", Path.home() / "AppData" / "Local")) / "wallkit"
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Caches" / "wallkit"
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "wallkit"
