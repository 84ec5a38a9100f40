"""As many digits as a run needs: doubled until two runs agree."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from importers.errors import WallkitError


class PrecisionError(WallkitError):
    """More digits were asked for than this installation, or this run, can give."""


def agreed(
    run: Callable[[int], tuple[list[Any], Any]],
    same: Callable[[Any], Any],
    digits: int,
    most: int,
    count: int,
    what: str,
) -> list[Any]:
    """Double the digits until two runs agree: ``same`` of each contact is equal, places to 1e-25 of the scene's size.

    Args:
        run: gives the contacts, each with a ``position``, and the scene's size, with so many digits.
        same: what of a contact must be equal.
        digits: to begin with.
        most: digits at which this gives up.
        count: how many contacts are asked for.
        what: what they are called.

    Raises:
        PrecisionError: ``most`` digits do not suffice.
    """
    coarse, _ = run(digits)
    while digits < most:
        digits *= 2
        fine, size = run(digits)
        if len(coarse) == len(fine) and all(
            same(a) == same(b) and all(abs(p - q) <= 1e-25 * size for p, q in zip(a.position, b.position, strict=True))
            for a, b in zip(coarse, fine, strict=True)
        ):
            return fine
        coarse = fine
    words = f"{count} {what} of this scene need more than {most} digits"
    raise PrecisionError(words, code="precision", fix=f"ask for fewer {what}")
