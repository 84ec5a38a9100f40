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
        first_line: number of the first line (more than 1 for a part of a file).
    """

    def __init__(self, data: bytes, first_line: int = 1) -> None:
        self.data = data
        self.first_line = first_line
        self._position = 0
        self._line = first_line

    def line(self, position: int) -> int:
        """Give the line of a byte position, from 1; cheap when asked in rising order."""
        if position < self._position:
            self._position, self._line = 0, self.first_line
        self._line += self._line_ends(self._position, position)
        self._position = position
        return self._line

    def place(self, position: int) -> Place:
        """Give line, column and excerpt of a byte position."""
        data = self.data
        position = min(position, len(data))
        start = max(data.rfind(b"\n", 0, position), data.rfind(b"\r", 0, position)) + 1
        column = position - start + 1
        if column > _FARTHEST:
            return Place(self.line(position), column, "")
        text = data[start : position + _BEYOND].decode("latin-1").partition("\n")[0].partition("\r")[0]
        excerpt = "".join(char if char.isprintable() else " " if char == "\t" else "." for char in text)
        return Place(self.line(position), column, excerpt)

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
