"""A PDF file opened with care: its first page and its streams, decoded with a bound, whatever the file says.

pikepdf reads the structure. It is never asked to decode a stream: qpdf hands out all that a stream stands for.
"""

from __future__ import annotations

import io
import itertools
import re
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from importers import filters
from importers.errors import DrawingError
from importers.limits import MAX_DEPTH, Unpacker, limit_error

_HEADER = re.compile(rb"%PDF-\d")
# Streams that qpdf itself decodes while it opens a file. A name may be written with #xx for any letter.
_STRUCTURE = re.compile(
    rb"/(?:O|#4[fF])(?:b|#62)(?:j|#6[aA])(?:S|#53)(?:t|#74)(?:m|#6[dD])|/(?:X|#58)(?:R|#52)(?:e|#65)(?:f|#66)"
)
_STREAM = re.compile(rb"stream[\r\n]+")
_FILTER = re.compile(rb"/F(?:ilter)?\b|/[^\s/<>\[\]()]*#")
_ONE_FLATE = re.compile(rb"/Filter\s*(?:\[\s*)?/(?:FlateDecode|Fl)\s*(?:\]|/(?!F)|>>|\s)")
_DICTIONARY = 65_536  # bytes before a name in which the dictionary around it is looked for to begin
_MAX_STRUCTURE = 100_000
_MAX_CANDIDATES = 8
_MAX_MENDED = 8 * 1024 * 1024  # bytes of a file whose table of objects is made anew
# Pages in one node of the tree of pages: qpdf lists all pages while it opens a file, at 2 kB each.
_MAX_KIDS = 50_000
_KIDS = re.compile(rb"/Kids\s*\[([^\]]*)")
_MAX_SLOW_BYTES = 4_000_000  # of LZW and RunLength data, which are decoded code by code
_FILTER_NAMES = {"/Fl": "/FlateDecode", "/LZW": "/LZWDecode", "/A85": "/ASCII85Decode", "/AHx": "/ASCIIHexDecode"}
_FILTER_NAMES["/RL"] = "/RunLengthDecode"


def find_header(data: bytes) -> int:
    """Give the position of the PDF header within the first 1,024 bytes, or -1."""
    match = _HEADER.search(data, 0, 1024)
    return match.start() if match else -1


class Document:
    """An open PDF.

    Attributes:
        file: its name, for messages.
        unpacker: counts what its streams hold.
        damage: what was wrong with streams that were read, by what they are.
    """

    def __init__(self, data: bytes, file: str = "") -> None:
        import pikepdf

        self.file = file
        self.unpacker = Unpacker(file)
        self._slow_bytes = 0
        self._check_structure(data)
        try:
            self._pdf = self._open(data)
        except pikepdf.PasswordError as error:
            raise DrawingError(
                "the PDF is encrypted", code="encrypted", fix="save it without a password", file=file
            ) from error
        except (pikepdf.PdfError, pikepdf.PikepdfError, RuntimeError, ValueError) as error:
            raise DrawingError(
                f"the PDF is broken: {_reason(error)}",
                code="broken-pdf",
                fix="save or export the drawing again; a repairing program such as qpdf may help",
                file=file,
            ) from error

    def _open(self, data: bytes) -> Any:
        """Open the file; a broken one is mended only while that takes no time to speak of."""
        import pikepdf

        try:
            return pikepdf.open(io.BytesIO(data), attempt_recovery=False)
        except pikepdf.PasswordError:
            raise
        except (pikepdf.PdfError, pikepdf.PikepdfError, RuntimeError, ValueError):
            if len(data) > _MAX_MENDED:
                raise
        return pikepdf.open(io.BytesIO(data))

    def close(self) -> None:
        """Give the file back."""
        self._pdf.close()

    @property
    def root(self) -> Any:
        """The catalogue."""
        return self._pdf.Root

    @property
    def info(self) -> Any:
        """The dictionary that names author and program, or None."""
        return get(self._pdf.trailer, "/Info")

    def first_page(self) -> tuple[Page, int]:
        """Find the first page, with the entries it inherits, and count the pages.

        Raises:
            DrawingError: there is none.
        """
        inherited: dict[str, Any] = {}
        seen: set[tuple[int, int]] = set()
        node = get(self.root, "/Pages")
        count = number(get(node, "/Count"))
        for _ in range(MAX_DEPTH):
            if node is None or not is_dictionary(node) or node.objgen in seen:
                break
            if node.objgen != (0, 0):
                seen.add(node.objgen)
            for key in ("/Resources", "/MediaBox", "/Rotate"):
                value = get(node, key)
                if value is not None:
                    inherited[key] = value
            kids = get(node, "/Kids")
            if kids is None:
                return Page(node, inherited), int(min(max(count or 1, 1), 1e9))
            node = next((kid for kid in items(kids) if is_dictionary(kid)), None)
        raise DrawingError(
            "the PDF has no pages", code="no-pages", fix="save or export the drawing again", file=self.file
        )

    def decode(self, stream: Any) -> tuple[bytes, str]:
        """Decode a stream within the limits.

        Returns:
            Its bytes as far as they could be decoded, and what is wrong with it or ``""``.

        Raises:
            LimitError: it stands for more than the limits allow.
        """
        import pikepdf

        try:
            data: bytes = stream.read_raw_bytes()
        except (pikepdf.PdfError, pikepdf.PikepdfError, AttributeError, TypeError, ValueError, RuntimeError) as error:
            return b"", _reason(error)
        damage = ""
        for name, parameters in _filters_of(stream):
            if name == "/FlateDecode":
                data, damage = self.unpacker.unpack(data, "zlib")
            elif name == "/LZWDecode":
                self._charge_slow(len(data))
                early = number(get(parameters, "/EarlyChange"))
                data = filters.lzw(data, early=early is None or early != 0, file=self.file)
                self.unpacker.charge(len(data))
            elif name == "/RunLengthDecode":
                self._charge_slow(len(data))
                data = filters.run_length(data, self.file)
                self.unpacker.charge(len(data))
            elif name == "/ASCII85Decode":
                data = filters.ascii85(data, self.file)
            elif name == "/ASCIIHexDecode":
                data = filters.ascii_hex(data)
            elif name != "/Crypt":
                return b"", f"the filter {name} is not for drawings"
            if (number(get(parameters, "/Predictor")) or 1) > 1:
                return b"", "a predictor is not for drawings"
        return data, damage

    def _charge_slow(self, size: int) -> None:
        """Count bytes that are decoded code by code."""
        self._slow_bytes += size
        if self._slow_bytes > _MAX_SLOW_BYTES:
            raise limit_error("LZW and RunLength data of a PDF", f"{_MAX_SLOW_BYTES // 1_000_000} MB", file=self.file)

    def _check_structure(self, data: bytes) -> None:
        """Make sure that what qpdf decodes on its own while opening the file stays within the limits."""
        for kids in _KIDS.finditer(data):
            if kids.group(1).count(b"R") > _MAX_KIDS:
                raise limit_error("pages of a PDF", f"{_MAX_KIDS:,}", file=self.file)
        checked = 0
        for count, match in enumerate(_STRUCTURE.finditer(data)):
            if count > _MAX_STRUCTURE:
                raise limit_error("object streams of a PDF", f"{_MAX_STRUCTURE:,}", file=self.file)
            if match.start() < checked:
                continue
            checked = self._check_stream(data, match.start())

    def _check_stream(self, data: bytes, start: int) -> int:
        """Measure the stream whose dictionary has a name at `start`; give the position after it."""
        end = data.find(b"endstream", start)
        end = end if end >= 0 else len(data)
        head_start = max(data.rfind(b"obj", max(start - _DICTIONARY, 0), start), 0)
        # The word may also stand in a comment of the dictionary, so each place is tried.
        for candidate in itertools.islice(_STREAM.finditer(data, start, end), _MAX_CANDIDATES):
            head = data[head_start : candidate.start()]
            filters_found = _FILTER.search(head)
            if filters_found and _ONE_FLATE.match(head, filters_found.start()) is None:
                raise DrawingError(
                    "the structure of the PDF is packed in a way that drawing programs do not use",
                    code="broken-pdf",
                    fix="save or export the drawing again",
                    file=self.file,
                )
            if filters_found:
                self.unpacker.unpack(data[candidate.end() : end], "zlib")
        return end


class Page:
    """A page dictionary with what it inherits."""

    def __init__(self, dictionary: Any, inherited: dict[str, Any]) -> None:
        self.dictionary = dictionary
        self._inherited = inherited

    def get(self, key: str) -> Any:
        """Give an entry of the page or of what is above it, or None."""
        value = get(self.dictionary, key)
        return self._inherited.get(key) if value is None else value


def get(container: Any, key: str) -> Any:
    """Give a dictionary's entry, or None when it has none, is none, or cannot be read."""
    with _carefully():
        if is_dictionary(container):
            return container.get(key)
    return None


def items(array: Any) -> Iterator[Any]:
    """Go through the elements of an array that can be read; nothing when it is none."""
    import pikepdf

    if not isinstance(array, pikepdf.Array):
        return
    for index in range(len(array)):
        element = None
        with _carefully():
            element = array[index]
        if element is not None:
            yield element


def entries(dictionary: Any) -> Iterator[tuple[str, Any]]:
    """Go through the entries of a dictionary that can be read; nothing when it is none."""
    if is_dictionary(dictionary):
        for key in list(dictionary.keys()):
            value = get(dictionary, key)
            if value is not None:
                yield key, value


def is_dictionary(value: Any) -> bool:
    """Tell whether a value is a dictionary or a stream (whose dictionary then counts)."""
    import pikepdf

    return isinstance(value, pikepdf.Dictionary | pikepdf.Stream)


def is_stream(value: Any) -> bool:
    """Tell whether a value is a stream."""
    import pikepdf

    return isinstance(value, pikepdf.Stream)


def number(value: Any) -> float | None:
    """Give a number as a float; None for anything else."""
    if isinstance(value, bool):
        return None
    try:
        return float(value)
    except (TypeError, ValueError, OverflowError, ArithmeticError):
        return None


def word(value: Any) -> str:
    """Give a name or a text as text; ``""`` for anything else."""
    import pikepdf

    with _carefully():
        if isinstance(value, pikepdf.Name | pikepdf.String):
            return str(value)
    return ""


def _filters_of(stream: Any) -> list[tuple[str, Any]]:
    """List a stream's filters in the order of decoding, with their parameters."""
    import pikepdf

    found = get(stream, "/Filter")
    parameters = get(stream, "/DecodeParms")
    if isinstance(found, pikepdf.Name):
        names = [str(found)]
        all_parameters = [parameters]
    else:
        names = [word(name) for name in items(found)]
        all_parameters = list(items(parameters))
    names = [_FILTER_NAMES.get(name, name) for name in names]
    return [(name, all_parameters[index] if index < len(all_parameters) else None) for index, name in enumerate(names)]


def _reason(error: Exception) -> str:
    """Give an error of the PDF library without its talk of memory addresses."""
    text = str(error).strip() or type(error).__name__
    return re.sub(r"^.*<[^>]*>[^:]*: *", "", text.splitlines()[0])[:200]


@contextmanager
def _carefully() -> Iterator[None]:
    """Swallow what the PDF library raises for an object that is not what it should be: it counts as absent."""
    import pikepdf

    try:
        yield
    except (pikepdf.PdfError, pikepdf.PikepdfError, KeyError, IndexError, AttributeError, TypeError, ValueError):
        pass
    except RuntimeError:
        pass
