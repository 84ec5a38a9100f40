"""Arrays and records in LLVM: places of items, loads and stores."""

from __future__ import annotations

from typing import Any

from wallkit.kernels.compiler.emitter import Emitter, Maybe
from wallkit.kernels.compiler.values import (
    BOOL,
    COMPLEX,
    FLOAT,
    INT,
    NATURAL,
    Array,
    Record,
    UnknownError,
    Value,
    number_of,
    tuple_of,
)


def length(array: Value) -> Value:
    """Give ``len`` of an array."""
    return Value(NATURAL, (array.leaves[1],))


def shape(array: Value) -> Value:
    """Give the shape of an array."""
    sizes = array.leaves[1 : 1 + array.type.dimensions]
    return tuple_of([Value(NATURAL, (size,)) for size in sizes])


def item(to: Emitter, array: Value, indices: list[Maybe]) -> Value:
    """Give an item of an array: a number, a record, or an array of fewer dimensions."""
    place = place_of(to, array, indices)
    dtype, dimensions, order = array.type
    if len(indices) < dimensions:
        first, number = 1 + len(indices), dimensions
        strides = array.leaves[first + number :] if order == "A" else ()
        return Value(
            Array(dtype, dimensions - len(indices), order), (place, *array.leaves[first : 1 + number], *strides)
        )
    return Value(Record(dtype), (place,)) if dtype.names else load(to, dtype, place)


def place_of(to: Emitter, array: Value, indices: list[Maybe]) -> str:
    """Give the address of an item; an index below 0 counts from the end."""
    dtype, dimensions, order = array.type
    sizes = array.leaves[1 : 1 + dimensions]
    at = [_from_start(to, to.whole(index), size) for index, size in zip(indices, sizes, strict=False)]
    if order == "A":
        place = array.leaves[0]
        for number, stride in zip(at, array.leaves[1 + dimensions :], strict=False):
            place = to.emit(f"getelementptr i8, ptr {place}, i64 {to.emit(f'mul i64 {number}, {stride}')}")
        return place
    flat = at[0]
    for number, size in zip(at[1:], sizes[1:], strict=False):
        flat = to.emit(f"add i64 {to.emit(f'mul i64 {flat}, {size}')}, {number}")
    for size in sizes[len(at) :]:
        flat = to.emit(f"mul i64 {flat}, {size}")
    return _nth(to, dtype, array.leaves[0], flat)


def unchecked_place(to: Emitter, array: Value, index: str) -> str:
    """Give the address of an item, counted from the start wherever that is."""
    if array.type.order != "C":
        raise UnknownError("items that lie apart")
    return _nth(to, array.type.dtype, array.leaves[0], index, "")


def _nth(to: Emitter, dtype: Any, data: str, index: str, inside: str = "inbounds ") -> str:
    kind = f"[{dtype.itemsize} x i8]" if dtype.names or dtype.kind in "cb" else kind_of(dtype)
    return to.emit(f"getelementptr {inside}{kind}, ptr {data}, i64 {index}")


def _from_start(to: Emitter, index: Value, size: str) -> str:
    leaf = index.leaves[0]
    if index.type == NATURAL:
        return leaf
    below, from_end = to.emit(f"icmp slt i64 {leaf}, 0"), to.emit(f"add i64 {leaf}, {size}")
    return to.emit(f"select i1 {below}, i64 {from_end}, i64 {leaf}")


def kind_of(dtype: Any) -> str:
    """Give LLVM's type of a number in memory.

    Raises:
        UnknownError: no kernel computes with such.
    """
    if dtype.kind == "f":
        return {4: "float", 8: "double"}[dtype.itemsize]
    if dtype.kind in "iub":
        return f"i{8 * dtype.itemsize}"
    raise UnknownError(f"numbers of {dtype} in memory")


def load(to: Emitter, dtype: Any, place: str, align: int | None = None) -> Value:
    """Load a number."""
    of = number_of(dtype)
    if of == COMPLEX:
        other = to.emit(f"getelementptr double, ptr {place}, i64 1")
        return Value(COMPLEX, tuple(to.emit(f"load double, ptr {one}, align 8") for one in (place, other)))
    kind = kind_of(dtype)
    found = to.emit(f"load {kind}, ptr {place}, align {align or dtype.itemsize}")
    if of == FLOAT or (of in (INT, NATURAL) and dtype.itemsize == 8):
        return Value(of, (found,))
    if of == BOOL:
        return Value(BOOL, (to.emit(f"icmp ne {kind} {found}, 0"),))
    extend = "zext" if of == NATURAL else "sext"
    return Value(of, (to.emit(f"{extend} {kind} {found} to i64"),))


def store(to: Emitter, dtype: Any, place: str, value: Maybe, align: int | None = None) -> None:
    """Store a number, as NumPy does in an array of another type."""
    kind, align = (kind_of(dtype) if dtype.kind != "c" else ""), align or dtype.itemsize
    value = to.value(value)
    if dtype.kind == "c":
        other = to.emit(f"getelementptr double, ptr {place}, i64 1")
        for one, leaf in zip((place, other), to.into(value, COMPLEX).leaves, strict=True):
            to.do(f"store double {leaf}, ptr {one}, align 8")
        return
    if dtype.kind == "f":
        leaf = to.into(value, FLOAT).leaves[0]
        if dtype.itemsize != 8:
            raise UnknownError(f"numbers of {dtype} in memory")
    elif dtype.kind == "b":
        leaf = to.emit(f"zext i1 {to.into(value, BOOL).leaves[0]} to i8")
    elif value.type == FLOAT:
        leaf = to.emit(f"{'fptoui' if dtype.kind == 'u' else 'fptosi'} double {value.leaves[0]} to {kind}")
    else:
        leaf = to.into(value, INT).leaves[0]
        leaf = leaf if dtype.itemsize == 8 else to.emit(f"trunc i64 {leaf} to {kind}")
    to.do(f"store {kind} {leaf}, ptr {place}, align {align}")


def field_of(to: Emitter, record: Value, name: str) -> tuple[Any, str]:
    """Give the type of a record's field, as NumPy has it, and its address.

    Raises:
        UnknownError: there is none.
    """
    fields = record.type.dtype.fields
    if name not in fields:
        raise UnknownError(f"the field {name}")
    dtype, offset = fields[name][:2]
    return dtype, to.emit(
        f"getelementptr inbounds i8, ptr {record.leaves[0]}, i64 {offset}"
    ) if offset else record.leaves[0]


def tail(to: Emitter, array: Value, start: Maybe) -> Value:
    """Give the part of an array from an index on, as ``array[start:]``."""
    dtype, dimensions, order = array.type
    first = to.value(start)
    if dimensions != 1 or order != "C" or first.type not in (INT, NATURAL):
        raise UnknownError("a part of such an array")
    size = length(array)
    at = Value(INT, (_from_start(to, first, size.leaves[0]),))
    at = to.value(to.extreme("Lt", (to.extreme("Gt", (at, 0)), size)))  # beyond either end there is nothing
    left = to.emit(f"sub i64 {size.leaves[0]}, {at.leaves[0]}")
    return Value(array.type, (_nth(to, dtype, array.leaves[0], at.leaves[0]), left))
