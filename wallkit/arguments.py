"""Arguments of public functions, checked: an error names what was given, and what may be.

Each function takes the value and the ``name`` of the argument, and gives the value in the one type that the code behind
it expects. What does not fit is a :class:`wallkit.WallkitError` of the kind that the caller chooses, never a TypeError.
"""

from __future__ import annotations

import math
import numbers
import reprlib
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from importers.errors import WallkitError
from wallkit.geometry.arrays import FloatArray

ErrorKind = type[WallkitError]


def refused(name: str, value: object, may_be: str, error: ErrorKind, code: str) -> WallkitError:
    """Make the error: what was given for which argument, and what may be."""
    return error(f"{name} is {reprlib.repr(value)}", code=code, fix=f"give {may_be}")


def number(
    value: object,
    name: str,
    may_be: str = "a finite number",
    *,
    error: ErrorKind,
    code: str,
    least: float = -math.inf,
    most: float = math.inf,
    infinite: bool = False,
) -> float:
    """Give a number from ``least`` to ``most``; infinite ones only where they may be, NaN never."""
    if isinstance(value, np.ndarray) and value.shape == ():
        value = value.item()
    if isinstance(value, numbers.Real) and not isinstance(value, bool | np.bool_):
        try:
            found = float(value)
        except OverflowError:  # a whole number that no double reaches
            found = math.nan
        if least <= found <= most and (infinite or math.isfinite(found)):
            return found
    raise refused(name, value, may_be, error, code)


ABOVE_0 = math.ulp(0.0)
"""The least number above 0."""
MOST = 2**62
"""Whole numbers beyond are refused: kernels count in 64 bits."""


def whole_number(
    value: object,
    name: str,
    may_be: str = "a whole number",
    *,
    error: ErrorKind,
    code: str,
    least: int,
    most: int = MOST,
) -> int:
    """Give a whole number from ``least`` to ``most``; 1e6 is one, 2.5 is none."""
    found = number(value, name, may_be, error=error, code=code, least=least, most=most)
    if not found.is_integer():
        raise refused(name, value, may_be, error, code)
    return int(value) if isinstance(value, numbers.Integral) else int(found)


def flag(value: object, name: str, *, error: ErrorKind, code: str) -> bool:
    """Give True or False; no other value stands for one of them."""
    if not isinstance(value, bool | np.bool_):
        raise refused(name, value, "True or False", error, code)
    return bool(value)


def word(value: object, name: str, words: Sequence[str], *, error: ErrorKind, code: str) -> str:
    """Give one of several words."""
    if not (isinstance(value, str) and value in words):
        *others, last = map(repr, words)
        raise refused(name, value, f"{', '.join(others)} or {last}" if others else last, error, code)
    return value


def text(value: object, name: str, *, error: ErrorKind, code: str) -> str:
    """Give a text."""
    if not isinstance(value, str):
        raise refused(name, value, "a text", error, code)
    return value


def of_type(value: Any, name: str, types: type | tuple[type, ...], may_be: str, *, error: ErrorKind, code: str) -> None:
    """Refuse what is of none of the types."""
    if not isinstance(value, types):
        raise refused(name, value, may_be, error, code)


def floats(value: object, name: str, may_be: str, *, error: ErrorKind, code: str) -> FloatArray:
    """Give an array of float64 of the shape that the value has; an array of float64 is given back as it is.

    Texts, truth values and complex numbers are no numbers here, though NumPy would make some of them.
    """
    try:
        array = np.asarray(value)
        if array.dtype.kind == "O" and all(isinstance(one, numbers.Real) for one in array.flat):
            array = array.astype(np.float64)
    except (TypeError, ValueError, OverflowError):  # rows of different lengths, or numbers beyond doubles
        raise refused(name, value, may_be, error, code) from None
    if array.dtype.kind not in "iuf":
        raise refused(name, value, may_be, error, code)
    return np.asarray(array, dtype=np.float64)


def chosen(value: Any, count: int, name: str, *, error: ErrorKind, code: str) -> NDArray[np.int64]:
    """Give the numbers, 0 to ``count`` - 1, that a choice means: numbers in any order, a mask, or a slice."""
    may_be = f"numbers from 0 to {count - 1}, {count} truth values, or a slice"
    if isinstance(value, slice):
        try:
            return np.arange(count, dtype=np.int64)[value]
        except TypeError:
            raise refused(name, value, may_be, error, code) from None
    try:
        array = np.atleast_1d(np.asarray(value))
    except ValueError:
        raise refused(name, value, may_be, error, code) from None
    if array.dtype == np.bool_ and array.shape == (count,):
        return np.flatnonzero(array).astype(np.int64)
    if array.size == 0 and array.ndim == 1:
        return np.empty(0, dtype=np.int64)
    if array.ndim != 1 or array.dtype.kind not in "iu" or array.min() < 0 or array.max() >= count:
        raise refused(name, value, may_be, error, code)
    return array.astype(np.int64)
