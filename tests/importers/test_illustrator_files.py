"""Whole Illustrator files: where their art is, what stands around it, which alphabet their names are in."""

import base64
import struct
import zlib
from pathlib import Path

import pytest
import zstandard

from importers.errors import DrawingError
from importers.illustrator import read_illustrator

DRAWINGS = Path(__file__).parent / "drawings"
SQUARE = b"0 0 m\n10 0 L\n10 10 L\n0 10 L\n0 0 L\nf\n"
HEAD = b"%!PS-Adobe-3.0\n%%Creator: Adobe Illustrator(TM) 5.5\n%%EndComments\n"


def layer(art, name=b"Walls"):
    return b"%AI5_BeginLayer\n1 1 1 1 0 0 0 79 128 255 Lb\n(" + name + b") Ln\n" + art + b"LB\n%AI5_EndLayer--\n"


def starts(drawing):
    return [path.subpaths[0].segments[0][1:] for path in drawing.paths]


def test_only_art_is_art():
    drawing = read_illustrator((DRAWINGS / "lighthouse_ai5.ai").read_bytes())
    assert drawing.kind == "Illustrator 5.5"
    # Neither the prolog's layer nor the pattern's and the brush's paths, nor what stands behind the page's trailer.
    assert [layer.name for layer in drawing.layers] == ["Tower", "Rocks (hidden)", "Light"]
    assert len(drawing.paths) == 10
    assert drawing.problems == []
    tower, lantern, door, *_ = drawing.paths
    assert (tower.tags, tower.stroke_width, tower.fill) == ({"note": "material=stone"}, 1.5, "#cccccc")
    assert (tower.groups, lantern.groups, len(door.subpaths)) == (("",), ("", ""), 2)
    assert [path.line for path in drawing.paths[:2]] == [55, 63]
    assert [path.layer for path in drawing.paths if not path.visible] == ["Rocks (hidden)"] * 2
    assert all(path.locked for path in drawing.paths if path.layer == "Rocks (hidden)")
    assert sum(path.guide for path in drawing.paths) == 2
    assert [path.fill_rule for path in drawing.paths if path.fill_rule == "evenodd"] == ["evenodd"] * 3


@pytest.mark.parametrize("line_end", [b"\n", b"\r", b"\r\n"])
@pytest.mark.parametrize("markers", [b"%%EndProlog\n%%BeginSetup\n%%EndSetup\n", b"%%EndProlog\n", b""])
def test_setup_and_prolog_may_be_missing(markers, line_end):
    text = (HEAD + markers + layer(SQUARE) + b"%%PageTrailer\n%%Trailer\n").replace(b"\n", line_end)
    drawing = read_illustrator(text)
    assert [path.layer for path in drawing.paths] == ["Walls"]
    assert drawing.paths[0].line == 7 + markers.count(b"\n")
    assert drawing.problems == []


def test_line_ends_may_be_mixed():
    text = HEAD.replace(b"\n", b"\r\n") + b"%%EndSetup\r" + layer(SQUARE)
    assert read_illustrator(text).paths[0].line == 8


@pytest.mark.parametrize("block", ["Pattern", "BrushPattern", "Symbol", "Palette"])
def test_definitions_hold_no_art_wherever_they_stand(block):
    text = f"%AI14_Begin{block}\n(Leaf)\n".encode() + SQUARE + f"%AI10_End{block}\n".encode() + b"5 5 m 6 6 L S\n"
    assert starts(read_illustrator(text)) == [(5, 5)]


def test_binary_data_are_skipped_by_their_count():
    bytes_like_art = b"0 0 m\r9 9 L f\r%%EndData\r" + bytes(range(256))
    data = b"%%BeginData: " + str(len(bytes_like_art)).encode() + b" Binary Bytes\n" + bytes_like_art + b"%%EndData\n"
    for prefix in (b"", b"%_"):
        drawing = read_illustrator(layer(prefix + data + SQUARE))
        assert starts(drawing) == [(0, 0)]
        assert drawing.problems == []


def test_a_wrong_count_of_binary_data_is_made_good():
    # As when a program has turned every CR into CRLF: the count is too small.
    data = b"%%BeginData: 4 Hex Bytes\r\n0 0 m 1 1 L f (((\r\n%%EndData\r\n"
    assert starts(read_illustrator(layer(data + b"7 7 m 8 8 L S\n"))) == [(7, 7)]


def test_binary_data_without_an_end_are_said():
    drawing = read_illustrator(layer(SQUARE) + b"%%BeginData: 999999\nabc")
    assert [problem.code for problem in drawing.problems] == ["bad-data"]
    assert len(drawing.paths) == 1


def test_rasters_and_placed_files_are_said():
    raster = (
        b"%AI5_File:\n%AI5_BeginRaster\n(a.tif) 0 XG\n[1 0 0 1 0 0] 0 0 4 4 Xh\n"
        b"%%BeginData: 5\nXI\n \x00\n%%EndData\nXH\n%AI5_EndRaster\nF\n"
    )
    placed = b"%%BeginDocument: other.eps\n%!PS\n%%EndSetup\n0 0 m 1 1 L f\n%%Trailer\n%%EndDocument\n"
    drawing = read_illustrator(layer(raster + placed + SQUARE))
    assert [problem.code for problem in drawing.problems] == ["image-left-out", "placed-file-left-out"]
    assert [problem.line for problem in drawing.problems] == [5, 15]
    assert len(drawing.paths) == 1


def test_dos_eps_with_its_preview():
    text = HEAD + b"%%EndSetup\n" + layer(SQUARE)
    preview = b"II*\x00" + b"0 0 m 1 1 L f " * 3
    header = struct.pack("<4sIIIIIIH", b"\xc5\xd0\xd3\xc6", 30, len(text), 0, 0, 30 + len(text), len(preview), 0xFFFF)
    drawing = read_illustrator(header + text + preview)
    assert drawing.kind == "Illustrator 5.5"
    assert len(drawing.paths) == 1


def test_dos_eps_with_its_preview_in_front():
    text = HEAD + layer(SQUARE)
    preview = b"0 0 m 1 1 L f " * 3
    header = struct.pack(
        "<4sIIIIIIH", b"\xc5\xd0\xd3\xc6", 30 + len(preview), len(text), 0, 0, 30, len(preview), 0xFFFF
    )
    assert len(read_illustrator(header + preview + text).paths) == 1


def test_pages_after_the_first_are_said():
    text = HEAD + b"%%EndSetup\n%%Page: 1 1\n" + SQUARE + b"%%PageTrailer\n%%Page: 2 2\n" + SQUARE + b"%%PageTrailer\n"
    drawing = read_illustrator(text)
    assert len(drawing.paths) == 1
    assert [(problem.code, problem.line) for problem in drawing.problems] == [("several-pages", 13)]


NAME = "Öffnung für Flügel"


@pytest.mark.parametrize(
    ("head", "line_end", "encoding"),
    [
        (HEAD, b"\r", "mac_roman"),
        (HEAD, b"\r\n", "cp1252"),
        (HEAD.replace(b"(TM)", b"(TM) for Windows, version"), b"\n", "cp1252"),
        (HEAD, b"\n", "mac_roman"),  # LF says nothing; these bytes would be control characters in Latin-1
        (HEAD, b"\n", "latin-1"),
        (HEAD, b"\n", "utf-8"),
        (HEAD, b"\n", "utf-16"),
    ],
)
def test_names_come_in_the_alphabet_of_their_system(head, line_end, encoding):
    octal = b"".join(b"\\%03o" % byte for byte in NAME.encode(encoding))
    raw = NAME.encode(encoding) if encoding != "utf-16" else octal
    for name in {raw, octal}:
        text = (head + b"%%EndSetup\n" + layer(SQUARE, b"?")).replace(b"\n", line_end).replace(b"?", name)
        assert read_illustrator(text).layers[0].name == NAME


def test_parentheses_in_names():
    drawing = read_illustrator(layer(SQUARE, rb"a (b (c)) \) \050 d\\") + layer(SQUARE, b"two\\\nlines"))
    assert [layer.name for layer in drawing.layers] == ["a (b (c)) ) ( d\\", "twolines"]


def test_a_name_that_does_not_end_costs_its_line_only():
    drawing = read_illustrator(b"(Walls Ln\n" + SQUARE)
    assert starts(drawing) == [(0, 0)]
    assert [(problem.code, problem.line, problem.column) for problem in drawing.problems] == [("open-string", 1, 1)]


def in_comments(packed):
    text = base64.a85encode(packed) + b"~>"
    return b"".join(b"%" + text[start : start + 60] + b"\r" for start in range(0, len(text), 60))


@pytest.mark.parametrize(
    ("mark", "pack"), [(b"%AI9_DataStream", zlib.compress), (b"%AI24_DataStream", zstandard.ZstdCompressor().compress)]
)
def test_eps_of_newer_versions_has_its_drawing_behind_the_page(mark, pack):
    page = HEAD + b"%%EndSetup\n5 5 mo 6 6 li cp ef\n%%PageTrailer\n%%EOF\n"
    drawing = b"%%Creator: Adobe Illustrator(R) 24.0\r%%AI8_CreatorVersion: 28.1\r%%EndSetup\r" + layer(SQUARE)
    text = page + b"%AI9_PrivateDataBegin\r" + mark + b"\r" + in_comments(pack(drawing)) + b"%AI9_PrivateDataEnd\r"
    read = read_illustrator(text)
    assert starts(read) == [(0, 0)]
    assert read.layers[0].name == "Walls"
    assert read.paths[0].line is None
    assert "own data" in read.kind
    assert read.problems == []


def test_the_same_unpacked():
    page = HEAD + b"%%EndSetup\n5 5 mo 6 6 li cp ef\n%%PageTrailer\n%%EOF\n"
    text = page + b"%AI9_PrivateDataBegin\n%%EndSetup\n" + layer(SQUARE) + b"%AI9_PrivateDataEnd\n9 9 m 8 8 L f"
    assert starts(read_illustrator(text)) == [(0, 0)]


def test_a_damaged_stream_gives_what_stands_before_the_damage():
    drawing = b"%%EndSetup\r" + layer(b"".join(b"%d 7 m %d 9 L S\r" % (i * i, i) for i in range(3000)))
    packed = zlib.compress(drawing)
    text = HEAD + b"%AI9_PrivateDataBegin\r%AI9_DataStream\r" + in_comments(packed[: len(packed) // 2])
    read = read_illustrator(text)
    assert 0 < len(read.paths) < 3000
    assert [problem.code for problem in read.problems] == ["damaged-stream"]


def test_a_program_without_illustrators_drawing_is_refused():
    with pytest.raises(DrawingError, match="PostScript program"):
        read_illustrator(HEAD + b"%AI5_FileFormat 14.0\n%%EndSetup\n5 5 mo 6 6 li cp ef\n%%PageTrailer\n")


def test_what_is_no_drawing_is_refused_with_advice():
    with pytest.raises(DrawingError, match="24 803 m") as caught:
        read_illustrator(b"Dear Sir,", "letter.txt")
    assert (caught.value.code, caught.value.file) == ("not-a-drawing", "letter.txt")


def test_files_of_other_programs():
    corel = (
        b"%!PS-Adobe-2.0 EPSF-1.2\r\n%%Creator: CorelDRAW\r\n%%EndProlog\r\nAdobe_Illustrator_1.1 begin\r\nn\r\n"
        + SQUARE
    )
    assert read_illustrator(corel).kind == "Illustrator operators by CorelDRAW"
    assert read_illustrator(corel).problems == []


def test_artboards_are_listed_with_their_names():
    entry = (
        "%_/Dictionary :\r%_({name}) /UnicodeString (Name) ,\r%_7991 8041 /RealPoint\r%_ (RulerOrigin) ,\r"
        "%_{right} {bottom} /RealPointRelToROrigin\r%_ (PositionPoint2) ,\r"
        "%_{left} {top} /RealPointRelToROrigin\r%_ (PositionPoint1) ,\r%_; ,\r"
    )
    boards = entry.format(name="Main \\(1\\)", left=0, top=300, right=400.5, bottom=-20)
    boards += entry.format(name="Square", left=450, top=300, right=650, bottom=100)
    setup = f"%AI9_BeginDocumentData\r%_/Array :\r{boards}%_; (ArtboardArray) ,\r%AI9_EndDocumentData\r%%EndSetup\r"
    drawing = read_illustrator(b"%!PS-Adobe-3.0\r" + setup.encode() + layer(SQUARE))
    assert [(board.name, board.x_min, board.y_min, board.x_max, board.y_max) for board in drawing.artboards] == [
        ("Main (1)", 0, -20, 400.5, 300),
        ("Square", 450, 100, 650, 300),
    ]
    assert drawing.to_json()["artboards"][1] == {"name": "Square", "box": [450, 100, 650, 300]}


@pytest.mark.parametrize(("scale", "codes"), [(b"1", []), (b"10", ["large-canvas"])])
def test_a_large_canvas_is_said(scale, codes):
    text = HEAD + b"%AI24_LargeCanvasScale: " + scale + b"\n%%EndSetup\n" + layer(SQUARE)
    drawing = read_illustrator(text)
    assert [problem.code for problem in drawing.problems] == codes
    assert drawing.paths[0].subpaths[0].segments[1] == ("L", 10, 0)
