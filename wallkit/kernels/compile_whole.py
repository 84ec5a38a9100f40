"""Compile a kernel as a whole: Numba translates it and all that it calls, then LLVM optimises it, once.

Numba by itself optimises each function, and makes machine code of it, before the functions that call it: what a kernel
calls would be compiled as often as calls are deep, though all of it is inlined in the end. That took most of the time.
"""

from __future__ import annotations

import contextlib
import gc
from collections.abc import Callable, Iterator
from functools import cache
from typing import Any, NamedTuple

BARE: dict[str, Any] = {"_nrt": False, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
"""Kernels allocate nothing, so that none counts references, and are called by other kernels or by their address."""


class Whole(NamedTuple):
    """A kernel that is compiled.

    Attributes:
        symbol: its name.
        returned: Numba's type of what it returns.
        image: the object file, as bytes.
        module: of LLVM, optimised.
    """

    symbol: str
    returned: Any
    image: bytes
    module: Any


def compile_whole(entry: Callable[..., Any], types: tuple[Any, ...]) -> Whole:
    """Compile a kernel for arguments of Numba's types."""
    import numba

    with _parts_stay_as_they_are(), _no_garbage_collected():
        dispatcher: Any = numba.njit(nogil=True, error_model="numpy", **BARE)(entry)
        dispatcher.compile(types)
        made = dispatcher.overloads[types]
        library = made.library
        module = _linked(library)
        library._optimize_final_module()
        module.verify()
        image = library.codegen._tm.emit_object(module)
    return Whole(made.fndesc.llvm_func_name, made.signature.return_type, image, module)


def _linked(library: Any) -> Any:
    """Link all that a kernel calls into its module, what calls before what is called: others would be left out."""
    from llvmlite.binding import Linkage

    order: list[Any] = []

    def visit(part: Any) -> None:
        if part not in met:
            met.add(part)
            for called in part._linking_libraries:
                visit(called)
            order.append(part)

    met: set[Any] = set()
    visit(library)
    module = library._final_module
    for part in reversed(order[:-1]):
        copy = part._final_module.clone()
        for function in copy.functions:
            if not function.is_declaration and function.linkage == Linkage.external:
                function.linkage = "linkonce_odr"  # gone once it is inlined
        module.link_in(copy)
    return module


@contextlib.contextmanager
def _parts_stay_as_they_are() -> Iterator[None]:
    """Let Numba compile in contexts of ours; there is no other way to say so than to put them in the place of its own.

    Nobody else compiles meanwhile: the lock is Numba's.
    """
    from numba.core.compiler_lock import global_compiler_lock
    from numba.core.registry import cpu_target

    names = ("_toplevel_typing_context", "_toplevel_target_context")
    with global_compiler_lock:
        own = cpu_target.typing_context, cpu_target.target_context
        vars(cpu_target).update(zip(names, _contexts(), strict=True))
        try:
            yield
        finally:
            vars(cpu_target).update(zip(names, own, strict=True))


@cache
def _contexts() -> tuple[Any, Any]:
    """Give Numba's contexts of typing and translating, in which parts are neither optimised nor made ready to run."""
    from numba.core import codegen, cpu
    from numba.core.typing.context import Context as Typing

    class Part(codegen.JITCodeLibrary):
        def finalize(self) -> None:
            self._finalized = True

        def get_pointer_to_function(self, name: str) -> int:
            return 0  # as of what has no wrapper for Python

    class Translating(codegen.JITCPUCodegen):
        _library_class = Part

        def set_env(self, name: str, env: Any) -> None:
            """What is not made ready to run has no environment."""

    class Context(cpu.CPUContext):
        def init(self) -> None:
            super().init()
            self._internal_codegen = Translating("wallkit")

    ours = Typing()
    return ours, Context(ours, "cpu")


@contextlib.contextmanager
def _no_garbage_collected() -> Iterator[None]:
    """What Numba makes is kept anyway: looking through all of it again and again takes a sixth of the time."""
    was = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was:
            gc.enable()
