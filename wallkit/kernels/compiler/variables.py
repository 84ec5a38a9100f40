"""Variables of a kernel that is lowered.

A variable lies in memory of its own (LLVM takes it into registers), and is also known by the value that it was given
last, as long as that stands in the same block or in one that comes before it in any case.
"""

from __future__ import annotations

import ast
import builtins
from functools import cache
from typing import Any

from wallkit.kernels.compiler.emitter import Emitter, Maybe
from wallkit.kernels.compiler.memory import field_of, place_of, store
from wallkit.kernels.compiler.values import Array, Record, Type, UnknownError, Value, items_of, joined, leaves_of

RECORD_ALIGNED = 1
"""Fields of records may lie anywhere, as NumPy packs them."""


class Variables:
    """What names stand for in a kernel, and where they are kept.

    A variable's type is known once all that is assigned to it was seen; where it was used before that, lowering has to
    begin ``again``, with the types found so far.
    """

    def __init__(self, tree: ast.FunctionDef, names: dict[str, Any], kinds: list[Type]) -> None:
        self.tree, self.names, self.kinds = tree, names, kinds
        self.types: dict[str, Type] = {}
        self.assigned = assigned_in(tree.body)

    def begin(self) -> None:
        """Begin, with the arguments; types that were found before stay."""
        self.again = False
        self.needed: set[str] = set()
        self.to = Emitter(self.needed)
        self.known: dict[str, Maybe] = {}
        self.loaded: set[str] = set()
        self.slots: dict[str, list[str]] = {}
        first = 0
        for argument, kind in zip(self.tree.args.args, self.kinds, strict=True):
            size = len(leaves_of(kind))
            value = Value(kind, tuple(f"%p{first + number}" for number in range(size)))
            first += size
            if argument.arg in self.assigned:
                self.assign_name(argument.arg, value)
            else:
                self.known[argument.arg] = value

    def text(self) -> list[str]:
        """Give the lines of the body, without memory of variables that are never read there."""
        unread = {slot for name, slots in self.slots.items() if name not in self.loaded for slot in slots}
        head = [
            f"{slot} = alloca {kind}"
            for name, slots in self.slots.items()
            if name in self.loaded
            for slot, kind in zip(slots, leaves_of(self.types[name]), strict=True)
        ]
        lines = (line for line in self.to.lines[1:] if not (line.startswith("store") and line.split()[-1] in unread))
        return ["entry:", *self.to.head, *head, *lines]

    def expression(self, node: ast.expr) -> Maybe:
        """Lower an expression: its value, or the constant that it is."""
        raise NotImplementedError

    def indices(self, node: ast.expr) -> list[Maybe]:
        """Lower what stands in brackets."""
        raise NotImplementedError

    def assign(self, target: ast.expr, value: Maybe) -> None:
        """Assign to a name, to several, or to a place in memory."""
        if isinstance(target, ast.Name):
            if target.id != "_":  # which nobody reads
                self.assign_name(target.id, value)
        elif isinstance(target, ast.Tuple):
            parts = items_of(value) if isinstance(value, Value) else list(value)
            for one, part in zip(target.elts, parts, strict=True):
                self.assign(one, part)
        else:
            dtype, place, align = self.place(target)
            if dtype.names:
                self._copy(dtype, place, value)
            else:
                store(self.to, dtype, place, value, align)

    def _copy(self, dtype: Any, place: str, value: Maybe) -> None:
        if not isinstance(value, Value) or value.type != Record(dtype):
            raise UnknownError("a record made of something else")
        arguments = f"ptr {place}", f"ptr {value.leaves[0]}", f"i64 {dtype.itemsize}", "i1 false"
        self.to.call("llvm.memmove.p0.p0.i64", "void", *arguments)

    def assign_name(self, name: str, value: Maybe) -> None:
        """Give a variable a value."""
        value = self.to.value(value)
        old = self.types.get(name)
        of = value.type if old is None else joined(old, value.type)
        if of != old:
            misled = old is not None and (name in self.loaded or leaves_of(old) != leaves_of(of))
            self.again, self.types[name] = self.again or misled, of
        slots = self.slots.get(name)
        if slots is None:
            slots = self.slots[name] = [f"%{self.to.new('x')}" for _ in leaves_of(of)]
        value = self._known_as(value, of)
        for slot, leaf, kind in zip(slots, value.leaves, leaves_of(of), strict=False):
            self.to.do(f"store {kind} {leaf}, ptr {slot}")
        self.known[name] = value

    def _known_as(self, value: Value, of: Type) -> Value:
        """Convert to a variable's type, but go on knowing which integers are at least 0."""
        into = self.to.into(value, of)
        return value if into.leaves == value.leaves else into

    def read(self, name: str) -> Maybe:
        """Give what a variable holds, or what a name of the module stands for."""
        if name in self.known:
            return self.known[name]
        if name not in self.assigned:
            return self.global_named(name)
        if name not in self.types:
            raise UnknownError(f"{name} before anything is assigned to it")
        of = self.types[name]
        self.loaded.add(name)
        slots = self.slots.setdefault(name, [f"%{self.to.new('x')}" for _ in leaves_of(of)])
        leaves = [self.to.emit(f"load {kind}, ptr {slot}") for slot, kind in zip(slots, leaves_of(of), strict=False)]
        self.known[name] = Value(of, tuple(leaves))
        return self.known[name]

    def global_named(self, name: str) -> Any:
        """Give what Python finds under a name outside of the kernel."""
        if name in self.names:
            return self.names[name]
        if hasattr(builtins, name):
            return getattr(builtins, name)
        raise UnknownError(f"the name {name}")

    def name_of(self, node: ast.expr) -> Any:
        """Give what Python finds under a dotted name that no variable of the kernel has; None if there is none."""
        if isinstance(node, ast.Name) and node.id not in self.assigned and node.id not in self.known:
            return self.global_named(node.id)
        if isinstance(node, ast.Attribute):
            owner = self.name_of(node.value)
            return None if owner is None else getattr(owner, node.attr, None)
        return None

    def place(self, target: ast.expr) -> tuple[Any, str, int | None]:
        """Give where something is to be stored: NumPy's type, address, alignment."""
        if isinstance(target, ast.Subscript):
            array = self.expression(target.value)
            if not isinstance(array, Value) or not isinstance(array.type, Array):
                raise UnknownError(ast.unparse(target))
            indices = self.indices(target.slice)
            if len(indices) != array.type.dimensions:
                raise UnknownError(ast.unparse(target))
            return array.type.dtype, place_of(self.to, array, indices), None
        if isinstance(target, ast.Attribute):
            record = self.expression(target.value)
            if isinstance(record, Value) and isinstance(record.type, Record):
                return (*field_of(self.to, record, target.attr), RECORD_ALIGNED)
        raise UnknownError(ast.unparse(target))


def without(known: dict[str, Maybe], names: set[str]) -> dict[str, Maybe]:
    """Forget what variables stand for."""
    return {name: value for name, value in known.items() if name not in names}


def assigned_in(statements: list[ast.stmt]) -> set[str]:
    """Name all variables that statements assign to."""
    return {name for statement in statements for name in _assigned_by(statement)}


@cache
def _assigned_by(statement: ast.stmt) -> frozenset[str]:
    names = (node for node in ast.walk(statement) if isinstance(node, ast.Name))
    return frozenset(node.id for node in names if isinstance(node.ctx, ast.Store))
