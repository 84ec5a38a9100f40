"""A PDF file opened with care: its first page and its streams, decoded with a bound, whatever the file says.

pikepdf reads the structure. It is never asked to decode a stream: qpdf hands out all that a stream stands for.
"""

from __future__ import annotations

import io
import re
from collections.abc import Iterator
from itertools import islice
from typing import Any

from importers import filters
from importers.errors import DrawingError
from importers.limits import MAX_DEPTH, Unpacker, limit_error
from importers.pdf.structure import Gate

_HEADER = re.compile(rb"%PDF-\d")
_MAX_MENDED = 8 * 1024 * 1024  # bytes of a file whose table of objects is made anew
_MAX_PAGES = 50_000  # and nodes of their tree
_MAX_SLOW_BYTES = 4_000_000  # of LZW and RunLength data, which are decoded code by code
_MAX_FILTERS = 16  # of one stream
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
        self._followed: dict[str, int] = {}
        Gate(data, self.unpacker, file).check()
        try:
            self._pdf = self._open(data)
        except pikepdf.PasswordError as error:
            raise DrawingError(
                "the PDF is encrypted", code="encrypted", fix="save it without a password", file=file
            ) from error
        except _own_errors(RuntimeError, ValueError) as error:
            raise DrawingError(
                f"the PDF is broken: {_reason(error)}",
                code="broken-pdf",
                fix="save or export the drawing again; a repairing program such as qpdf may help",
                file=file,
            ) from error

    def _open(self, data: bytes) -> Any:
        """Open the file; one that is broken or shows no page is mended, while that takes no time to speak of."""
        import pikepdf

        try:
            # Pages inherit when they are asked: to push everything down, qpdf would list all pages at 2 kB each.
            pdf = pikepdf.open(io.BytesIO(data), attempt_recovery=False, inherit_page_attributes=False)
        except pikepdf.PasswordError:
            raise
        except _own_errors(RuntimeError, ValueError):
            if len(data) > _MAX_MENDED:
                raise
        else:
            if len(data) > _MAX_MENDED or next(self._pages_below(_catalogue(pdf)), None) is not None:
                return pdf
            pdf.close()
        return pikepdf.open(io.BytesIO(data), inherit_page_attributes=False)

    def close(self) -> None:
        """Give the file back."""
        self._pdf.close()

    @property
    def root(self) -> Any:
        """The catalogue, or None."""
        return _catalogue(self._pdf)

    @property
    def info(self) -> Any:
        """The dictionary that names author and program, or None."""
        return get(self._pdf.trailer, "/Info")

    def pages(self) -> Iterator[Page]:
        """Go through the pages in order, each with the entries it inherits.

        Raises:
            LimitError: the tree of pages is too deep, or has too many nodes.
        """
        return self._pages_below(self.root)

    def _pages_below(self, catalogue: Any) -> Iterator[Page]:
        """Go through the pages that a catalogue knows."""
        above: list[tuple[Iterator[Any], dict[str, Any], tuple[int, int]]] = []
        kids, inherited = iter((get(catalogue, "/Pages"),)), dict[str, Any]()
        key = (0, 0)
        while True:
            node = next(kids, None)
            if node is None:
                if not above:
                    return
                kids, inherited, key = above.pop()
                continue
            self.follow("pages of a PDF", _MAX_PAGES)
            if not is_dictionary(node) or _is_above(node.objgen, key, above):
                continue
            found = {name: get(node, name) for name in ("/Resources", "/MediaBox", "/Rotate")}
            here = {**inherited, **{name: value for name, value in found.items() if value is not None}}
            children = get(node, "/Kids")
            if children is None:
                yield Page(node, here)
                continue
            if len(above) >= MAX_DEPTH:
                raise limit_error("nodes of the tree of pages in each other", str(MAX_DEPTH), file=self.file)
            above.append((kids, inherited, key))
            kids, inherited, key = items(children), here, node.objgen

    def page_count(self) -> int:
        """Give how many pages there are by the file's own count, at least 1."""
        count = number(get(get(self.root, "/Pages"), "/Count"))
        return int(min(max(count or 1, 1), 1e9))

    def decode(self, stream: Any) -> tuple[bytes, str]:
        """Decode a stream within the limits.

        Returns:
            Its bytes as far as they could be decoded, and what is wrong with it or ``""``.

        Raises:
            LimitError: it stands for more than the limits allow.
        """
        try:
            data: bytes = stream.read_raw_bytes()
        except _own_errors(AttributeError, TypeError, ValueError, RuntimeError) as error:
            return b"", _reason(error)
        damage = ""
        filters_used = _filters_of(stream)
        if len(filters_used) > _MAX_FILTERS:
            return b"", f"it is packed more than {_MAX_FILTERS} times over"
        if not filters_used:
            self.unpacker.charge(len(data))
        for name, parameters in filters_used:
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

    def follow(self, what: str, limit: int) -> None:
        """Count a reference that is followed, by what it is for.

        Raises:
            LimitError: there were more than `limit`.
        """
        self._followed[what] = count = self._followed.get(what, 0) + 1
        if count > limit:
            raise limit_error(what, f"{limit:,}", file=self.file)

    def _charge_slow(self, size: int) -> None:
        """Count bytes that are decoded code by code."""
        self._slow_bytes += size
        if self._slow_bytes > _MAX_SLOW_BYTES:
            raise limit_error("LZW and RunLength data of a PDF", f"{_MAX_SLOW_BYTES // 1_000_000} MB", file=self.file)


def _catalogue(pdf: Any) -> Any:
    """Give the catalogue of an open file, None when it has none."""
    try:
        return pdf.Root
    except _library_errors():
        return None


def _is_above(key: tuple[int, int], own: tuple[int, int], above: list[tuple[Any, Any, tuple[int, int]]]) -> bool:
    """Tell whether a node of the tree of pages is its own ancestor (one without a number cannot be)."""
    return key != (0, 0) and (key == own or any(key == other for _, _, other in above))


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
    try:
        return container.get(key) if is_dictionary(container) else None
    except _library_errors():
        return None


def items(array: Any) -> Iterator[Any]:
    """Go through the elements of an array that can be read; nothing when it is none."""
    import pikepdf

    if not isinstance(array, pikepdf.Array):
        return
    broken = _library_errors()
    for index in range(len(array)):
        try:
            element = array[index]
        except broken:
            continue
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

    try:
        return str(value) if isinstance(value, pikepdf.Name | pikepdf.String) else ""
    except _library_errors():
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
        names = [word(name) for name in islice(items(found), _MAX_FILTERS + 1)]
        all_parameters = list(islice(items(parameters), _MAX_FILTERS + 1))
    names = [_FILTER_NAMES.get(name, name) for name in names]
    return [(name, all_parameters[index] if index < len(all_parameters) else None) for index, name in enumerate(names)]


def _reason(error: Exception) -> str:
    """Give an error of the PDF library without its talk of memory addresses."""
    text = str(error).strip() or type(error).__name__
    return re.sub(r"^.*<[^>]*>[^:]*: *", "", text.splitlines()[0][:500])[:200]


def _own_errors(*others: type[Exception]) -> tuple[type[Exception], ...]:
    """Give the errors of the PDF library itself and others; its versions up to 10.12 have no class for all."""
    import pikepdf

    return pikepdf.PdfError, getattr(pikepdf, "PikepdfError", pikepdf.PdfError), *others


def _library_errors() -> tuple[type[Exception], ...]:
    """Give what the PDF library raises for an object that is not what it should be: it counts as absent."""
    return _own_errors(KeyError, IndexError, AttributeError, TypeError, ValueError, RuntimeError)
