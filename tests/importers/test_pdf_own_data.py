"""Illustrator's own data inside a PDF: which of the two is read, and its artboards."""

import io
import zlib

import pikepdf
import pytest
import zstandard
from pdf_making import make, saved, segments, with_own_data
from pikepdf import Dictionary

from importers.errors import DrawingError
from importers.pdf import read_pdf

OWN_DATA = (
    b"%!PS-Adobe-3.0 \r%%Creator: Adobe Illustrator(R) 24.0\r%%AI8_CreatorVersion: 28.7.3\r%%EndComments\r%%EndSetup\r"
    b"%AI5_BeginLayer\r1 1 1 1 0 0 1 0 79 128 255 0 50 0 Lb\r(Shown) Ln\r0 0 m\r9 0 L\r9 9 L\rf\r"
    b"1 Xw\r1 1 m\r2 1 L\r2 2 L\rf\r0 Xw\rLB\r%AI5_EndLayer--\r"
    b"%AI5_BeginLayer\r0 1 0 1 0 0 1 0 79 128 255 0 50 0 Lb\r(Hidden) Ln\r3 3 m\r4 3 L\r4 4 L\rs\rLB\r%AI5_EndLayer--\r"
    b"%%PageTrailer\r%%Trailer\r%%EOF\r"
)

HEADER = b"%%BoundingBox: 0 0 9 9\r%AI7_Thumbnail: 8 8 8\r"


@pytest.mark.parametrize(
    "data",
    [
        OWN_DATA,
        HEADER + b"%AI12_CompressedData" + zlib.compress(OWN_DATA),
        b"%AI24_ZStandard_Data" + zstandard.ZstdCompressor().compress(OWN_DATA) + bytes(100),
    ],
    ids=["plain", "zlib", "zstd"],
)
@pytest.mark.parametrize("size", [50, 65_536])
def test_illustrators_own_data_come_first(data, size):
    drawing = read_pdf(with_own_data(data, size))
    assert drawing.kind == "Illustrator 28 (PDF with Illustrator's own data)"
    assert [(path.layer, path.visible, path.locked) for path in drawing.paths] == [
        ("Shown", True, False),
        ("Shown", False, False),
        ("Hidden", False, True),
    ]
    assert [layer.visible for layer in drawing.layers] == [True, False]
    assert [path.line for path in drawing.paths] == [None] * 3
    assert drawing.problems == []


def test_without_anything_in_its_own_data_the_page_is_read_and_that_is_said():
    drawing = read_pdf(with_own_data(b"%AI12_CompressedData" + b"broken"))
    assert [path.subpaths[0].segments[0] for path in drawing.paths] == [("M", 0, 0)]
    assert [(problem.code, problem.severity) for problem in drawing.problems] == [("page-content", "info")]
    assert "page content" in drawing.kind


def test_damaged_own_data_give_what_stands_before_the_damage():
    many = OWN_DATA.replace(b"0 0 m\r", b"".join(b"%d 7 m\r%d 9 L\rS\r" % (i * i, i) for i in range(3000)) + b"0 0 m\r")
    packed = zlib.compress(many)
    drawing = read_pdf(with_own_data(b"%AI12_CompressedData" + packed[: len(packed) // 2]))
    assert 0 < len(drawing.paths) < 3000
    assert [(problem.code, problem.severity) for problem in drawing.problems] == [("damaged-stream", "error")]


@pytest.mark.parametrize(
    ("data", "key"),
    [(OWN_DATA, "/AIPDFPrivateData"), (b"%AI24_ZStandard_Data" + zstandard.compress(OWN_DATA), "/AIPDFPrivateData")],
    ids=["plain", "zstd"],
)
@pytest.mark.parametrize("size", [50, 65_536])
def test_own_data_of_a_pdf_saved_with_editing_capabilities_are_read(data, key, size):
    as_ai, as_pdf = read_pdf(with_own_data(data, size)), read_pdf(with_own_data(data, size, key=key))
    assert as_pdf.to_json() == as_ai.to_json()
    assert [layer.name for layer in as_pdf.layers] == ["Shown", "Hidden"]


def test_own_data_in_one_stream_are_read():
    pdf = make(b"0 0 50 50 re f")
    private = pdf.make_stream(b"%AI24_ZStandard_Data" + zstandard.compress(OWN_DATA))
    pdf.pages[0].PieceInfo = Dictionary(Illustrator=Dictionary(Private=private))
    assert [layer.name for layer in read_pdf(saved(pdf)).layers] == ["Shown", "Hidden"]


def test_own_data_under_an_unknown_name_are_missed_aloud():
    drawing = read_pdf(with_own_data(OWN_DATA, key="/AIFutureData"))
    assert [(problem.code, problem.severity) for problem in drawing.problems] == [("page-content", "info")]
    assert segments(drawing.paths[0])[0][0] == ("M", 0, 0)


ARTBOARDS = (
    b"%!PS-Adobe-3.0 \r%%Creator: Adobe Illustrator(R) 24.0\r%%AI8_CreatorVersion: 28.7.3\r%%EndComments\r"
    b"%_/Array :\r%_/Dictionary :\r%_0 0 /RealPointRelToROrigin\r%_ (PositionPoint1) ,\r"
    b"%_200 -150 /RealPointRelToROrigin\r%_ (PositionPoint2) ,\r%_(left) /UnicodeString (Name) ,\r%_;\r"
    b"%_/Dictionary :\r%_250 0 /RealPointRelToROrigin\r%_ (PositionPoint1) ,\r"
    b"%_450 -150 /RealPointRelToROrigin\r%_ (PositionPoint2) ,\r%_(right) /UnicodeString (Name) ,\r%_;\r"
    b"%_; (ArtboardArray) ,\r%%EndSetup\r"
    b"20 -20 m\r90 -20 L\r90 -90 L\rf\r270 -20 m\r340 -20 L\r340 -90 L\rf\r190 -9 m\r260 -9 L\rS\r%%PageTrailer\r"
)


def with_artboards():
    pdf = pikepdf.open(io.BytesIO(with_own_data(ARTBOARDS)))
    pdf.add_blank_page(page_size=(200, 150))
    return saved(pdf)


def test_the_art_of_all_artboards_is_read_and_no_page_is_missed():
    drawing = read_pdf(with_artboards())
    assert (len(drawing.paths), drawing.problems) == (3, [])
    assert [board.name for board in drawing.artboards] == ["left", "right"]
    assert len(read_pdf(with_artboards(), page="all").paths) == 3


@pytest.mark.parametrize(("page", "starts"), [(1, [20, 190]), (2, [270, 190])])
def test_an_artboard_is_chosen_by_its_number(page, starts):
    drawing = read_pdf(with_artboards(), page=page)
    assert [segments(path)[0][0][1] for path in drawing.paths] == starts
    (problem,) = drawing.problems
    assert (problem.code, problem.severity) == ("other-artboards", "info")
    assert problem.message.startswith("1 path is outside artboard")


def test_an_artboard_that_there_is_not_is_an_error():
    with pytest.raises(DrawingError, match="there is no page 3: the drawing has 2"):
        read_pdf(with_artboards(), page=3)
