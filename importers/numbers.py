"""The gate that every number worked out from a file passes: what is not finite never gets behind it."""

from __future__ import annotations

import math


class NumberError(ArithmeticError):
    """A number is beyond what a double holds, or none; whoever reads the file makes a ``bad-number`` problem of it.

    Attributes:
        attribute: where it stands, ``""`` where that is not known.
        offset: index into the attribute's value.
        value: what it came to.
    """

    def __init__(self, attribute: str = "", offset: int = 0, value: float = math.inf) -> None:
        super().__init__("a number is too large")
        self.attribute = attribute
        self.offset = offset
        self.value = value


def finite(value: float, attribute: str = "", offset: int = 0) -> float:
    """Give the value back when it is finite.

    Raises:
        NumberError: it is infinite or not a number.
    """
    if not math.isfinite(value):
        raise NumberError(attribute, offset, value)
    return value
