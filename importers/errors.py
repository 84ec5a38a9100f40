"""The one hierarchy of errors that wallkit raises on purpose; all of it derives from WallkitError.

It lives on the ground floor because the readers raise it too; users import it from ``wallkit``.
"""

from __future__ import annotations


class WallkitError(Exception):
    """Anything that wallkit raises on purpose.

    Attributes:
        code: a stable word for programs, such as ``"not-a-drawing"``.
        message: what is wrong, in one sentence, without the place.
        fix: what to do about it, or ``""``.
        file: the file's name as the user gave it, or ``""``.
        line: the line in the file, from 1, or None where lines mean nothing (a binary part).
        column: the column in that line, from 1, or None.
        exit_code: how the command line ends on it: 2 unreadable input or usage, 3 a limit hit.
    """

    exit_code = 2

    def __init__(
        self,
        message: str,
        *,
        code: str = "error",
        fix: str = "",
        file: str = "",
        line: int | None = None,
        column: int | None = None,
    ) -> None:
        super().__init__(message)
        self.message = message
        self.code = code
        self.fix = fix
        self.file = file
        self.line = line
        self.column = column

    def __str__(self) -> str:
        place = ":".join(str(part) for part in (self.file, self.line, self.column) if part not in ("", None))
        text = f"{place}: {self.message}" if place else self.message
        return f"{text} ({self.fix})" if self.fix else text


class DrawingError(WallkitError):
    """The file cannot be read as a drawing at all (a part that cannot be read is a Problem instead)."""


class LimitError(WallkitError):
    """A stated limit on size, depth or count was hit; the message names the limit and its figure."""

    exit_code = 3
