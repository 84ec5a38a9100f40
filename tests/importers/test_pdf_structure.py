"""The gate in front of the PDF library: every spelling of a compressed object stream is read, and bounded."""

import io
import itertools
import random
import zlib

import pikepdf
import pytest

from importers.errors import DrawingError, LimitError
from importers.limits import Unpacker
from importers.pdf import read_pdf
from importers.pdf.structure import Gate

CATALOGUE = b"<</Type/Catalog/Pages 2 0 R>>"
PAGES = b"<</Type/Pages/Kids[3 0 R]/Count 1>>"
PAGE = b"<</Type/Page/Parent 2 0 R/MediaBox[0 0 300 200]/Resources<<>>/Contents 4 0 R>>"
CONTENT = b"20 20 260 160 re 100 100 m 120 130 l 140 100 l h f"
DEFLATED = {b"Filter": b"/FlateDecode"}
FAR = b"5 0 obj"


def named(spelling):
    """Name a spelling without its function, whose address is another one in each process."""
    return str({key: value for key, value in spelling.items() if key != "pack"})


def packed_objects(objects, first_number=1):
    """Put objects into the text of an object stream: numbers and offsets, then the objects."""
    offsets = itertools.accumulate((len(text) + 1 for text in objects), initial=0)
    head = b" ".join(b"%d %d" % pair for pair in zip(itertools.count(first_number), offsets, strict=False))
    head = b" ".join(head.split()[: 2 * len(objects)])
    return head + b" " + b" ".join(objects), len(head) + 1


def spelled(entries, *, order, blank=b"", between=b""):
    """Write a dictionary with its keys in an order, and something between its tokens."""
    pieces = [b"/" + key + (blank or (b" " if entries[key][:1].isalnum() else b"")) + entries[key] for key in order]
    return b"<<" + between + (between or blank).join(pieces) + between + b">>"


def acrobat_file(write=spelled, *, filters=DEFLATED, pack=zlib.compress, drop=(), inner=None, **spelling):
    """Lay a file out as Adobe's library does: the catalogue and the pages in one object stream, a table as a stream."""
    text, first = inner or packed_objects([CATALOGUE, PAGES, PAGE])
    packed = pack(text)
    entries = {b"Type": b"/ObjStm", b"N": b"3", b"First": b"%d" % first, b"Length": b"%d" % len(packed), **filters}
    entries = {key: value for key, value in entries.items() if key not in drop}
    order = spelling.pop("order", sorted(entries))
    out = b"%PDF-1.5\n%\xe2\xe3\xcf\xd3\n"
    content = len(out)
    out += b"4 0 obj\n<</Length %d>>stream\n%s\nendstream\nendobj\n" % (len(CONTENT), CONTENT)
    objects = len(out)
    out += FAR + b"\n" + write(entries, order=order, **spelling) + b"stream\r\n" + packed + b"\r\nendstream\nendobj\n"
    table = len(out)
    rows = [(0, 0, 0), (2, 5, 0), (2, 5, 1), (2, 5, 2), (1, content, 0), (1, objects, 0), (1, table, 0)]
    body = zlib.compress(b"".join(kind.to_bytes(1, "big") + at.to_bytes(3, "big") + bytes([n]) for kind, at, n in rows))
    entries = {b"Type": b"/XRef", b"W": b"[1 3 1]", b"Size": b"7", b"Root": b"1 0 R", **DEFLATED}
    entries[b"Length"] = b"%d" % len(body)
    out += b"6 0 obj\n" + spelled(entries, order=sorted(entries)) + b"stream\n" + body + b"\nendstream\nendobj\n"
    return out + b"startxref\n%d\n%%%%EOF\n" % table


def boxes(data):
    drawing = read_pdf(data)
    assert drawing.problems == []
    return drawing.control_box(), len(drawing.paths[0].subpaths)


RIGHT = ((20, 20, 280, 180), 2)


def test_keys_in_any_order_are_read():
    for order in itertools.permutations((b"Type", b"N", b"First", b"Length", b"Filter")):
        assert boxes(acrobat_file(order=order)) == RIGHT


@pytest.mark.parametrize(
    "spelling",
    [
        {"blank": b" "},
        {"blank": b"\r\n \x00\t\x0c"},
        {"between": b"%/Filter/ASCIIHexDecode stream >>\n"},
        {"between": b" % endobj (\r"},
        {"filters": {b"Filter": b"[/FlateDecode]"}},
        {"filters": {b"Filter": b"[ /Fl ]"}},
        {"filters": {b"Filter": b"/Fl#61teDecode"}},
        {"filters": {b"F#69lter": b"/FlateDecode"}},
        {"filters": {b"Filter": b"%a comment\n[%another\n/FlateDecode%the last\n]"}},
        {"filters": {**DEFLATED, b"DecodeParms": b"null"}},
        {"filters": {**DEFLATED, b"DecodeParms": b"<</Predictor 1>>"}},
        {"filters": {}, "pack": bytes},
        {"filters": {b"Filter": b"null"}, "pack": bytes},
        {"filters": {b"Filter": b"[]"}, "pack": bytes},
        {"filters": {b"Filter": b"/ASCIIHexDecode"}, "pack": lambda text: text.hex().encode() + b">"},
        {
            "filters": {b"Filter": b"[/AHx/Fl]"},
            "pack": lambda text: zlib.compress(text).hex().encode() + b">",
        },
        {"filters": {b"Filter": b"[/Fl/Fl]"}, "pack": lambda text: zlib.compress(zlib.compress(text))},
        {"filters": {**DEFLATED, b"Extends": b"<</A(a \\) >> (stream))/B<3e3e>>>"}},
    ],
    ids=named,
)
def test_every_spelling_of_the_dictionary_is_read(spelling):
    assert boxes(acrobat_file(**spelling)) == RIGHT


def counted(data):
    """Measure a file and give what was unpacked, in bytes."""
    unpacker = Unpacker("file")
    Gate(data, unpacker, "file").check()
    return unpacker.decoded


HARMLESS = 30_000  # bytes that the packed stream stands for


def bloated():
    text, first = packed_objects([CATALOGUE, PAGES, PAGE])
    return text + b" " * HARMLESS, first


ESCAPED = [
    {},
    {"drop": (b"Type",)},
    {"drop": (b"Length",)},
    {"blank": b"\n"},
    {"between": b"% N First stream\r"},
    {"between": b"(endobj >> stream)"},
    {"between": b"<3e3e>"},
    {"filters": {b"#46ilter": b"/#46lateDecode"}},
    {"filters": {b"Filter": b"[/Fl]"}},
    {"filters": {b"Filter": b"[/AHx/Fl]"}, "pack": lambda text: zlib.compress(text).hex().encode() + b">"},
    {"filters": {b"Filter": b"[/Fl/Fl]"}, "pack": lambda text: zlib.compress(zlib.compress(text))},
    {"filters": {**DEFLATED, b"N": b"6 0 R"}},
    {"filters": {**DEFLATED, b"First": b"6 0 R"}},
    {"filters": {**DEFLATED, b"Length": b"6 0 R"}},
    {"filters": {**DEFLATED, b"Length": b"0"}},
]


@pytest.mark.parametrize("spelling", ESCAPED, ids=named)
def test_what_an_object_stream_stands_for_is_counted_however_it_is_spelled(spelling):
    # The table and the hexadecimal digits add less than a tenth.
    data = acrobat_file(inner=bloated(), **spelling)
    assert HARMLESS < counted(data) < 1.1 * HARMLESS + 1000


def test_random_spellings_are_all_counted():
    choose = random.Random(24).choice
    for seed in range(200):
        shuffled = random.Random(seed)

        def write(entries, *, order, shuffled=shuffled):
            keys = [*order]
            shuffled.shuffle(keys)
            tokens = [b"<<"]
            for key in keys:
                disguised = b"".join(b"#%02x" % byte if choose((True, False)) else bytes([byte]) for byte in key)
                tokens += [b"/" + disguised, choose((b" ", b"\n", b"%x\r", b"\x00 ")), entries[key]]
                tokens.append(choose((b"", b" ", b"% >> stream\n")) if entries[key][:1] != b"3" else b" ")
            return b"".join([*tokens, b">>"])

        assert counted(acrobat_file(write, inner=bloated())) > HARMLESS


@pytest.mark.parametrize(
    "head",
    [FAR + b"%a\n", b"5%a\n0\r%b\nobj\n", b"5 0 obj%a\r%b\r", b"5\x000\x0cobj\x00"],
    ids=["after", "between", "twice", "other blanks"],
)
def test_an_object_is_found_however_its_head_is_spelled(head):
    assert counted(acrobat_file(inner=bloated()).replace(FAR + b"\n", head)) > HARMLESS


def test_a_word_in_the_packed_data_does_not_end_them():
    text, first = bloated()
    stored = zlib.compress(b"endstream endobj " + text, 0)  # level 0 keeps the words as they are
    data = acrobat_file(inner=(text, first), pack=lambda _text: stored)
    assert b"stream\r\nx\x01" in data
    assert counted(data) > HARMLESS


@pytest.mark.parametrize(
    "filters",
    [
        {b"Filter": b"7 0 R"},
        {b"Filter": b"[7 0 R]"},
        {b"Filter": b"/RunLengthDecode"},
        {b"Filter": b"[/FlateDecode/LZWDecode]"},
        {b"Filter": b"/FlateDecode", b"F#69lter": b"null"},
        {**DEFLATED, b"DecodeParms": b"7 0 R"},
        {**DEFLATED, b"DecodeParms": b"<</Predictor 12/Columns 999999>>"},
        {**DEFLATED, b"DecodeParms": b"[<</Predictor 12/Columns 7 0 R>>]"},
        {**DEFLATED, b"Extends": b"(%s)" % bytes(70_000)},
    ],
    ids=lambda filters: str(filters)[:60],
)
def test_what_cannot_be_measured_is_refused(filters):
    with pytest.raises(DrawingError, match="packed in a way"):
        counted(acrobat_file(filters=filters))


def test_an_image_with_any_filter_is_no_concern_of_the_gate():
    data = b"%PDF-1.5\n1 0 obj<</Subtype/Image/Filter[/RunLengthDecode 7 0 R]/N 4>>stream\nx\nendstream endobj"
    assert counted(data) == 0


def test_the_same_bytes_are_not_looked_at_again_and_again():
    once = Gate(b"%PDF-1.4\n" + b"1 0 obj [ 0 ] endobj " * 2000, Unpacker())
    once.check()
    twice = Gate(b"%PDF-1.4\n" + b"1 0 obj [ 0 ] endobj " * 4000, Unpacker())
    twice.check()
    assert twice.looked_at == 2 * once.looked_at
    with pytest.raises(LimitError, match="objects in each other"):
        Gate(b"%PDF-1.4\n" + b"1 0 obj << " * 20_000, Unpacker()).check()


@pytest.mark.parametrize("kind", ["[{}]", "<</A[{}]>>"])
def test_values_are_counted_before_the_library_keeps_them(kind):
    few = Gate(b" obj " + kind.format("0 /A (a(b)) <61> [3] null " * 10).encode(), Unpacker())
    few.check()
    # Words, names, strings with their inner marks, brackets: between one and two for each of the 7 values.
    assert 70 <= few.values <= 140
    with pytest.raises(LimitError, match="values in the objects of a PDF, at most 2,000,000"):
        Gate(b" obj " + kind.format("0 " * 2_000_001).encode(), Unpacker()).check()


def test_values_in_an_object_stream_are_counted_too():
    text, first = packed_objects([CATALOGUE, PAGES, PAGE])
    with pytest.raises(LimitError, match="values in the objects of a PDF"):
        read_pdf(acrobat_file(inner=(text + b"[" + b"/A" * 2_000_001 + b"]", first)))


def encrypted(size, **options):
    pdf = pikepdf.new()
    pdf.add_blank_page(page_size=(200, 100))
    pdf.pages[0].Contents = pdf.make_stream(b"0 0 50 50 re f")
    pdf.Root.Long = pdf.make_indirect(pikepdf.Array([pikepdf.String(random.Random(1).randbytes(size).hex())]))
    out = io.BytesIO()
    pdf.save(out, encryption=pikepdf.Encryption(owner="o", user=""), **options)
    return out.getvalue()


def test_an_encrypted_object_stream_is_bounded_by_what_it_could_stand_for_at_most():
    objects = {"object_stream_mode": pikepdf.ObjectStreamMode.generate}
    assert len(read_pdf(encrypted(100, **objects)).paths) == 1
    with pytest.raises(DrawingError, match="encrypted"):
        read_pdf(encrypted(200_000, **objects))
    assert len(read_pdf(encrypted(200_000, object_stream_mode=pikepdf.ObjectStreamMode.disable)).paths) == 1
