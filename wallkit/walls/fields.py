"""What the parts of Walls may be: checked as they are given, one by one and as arguments of ``from_polylines``."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from importers.errors import WallkitError
from importers.problems import Problem
from wallkit import arguments
from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.walls.origins import Marker, Origin

Sides = Literal["both", "outward"]


class WallsError(WallkitError):
    """Arrays given as walls do not describe walls."""


MOST_RESTITUTION = 10.0


@dataclass(frozen=True, slots=True)
class Material:
    """How a wall gives a ball back.

    Attributes:
        restitution: 0 to 10, the part of the normal speed that a bounce leaves. Above 1 the wall is a bumper, and
            energy grows: between bumpers a ball makes endless bounces in a finite time, and ends as a collapse.
        tangential_restitution: 0 to 1, the same along the wall. 0.9 for both slows a ball down by 10 %.
        static_friction: 0 or more, the coefficient of the friction that holds a ball which stands on the wall under
            gravity: the tangent of the steepest slope on which it stays. One that moves along the wall is not slowed.
    """

    restitution: float = 1.0
    tangential_restitution: float = 1.0
    static_friction: float = 0.0

    def __post_init__(self) -> None:
        for name, most in (("restitution", MOST_RESTITUTION), ("tangential_restitution", 1.0)):
            given, may_be = getattr(self, name), f"a number from 0 to {most:g}"
            arguments.number(given, name, may_be, error=WallsError, code="bad-material", least=0.0, most=most)
        given, may_be = self.static_friction, "a finite number, 0 or more"
        arguments.number(given, "static_friction", may_be, error=WallsError, code="bad-material", least=0.0)


def points_of(points: ArrayLike, index: int) -> FloatArray:
    """Give the points of one polyline as an array (n, 2)."""
    may_be = "an (n, 2) array of numbers, n >= 2"
    array = arguments.floats(points, f"polyline {index}", may_be, error=WallsError, code="bad-polyline")
    if array.ndim != 2 or array.shape[1] != 2 or len(array) < 2:
        raise WallsError(f"polyline {index} has the shape {array.shape}", code="bad-polyline", fix=f"give {may_be}")
    if not np.isfinite(array).all():
        raise WallsError(f"polyline {index} has a coordinate that is not finite", code="bad-polyline")
    return array


def bulges_of(bulges: ArrayLike | None, length: int, index: int) -> FloatArray:
    """Give the bulges of one polyline as an array (n,); zeros for None."""
    if bulges is None:
        return np.zeros(length)
    name, may_be = f"bulges of polyline {index}", f"{length} finite numbers, one a vertex"
    array = arguments.floats(bulges, name, may_be, error=WallsError, code="bad-bulges")
    if array.shape != (length,) or not np.isfinite(array).all():
        raise WallsError(
            f"bulges of polyline {index} have the shape {array.shape}", code="bad-bulges", fix=f"give {may_be}"
        )
    return array + 0.0  # a line has the bulge 0, not -0: files leave the bulges of lines away


def each(value: Any, count: int, name: str) -> list[Any]:
    """Give one value a polyline: the value itself for each, or what the list holds."""
    if isinstance(value, str | bool | np.bool_ | Material):
        return [value] * count
    values = several(value, name)
    check_count(name, len(values), count, "polylines")
    return values


def several(values: Any, name: str) -> list[Any]:
    """Give the entries of a list, or of anything else that can be gone through."""
    if isinstance(values, str | bytes) or not isinstance(values, Iterable):
        raise wrong(name, values, "a list, one entry a polyline")
    return list(values)


def check_count(name: str, given: int, count: int, things: str) -> None:
    """Refuse lists of different lengths."""
    if given != count:
        raise WallsError(f"{name} has {given} entries for {count} {things}", code="bad-count")


def wrong(name: str, value: object, may_be: str) -> WallkitError:
    """Make the error for a part of the walls that is given wrongly."""
    return arguments.refused(name, value, may_be, WallsError, "bad-walls")


def _finite(name: str, may_be: str, *shape: int) -> Callable[[Any], FloatArray]:
    """Make the check of an array of finite numbers, one a vertex, each of the shape given."""

    def checked(value: Any) -> FloatArray:
        array = arguments.floats(value, name, may_be, error=WallsError, code="bad-walls")
        if array.ndim != 1 + len(shape) or array.shape[1:] != shape or not np.isfinite(array).all():
            raise wrong(name, value, may_be)
        return array

    return checked


def _whole(name: str, may_be: str) -> Callable[[Any], IntArray]:
    def checked(value: Any) -> IntArray:
        if isinstance(value, np.ndarray) and value.dtype == np.int64 and value.ndim == 1:
            return value
        array = arguments.floats(value, name, may_be, error=WallsError, code="bad-walls")
        whole = array.astype(np.int64)
        if array.ndim != 1 or not np.array_equal(whole, array):
            raise wrong(name, value, may_be)
        return whole

    return checked


def flags(value: Any) -> NDArray[np.bool_]:
    """Give truth values, one a wall."""
    array = np.asarray(value)
    if array.ndim != 1 or (len(array) and array.dtype != np.bool_):
        raise wrong("closed", value, "True or False, or one of them a wall")
    return array.astype(np.bool_, copy=False)


def _words(name: str, words: tuple[str, ...]) -> Callable[[Any], tuple[str, ...]]:
    def checked(value: Any) -> tuple[str, ...]:
        values = tuple(several(value, name))
        plain = set(map(type, values)) <= {str}  # of a million, types are told at once
        for one in set(values if plain else map(_hashable, values)).difference(words):
            arguments.word(one, name, words, error=WallsError, code="bad-walls")
        return values

    return checked


def _hashable(value: object) -> object:
    return value if isinstance(value, str) else repr(value)


def _all_of(name: str, kind: type, may_be: str) -> Callable[[Any], tuple[Any, ...]]:
    def checked(value: Any) -> tuple[Any, ...]:
        values = tuple(several(value, name))
        if not all(issubclass(one, kind) for one in set(map(type, values))):  # of a million, few types are told at once
            raise wrong(name, next(one for one in values if not isinstance(one, kind)), may_be)
        return values

    return checked


def _length(name: str) -> Callable[[Any], float]:
    return lambda value: arguments.number(
        value, name, "a finite number, 0 or more", error=WallsError, code="bad-walls", least=0.0
    )


def _text(name: str) -> Callable[[Any], str]:
    return lambda value: arguments.text(value, name, error=WallsError, code="bad-walls")


def _y_axis(value: Any) -> str:
    return arguments.word(value, "y_axis", ("up", "down"), error=WallsError, code="bad-walls")


def _optional(name: str, value: Any, kind: str) -> Any:
    """Take None, or what is of a kind whose module stands above this one."""
    if value is not None and type(value).__name__ != kind:
        raise wrong(name, value, f"{kind}, or None")
    return value


CHECKS: dict[str, Callable[[Any], Any]] = {
    "vertices": _finite("vertices", "a (V, 2) array of finite numbers", 2),
    "offsets": _whole("offsets", "W + 1 whole numbers"),
    "closed": flags,
    "bulges": _finite("bulges", "V finite numbers, one a vertex"),
    "depth": _whole("depth", "W whole numbers, one a wall"),
    "sides": _words("sides", get_args(Sides)),
    "materials": _all_of("materials", Material, "a Material, or one a wall"),
    "names": _all_of("names", str, "a text, or one a wall"),
    "layers": _all_of("layers", str, "a text, or one a wall"),
    "origins": _all_of("origins", Origin, "an Origin, or one a wall"),
    "markers": _all_of("markers", Marker, "a list of Markers"),
    "sensors": lambda value: _optional("sensors", value, "Walls"),
    "solid": lambda value: _optional("solid", value, "Solid"),
    "y_axis": _y_axis,
    "tolerance": _length("tolerance"),
    "measured_error": _length("measured_error"),
    "measured_normal_error": lambda value: None if value is None else _length("measured_normal_error")(value),
    "units": _text("units"),
    "source_file": _text("source_file"),
    "source_sha256": _text("source_sha256"),
    "problems": lambda value: list(_all_of("problems", Problem, "a list of Problems")(value)),
}
