"""What kind each argument of a kernel is, and the machine words that it is handed over as.

Machine code that lies on the disk is found by the kinds, and called with the words. An array is three or more of them,
a tuple those of its items, None one that nobody looks at. They are handed over side by side in memory, eight bytes
each: ctypes takes a tenth of a microsecond for an argument, and models are a hundred.
"""

from __future__ import annotations

import ctypes
from typing import Any

import numpy as np

C_ORDER, F_ORDER, ALIGNED, WRITEABLE, WARNS = 0x1, 0x2, 0x100, 0x400, 0x8000_0000
"""Of ``ndarray.flags.num``, as NumPy's C interface numbers them; writing to an array that WARNS is deprecated."""
INTEGER, FLOATING, TRUTH = np.dtype(np.int64), np.dtype(np.float64), np.dtype(np.bool_)
NUMBERS = {
    "b1": "?", "i1": "b", "i2": "h", "i4": "i", "i8": "q", "u1": "B", "u2": "H", "u4": "I", "u8": "Q",
    "f4": "f", "f8": "d",
}  # fmt: skip
"""The letters of the module struct by NumPy's names."""
addressof, lend = ctypes.addressof, ctypes.c_char.from_buffer
Kind = Any
"""None; a dtype, of a number; ("record", dtype); ("array", dtype, dimensions, order, aligned); (class, *kinds), of a
tuple. It can be hashed and sent, and its ``repr`` is the same in each process. Whether an array may be written to makes
no difference: one that may not is only given to kernels that read it, which need not be compiled twice."""


class Told:
    """An argument whose kind and words were told before, for calls that take less time than telling them.

    Attributes:
        value: the argument; the arrays in it must stay where they are, whatever is written into them.
    """

    __slots__ = ("kind", "value", "words")

    def __init__(self, value: Any) -> None:
        self.value, self.words = value, list[Any]()
        self.kind = _tuple_of((value,), self.words)[1]


def kinds_of(arguments: tuple[Any, ...]) -> tuple[Kind, ...]:
    """Give the kinds of a kernel's arguments."""
    return _tuple_of(arguments, [])[1:]


def taken(arguments: tuple[Any, ...]) -> tuple[tuple[Kind, ...], list[Any]]:
    """Give the kinds of arguments, and their words; the arguments must outlive these.

    Raises:
        TypeError: one is nothing that kernels take.
    """
    words: list[Any] = []
    return _tuple_of(arguments, words)[1:], words


def _tuple_of(values: tuple[Any, ...], words: list[Any]) -> tuple[Any, ...]:
    kinds: list[Kind] = [type(values)]
    for value in values:
        of = type(value)
        if of is np.ndarray:
            kinds.append(_array(value, words))
        elif of is float:
            kinds.append(FLOATING)
            words.append(value)
        elif of is int:
            kinds.append(INTEGER)
            words.append(value)
        elif of is Told:
            kinds.append(value.kind)
            words += value.words
        elif value is None:
            kinds.append(None)
            words.append(0)
        elif isinstance(value, tuple):
            kinds.append(_tuple_of(value, words))
        else:
            kinds.append(_other(value, words))
    return tuple(kinds)


def _array(array: Any, words: list[Any]) -> Kind:
    """Where its items lie, shape and strides."""
    flags = array.flags.num
    order = "C" if flags & C_ORDER else "F" if flags & F_ORDER else "A"
    # Three times as fast as array.ctypes.data, for arrays that may be lent for writing.
    lent = array.size and flags & (C_ORDER | WRITEABLE | WARNS) == C_ORDER | WRITEABLE
    place = addressof(lend(array)) if lent else array.ctypes.data
    words += (place, *array.shape, *array.strides)
    return "array", array.dtype, array.ndim, order, bool(flags & ALIGNED)


def _other(value: Any, words: list[Any]) -> Kind:
    if isinstance(value, np.void):  # a record: where it lies
        words.append(value.__array_interface__["data"][0])
        return "record", value.dtype
    if isinstance(value, np.ndarray):
        return _array(value, words)
    if isinstance(value, np.number | np.bool_):
        words.append(value.item())
        return value.dtype
    for python, kind in ((bool, TRUTH), (int, INTEGER), (float, FLOATING)):
        if isinstance(value, python):
            words.append(python(value))
            return kind
    raise TypeError(f"kernels take numbers, arrays, tuples and None, not a {type(value).__qualname__}")


def word_formats(kinds: tuple[Kind, ...]) -> list[str]:
    """Give what the words of these kinds are: a letter of the module struct each, P for addresses."""
    found: list[str] = []
    for kind in kinds:
        if isinstance(kind, np.dtype):
            found.append(NUMBERS[kind.str[1:]])
        elif kind is None or kind[0] == "record":
            found.append("P")
        elif kind[0] == "array":
            found += ["P", *"q" * 2 * kind[2]]
        else:
            found += word_formats(kind[1:])
    return found


def result_type(kind: Any) -> Any:
    """Give the type of C of a kernel's result."""
    if kind is None:
        return ctypes.c_void_p
    if isinstance(kind, str):
        return np.ctypeslib.as_ctypes_type(np.dtype(kind))
    fields = [(f"part{number}", result_type(part)) for number, part in enumerate(kind)]
    return type("Result", (ctypes.Structure,), {"_fields_": fields})


def result_from(kind: Any, returned: Any) -> Any:
    """Give what a kernel returned, as Python has it."""
    if kind is None:
        return None
    if isinstance(kind, str):
        return returned.value if isinstance(returned, ctypes._SimpleCData) else returned
    return tuple(
        result_from(part, getattr(returned, name)) for part, (name, _) in zip(kind, returned._fields_, strict=True)
    )
