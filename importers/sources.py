"""Where in a file something stands: lines, columns and excerpts from byte positions, computed only when asked for.

Readers of operator languages work on byte positions, since counting lines while reading costs more than reading.
"""

from __future__ import annotations

from typing import NamedTuple

# An excerpt begins where its line begins, so that a caret under it needs nothing but the column. It goes so far
# beyond the column, and there is none for a column so far out that nobody would see the caret.
_BEYOND = 60
_FARTHEST = 200


class Place(NamedTuple):
    """A place in a file, for people.

    Attributes:
        line: from 1.
        column: in that line, from 1 (in bytes).
        excerpt: the line up to some way behind the column, ``""`` for a far column; what does not print is a dot.
    """

    line: int
    column: int
    excerpt: str


class Source:
    """Bytes of a file with LF, CR or CRLF line ends, mixed as they come.

    Attributes:
        data: the bytes.
        has_lines: its lines are those of the file that a person has; a decoded stream's are not.
    """

    def __init__(self, data: bytes, *, has_lines: bool = True) -> None:
        self.data = data
        self.has_lines = has_lines
        self._position = 0
        self._line = 1

    def line(self, position: int) -> int | None:
        """Give the line of a byte position, from 1; cheap when asked in rising order. None without lines."""
        return self._line_of(position) if self.has_lines else None

    def _line_of(self, position: int) -> int:
        """Count lines on from the position that was asked for last."""
        if position < self._position:
            self._position, self._line = 0, 1
        self._line += self._line_ends(self._position, position)
        self._position = position
        return self._line

    def place(self, position: int) -> Place | None:
        """Give line, column and excerpt of a byte position; None without lines."""
        if not self.has_lines:
            return None
        data = self.data
        position = min(position, len(data))
        start = max(data.rfind(b"\n", 0, position), data.rfind(b"\r", 0, position)) + 1
        column = position - start + 1
        if column > _FARTHEST:
            return Place(self._line_of(position), column, "")
        text = data[start : position + _BEYOND].decode("latin-1").partition("\n")[0].partition("\r")[0]
        excerpt = "".join(char if char.isprintable() else " " if char == "\t" else "." for char in text)
        return Place(self._line_of(position), column, excerpt)

    def _line_ends(self, start: int, stop: int) -> int:
        """Count the line ends before `stop` and not before `start`."""
        data = self.data
        ends = data.count(b"\n", start, stop)
        returns = data.count(b"\r", start, stop)
        if returns:
            ends += returns - data.count(b"\r\n", start, stop)
        if 0 < start < stop and data[start] == 10 and data[start - 1] == 13:
            ends -= 1  # a pair that the start cuts in two: it was counted with its first half
        return ends
