"""What kernels compute with, as LLVM sees it: types, values, and what both are made of."""

from __future__ import annotations

import struct
from typing import Any, NamedTuple

import numpy as np

INT, NATURAL, FLOAT, BOOL, COMPLEX, NONE = "int", "natural", "float", "bool", "complex", "none"
"""Types of numbers: 64 bits each, but for truth. NATURAL is an INT that is known to be at least 0: as an index of an
array it does not count from the end."""
LEAVES = {INT: ["i64"], NATURAL: ["i64"], FLOAT: ["double"], BOOL: ["i1"], COMPLEX: ["double", "double"], NONE: []}
"""LLVM's types of what a number is made of."""
Type = Any
"""One of these names, or a Tuple, an Array or a Record."""


class UnknownError(Exception):
    """A kernel has something that this compiler does not know, or that has no one type."""


class Tuple(NamedTuple):
    """Several values of any types, by number, or by the names of a class's fields."""

    cls: type
    items: tuple[Type, ...]


class Array(NamedTuple):
    """A NumPy array; the order is C, or A where its strides count."""

    dtype: Any
    dimensions: int
    order: str


class Record(NamedTuple):
    """An item of an array of records: where it lies."""

    dtype: Any


class Value(NamedTuple):
    """A value of a type, and the LLVM values that it is made of: see :func:`leaves_of`."""

    type: Type
    leaves: tuple[str, ...]


def leaves_of(of: Type) -> list[str]:
    """Give LLVM's types of what a type's values are made of."""
    if isinstance(of, str):
        return LEAVES[of]
    if isinstance(of, Tuple):
        return [leaf for item in of.items for leaf in leaves_of(item)]
    if isinstance(of, Record):
        return ["ptr"]
    strides = 0 if of.order == "C" else of.dimensions
    return ["ptr", *["i64"] * (of.dimensions + strides)]  # where its items lie, shape, strides in bytes


def items_of(value: Value) -> list[Value]:
    """Give the items of a tuple."""
    found, first = [], 0
    for item in value.type.items:
        size = len(leaves_of(item))
        found.append(Value(item, value.leaves[first : first + size]))
        first += size
    return found


def tuple_of(values: list[Value], cls: type = tuple) -> Value:
    """Make a tuple of values."""
    return Value(Tuple(cls, tuple(value.type for value in values)), sum((value.leaves for value in values), ()))


def joined(one: Type, other: Type) -> Type:
    """Give the type of what may be of either type.

    Raises:
        UnknownError: there is none.
    """
    if one == other:
        return one
    if isinstance(one, str) and isinstance(other, str):
        both = {one, other}
        if both <= {BOOL, INT, NATURAL}:
            return INT
        if both <= {BOOL, INT, NATURAL, FLOAT}:
            return FLOAT
        if NONE not in both:
            return COMPLEX
    if isinstance(one, Tuple) and isinstance(other, Tuple) and len(one.items) == len(other.items):
        cls = one.cls if one.cls is other.cls else tuple
        return Tuple(cls, tuple(map(joined, one.items, other.items)))
    raise UnknownError(f"{one} or {other}")


def wider(of: Type) -> Type:
    """Forget what is known of numbers beside their type, so that what is made for such serves more callers."""
    if isinstance(of, Tuple):
        return Tuple(of.cls, tuple(map(wider, of.items)))
    return INT if of == NATURAL else of


def constant(value: Any) -> Value:
    """Make a value of one that Python knows.

    Raises:
        UnknownError: no kernel computes with such.
    """
    if value is None:
        return Value(NONE, ())
    if isinstance(value, bool | np.bool_):
        return Value(BOOL, ("true" if value else "false",))
    if isinstance(value, int | np.integer):
        return Value(NATURAL if value >= 0 else INT, (str(int(value)),))
    if isinstance(value, float):
        return Value(FLOAT, (floating(value),))
    if isinstance(value, complex):
        return Value(COMPLEX, (floating(value.real), floating(value.imag)))
    if isinstance(value, tuple):
        return tuple_of([constant(item) for item in value], type(value))
    raise UnknownError(f"a {type(value).__qualname__}")


def floating(value: float) -> str:
    """Write a number as LLVM reads it, to the bit."""
    return f"0x{struct.pack('>d', value).hex().upper()}"


def type_of(kind: Any) -> Type:
    """Give the type of arguments of a kind, see ``signatures.Kind``."""
    if kind is None:
        return NONE
    if isinstance(kind, np.dtype):
        return number_of(kind)
    if kind[0] == "record":
        return Record(kind[1])
    if kind[0] == "array":
        return Array(kind[1], kind[2], "C" if kind[3] == "C" else "A")
    return Tuple(kind[0], tuple(map(type_of, kind[1:])))


def number_of(dtype: Any) -> Type:
    """Give the type of numbers of a NumPy type.

    Raises:
        UnknownError: no kernel computes with such.
    """
    if dtype.kind == "f" and dtype.itemsize == 8:
        return FLOAT
    if dtype.kind == "u" and dtype.itemsize < 8:
        return NATURAL
    if dtype.kind in "iu":
        return INT
    if dtype.kind == "b":
        return BOOL
    if dtype.kind == "c" and dtype.itemsize == 16:
        return COMPLEX
    raise UnknownError(f"numbers of {dtype}")
