"""A kernel and all that it calls as one module of LLVM, which is optimised once and becomes machine code once.

Left alone, Numba makes machine code of each function that a kernel calls, and links what is optimised already into each
of its callers, which optimise it again: as often as calls are deep. Here the kernels that are called are only lowered;
passes over many balls alone are optimised before: in the midst of their callers vector instructions serve them less.
"""

from __future__ import annotations

import contextlib
import gc
import operator
from collections.abc import Callable, Iterator
from functools import cache
from typing import Any, NamedTuple

import numba
from numba.core import ir, types
from numba.core.codegen import CodeLibrary, JITCodeLibrary, JITCPUCodegen
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import FunctionPass, register_pass
from numba.core.untyped_passes import RewriteSemanticConstants

BARE: dict[str, Any] = {"_nrt": False, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
"""Kernels allocate nothing, so that none counts references, and are called by other kernels or by their address."""


class Part(JITCodeLibrary):
    """A kernel as Numba has lowered it."""

    def add_linking_library(self, library: CodeLibrary) -> None:
        """Note what this calls, and leave it as it is."""
        self._linking_libraries.append(library)

    def get_pointer_to_function(self, _name: str) -> int:
        """Give no address: Numba asks for that of a wrapper for Python, which kernels have none of."""
        return 0


class PassPart(Part):
    """A kernel that is a pass over many balls: it is optimised by itself before it is linked."""

    whole = False


class PartsCodegen(JITCPUCodegen):
    """The processor as Numba knows it, and parts in place of its libraries."""

    def set_env(self, _name: str, _environment: Any) -> None:
        """Keep nothing for exceptions and Python objects, which kernels have none of."""


_codegen = cache(lambda: PartsCodegen("wallkit"))


@register_pass(mutates_CFG=False, analysis_only=False)
class AnswerPresent(FunctionPass):
    """Answer ``x is None`` for arguments that are not None, so that what is for scenes without them is dropped.

    Numba itself answers it for those that are None; else it types and compiles both branches, and LLVM drops one.
    """

    _name = "wallkit_answer_present"

    def __init__(self) -> None:
        """Do nothing: Numba's own is abstract."""

    def run_pass(self, state: Any) -> bool:
        """Put constants in the place of such comparisons: whether there were any."""
        definitions = state.func_ir._definitions
        found = list(_comparisons_with_none(state.func_ir, definitions))
        for statement, argument in found:
            if isinstance(state.args[argument], types.NoneType | types.Optional | types.Omitted):
                continue
            answer = ir.Const(statement.value.fn is operator.is_not, loc=statement.loc)
            definitions[statement.target.name] = [answer]
            statement.value = answer
        return bool(found)


def _comparisons_with_none(func_ir: Any, definitions: dict[str, list[Any]]) -> Iterator[tuple[Any, int]]:
    """Give each assignment of ``x is None`` or ``x is not None`` with which argument x is."""
    for block in func_ir.blocks.values():
        for statement in block.find_insts(ir.Assign):
            value = statement.value
            if not (isinstance(value, ir.Expr) and value.op == "binop" and value.fn in (operator.is_, operator.is_not)):
                continue
            asked, other = (definitions[side.name] for side in (value.lhs, value.rhs))
            is_none = len(other) == 1 and isinstance(other[0], ir.Const) and other[0].value is None
            if is_none and len(asked) == 1 and isinstance(asked[0], ir.Arg):
                yield statement, asked[0].index


class PartCompiler(CompilerBase):
    """Numba's compiler of a kernel: it lowers it, and goes no further."""

    library = Part

    def define_pipelines(self) -> list[Any]:
        """Give Numba's own passes and ours; what they make goes into a part."""
        self.state.library = self.library(_codegen(), self.state.func_id.func_qualname)
        passes = DefaultPassBuilder.define_nopython_pipeline(self.state)
        passes.add_pass_after(AnswerPresent, RewriteSemanticConstants)  # next comes what drops dead branches
        passes.finalize()
        return [passes]


class PassCompiler(PartCompiler):
    """The same for a kernel that is a pass."""

    library = PassPart


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


def compile_whole(entry: Callable[..., Any], kinds: tuple[Any, ...]) -> Whole:
    """Compile a kernel, with all that it calls, for arguments of Numba's types."""
    with _no_garbage_collected():
        dispatcher: Any = numba.njit(nogil=True, error_model="numpy", pipeline_class=PartCompiler, **BARE)(entry)
        dispatcher.compile(kinds)
        made = dispatcher.overloads[kinds]
        _link(made.library)
        module = made.library._final_module
        image = made.library._codegen._tm.emit_object(module)
    return Whole(made.fndesc.llvm_func_name, made.signature.return_type, image, module)


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


def _link(library: Part) -> None:
    """Link what a part calls into its module, and optimise that."""
    module = library._final_module
    own = {function.name for function in module.functions if not function.is_declaration}
    for part in _called_by(library):
        if isinstance(part, PassPart) and not part.whole:
            _link(part)
            part.whole = True
        module.link_in(part._final_module, preserve=True)
    for function in module.functions:
        if not function.is_declaration and function.name not in own:
            function.linkage = "internal"  # dropped once it stands in its callers
    library._optimize_final_module()


def _called_by(library: Part) -> list[Any]:
    """List the libraries of all that a part calls, directly or not, each once."""
    found: dict[CodeLibrary, None] = {}
    left: list[Any] = [library]
    while left:
        for part in left.pop()._linking_libraries:
            if part not in found:
                found[part] = None
                # What Numba has finalised holds all that it calls, and so do passes.
                left += [] if part._finalized or isinstance(part, PassPart) else [part]
    return list(found)
