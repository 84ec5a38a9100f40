"""The text of one LLVM function as it grows, and the formulas of arithmetic in it."""

from __future__ import annotations

import math
import operator
from typing import Any

import numpy as np

from wallkit.kernels.compiler.values import (
    BOOL,
    COMPLEX,
    FLOAT,
    INT,
    NATURAL,
    NONE,
    Tuple,
    Type,
    UnknownError,
    Value,
    constant,
    floating,
    items_of,
    joined,
    leaves_of,
    tuple_of,
)

INTEGERS = (INT, NATURAL)
OPERATIONS = {
    "Add": (operator.add, "fadd", "add"),
    "Sub": (operator.sub, "fsub", "sub"),
    "Mult": (operator.mul, "fmul", "mul"),
    "Div": (operator.truediv, "fdiv", None),
    "FloorDiv": (operator.floordiv, None, "sdiv"),
    "Mod": (operator.mod, None, "srem"),
    "Pow": (operator.pow, None, None),
    "BitAnd": (operator.and_, None, "and"),
    "BitOr": (operator.or_, None, "or"),
    "BitXor": (operator.xor, None, "xor"),
    "LShift": (operator.lshift, None, "shl"),
    "RShift": (operator.rshift, None, "ashr"),
}
"""Of Python's operations: what does it on constants, and LLVM's instructions for floats and for integers."""
COMPARISONS = {
    "Lt": (operator.lt, "olt", "slt"),
    "LtE": (operator.le, "ole", "sle"),
    "Gt": (operator.gt, "ogt", "sgt"),
    "GtE": (operator.ge, "oge", "sge"),
    "Eq": (operator.eq, "oeq", "eq"),
    "NotEq": (operator.ne, "une", "ne"),
}
BITS = ("BitAnd", "BitOr", "BitXor")
Maybe = Any
"""A Value, or a constant as Python has it."""


class Emitter:
    """Lines of LLVM's assembly; ``head`` comes first, for memory of variables."""

    def __init__(self, needed: set[str]) -> None:
        self.head: list[str] = []
        self.lines: list[str] = ["entry:"]
        self.block, self._count, self.needed = "entry", 0, needed

    def new(self, prefix: str = "v") -> str:
        """Make up a name."""
        self._count += 1
        return f"{prefix}{self._count}"

    def emit(self, text: str) -> str:
        """Add an instruction that has a result: its name."""
        name = f"%{self.new()}"
        self.lines.append(f"{name} = {text}")
        return name

    def do(self, text: str) -> None:
        """Add an instruction that has none."""
        self.lines.append(text)

    def begin(self, label: str) -> None:
        """Begin a block."""
        self.lines.append(f"{label}:")
        self.block = label

    def call(self, name: str, result: str, *arguments: str) -> str:
        """Call a function that each process has, or LLVM itself: ``arguments`` with their types."""
        self.needed.add(f"declare {result} @{name}({', '.join(one.split()[0] for one in arguments)})")
        text = f"call {result} @{name}({', '.join(arguments)})"
        if result == "void":
            self.do(text)
            return ""
        return self.emit(text)

    # Conversions.

    def value(self, of: Maybe) -> Value:
        """Give a constant as a value."""
        return of if isinstance(of, Value) else constant(of)

    def into(self, of: Maybe, wanted: Type) -> Value:
        """Convert a value to a type that it joins with."""
        if not isinstance(of, Value) and wanted == FLOAT and isinstance(of, int | float):
            return Value(FLOAT, (floating(float(of)),))
        value = self.value(of)
        if value.type == wanted:
            return value
        if isinstance(wanted, Tuple) and isinstance(value.type, Tuple):
            parts = map(self.into, items_of(value), wanted.items)
            return tuple_of(list(parts), wanted.cls)
        (leaf, *_rest), of_type = value.leaves or ("",), value.type
        if wanted in INTEGERS and of_type in INTEGERS:
            return Value(wanted, value.leaves)
        if wanted in INTEGERS and of_type == BOOL:
            return Value(wanted, (self.emit(f"zext i1 {leaf} to i64"),))
        if wanted == FLOAT and of_type in INTEGERS:
            return Value(FLOAT, (self.emit(f"sitofp i64 {leaf} to double"),))
        if wanted == FLOAT and of_type == BOOL:
            return Value(FLOAT, (self.emit(f"uitofp i1 {leaf} to double"),))
        if wanted == COMPLEX and of_type in (BOOL, FLOAT, *INTEGERS):
            return Value(COMPLEX, (self.into(value, FLOAT).leaves[0], floating(0.0)))
        raise UnknownError(f"{value.type} as {wanted}")

    def whole(self, of: Maybe) -> Value:
        """Convert a number to an integer, towards 0."""
        value = self.value(of)
        if value.type == FLOAT:
            return Value(INT, (self.emit(f"fptosi double {value.leaves[0]} to i64"),))
        return value if value.type in INTEGERS else self.into(value, INT)

    def truth(self, of: Maybe) -> Maybe:
        """Tell whether a value is true, as ``bool`` does: LLVM's truth, or Python's where that is known."""
        if not isinstance(of, Value):
            return bool(of)
        if of.type == NONE:
            return False
        if of.type == BOOL:
            return of
        if of.type in INTEGERS:
            return Value(BOOL, (self.emit(f"icmp ne i64 {of.leaves[0]}, 0"),))
        if of.type == FLOAT:
            return Value(BOOL, (self.emit(f"fcmp une double {of.leaves[0]}, {floating(0.0)}"),))
        raise UnknownError(f"the truth of {of.type}")

    def select(self, test: str, yes: Maybe, no: Maybe) -> Value:
        """Give one of two values."""
        yes, no = self.value(yes), self.value(no)
        both = joined(yes.type, no.type)
        yes, no = self.into(yes, both), self.into(no, both)
        leaves = zip(yes.leaves, no.leaves, leaves_of(both), strict=True)
        return Value(both, tuple(self.emit(f"select i1 {test}, {kind} {a}, {kind} {b}") for a, b, kind in leaves))

    # Arithmetic.

    def binary(self, name: str, one: Maybe, other: Maybe) -> Maybe:
        """Compute ``one`` (operation) ``other``, as Python does."""
        on_constants, on_floats, on_integers = OPERATIONS[name]
        if not isinstance(one, Value) and not isinstance(other, Value):
            return on_constants(one, other)
        if name == "Pow":
            return self._power(one, other)
        both = joined(self.value(one).type, self.value(other).type)
        if both == COMPLEX:
            if name == "Div" and one_type(other) != COMPLEX:
                return self._divided(self.into(one, COMPLEX).leaves, self.into(other, FLOAT).leaves[0])
            return self._complex(name, self.into(one, COMPLEX).leaves, self.into(other, COMPLEX).leaves)
        if name == "Div":
            both = FLOAT
        if both == BOOL and name in BITS:
            a, b = self.value(one).leaves[0], self.value(other).leaves[0]
            return Value(BOOL, (self.emit(f"{on_integers} i1 {a}, {b}"),))
        if both == FLOAT and on_floats:
            a, b = self.into(one, FLOAT).leaves[0], self.into(other, FLOAT).leaves[0]
            return Value(FLOAT, (self.emit(f"{on_floats} double {a}, {b}"),))
        if both not in (BOOL, *INTEGERS) or on_integers is None:
            raise UnknownError(f"{name} of {both}")
        natural = (both == NATURAL and name != "Sub") or (
            name == "BitAnd" and NATURAL in (one_type(one), one_type(other))
        )
        a, b = self.into(one, INT).leaves[0], self.into(other, INT).leaves[0]
        if name in ("FloorDiv", "Mod") and both != NATURAL:
            return self._floored(name, a, b)
        return Value(NATURAL if natural else INT, (self.emit(f"{on_integers} i64 {a}, {b}"),))

    def _floored(self, name: str, a: str, b: str) -> Value:
        """Divide integers so that what is left has the sign of the divisor; LLVM rounds towards 0."""
        left = self.emit(f"srem i64 {a}, {b}")
        signs = self.emit(f"xor i64 {left}, {b}")
        differ, some = self.emit(f"icmp slt i64 {signs}, 0"), self.emit(f"icmp ne i64 {left}, 0")
        off = self.emit(f"and i1 {differ}, {some}")
        if name == "Mod":
            more = self.emit(f"add i64 {left}, {b}")
            return Value(INT, (self.emit(f"select i1 {off}, i64 {more}, i64 {left}"),))
        times, one = self.emit(f"sdiv i64 {a}, {b}"), self.emit(f"zext i1 {off} to i64")
        return Value(INT, (self.emit(f"sub i64 {times}, {one}"),))

    def _power(self, base: Maybe, exponent: Maybe) -> Value:
        base = self.value(base)
        if exponent == 2 and not isinstance(exponent, Value):
            return self.binary("Mult", base, base)  # type: ignore[no-any-return]
        a, b = self.into(base, FLOAT).leaves[0], self.into(exponent, FLOAT).leaves[0]
        return Value(FLOAT, (self.call("llvm.pow.f64", "double", f"double {a}", f"double {b}"),))

    def _complex(self, name: str, a: tuple[str, ...], b: tuple[str, ...]) -> Value:
        if name in ("Add", "Sub"):
            does = OPERATIONS[name][1]
            return Value(COMPLEX, tuple(self.emit(f"{does} double {x}, {y}") for x, y in zip(a, b, strict=True)))
        if name != "Mult":
            raise UnknownError(f"{name} of complex numbers")

        def times(x: str, y: str) -> str:
            return self.emit(f"fmul double {x}, {y}")

        real = self.emit(f"fsub double {times(a[0], b[0])}, {times(a[1], b[1])}")
        return Value(COMPLEX, (real, self.emit(f"fadd double {times(a[0], b[1])}, {times(a[1], b[0])}")))

    def _divided(self, a: tuple[str, ...], b: str) -> Value:
        """Divide a complex number by a real one, as Python does by a complex one: zeros have the same signs."""
        # With q the ratio 0 / b of the divisor's parts: (ar + ai q) / b and (ai - ar q) / b.
        ratio = self.emit(f"fdiv double {floating(0.0)}, {b}")
        products = [self.emit(f"fmul double {one}, {ratio}") for one in (a[1], a[0])]
        parts = self.emit(f"fadd double {a[0]}, {products[0]}"), self.emit(f"fsub double {a[1]}, {products[1]}")
        return Value(COMPLEX, tuple(self.emit(f"fdiv double {one}, {b}") for one in parts))

    def negative(self, of: Maybe) -> Maybe:
        """Compute ``-of``."""
        if not isinstance(of, Value):
            return -of
        if of.type in (FLOAT, COMPLEX):
            return Value(of.type, tuple(self.emit(f"fneg double {leaf}") for leaf in of.leaves))
        return self.binary("Sub", 0, of)

    def inverse(self, of: Maybe) -> Maybe:
        """Compute ``not of``."""
        truth = self.truth(of)
        return Value(BOOL, (self.emit(f"xor i1 {truth.leaves[0]}, true"),)) if isinstance(truth, Value) else not truth

    def compare(self, name: str, one: Maybe, other: Maybe) -> Maybe:
        """Compute ``one`` (comparison) ``other``."""
        on_constants, on_floats, on_integers = COMPARISONS[name]
        if not isinstance(one, Value) and not isinstance(other, Value):
            return on_constants(one, other)
        both = joined(self.value(one).type, self.value(other).type)
        if both == FLOAT:
            a, b = self.into(one, FLOAT).leaves[0], self.into(other, FLOAT).leaves[0]
            return Value(BOOL, (self.emit(f"fcmp {on_floats} double {a}, {b}"),))
        if both == BOOL and name in ("Eq", "NotEq"):
            a, b = self.value(one).leaves[0], self.value(other).leaves[0]
            return Value(BOOL, (self.emit(f"icmp {on_integers} i1 {a}, {b}"),))
        if both not in (BOOL, *INTEGERS):
            raise UnknownError(f"{name} of {both}")
        a, b = self.into(one, INT).leaves[0], self.into(other, INT).leaves[0]
        return Value(BOOL, (self.emit(f"icmp {on_integers} i64 {a}, {b}"),))

    # What modules and builtins have for numbers.

    def magnitude(self, of: Maybe) -> Maybe:
        """Compute ``abs``."""
        if not isinstance(of, Value):
            return abs(of)
        if of.type == FLOAT:
            return Value(FLOAT, (self.call("llvm.fabs.f64", "double", f"double {of.leaves[0]}"),))
        if of.type == NATURAL:
            return of
        found = self.select(self.compare("Lt", of, 0).leaves[0], self.negative(of), of)
        return Value(NATURAL, found.leaves)

    def extreme(self, name: str, values: tuple[Maybe, ...]) -> Maybe:
        """Compute ``max`` or ``min``: the first of those that are equal, as Python takes it."""
        if not any(isinstance(one, Value) for one in values):
            return max(values) if name == "Gt" else min(values)
        found = values[0]
        for one in values[1:]:
            found = self.select(self.value(self.compare(name, one, found)).leaves[0], one, found)
        return found

    def of_floats(self, name: str, values: tuple[Maybe, ...]) -> Value:
        """Call a function of floats."""
        leaves = [f"double {self.into(one, FLOAT).leaves[0]}" for one in values]
        return Value(FLOAT, (self.call(name, "double", *leaves),))

    def finite(self, of: Maybe) -> Maybe:
        """Compute ``math.isfinite``."""
        if not isinstance(of, Value):
            return math.isfinite(of)
        return self.compare("Lt", self.magnitude(self.into(of, FLOAT)), math.inf)


def one_type(of: Maybe) -> Type:
    """Give the type of a value or a constant."""
    return of.type if isinstance(of, Value) else constant(of).type


CALLS: dict[Any, Any] = {
    abs: lambda emitter, one: emitter.magnitude(one),
    max: lambda emitter, *values: emitter.extreme("Gt", values),
    min: lambda emitter, *values: emitter.extreme("Lt", values),
    int: lambda emitter, one: emitter.whole(one) if isinstance(one, Value) else int(one),
    np.int64: lambda emitter, one: emitter.whole(one),
    float: lambda emitter, one: emitter.into(one, FLOAT) if isinstance(one, Value) else float(one),
    bool: lambda emitter, one: emitter.truth(one),
    complex: lambda emitter, one, other: Value(
        COMPLEX, (emitter.into(one, FLOAT).leaves[0], emitter.into(other, FLOAT).leaves[0])
    ),
    math.floor: lambda emitter, one: emitter.whole(emitter.of_floats("llvm.floor.f64", (one,))),
    math.ceil: lambda emitter, one: emitter.whole(emitter.of_floats("llvm.ceil.f64", (one,))),
    np.floor: lambda emitter, one: emitter.of_floats("llvm.floor.f64", (one,)),
    np.ceil: lambda emitter, one: emitter.of_floats("llvm.ceil.f64", (one,)),
    math.isfinite: lambda emitter, one: emitter.finite(one),
}
"""What stands in for functions of Python and its modules."""
for _function, _name in {
    math.sqrt: "llvm.sqrt.f64", math.exp: "llvm.exp.f64", math.log: "llvm.log.f64", math.log1p: "log1p",
    math.expm1: "expm1", math.copysign: "llvm.copysign.f64", np.hypot: "hypot",
}.items():  # fmt: skip
    CALLS[_function] = lambda emitter, *values, name=_name: emitter.of_floats(name, values)
