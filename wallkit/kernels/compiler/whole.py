"""A kernel and all that it calls: from Python to machine code, as one module of LLVM.

Kernels are a small part of Python: numbers, tuples, arrays and records, arithmetic, branches and loops, calls of other
kernels. So what takes a general compiler many passes over each function takes one walk of its syntax here, which writes
LLVM's assembly (``lowering``). A function takes of its arguments only what it uses, however much a model has. All is
optimised once, but for passes over many balls, which are optimised alone before: in the midst of their callers vector
instructions serve them less.
"""

from __future__ import annotations

import ast
import hashlib
import linecache
import os
import re
from collections.abc import Callable, Iterator
from functools import cache
from typing import Any, NamedTuple

from wallkit.kernels.compiler.instructions import INSTRUCTIONS
from wallkit.kernels.compiler.lowering import Lowered, Lowering, part_of, returned_as
from wallkit.kernels.compiler.values import (
    BOOL,
    FLOAT,
    INT,
    NONE,
    Tuple,
    Type,
    UnknownError,
    Value,
    leaves_of,
    type_of,
    wider,
)
from wallkit.kernels.marks import ALONE, CALLED
from wallkit.kernels.signatures import Kind, result_type, word_formats

WORD = 8
"""Bytes of a word."""
FASTEST = 3
"""LLVM's level of optimising."""


class Program:
    """The kernels that one kernel calls, each lowered once for arguments of the same types."""

    def __init__(self, marks: dict[Callable[..., Any], str]) -> None:
        self.marks = marks
        self.lowered: dict[tuple[Any, ...], Lowered] = {}
        self.modes: dict[str, str] = {}

    def of(self, function: Callable[..., Any], kinds: tuple[Type, ...]) -> Lowered:
        """Lower a kernel for arguments of some types."""
        key = function, kinds
        if (found := self.lowered.get(key)) is None:
            tree = _tree(function)
            if len(tree.args.args) != len(kinds):
                raise UnknownError(f"{function.__qualname__}: called with {len(kinds)} arguments")
            lowering = Lowering(tree, _names_of(function), list(kinds), self.call)
            try:
                lowering.lower()
            except UnknownError as error:
                raise UnknownError(f"{function.__qualname__}: {error}") from error
            found = self.lowered[key] = self._told(function, kinds, lowering)
        return found

    def _told(self, function: Callable[..., Any], kinds: tuple[Type, ...], lowering: Lowering) -> Lowered:
        name = f"{function.__name__}.{len(self.lowered)}"
        self.modes[name] = self.marks.get(function, CALLED)
        body = "\n".join(lowering.text())
        used = tuple(sorted({int(number) for number in _ARGUMENT.findall(body)}))
        types = [leaf for kind in kinds for leaf in leaves_of(kind)]
        assert lowering.returned is not None
        returned, struct = returned_as(lowering.returned)
        taken = [f"{types[number]} %p{number}" for number in used] + ["ptr noalias %ret"] * bool(struct)
        head = f"{returned} @{name}({', '.join(taken)})"
        return Lowered(name, lowering.returned, used, head, body, tuple(lowering.called), frozenset(lowering.needed))

    def call(self, caller: Lowering, function: Callable[..., Any], arguments: list[Any]) -> Any:
        """Lower a call of a kernel, or what stands in for one."""
        to = caller.to
        if function in INSTRUCTIONS:
            return INSTRUCTIONS[function](to, *arguments)
        if function not in self.marks:
            raise UnknownError(f"a call of {function!r}")
        values = [to.value(one) for one in arguments]
        known = self.of(function, tuple(wider(value.type) for value in values))
        caller.called.append(known)
        leaves = [leaf for value in values for leaf in value.leaves]
        types = [leaf for value in values for leaf in leaves_of(value.type)]
        taken = [f"{types[number]} {leaves[number]}" for number in known.used]
        kinds, (result, struct) = leaves_of(known.returned), returned_as(known.returned)
        if struct:
            place = f"%{to.new('r')}"
            to.head.append(f"{place} = alloca {struct}")
            to.do(f"call void @{known.name}({', '.join([*taken, f'ptr {place}'])})")
            parts = [to.emit(f"load {kind}, ptr {part_of(to, struct, place, k)}") for k, kind in enumerate(kinds)]
            return Value(known.returned, tuple(parts))
        call = f"call {result} @{known.name}({', '.join(taken)})"
        if not kinds:
            to.do(call)
        return Value(known.returned, (to.emit(call),) if kinds else ())

    def module(self, entry: Lowered, extra: str = "") -> Any:
        """Parse the module of a kernel with all that it calls; kernels that stand alone are linked in."""
        from llvmlite import binding

        functions, alone = [], []
        needed = set(entry.needed)
        for known in reached(entry, self.modes):
            needed |= known.needed
            if known is not entry and self.modes[known.name] == ALONE:
                functions.append(f"declare {_ARGUMENT_NAME.sub('', known.head)}")
                alone.append(known)
                continue
            linkage = "" if known is entry else "internal "
            inline = "" if self.modes[known.name] == CALLED else "alwaysinline "
            functions.append(f"define {linkage}{known.head} {inline}nounwind {{\n{known.body}\n}}")
        machine = target_machine()
        head = f'target datalayout = "{machine.target_data}"\ntarget triple = "{machine.triple}"'
        module = binding.parse_assembly("\n".join([head, *sorted(needed), *functions, extra]))
        for known in alone:
            module.link_in(self._optimised_alone(known))
            module.get_function(known.name).linkage = "internal"
        return module

    def _optimised_alone(self, known: Lowered) -> Any:
        module = self.module(known)
        optimise(module)
        return module


def reached(entry: Lowered, modes: dict[str, str]) -> Iterator[Lowered]:
    """Give a kernel and all that it calls, each once; what kernels call that stand alone is theirs."""
    found, left = {entry.name}, [entry]
    while left:
        known = left.pop()
        yield known
        if known is not entry and modes[known.name] == ALONE:
            continue
        for one in known.calls:
            if one.name not in found:
                found.add(one.name)
                left.append(one)


class Whole(NamedTuple):
    """A kernel that is compiled.

    Attributes:
        symbol: name of the function that takes two addresses: where the result goes, and where the words are.
        result: kind of what it returns, see ``signatures.result_type``.
        image: the object file, as bytes.
        module: of LLVM, optimised.
    """

    symbol: str
    result: Any
    image: bytes
    module: Any


def compile_whole(entry: Callable[..., Any], kinds: tuple[Kind, ...], marks: dict[Callable[..., Any], str]) -> Whole:
    """Compile a kernel, with all that it calls.

    Args:
        entry: the kernel.
        kinds: of its arguments, see ``signatures.kinds_of``.
        marks: of all kernels, what becomes of them.

    Raises:
        UnknownError: a kernel has what this compiler does not know.
    """
    program = Program(marks)
    types = tuple(wider(type_of(kind)) for kind in kinds)
    known = program.of(entry, types)
    result, symbol = _result_of(known.returned), _symbol_of(entry, kinds)
    module = program.module(known, _entry(symbol, known, types, kinds, result))
    module.get_function(known.name).linkage = "internal"
    optimise(module)
    return Whole(symbol, result, target_machine().emit_object(module), module)


def _symbol_of(entry: Callable[..., Any], kinds: tuple[Kind, ...]) -> str:
    """Name a kernel's entry as no other one is named: a process loads many, for other kinds too."""
    told = repr((entry.__module__, entry.__qualname__, kinds))
    return f"{entry.__name__}.{hashlib.sha256(told.encode()).hexdigest()[:24]}"


def _entry(symbol: str, known: Lowered, types: tuple[Type, ...], kinds: tuple[Kind, ...], result: Any) -> str:
    """Write the function that takes the words of arguments, side by side in memory, and calls a kernel with them."""
    lines, arguments = [], []
    for number, (leaf, word) in enumerate(_words(types, kinds)):
        if number not in known.used:
            continue
        lines.append(f"%w{number} = getelementptr i8, ptr %words, i64 {WORD * word[0]}")
        lines += _loaded(number, leaf, word[1])
        arguments.append(f"{leaf} %a{number}")
    returned, struct = returned_as(known.returned)
    if struct:
        lines.append(f"%r = alloca {struct}")
        arguments.append("ptr %r")
    call = f"call {returned} @{known.name}({', '.join(arguments)})"
    lines.append(call if returned == "void" else f"%r0 = {call}")
    for number, (leaf, offset) in enumerate(zip(leaves_of(known.returned), _offsets(result), strict=True)):
        if struct:
            lines.append(f"%f{number} = getelementptr {struct}, ptr %r, i32 0, i32 {number}")
            lines.append(f"%r{number} = load {leaf}, ptr %f{number}")
        part = f"%r{number}"
        if leaf == "i1":
            lines.append(f"%t{number} = zext i1 {part} to i8")
            leaf, part = "i8", f"%t{number}"
        lines.append(f"%o{number} = getelementptr i8, ptr %result, i64 {offset}")
        lines.append(f"store {leaf} {part}, ptr %o{number}, align 1")
    text = "\n".join([*lines, "ret void"])
    return f"define void @{symbol}(ptr noalias %result, ptr noalias %words) nounwind {{\n{text}\n}}"


def _words(types: tuple[Type, ...], kinds: tuple[Kind, ...]) -> Iterator[tuple[str, tuple[int, str]]]:
    """Give for each leaf of arguments LLVM's type, and which word it is, of what format."""
    first = 0
    for of, kind in zip(types, kinds, strict=True):
        formats = word_formats((kind,))
        own: Iterator[tuple[str, tuple[int, str]]] = zip(leaves_of(of), enumerate(formats), strict=False)
        if isinstance(of, Tuple):
            own = _words(of.items, kind[1:])
        for leaf, (word, form) in own:  # of an array in C's order strides do not count
            yield leaf, (first + word, form)
        first += len(formats)


def _loaded(number: int, leaf: str, form: str) -> list[str]:
    """Write what loads a leaf from its word."""
    if leaf == "i1":
        return [f"%b{number} = load i8, ptr %w{number}", f"%a{number} = icmp ne i8 %b{number}, 0"]
    narrow = {"b": "i8", "h": "i16", "i": "i32", "B": "i8", "H": "i16", "I": "i32"}.get(form)
    if narrow is None:
        return [f"%a{number} = load {leaf}, ptr %w{number}"]
    extend = "zext" if form.isupper() else "sext"
    return [f"%b{number} = load {narrow}, ptr %w{number}", f"%a{number} = {extend} {narrow} %b{number} to i64"]


def _result_of(of: Type) -> Any:
    """Give the kind of a result, see ``signatures.result_type``."""
    if isinstance(of, Tuple):
        return list(map(_result_of, of.items))
    if of not in (NONE, INT, FLOAT, BOOL):
        raise UnknownError(f"returning {of} to Python")
    return {NONE: None, INT: "int64", FLOAT: "float64", BOOL: "bool"}[of]


def _offsets(result: Any) -> list[int]:
    """Give where the numbers of a result lie in it."""
    if result is None:
        return []
    if isinstance(result, str):
        return [0]
    fields: Any = result_type(result)
    return [
        getattr(fields, name).offset + offset
        for part, (name, _) in zip(result, fields._fields_, strict=True)
        for offset in _offsets(part)
    ]


def optimise(module: Any) -> None:
    """Let LLVM optimise a module: calls stand in their callers first, then all that it has, but nothing inexact."""
    from llvmlite import binding

    machine = target_machine()
    for level, vectors in ((0, False), (FASTEST, True)):
        options = binding.create_pipeline_tuning_options(level)
        options.loop_vectorization, options.slp_vectorization = vectors, False
        builder = binding.create_pass_builder(machine, options)
        passes = builder.getModulePassManager()
        if level == 0:
            passes.add_sroa_pass()
            passes.add_loop_rotate_pass()
            passes.add_instruction_combine_pass()
            passes.add_jump_threading_pass()
        passes.run(module, builder)


@cache
def target_machine() -> Any:
    """Tell LLVM what processor to make machine code for: this one, or the one that is set."""
    from llvmlite import binding

    binding.initialize_native_target()
    binding.initialize_native_asmprinter()
    name = os.environ.get("WALLKIT_CPU_NAME") or binding.get_host_cpu_name()
    features = os.environ.get("WALLKIT_CPU_FEATURES")
    if features is None:
        try:
            features = binding.get_host_cpu_features().flatten()
        except RuntimeError:  # LLVM does not know
            features = ""
    triple = binding.get_process_triple()
    relocation = "static" if triple.startswith(("x86", "i686")) else "default"
    return binding.Target.from_triple(triple).create_target_machine(
        cpu=name, features=features, opt=FASTEST, reloc=relocation, codemodel="jitdefault", jit=True
    )


@cache
def _trees(file: str) -> dict[int, ast.FunctionDef]:
    """Parse a file: its functions, by the line in which they begin, decorators included."""
    tree = ast.parse("".join(linecache.getlines(file)))
    functions = (node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef))
    return {min([node.lineno, *(one.lineno for one in node.decorator_list)]): node for node in functions}


def _tree(function: Callable[..., Any]) -> ast.FunctionDef:
    """Give the syntax of a kernel.

    Raises:
        UnknownError: its source is not at hand, or it takes arguments in other ways than by their places.
    """
    code = function.__code__
    linecache.lazycache(code.co_filename, function.__globals__)  # sources may lie in an archive
    tree = _trees(code.co_filename).get(code.co_firstlineno)
    if tree is None or tree.name != code.co_name:
        raise UnknownError("a kernel without its source")
    others = tree.args.posonlyargs or tree.args.kwonlyargs or tree.args.defaults or tree.args.vararg or tree.args.kwarg
    if others:
        raise UnknownError("other arguments than those by place")
    return tree


def _names_of(function: Callable[..., Any]) -> dict[str, Any]:
    """Give what a kernel finds under names outside of it."""
    cells = function.__closure__
    if cells is None:
        return function.__globals__
    around = zip(function.__code__.co_freevars, (cell.cell_contents for cell in cells), strict=True)
    return {**function.__globals__, **dict(around)}


_ARGUMENT, _ARGUMENT_NAME = re.compile(r"%p(\d+)\b"), re.compile(r" %(p\d+|ret)\b")
