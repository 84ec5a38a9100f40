"""Expressions of a kernel that is lowered, and the tests among them.

Whatever the types say is decided at once (``x is None``), and only the branch that is taken becomes code.
"""

from __future__ import annotations

import ast
from collections.abc import Callable
from typing import Any

from wallkit.kernels.compiler.emitter import CALLS, Maybe, one_type
from wallkit.kernels.compiler.memory import field_of, item, length, load, shape, tail
from wallkit.kernels.compiler.values import (
    BOOL,
    COMPLEX,
    FLOAT,
    NONE,
    Array,
    Record,
    Tuple,
    UnknownError,
    Value,
    items_of,
    joined,
    leaves_of,
    tuple_of,
)
from wallkit.kernels.compiler.variables import RECORD_ALIGNED, Variables


class Expressions(Variables):
    """Lowers expressions: ``of_Name`` those that ``ast`` calls a Name, and so on."""

    def call_kernel(self, function: Any, arguments: list[Maybe]) -> Maybe:
        """Lower a call of a kernel, or what stands in for one."""
        raise NotImplementedError

    # Tests.

    def static(self, node: ast.expr) -> bool | None:
        """Tell how a test comes out whatever the values: None if that depends on them."""
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
            inner = self.static(node.operand)
            return None if inner is None else not inner
        if isinstance(node, ast.BoolOp):
            decides = isinstance(node.op, ast.Or)
            found = [self.static(value) for value in node.values]
            if decides in found:
                return decides
            return None if None in found else not decides
        if isinstance(node, ast.Compare) and isinstance(node.ops[0], ast.Is | ast.IsNot):
            one, other = self.expression(node.left), self.expression(node.comparators[0])
            if other is not None:
                raise UnknownError(ast.unparse(node))
            is_none = one is None or (isinstance(one, Value) and one.type == NONE)
            return is_none == isinstance(node.ops[0], ast.Is)
        if isinstance(node, ast.Constant | ast.Name):
            value = self.expression(node)
            if not isinstance(value, Value) or value.type == NONE:
                return bool(self.to.truth(value))
        return None

    def branch(self, node: ast.expr, yes: str, no: str) -> None:
        """Go to one of two blocks as a test comes out."""
        static = self.static(node)
        if static is not None:
            self.to.do(f"br label %{yes if static else no}")
        elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
            self.branch(node.operand, no, yes)
        elif isinstance(node, ast.BoolOp):
            known = dict(self.known)
            left = [one for one in node.values if self.static(one) is None]
            for one in left[:-1]:
                then = self.to.new("and")
                self.branch(one, *((then, no) if isinstance(node.op, ast.And) else (yes, then)))
                self.to.begin(then)
            self.branch(left[-1], yes, no)
            self.known = known  # what was read in later tests need not be read in all cases
        else:
            test = self.to.truth(self.expression(node))
            if not isinstance(test, Value):
                self.to.do(f"br label %{yes if test else no}")
            else:
                self.to.do(f"br i1 {test.leaves[0]}, label %{yes}, label %{no}")

    # Expressions.

    def expression(self, node: ast.expr) -> Maybe:
        """Lower an expression: its value, or the constant that it is."""
        lower = getattr(self, f"of_{type(node).__name__}", None)
        if lower is None:
            raise UnknownError(ast.unparse(node))
        return lower(node)

    def of_Constant(self, node: ast.Constant) -> Maybe:
        """A number, a truth, or None."""
        return node.value

    def of_Name(self, node: ast.Name) -> Maybe:
        """A variable, or something of the module."""
        return self.read(node.id)

    def of_Tuple(self, node: ast.Tuple) -> Maybe:
        """Several values."""
        parts = self.expressions(node.elts)
        return tuple_of([self.to.value(one) for one in parts]) if _any_value(parts) else tuple(parts)

    def expressions(self, nodes: list[ast.expr]) -> list[Maybe]:
        """Lower several; one with a star stands for its items."""
        found: list[Maybe] = []
        for node in nodes:
            if isinstance(node, ast.Starred):
                value = self.expression(node.value)
                found += items_of(value) if isinstance(value, Value) else value
            else:
                found.append(self.expression(node))
        return found

    def of_Attribute(self, node: ast.Attribute) -> Maybe:
        """A field of a tuple or a record, a shape, a part of a complex number, or something of a module."""
        value = self.expression(node.value)
        if not isinstance(value, Value):
            return getattr(value, node.attr)
        if isinstance(value.type, Record):
            return load(self.to, *field_of(self.to, value, node.attr), RECORD_ALIGNED)
        if value.type == COMPLEX and node.attr in ("real", "imag"):
            return Value(FLOAT, (value.leaves[node.attr == "imag"],))
        if isinstance(value.type, Array) and node.attr == "shape":
            return shape(value)
        names = getattr(value.type.cls, "_fields", ()) if isinstance(value.type, Tuple) else ()
        if node.attr not in names:
            raise UnknownError(ast.unparse(node))
        return items_of(value)[names.index(node.attr)]

    def of_Subscript(self, node: ast.Subscript) -> Maybe:
        """An item of a tuple or an array, or a part of one."""
        value = self.expression(node.value)
        if not isinstance(value, Value) or isinstance(value.type, Tuple):
            return self._of_tuple(value, node.slice)
        if not isinstance(value.type, Array):
            raise UnknownError(ast.unparse(node))
        if isinstance(node.slice, ast.Slice):
            start, *others = node.slice.lower, node.slice.upper, node.slice.step
            if start is None or any(others):
                raise UnknownError(ast.unparse(node))
            return tail(self.to, value, self.expression(start))
        return item(self.to, value, self.indices(node.slice))

    def _of_tuple(self, value: Maybe, index: ast.expr) -> Maybe:
        if isinstance(index, ast.Slice):
            ends = [None if one is None else self.expression(one) for one in (index.lower, index.upper, index.step)]
            which: Any = slice(*ends)
        else:
            which = self.expression(index)
        parts = items_of(value) if isinstance(value, Value) else value
        if isinstance(which, Value):
            found = parts[0]
            for number, part in enumerate(parts[1:], 1):
                found = self.to.select(self.to.compare("Eq", which, number).leaves[0], part, found)
            return found
        return tuple_of(parts[which]) if isinstance(value, Value) and isinstance(which, slice) else parts[which]

    def indices(self, node: ast.expr) -> list[Maybe]:
        """Lower what stands in brackets."""
        if isinstance(node, ast.Tuple):
            return self.expressions(node.elts)
        index = self.expression(node)
        return items_of(index) if isinstance(index, Value) and isinstance(index.type, Tuple) else [index]

    def of_UnaryOp(self, node: ast.UnaryOp) -> Maybe:
        """``-x``, ``not x`` and such."""
        if isinstance(node.op, ast.Not):
            static = self.static(node)
            return self.to.inverse(self.expression(node.operand)) if static is None else static
        value = self.expression(node.operand)
        if isinstance(node.op, ast.USub):
            return self.to.negative(value)
        if isinstance(node.op, ast.Invert):
            return self.to.binary("BitXor", value, -1)
        return value

    def of_BinOp(self, node: ast.BinOp) -> Maybe:
        """An operation."""
        one, other = self.expression(node.left), self.expression(node.right)
        return self.to.binary(type(node.op).__name__, one, other)

    def of_Compare(self, node: ast.Compare) -> Maybe:
        """A comparison, or several in a chain: a later one is made where those before it hold."""
        if isinstance(node.ops[0], ast.Is | ast.IsNot):
            return self.static(node)
        left = self.expression(node.left)
        if len(node.ops) == 1:
            return self._compared(node.ops[0], left, node.comparators[0])[0]
        return self._shortened([(op, right) for op, right in zip(node.ops, node.comparators, strict=True)], left)

    def _compared(self, op: ast.cmpop, left: Maybe, right: ast.expr) -> tuple[Maybe, Maybe]:
        """Compare with an expression: how that comes out, and the expression's value."""
        other = self.expression(right)
        if not isinstance(op, ast.In | ast.NotIn):
            return self.to.compare(type(op).__name__, left, other), other
        found: Maybe = False
        for one in items_of(other) if isinstance(other, Value) else other:
            found = self.to.binary("BitOr", found, self.to.compare("Eq", left, one))
        return self.to.inverse(found) if isinstance(op, ast.NotIn) else found, other

    def _shortened(self, rest: list[tuple[ast.cmpop, ast.expr]], left: Maybe) -> Maybe:
        between = [left]

        def make(op: ast.cmpop, right: ast.expr) -> Callable[[], Maybe]:
            def compare() -> Maybe:
                found, other = self._compared(op, between[-1], right)
                between.append(other)
                return found

            return compare

        return self._decided([make(op, right) for op, right in rest], False)

    def of_BoolOp(self, node: ast.BoolOp) -> Maybe:
        """``and`` and ``or`` of truths: a later one is asked where those before it do not decide."""
        decides = isinstance(node.op, ast.Or)
        if (static := self.static(node)) is not None:
            return static
        left = [one for one in node.values if self.static(one) is None]

        def make(one: ast.expr) -> Callable[[], Maybe]:
            def truth() -> Maybe:
                found = self.expression(one)
                if one_type(found) != BOOL:  # Python gives the operand itself
                    raise UnknownError(ast.unparse(node))
                return found

            return truth

        return self._decided([make(one) for one in left], decides)

    def _decided(self, tests: list[Callable[[], Maybe]], decides: bool) -> Maybe:
        """Make tests one after the other until one decides."""
        to, end, came = self.to, self.to.new("so"), []
        before = dict(self.known)
        for number, test in enumerate(tests):
            leaf = to.into(to.value(test()), BOOL).leaves[0]
            if number == 0:
                before = dict(self.known)
            if number < len(tests) - 1:
                then = to.new("then")
                came.append(("true" if decides else "false", to.block))
                to.do(f"br i1 {leaf}, label %{end if decides else then}, label %{then if decides else end}")
                to.begin(then)
            else:
                came.append((leaf, to.block))
                to.do(f"br label %{end}")
        to.begin(end)
        self.known = before
        ways = ", ".join(f"[ {leaf}, %{block} ]" for leaf, block in came)
        return Value(BOOL, (to.emit(f"phi i1 {ways}"),))

    def of_IfExp(self, node: ast.IfExp) -> Maybe:
        """One of two values: selected where both are at hand, else only one is computed."""
        static = self.static(node.test)
        if static is not None:
            return self.expression(node.body if static else node.orelse)
        if at_hand(node.body) and at_hand(node.orelse):
            test = self.to.truth(self.expression(node.test))
            one, other = self.expression(node.body), self.expression(node.orelse)
            return self.to.select(self.to.value(test).leaves[0], one, other)
        return self._either(node)

    def _either(self, node: ast.IfExp) -> Value:
        to = self.to
        yes, no, end = (to.new("one") for _ in range(3))
        self.branch(node.test, yes, no)
        before = dict(self.known)
        to.begin(yes)
        one, from_one, at = self.expression(node.body), to.block, len(to.lines)
        to.do(f"br label %{end}")
        self.known = dict(before)
        to.begin(no)
        other = self.expression(node.orelse)
        both = joined(to.value(one).type, to.value(other).type)
        second, from_other = to.into(other, both), to.block
        to.do(f"br label %{end}")
        after = to.lines[at:]
        del to.lines[at:]
        first = to.into(one, both)  # at the end of its own block, now that the type is known
        to.lines += after
        to.begin(end)
        self.known = before
        pairs = zip(first.leaves, second.leaves, leaves_of(both), strict=True)
        leaves = (to.emit(f"phi {kind} [ {a}, %{from_one} ], [ {b}, %{from_other} ]") for a, b, kind in pairs)
        return Value(both, tuple(leaves))

    def of_Call(self, node: ast.Call) -> Maybe:
        """A call of a kernel, or of what stands in for a function of Python."""
        function = self.name_of(node.func)
        arguments = self.expressions(node.args)
        if node.keywords or function is None:
            raise UnknownError(ast.unparse(node))
        if function is len:
            return self._length(arguments[0])
        if function in CALLS:
            return CALLS[function](self.to, *arguments)
        if isinstance(function, type) and issubclass(function, tuple) and hasattr(function, "_fields"):
            return tuple_of([self.to.value(one) for one in arguments], function)
        return self.call_kernel(function, arguments)

    def _length(self, of: Maybe) -> Maybe:
        if not isinstance(of, Value):
            return len(of)
        return len(of.type.items) if isinstance(of.type, Tuple) else length(of)


def _any_value(parts: list[Maybe]) -> bool:
    return any(isinstance(one, Value) or (isinstance(one, tuple) and _any_value(list(one))) for one in parts)


def at_hand(node: ast.expr) -> bool:
    """Tell whether an expression takes no instructions."""
    if isinstance(node, ast.Tuple):
        return all(map(at_hand, node.elts))
    if isinstance(node, ast.UnaryOp):
        return isinstance(node.op, ast.USub) and at_hand(node.operand)
    return isinstance(node, ast.Constant | ast.Name)
