"""The one home of compiler flags: one source, interpreted as it stands or compiled by Numba on request.

``@kernel`` marks a function and leaves it an ordinary Python function, so that importing the kernels costs
nothing and a small run never waits for a compiler. :func:`compiled` gives the machine-code twin of an entry
point; kernels that it calls are compiled with it. No fastmath: both forms give the same bits.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import shutil
import sys
import threading
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

from wallkit.kernels import intrinsics

Function = TypeVar("Function", bound=Callable[..., Any])

KEPT = 4
"""Folders of machine code that stay: this version's, and those last used, for other environments have versions too."""

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
    intrinsics.register()
    options: dict[str, Any] = {"nogil": True, "error_model": "numpy", "_nrt": False}
    theirs = getattr(config, "CACHE_DIR", "")
    setattr(config, "CACHE_DIR", str(cache_folder()))  # noqa: B010 - numba makes its settings at run time
    try:
        return numba.njit(cache=True, **options)(entry)  # type: ignore[no-any-return]
    except RuntimeError:  # numba's word for "no folder can be written"
        return numba.njit(**options)(entry)  # type: ignore[no-any-return]
    finally:
        setattr(config, "CACHE_DIR", theirs)  # noqa: B010


def compile_for(entry: Callable[..., Any], *types: Any) -> None:
    """Compile a kernel for Numba's types of its arguments, or take it from the disk."""
    machine_code: Any = compiled(entry)
    machine_code.compile(types)


def types_of(arguments: tuple[Any, ...]) -> tuple[Any, ...]:
    """Give Numba's types of a kernel's arguments."""
    from numba import typeof

    return tuple(typeof(argument) for argument in arguments)


class NotCompiledError(Exception):
    """Machine code is neither in this process nor on the disk."""


@contextlib.contextmanager
def never_compiling() -> Iterator[None]:
    """Let kernels come from the disk alone, in this thread.

    Raises:
        NotCompiledError: one would have to be compiled.
    """
    from numba.core import event

    here = threading.get_ident()

    class Refusal(event.Listener):
        """Numba looks on the disk first, and says that it compiles just before it does."""

        def on_start(self, event: Any) -> None:
            if threading.get_ident() == here:
                raise NotCompiledError

        def on_end(self, event: Any) -> None:
            """Nothing of ours ever ends."""

    with event.install_listener("numba:compile", Refusal()):
        yield


def _register_all(register: Callable[..., Any]) -> None:
    """Tell Numba of the kernels marked since the last time: some modules are imported after the first compiling."""
    while _marked:
        register(forceinline=True, _nrt=False)(_marked.pop())
    while _rare:
        register(_nrt=False)(_rare.pop())


def cache_folder() -> Path:
    """Give the folder of the machine code of these very kernels."""
    digest = hashlib.sha256()
    folder = Path(__file__).parent
    for path in sorted(folder.rglob("*.py")):  # kernels live in subfolders too
        digest.update(path.relative_to(folder).as_posix().encode() + b"\0" + path.read_bytes())
    own = _cache_home() / f"kernels-{digest.hexdigest()[:16]}"
    _clear_older(own)
    return own


@cache
def _clear_older(own: Path) -> None:
    """Note that a folder of machine code is in use, and remove those of older versions but the ones used last."""
    try:
        own.mkdir(parents=True, exist_ok=True)
        os.utime(own)
        others = sorted((path.stat().st_mtime, path) for path in own.parent.glob("kernels-*") if path != own)
    except OSError:  # nothing can be written there, or another process clears as well
        return
    for _used, folder in others[: max(0, len(others) - (KEPT - 1))]:
        shutil.rmtree(folder, ignore_errors=True)


def _cache_home() -> Path:
    if folder := os.environ.get("WALLKIT_CACHE_DIR"):
        return Path(folder)
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA", Path.home() / "AppData" / "Local")) / "wallkit"
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Caches" / "wallkit"
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "wallkit"
