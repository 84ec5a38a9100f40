"""One kernel, for arguments of some types, from Python's syntax to the text of an LLVM function: its statements."""

from __future__ import annotations

import ast
from collections.abc import Callable
from typing import Any, NamedTuple

from wallkit.kernels.compiler.emitter import Emitter, Maybe
from wallkit.kernels.compiler.expressions import Expressions
from wallkit.kernels.compiler.memory import item, length, load, store
from wallkit.kernels.compiler.values import (
    INT,
    NATURAL,
    NONE,
    Array,
    Tuple,
    Type,
    UnknownError,
    Value,
    items_of,
    joined,
    leaves_of,
    wider,
)
from wallkit.kernels.compiler.variables import assigned_in, without


class Lowered(NamedTuple):
    """A kernel that was lowered.

    Attributes:
        name: of LLVM's function.
        returned: type of what it returns.
        used: which leaves of the arguments it takes, in their order.
        head: of the function, with what it takes.
        body: its blocks.
        calls: kernels that it calls.
        needed: declarations of other functions.
    """

    name: str
    returned: Type
    used: tuple[int, ...]
    head: str
    body: str
    calls: tuple[Any, ...]
    needed: frozenset[str]


class Lowering(Expressions):
    """Lowers a kernel: ``on_If`` statements that ``ast`` calls an If, and so on.

    Statements become blocks. Each method tells whether what comes after its statement is never reached.
    """

    def __init__(
        self, tree: ast.FunctionDef, names: dict[str, Any], kinds: list[Type], call: Callable[..., Any]
    ) -> None:
        super().__init__(tree, names, kinds)
        self._call = call
        self.returned: Type | None = None

    def lower(self) -> None:
        """Lower it, again and again until all types are known."""
        self.again = True
        while self.again:
            self.begin()
            self.called: list[Lowered] = []
            self.loops: list[tuple[str, str]] = []
            self.returns = False
            if not self.suite(self.tree.body):
                self.end_without()

    def call_kernel(self, function: Any, arguments: list[Maybe]) -> Maybe:
        """Lower a call of a kernel, or what stands in for one."""
        return self._call(self, function, arguments)

    def end_without(self) -> None:
        """End a function that returns nothing."""
        if self.returned not in (None, NONE):
            raise UnknownError("a kernel that returns something, or nothing")
        self.returned = NONE
        self.to.do("ret void")

    def suite(self, statements: list[ast.stmt]) -> bool:
        """Lower statements one after the other."""
        return any(self.statement(one) for one in statements)

    def statement(self, node: ast.stmt) -> bool:
        """Lower a statement."""
        lower = getattr(self, f"on_{type(node).__name__}", None)
        if lower is None:
            raise UnknownError(ast.unparse(node))
        return bool(lower(node))

    def on_Expr(self, node: ast.Expr) -> bool:
        """A call for what it does, or a docstring."""
        if not isinstance(node.value, ast.Constant):
            self.expression(node.value)
        return False

    def on_Pass(self, _node: ast.Pass) -> bool:
        """Nothing."""
        return False

    def on_Return(self, node: ast.Return) -> bool:
        """Return a value; several in one function have one type."""
        if node.value is None:
            self.end_without()
            return True
        value = self.to.value(self.expression(node.value))
        of = wider(value.type)
        both = of if self.returned is None else joined(self.returned, of)
        self.again = self.again or (self.returns and both != self.returned)
        self.returned, self.returns = both, True
        _return(self.to, self.to.into(value, both))
        return True

    def on_Assign(self, node: ast.Assign) -> bool:
        """Assign to one or more targets."""
        value = self.expression(node.value)
        for target in node.targets:
            self.assign(target, value)
        return False

    def on_AnnAssign(self, node: ast.AnnAssign) -> bool:
        """Assign; the type is for people."""
        if node.value is not None:
            self.assign(node.target, self.expression(node.value))
        return False

    def on_AugAssign(self, node: ast.AugAssign) -> bool:
        """Assign what an operation on the target gives."""
        name = type(node.op).__name__
        if isinstance(node.target, ast.Name):
            old = self.read(node.target.id)
            self.assign_name(node.target.id, self.to.binary(name, old, self.expression(node.value)))
            return False
        dtype, place, align = self.place(node.target)
        old = load(self.to, dtype, place, align)
        store(self.to, dtype, place, self.to.binary(name, old, self.expression(node.value)), align)
        return False

    def on_If(self, node: ast.If) -> bool:
        """Lower both branches, or the one that is known to be taken."""
        test = self.static(node.test)
        if test is not None:
            return self.suite(node.body if test else node.orelse)
        yes, no, end = (self.to.new("if") for _ in range(3))
        self.branch(node.test, yes, no if node.orelse else end)
        before, ended, left = dict(self.known), [], []
        for label, body in ((yes, node.body), (no, node.orelse)):
            self.known = dict(before)
            if body:
                self.to.begin(label)
                ended.append(self.suite(body))
                if not ended[-1]:
                    self.to.do(f"br label %{end}")
            if not body or not ended[-1]:
                left.append(self.known)
        if not left:
            return True
        self.to.begin(end)
        # What a branch knows holds after it only if the other one never gets there.
        self.known = left[0] if len(left) == 1 else without(before, assigned_in([*node.body, *node.orelse]))
        return False

    def on_While(self, node: ast.While) -> bool:
        """Loop while a test holds."""
        test, body, end = (self.to.new("while") for _ in range(3))
        changing = assigned_in(node.body)
        self.known = without(self.known, changing)
        self.to.do(f"br label %{test}")
        self.to.begin(test)
        static = self.static(node.test)
        if static is False:
            self.to.do(f"br label %{end}")
            self.to.begin(end)
            return False
        if static is None:
            self.branch(node.test, body, end)
        else:
            self.to.do(f"br label %{body}")
        before = dict(self.known)
        self._loop(node.body, body, test, end, test)
        self.known = before
        if static is True and not _breaks(node.body):
            self.to.do("unreachable")
            return True
        return False

    def _loop(self, statements: list[ast.stmt], body: str, again: str, end: str, after: str) -> None:
        """Lower the body of a loop: ``again`` is where ``continue`` goes, and ``end`` what comes after all."""
        self.to.begin(body)
        self.loops.append((again, end))
        if not self.suite(statements):
            self.to.do(f"br label %{after}")
        self.loops.pop()
        self.to.begin(end)

    def on_Break(self, _node: ast.Break) -> bool:
        """Leave the loop."""
        self.to.do(f"br label %{self.loops[-1][1]}")
        return True

    def on_Continue(self, _node: ast.Continue) -> bool:
        """Go on with the loop."""
        self.to.do(f"br label %{self.loops[-1][0]}")
        return True

    def on_For(self, node: ast.For) -> bool:
        """Loop over a range, a tuple (each item has code of its own), or an array of numbers."""
        if isinstance(node.iter, ast.Call) and self.name_of(node.iter.func) is range:
            bounds = [self.expression(one) for one in node.iter.args]
            start, stop, step = (0, bounds[0], 1) if len(bounds) == 1 else (*bounds, 1)[:3]
            self._count(node, start, stop, step, lambda number: number)
            return False
        over = self.expression(node.iter)
        if isinstance(over, Value) and isinstance(over.type, Array):
            self._count(node, 0, length(over), 1, lambda number: item(self.to, over, [number]))
            return False
        if isinstance(over, Value) and not isinstance(over.type, Tuple):
            raise UnknownError(ast.unparse(node.iter))
        for one in items_of(over) if isinstance(over, Value) else over:
            body, again, end = (self.to.new("item") for _ in range(3))
            if _breaks(node.body):
                raise UnknownError("break out of a loop over a tuple")
            self.known = without(self.known, assigned_in(node.body))
            before = dict(self.known)
            self.to.do(f"br label %{body}")
            self.to.begin(body)
            self.loops.append((again, end))
            self.assign(node.target, one)
            if not self.suite(node.body):
                self.to.do(f"br label %{again}")
            self.loops.pop()
            self.to.begin(again)
            self.known = without(before, assigned_in([node]))
        return False

    def _count(self, node: ast.For, start: Maybe, stop: Maybe, step: Maybe, numbered: Callable[[Value], Value]) -> None:
        to = self.to
        first, last, by = to.whole(start), to.whole(stop), to.whole(step)
        natural = first.type == NATURAL and by.type == NATURAL
        counter = f"%{to.new('n')}"
        to.head.append(f"{counter} = alloca i64")
        to.do(f"store i64 {first.leaves[0]}, ptr {counter}")
        test, body, again, end = (to.new("for") for _ in range(4))
        self.known = without(self.known, assigned_in([node]))
        to.do(f"br label %{test}")
        to.begin(test)
        number = to.emit(f"load i64, ptr {counter}")
        goes_on = self._before(number, last.leaves[0], by, step)
        to.do(f"br i1 {goes_on}, label %{body}, label %{end}")
        before = dict(self.known)
        to.begin(body)
        self.loops.append((again, end))
        self.assign(node.target, numbered(Value(NATURAL if natural else INT, (number,))))
        if not self.suite(node.body):
            to.do(f"br label %{again}")
        self.loops.pop()
        to.begin(again)
        to.do(f"store i64 {to.emit(f'add nsw i64 {number}, {by.leaves[0]}')}, ptr {counter}")
        to.do(f"br label %{test}")
        to.begin(end)
        self.known = before

    def _before(self, number: str, last: str, by: Value, step: Maybe) -> str:
        """Tell whether a count has not come to its end, upwards or downwards."""
        to = self.to
        ways = ["slt", "sgt"] if isinstance(step, Value) else ["slt" if step > 0 else "sgt"]
        before = [to.emit(f"icmp {way} i64 {number}, {last}") for way in ways]
        if len(before) == 1:
            return before[0]
        up = to.emit(f"icmp sgt i64 {by.leaves[0]}, 0")
        return to.emit(f"select i1 {up}, i1 {before[0]}, i1 {before[1]}")


def returned_as(of: Type) -> tuple[str, str]:
    """Give what a function returns as LLVM's type, and that of the memory that it writes to where it is several."""
    leaves = leaves_of(of)
    if len(leaves) < 2:
        return (leaves[0] if leaves else "void"), ""
    # Not a struct: one that comes from several blocks keeps LLVM from vector instructions.
    return "void", f"{{ {', '.join(leaves)} }}"


def part_of(to: Emitter, struct: str, place: str, number: int) -> str:
    """Give the address of a part of what a function returns."""
    return to.emit(f"getelementptr {struct}, ptr {place}, i32 0, i32 {number}")


def _return(to: Emitter, value: Value) -> None:
    kinds, (kind, struct) = leaves_of(value.type), returned_as(value.type)
    if struct:
        for number, (leaf, one) in enumerate(zip(value.leaves, kinds, strict=True)):
            to.do(f"store {one} {leaf}, ptr {part_of(to, struct, '%ret', number)}")
    to.do("ret void" if struct or not kinds else f"ret {kind} {value.leaves[0]}")


def _breaks(statements: list[ast.stmt]) -> bool:
    """Tell whether a loop's statements have a break of their own."""
    for one in statements:
        if isinstance(one, ast.Break):
            return True
        if isinstance(one, ast.If) and (_breaks(one.body) or _breaks(one.orelse)):
            return True
    return False
