"""The gate in front of the PDF library: what it would unpack and parse by itself is measured here first.

While it opens a file and follows references, qpdf unpacks object streams and cross-reference streams and parses
objects, all without a bound. This module looks at every place where an object can begin, however its dictionary is
spelled (keys in any order, no blanks, comments, ``#xx`` for letters), and unpacks within the limits what qpdf could
take for such a stream. Where it cannot tell what qpdf would do, the file is refused.

The argument that nothing passes unmeasured: qpdf reads an object only at ``N G obj``, so each ``obj`` is looked at,
wherever it stands; it takes a stream for an object stream only if its dictionary has the keys N and First, and for a
cross-reference stream only if it has W; filters are self-terminating, so the measure needs no length.
"""

from __future__ import annotations

import re

from importers import filters
from importers.errors import DrawingError
from importers.limits import MAX_STREAM_BYTES, Unpacker, limit_error

# A value costs qpdf about 130 bytes and 1 microsecond; a drawing of a hundred thousand objects has fewer.
_MAX_VALUES = 2_000_000
_MAX_OBJECTS = 1_000_000
_MAX_STRUCTURE = 100_000  # object streams, each with a decoder of its own
_MAX_TABLE_BYTES = 8_000_000  # of all cross-reference streams; an entry takes about 6
_MAX_DICTIONARY = 65_536  # bytes of the dictionary of an object stream
_MAX_PARAMETER_DIGITS = 5  # of a predictor's columns, for which qpdf takes memory at once
_DEFLATE_RATIO = 1032  # no deflated byte stands for more

_OBJECT = re.compile(rb"(?<=[\s\x00])obj(?=[\s\x00()<>\[\]{}/%])")
_BLANKS = re.compile(rb"[\s\x00]*")
_LINE_END = re.compile(rb"[\r\n]")
_DELIMITER = re.compile(rb"<<|>>|[\[\](<%]|/[^\s\x00()<>\[\]{}/%]*")
_STRING_MARK = re.compile(rb"\\.|[()]", re.DOTALL)
_STREAM = re.compile(rb"stream[ \t\f\v\x00]*(?:\r\n|\n|\r)?")
_TOKEN = re.compile(rb"%[^\r\n]*|<<|>>|[\[\]()<>{}]|/[^\s\x00()<>\[\]{}/%]*|[^\s\x00()<>\[\]{}/%]+")
_NAME_ESCAPE = re.compile(rb"#([0-9A-Fa-f]{2})")
# /Encrypt with any of its letters as #xx
_ENCRYPT = re.compile(
    rb"/(?:E|#45)(?:n|#6[eE])(?:c|#63)(?:r|#72)(?:y|#79)(?:p|#70)(?:t|#74)(?=[\s\x00()<>\[\]{}/%]|\Z)"
)
_MARKS = frozenset((b"/N", b"/First", b"/W", b"/ObjStm", b"/XRef"))
_SHORT = {b"/Fl": b"/FlateDecode", b"/A85": b"/ASCII85Decode", b"/AHx": b"/ASCIIHexDecode"}
_UNPACKED = frozenset((b"/FlateDecode", b"/ASCII85Decode", b"/ASCIIHexDecode"))
_WHITE_TO_BLANK = bytes(32 if bytes((byte,)).isspace() or byte == 0 else 120 for byte in range(256))


class Gate:
    """Measures one file before it is opened.

    Attributes:
        values: names, numbers, strings and containers seen so far, in objects and object streams.
        looked_at: bytes of objects looked at so far, those looked at again counted again.
    """

    def __init__(self, data: bytes, unpacker: Unpacker, file: str = "") -> None:
        self.values = 0
        self.looked_at = 0
        self._data = data
        self._unpacker = unpacker
        self._file = file
        self._streams = 0
        self._table_bytes = 0
        self._next_end = -1  # where the next stream ends, of those looked for so far
        self._encrypted = _ENCRYPT.search(data) is not None

    def check(self) -> None:
        """Measure all objects of the file.

        Raises:
            LimitError: they stand for more than the limits allow.
            DrawingError: an object stream is packed in a way whose size cannot be told.
        """
        for count, match in enumerate(_OBJECT.finditer(self._data)):
            if count > _MAX_OBJECTS:
                raise limit_error("objects of a PDF", f"{_MAX_OBJECTS:,}", file=self._file)
            begin = _after_blanks(self._data, match.end())
            self._look_at(begin - match.end())
            if self._data.startswith((b"<<", b"["), begin):
                end, marks = self._measure(begin)
                if marks and end > 0:
                    self._check_stream(begin, end, marks)

    def _look_at(self, size: int) -> None:
        """Count bytes looked at: in a sound file no object lies within another, so twice the file is ample."""
        self.looked_at += size
        if self.looked_at > 2 * len(self._data) + _MAX_DICTIONARY:
            raise limit_error("objects in each other in a PDF", "each byte twice", file=self._file)

    def _count(self, values: int) -> None:
        """Count values that the PDF library would keep."""
        self.values += values
        if self.values > _MAX_VALUES:
            raise limit_error("values in the objects of a PDF", f"{_MAX_VALUES:,}", file=self._file)

    def _measure(self, begin: int) -> tuple[int, set[bytes]]:
        """Count the values of the object at `begin`.

        Returns:
            The position after it (-1 when it does not end), and which of the telling names are in it.
        """
        data = self._data
        marks: set[bytes] = set()
        stack = bytearray()
        position = begin
        values = 0
        while match := _DELIMITER.search(data, position):
            start, end = match.span()
            if start > position:
                values += _words_in(data, position, start)
            values += 1
            piece = match.group()
            if piece == b"<<" or piece == b"[":
                stack.append(piece[0])
            elif piece == b">>" or piece == b"]":
                # What closes nothing is no end: qpdf takes it for null.
                if stack and stack[-1] == (0x3C if piece == b">>" else 0x5B):
                    stack.pop()
            elif piece[0] == 0x2F:
                if b"#" in piece:
                    piece = _plain_name(piece)
                if piece in _MARKS:
                    marks.add(piece)
            else:
                end = self._skip(piece, end)
            position = end
            if not stack:
                break
            if values > _MAX_VALUES:
                self._count(values)
        self._count(values)
        if stack:
            position = len(data)
        self._look_at(position - begin)
        return -1 if stack else position, marks

    def _skip(self, piece: bytes, position: int) -> int:
        """Give the position after a comment, a string in angle brackets or one in parentheses."""
        data = self._data
        if piece == b"<":
            end = data.find(b">", position)
            return end + 1 if end >= 0 else len(data)
        if piece == b"%":
            line_end = _LINE_END.search(data, position)
            return line_end.end() if line_end else len(data)
        depth = 1
        while match := _STRING_MARK.search(data, position):
            self._count(1)
            position = match.end()
            depth += {b"(": 1, b")": -1}.get(match.group(), 0)
            if depth == 0:
                return position
        return len(data)

    def _check_stream(self, begin: int, end: int, marks: set[bytes]) -> None:
        """Measure the stream behind a dictionary, if there is one and qpdf could unpack it by itself."""
        objects = b"/ObjStm" in marks or {b"/N", b"/First"} <= marks
        table = b"/XRef" in marks or b"/W" in marks
        if not objects and not table:
            return
        stream = _STREAM.match(self._data, _after_blanks(self._data, end))
        if stream is None:
            return
        self._streams += 1
        if self._streams > _MAX_STRUCTURE:
            raise limit_error("object streams of a PDF", f"{_MAX_STRUCTURE:,}", file=self._file)
        if end - begin > _MAX_DICTIONARY:
            raise self._refusal()
        tokens = [token for token in _TOKEN.findall(self._data, begin, end) if token[:1] != b"%"]
        tokens = [_plain_name(token) if token[:1] == b"/" else token for token in tokens]
        self._check_parameters(tokens)
        names = self._filters(tokens)
        if objects and self._encrypted and names:
            self._check_encrypted(stream.end(), tokens, names)
        data = self._unpack(stream.end(), names)
        if table:
            self._table_bytes += len(data)
            if self._table_bytes > _MAX_TABLE_BYTES:
                limit = f"{_MAX_TABLE_BYTES // 1_000_000} MB"
                raise limit_error("table of objects of a PDF", limit, file=self._file)
        if objects:
            self._count(_words_in(data, 0, len(data)) + sum(map(data.count, (b"/", b"[", b"(", b"<"))))

    def _filters(self, tokens: list[bytes]) -> list[bytes]:
        """Give the filters that a dictionary names, in the order of decoding."""
        value = self._only_value(tokens, b"/Filter")
        if value is None or value[:1] == [b"null"]:
            return []
        found = value[1 : value.index(b"]")] if value[:1] == [b"["] and b"]" in value else value[:1]
        names = [_SHORT.get(name, name) for name in found]
        if not _UNPACKED.issuperset(names):
            raise self._refusal()
        return names

    def _only_value(self, tokens: list[bytes], key: bytes) -> list[bytes] | None:
        """Give what follows the one place that has a key, None without any; with several, nobody knows which counts."""
        if tokens.count(key) > 1:
            raise self._refusal()
        return tokens[tokens.index(key) + 1 :] if key in tokens else None

    def _check_parameters(self, tokens: list[bytes]) -> None:
        """Make sure that a predictor's rows are of a size that somebody could mean."""
        value = self._only_value(tokens, b"/DecodeParms") or [b"null"]
        if value[0] not in (b"null", b"<<", b"["):
            raise self._refusal()
        depth = 0
        for token in value:
            depth += (token in (b"<<", b"[")) - (token in (b">>", b"]"))
            if token == b"R" or (token.lstrip(b"+-").isdigit() and len(token) > _MAX_PARAMETER_DIGITS):
                raise self._refusal()
            if depth <= 0:
                return

    def _check_encrypted(self, start: int, tokens: list[bytes], names: list[bytes]) -> None:
        """Bound an encrypted object stream by the most that so many deflated bytes can stand for."""
        value = self._only_value(tokens, b"/Length") or []
        size = max(self._end_of_stream(start) - start, int(value[0]) if _is_size(value) else 0)
        if not _is_size(value) or names.count(b"/FlateDecode") > 1 or size * _DEFLATE_RATIO > MAX_STREAM_BYTES:
            raise DrawingError(
                "the PDF is encrypted",
                code="encrypted",
                fix="save it without a password and without restrictions",
                file=self._file,
            )
        self._unpacker.charge(size * _DEFLATE_RATIO)

    def _end_of_stream(self, start: int) -> int:
        """Give where the stream that begins at `start` ends by the first word that says so, else the file's end."""
        if self._next_end < start:
            end = self._data.find(b"endstream", start)
            self._next_end = end if end >= 0 else len(self._data)
        return self._next_end

    def _unpack(self, start: int, names: list[bytes]) -> bytes:
        """Unpack the stream that begins at `start`."""
        end = self._end_of_stream(start)
        self._look_at(end - start)
        data = self._data[start:end]
        for index, name in enumerate(names):
            if name == b"/FlateDecode":
                unpacked = self._unpacker.unpack(data, "zlib")
                if index == 0 and unpacked.damage and end < len(self._data):
                    # The word may stand in the packed data, which say themselves where they end.
                    self._look_at(len(self._data) - start)
                    unpacked = self._unpacker.unpack(self._data[start:], "zlib")
                data = unpacked.data
                continue
            mark, decode = (b"~", filters.ascii85) if name == b"/ASCII85Decode" else (b">", _ascii_hex)
            if index == 0:
                stop = self._data.find(mark, start)
                data = self._data[start : stop + 1 if stop >= 0 else len(self._data)]
                self._look_at(len(data))
            data = decode(data, self._file)
            self._unpacker.charge(len(data))
        return data

    def _refusal(self) -> DrawingError:
        return DrawingError(
            "the structure of the PDF is packed in a way that drawing programs do not use",
            code="broken-pdf",
            fix="save or export the drawing again",
            file=self._file,
        )


def _ascii_hex(data: bytes, _file: str) -> bytes:
    return filters.ascii_hex(data)


def _is_size(value: list[bytes]) -> bool:
    """Tell whether a value is a number of bytes and no reference."""
    return bool(value) and value[0].isdigit() and len(value[0]) <= 10 and value[1:3][-1:] != [b"R"]


def _after_blanks(data: bytes, position: int) -> int:
    """Give the position after blanks and comments."""
    while True:
        blanks = _BLANKS.match(data, position)
        position = blanks.end() if blanks else position
        if data[position : position + 1] != b"%":
            return position
        line_end = _LINE_END.search(data, position)
        position = line_end.end() if line_end else len(data)


def _plain_name(name: bytes) -> bytes:
    """Give a name with its ``#xx`` resolved."""
    if b"#" not in name:
        return name
    return _NAME_ESCAPE.sub(lambda code: bytes((int(code.group(1), 16),)), name)


def _words_in(data: bytes, start: int, stop: int) -> int:
    """Count the words between two positions, without making a list of millions."""
    words = data[start:stop]
    if len(words) < 4096:
        return len(words.split())
    words = words.translate(_WHITE_TO_BLANK)
    return words.count(b" x") + (words[:1] == b"x")
