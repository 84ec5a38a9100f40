"""One source, interpreted as it stands or compiled on request.

``@kernel`` marks a function and leaves it an ordinary Python function, so that importing the kernels costs
nothing and a small run never waits for a compiler. :func:`compiled` gives the machine-code twin of an entry
point; kernels that it calls are compiled with it. No fastmath: both forms give the same bits.
"""

from __future__ import annotations

import contextlib
import os
import shutil
import sys
import threading
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

from wallkit.kernels.machine_code import (
    Code,
    alone,
    file_of,
    loaded,
    needs_of,
    processor,
    read,
    sources,
    write,
)
from wallkit.kernels.marks import ALONE, CALLED, INLINE
from wallkit.kernels.shipped_code import shipped_folders
from wallkit.kernels.signatures import Kind, Told, taken

Function = TypeVar("Function", bound=Callable[..., Any])

KEPT = 4
"""Folders of machine code that stay: this version's, and those last used, for other environments have versions too."""

_marks: dict[Callable[..., Any], str] = {}
_compiling, _loading = threading.Lock(), threading.Lock()
_refusing = threading.local()


def kernel(function: Function) -> Function:
    """Mark a function of floats and arrays as one that may be compiled."""
    _marks[function] = INLINE
    return function


def rare_kernel(function: Function) -> Function:
    """Mark a kernel that is seldom called: it stays a call, which keeps compiling short."""
    _marks[function] = CALLED
    return function


def pass_kernel(function: Function) -> Function:
    """Mark a kernel that is a loop over many balls: vector instructions serve it best where it is optimised alone."""
    _marks[function] = ALONE
    return function


class MachineCode:
    """The machine-code twin of a kernel: the first call with arguments of new kinds compiles, or loads from disk."""

    def __init__(self, entry: Callable[..., Any]) -> None:
        self._entry = entry
        self._ready: dict[tuple[Kind, ...], Callable[..., Any]] = {}

    def __call__(self, *arguments: Any) -> Any:
        """Call it, without the interpreter's lock; kernels take what lies in memory as they find it."""
        kinds, words = taken(arguments)
        return (self._ready.get(kinds) or self.make_ready(kinds))(words)

    def make_ready(self, kinds: tuple[Kind, ...]) -> Callable[..., Any]:
        """Compile for arguments of these kinds, or load what was; give what takes their words.

        Raises:
            NotCompiledError: where nothing may be compiled, see :func:`never_compiling`.
        """
        for folder in _folders():
            if (code := read(file_of(folder, self._entry, kinds))) is not None:
                return self._load(code, kinds)
        if getattr(_refusing, "now", False):
            raise NotCompiledError
        file = file_of(own_folder(), self._entry, kinds)
        with _compiling:
            if kinds not in self._ready:  # no other thread has compiled it meanwhile
                _tell_once(cache_folder())
                with alone(file):
                    if (code := read(file)) is None:  # nor another process
                        code = _compile(self._entry, kinds)
                        write(file, code)
                self._load(code, kinds)
            return self._ready[kinds]

    def _load(self, code: Code, kinds: tuple[Kind, ...]) -> Callable[..., Any]:
        with _loading:
            if kinds not in self._ready:
                self._ready[kinds] = loaded(code, kinds)
            return self._ready[kinds]


def _folders() -> Iterator[Path]:
    """Give the folders in which machine code may lie: those of the wheel, then the user's, which need not be there."""
    yield from shipped_folders()
    yield own_folder()


def own_folder() -> Path:
    """Give the folder of what is compiled here; of one cache, several kinds of machines may have their own."""
    return cache_folder() / processor()


@cache
def _tell_once(folder: Path) -> None:
    """Tell whoever sits at a terminal what is waited for."""
    if sys.stderr is None or not sys.stderr.isatty():
        return
    kept = f"once: they are kept in {folder}" if os.access(folder, os.W_OK) else f"each time: {folder} is not writable"
    print(f"wallkit: compiling kernels for what this scene has, some seconds, {kept}", file=sys.stderr)


@cache
def compiled(entry: Callable[..., Any]) -> Callable[..., Any]:
    """Give the machine-code twin of a kernel; the first call of a new signature compiles, or loads from disk.

    What does not come with the wheel is kept in a folder named by a digest of all kernel sources, for a kernel changes
    with those that it calls. ``WALLKIT_CACHE_DIR`` moves it; where no folder can be written, compiled code lasts as
    long as the process.
    With ``WALLKIT_INTERPRET`` set there is none, and the kernel itself is called.
    """
    if os.environ.get("WALLKIT_INTERPRET", "0") not in ("", "0"):
        return lambda *arguments: entry(*(one.value if isinstance(one, Told) else one for one in arguments))
    return _twins.setdefault(entry, MachineCode(entry))  # one for all threads, which a cache alone does not promise


_twins: dict[Callable[..., Any], MachineCode] = {}


def _compile(entry: Callable[..., Any], kinds: tuple[Kind, ...]) -> Code:
    """Compile a kernel, with what takes its words."""
    from wallkit.kernels.compiler.whole import compile_whole

    made = compile_whole(entry, kinds, _marks)
    return Code(made.symbol, made.result, made.image, needs_of(made.module))


def compile_for(entry: Callable[..., Any], *kinds: Kind) -> None:
    """Compile a kernel for arguments of some kinds, or take it from the disk."""
    if isinstance(twin := compiled(entry), MachineCode):
        twin.make_ready(kinds)


class NotCompiledError(Exception):
    """Machine code is neither in this process nor on the disk."""


@contextlib.contextmanager
def never_compiling() -> Iterator[None]:
    """Let kernels come from the disk alone, in this thread.

    Raises:
        NotCompiledError: one would have to be compiled.
    """
    before = getattr(_refusing, "now", False)
    _refusing.now = True
    try:
        yield
    finally:
        _refusing.now = before


def cache_folder() -> Path:
    """Give the folder of the machine code of these very kernels."""
    own = _cache_home() / f"kernels-{sources()}"
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
