"""The reader of Illustrator's operators: from bytes to operators with their operands, in one pass."""

from __future__ import annotations

from itertools import count, repeat

from importers.ids import decode_id
from importers.illustrator import findings, scanner
from importers.illustrator.art import Art, Operands, Text
from importers.illustrator.text import MAX_STRING_BYTES, alphabet, decode, string_end, unescape
from importers.sources import Source

_BATCH = 20_000  # tokens between two looks at the limits
_BYTES_PER_TOKEN = 16  # of strings and procedures, whose cost grows with their length
_MAX_OPERANDS = 4096
_NUMBER_OR_OPERATOR_STARTS = frozenset(b"+-.0123456789*abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ")
_MAX_OPEN_STRINGS = 100  # texts without an end that are worth a second look at what follows them
# Lines hidden from PostScript that end an object: a name after them is not the name of the path before.
_HIDDEN_OBJECT_ENDS = frozenset(b"n N f F s S b B U *U Q XW".split())


class ArtReader:
    """Reads the art of one file.

    Attributes:
        art: what was drawn.
    """

    def __init__(
        self, source: Source, start: int, stop: int, file: str = "", movers: frozenset[bytes] = frozenset()
    ) -> None:
        self.source = source
        self.art = Art(source, alphabet(source.data), file, movers)
        self._start = start
        self._stop = stop
        self._endless: set[bytes] = set()  # blocks whose end was looked for and is not there
        self._open_strings = 0
        self._tokens = 0  # read one by one, which costs twice as much

    def read(self) -> Art:
        """Read it all.

        Raises:
            LimitError: more elements or deeper groups than the limits allow.
        """
        position = self._start
        stack: Operands = []
        for batch in count(1):
            position = self._read_batch(position, stack)
            self.art.check_count(batch * _BATCH + self._tokens)
            if position >= self._stop:
                break
        self.art.finish()
        return self.art

    def _read_batch(self, position: int, stack: Operands) -> int:
        """Read some thousand tokens from `position`; give the position after them."""
        data, stop, art = self.source.data, self._stop, self.art
        handlers = art.handlers
        match_operator = scanner.NUMBERS_AND_OPERATOR.match
        for _ in repeat(None, _BATCH):
            match = match_operator(data, position, stop)
            if match is None:
                break  # it never fails
            numbers, operator = match.groups()
            position = match.end()
            if operator is None:
                if numbers:
                    stack += numbers.split()
                    self._tokens += 2
                position = self._read_token(position, stack)
                if position >= stop:
                    break
                continue
            art.position = position - len(operator)
            operands: Operands = numbers.split()
            if stack:
                operands = stack + operands
                stack.clear()
            handler = handlers.get(operator)
            if handler is None:
                art.unknown(operator)
                continue
            try:
                handler(operands)
            except (ValueError, TypeError):
                art.failed(operator, operands)
                self._tokens += 2
        return position

    def _read_token(self, position: int, stack: Operands) -> int:
        """Read what is not just numbers and a short operator; give the position after it."""
        data, stop = self.source.data, self._stop
        white = scanner.WHITE.match(data, position, stop)
        position = white.end() if white else position
        if position == stop:
            return position
        if white and data[position] in _NUMBER_OR_OPERATOR_STARTS:
            return position
        byte = data[position : position + 1]
        if byte == b"%":
            return self._comment(position)
        self._tokens += 1
        if len(stack) > _MAX_OPERANDS:
            stack.clear()
        if byte == b"(":
            return self._string(position, stack)
        if byte == b"/":
            word = scanner.WORD.match(data, position + 1, stop)
            stack.append(Text(word.group()[:100] if word else b""))
            return word.end() if word else position + 1
        if byte == b"{":
            return self._procedure(position)
        word = scanner.WORD.match(data, position, stop)
        if not word:
            return position + 1  # a bracket: arrays are read as their elements
        self._word(word.group(), position, stack)
        return word.end()

    def _procedure(self, position: int) -> int:
        """Skip a procedure of a PostScript program; give the position after it."""
        end = -1 if b"{" in self._endless else scanner.braces_end(self.source.data, position, self._stop)
        if end < 0:
            self._endless.add(b"{")
            return position + 1
        self._tokens += (end - position) // _BYTES_PER_TOKEN
        return end

    def _word(self, word: bytes, position: int, stack: Operands) -> None:
        """Take a number as an operand, do anything else as an operator."""
        if scanner.NUMBER.fullmatch(word):
            stack.append(word)
            return
        self.art.position = position
        operands = stack.copy()
        stack.clear()
        handler = self.art.handlers.get(word)
        if handler is None:
            self.art.unknown(word)
            return
        try:
            handler(operands)
        except (ValueError, TypeError):
            self.art.failed(word, operands)

    def _string(self, position: int, stack: Operands) -> int:
        """Take a string as an operand; give the position after it."""
        data = self.source.data
        end = string_end(data, position, self._stop)
        if end > 0:
            stack.append(Text(unescape(data[position + 1 : end - 1])))
            self._tokens += (end - position) // _BYTES_PER_TOKEN
            return end
        self.art.find(findings.STRING, position=position)
        self._open_strings += 1
        if self._open_strings > _MAX_OPEN_STRINGS:
            return position + MAX_STRING_BYTES
        line_end = scanner.LINE_END.search(data, position, self._stop)
        return line_end.end() if line_end else self._stop

    # --- comments ---------------------------------------------------------------------------------------

    def _comment(self, position: int) -> int:
        """Read a comment, which here may be a name, a block without art or the end; give the position after it."""
        data, stop, art = self.source.data, self._stop, self.art
        dull = scanner.DULL_LINES.match(data, position, stop)
        if dull:
            return dull.end()
        match = scanner.COMMENT.match(data, position, stop)
        end = match.end() if match else stop
        head = data[position : position + 24]
        if head.startswith((b"%_%%BeginData", b"%%BeginData")):
            return self._skip_data(position, end)
        if head.startswith(b"%_"):
            self._hidden_line(data[position + 2 : min(end, position + 2 + MAX_STRING_BYTES)])
        elif head.startswith(b"%AI3_Note:"):
            art.note = decode(data[position + 10 : min(end, position + 1000)], art.encoding)
        elif head.startswith((b"%%PageTrailer", b"%%Trailer", b"%%EOF")):
            return self._page_end(end)
        elif head.startswith((b"%AI5_BeginRaster", b"%AI5_BeginPlace")):
            raster = head.startswith(b"%AI5_BeginRaster")
            art.find(findings.RASTER if raster else findings.PLACED, position=position)
            return self._skip_block(b"Raster" if raster else b"Place", position, end)
        elif block := scanner.BEGIN_BLOCK.match(data, position, end):
            return self._skip_block(block.group(1), position, end)
        return end

    def _skip_block(self, name: bytes, position: int, end: int) -> int:
        """Skip a block without art; give the position after it."""
        self.art.named = None
        self._tokens += 2
        if name in self._endless:
            return end
        block_end = scanner.block_end(self.source.data, name, end, self._stop)
        if block_end < 0:
            self._endless.add(name)
            return end
        if name == b"Document":
            self.art.find(findings.PLACED, position=position)
        return block_end

    def _skip_data(self, position: int, end: int) -> int:
        """Skip data by their count, or up to their end mark where the count is wrong; give the position after them."""
        data, stop = self.source.data, self._stop
        match = scanner.BEGIN_DATA.match(data, position, end)
        line_end = scanner.LINE_END.match(data, end, stop)
        begin = line_end.end() if line_end else end
        in_lines = match is None or b"Lines" in match.groups()
        after = begin if match is None or in_lines else begin + int(match.group(1))
        mark = data.find(scanner.END_DATA, max(after - 2, begin), min(after + 200, stop)) if after <= stop else -1
        if mark < 0 and b"Data" not in self._endless:
            mark = data.find(scanner.END_DATA, begin, stop)
        if mark >= 0:
            return mark + len(scanner.END_DATA)
        self._endless.add(b"Data")
        self.art.find(findings.DATA, position=position)
        return min(after, stop)

    def _page_end(self, end: int) -> int:
        """End the art; pages after the first are counted only."""
        data, stop = self.source.data, self._stop
        first = scanner.find_note(data, b"%%Page:", end, stop)
        if first >= 0:
            pages = sum(data.count(line_end + b"%%Page:", first, stop) for line_end in (b"\n", b"\r"))
            self.art.findings.add(findings.PAGES, first, count=pages + 1)
        return stop

    def _hidden_line(self, line: bytes) -> None:
        """Read a line that is hidden from PostScript: a name of the object before it, or art that is none."""
        is_id = line.startswith(b"/XMLUID")
        self._tokens += 4 if is_id else 1
        if is_id or b"(AIArtName)" in line:
            start = line.find(b"(")
            end = string_end(line, start, len(line)) if start >= 0 else -1
            if end > 0:
                name = decode(unescape(line[start + 1 : end - 1]), self.art.encoding)
                self.art.set_name(decode_id(name) if is_id else name)
            return
        last = line[-8:].split()
        if last and last[-1] in _HIDDEN_OBJECT_ENDS:
            self.art.named = None
