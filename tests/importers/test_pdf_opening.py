"""Opening a PDF: pages, packed and damaged parts, passwords, what is refused with advice."""

import zlib

import pikepdf
import pytest
from pdf_making import make, saved, segments
from pikepdf import Array, Dictionary, Name

from importers.errors import DrawingError
from importers.pdf import looks_like_pdf, read_pdf


def three_pages():
    pdf = pikepdf.new()
    for index in range(3):
        pdf.add_blank_page(page_size=(200, 100))
        pdf.pages[index].Contents = pdf.make_stream(b"%d 0 9 9 re f" % index)
    pdf.pages[1].MediaBox = Array([-50, 0, 30, 70])
    return saved(pdf)


def test_further_pages_are_said():
    pdf = make(b"0 0 1 1 re f")
    pdf.add_blank_page()
    pdf.add_blank_page()
    drawing = read_pdf(saved(pdf))
    assert [problem.message for problem in drawing.problems] == ["the file has 2 more pages; only the first is read"]


def test_a_page_is_chosen_by_its_number():
    first = read_pdf(three_pages())
    assert [problem.code for problem in first.problems] == ["several-pages"]
    for page in (1, 2, 3):
        drawing = read_pdf(three_pages(), page=page)
        assert segments(drawing.paths[0])[0][0] == ("M", page - 1, 0)
        assert (len(drawing.paths), drawing.problems, drawing.artboards) == (1, [], [])


def test_all_pages_stand_side_by_side():
    drawing = read_pdf(three_pages(), page="all")
    assert [segments(path)[0][0] for path in drawing.paths] == [("M", 0, 0), ("M", 251, 0), ("M", 282, 0)]
    assert [(board.x_min, board.x_max, board.y_max) for board in drawing.artboards] == [
        (0, 200, 100),
        (200, 280, 70),
        (280, 480, 100),
    ]
    assert drawing.problems == []


@pytest.mark.parametrize("page", [0, -1, 4, "two", 1.5, True])
def test_a_page_that_there_is_not_is_an_error(page):
    with pytest.raises(DrawingError) as caught:
        read_pdf(three_pages(), page=page)
    assert caught.value.code == "no-such-page"


@pytest.mark.parametrize("packing", ["/FlateDecode", "/ASCIIHexDecode", "/ASCII85Decode", "/RunLengthDecode"])
def test_contents_in_pieces_and_packed(packing):
    import base64

    pack = {
        "/FlateDecode": zlib.compress,
        "/ASCIIHexDecode": lambda raw: raw.hex().encode() + b">",
        "/ASCII85Decode": lambda raw: base64.a85encode(raw) + b"~>",
        "/RunLengthDecode": lambda raw: bytes([len(raw) - 1]) + raw + b"\x80",
    }[packing]
    pdf = make()
    pieces = [pikepdf.Stream(pdf, pack(piece), Filter=Name(packing)) for piece in (b"0 0 m 5 0", b"l 5 5 l f")]
    pdf.pages[0].Contents = Array([pdf.make_indirect(piece) for piece in pieces])
    drawing = read_pdf(saved(pdf, compress_streams=False))
    assert segments(drawing.paths[0]) == [[("M", 0, 0), ("L", 5, 0), ("L", 5, 5)]]
    assert drawing.problems == []


def test_a_stream_that_nobody_can_read_is_said():
    pdf = make()
    pdf.pages[0].Contents = pikepdf.Stream(pdf, b"\xff\xd8", Filter=Name.DCTDecode)
    drawing = read_pdf(saved(pdf))
    assert [problem.code for problem in drawing.problems] == ["damaged-stream"]


def test_resources_are_inherited():
    pdf = make(b"/X Do")
    pdf.Root.Pages.Resources = Dictionary(XObject=Dictionary(X=pdf.make_stream(b"0 0 1 1 re f", Subtype=Name.Form)))
    del pdf.pages[0].Resources
    assert len(read_pdf(saved(pdf)).paths) == 1


def test_a_file_with_an_empty_password_opens_and_another_does_not():
    pdf = make(b"0 0 1 1 re f")
    assert len(read_pdf(saved(pdf, encryption=pikepdf.Encryption(owner="o", user=""))).paths) == 1
    with pytest.raises(DrawingError, match="encrypted"):
        read_pdf(saved(pdf, encryption=pikepdf.Encryption(owner="o", user="u")))


def test_object_streams_are_read():
    data = saved(make(b"0 0 1 1 re f"), object_stream_mode=pikepdf.ObjectStreamMode.generate)
    assert b"/ObjStm" in data
    assert len(read_pdf(data).paths) == 1


def test_a_broken_table_of_objects_is_mended():
    data = saved(make(b"0 0 1 1 re f"))
    assert len(read_pdf(data[: data.rindex(b"xref")]).paths) == 1
    assert len(read_pdf(data.replace(b"startxref", b"startxxxx")).paths) == 1


def moved_table(data, number):
    """Write an object's place in the table of objects ten bytes too far."""
    place = data.index(b"\n%d 0 obj" % number) + 1
    return data.replace(b"%010d 00000 n" % place, b"%010d 00000 n" % (place + 10))


@pytest.mark.parametrize("number", [1, 2, 3], ids=["catalogue", "pages", "page"])
def test_a_table_that_tells_a_wrong_place_is_mended(number):
    data = saved(make(b"0 0 1 1 re f"), object_stream_mode=pikepdf.ObjectStreamMode.disable)
    assert moved_table(data, number) != data
    assert len(read_pdf(moved_table(data, number)).paths) == 1


@pytest.mark.parametrize("root", [b"/Root 99 0 R", b"/Root null", b"/Root 4 0 R", b"/Rot 1 0 R"])
def test_a_file_without_a_catalogue_is_broken_in_words(root):
    data = saved(make(b"0 0 1 1 re f"), object_stream_mode=pikepdf.ObjectStreamMode.disable)
    data = data.replace(b"/Root 1 0 R", root).replace(b"/Type /Catalog", b"/Typo /Catalog")
    with pytest.raises(DrawingError) as caught:
        read_pdf(data)
    assert caught.value.code in ("broken-pdf", "no-pages")


@pytest.mark.parametrize(
    ("data", "code"),
    [
        (b"%PDF-1.4\n", "broken-pdf"),
        (b"%PDF-1.4\n1 0 obj\n" + b"[" * 100_000, "broken-pdf"),
        (b"%PDF-1.4\n1 0 obj<</Type/Catalog>>endobj\ntrailer<</Root 1 0 R>>", "broken-pdf no-pages"),  # older qpdf
        (saved(pikepdf.new()), "no-pages"),
    ],
    ids=["a head alone", "open brackets", "no pages", "no page"],  # older qpdf makes up an /ID each time
)
def test_what_cannot_be_opened_is_refused_with_advice(data, code):
    with pytest.raises(DrawingError) as caught:
        read_pdf(data, "plan.ai")
    assert caught.value.code in code.split()
    assert caught.value.file == "plan.ai"
    assert caught.value.fix


def test_what_it_is_is_told_by_the_content():
    assert looks_like_pdf(b"%PDF-1.7\n")
    assert looks_like_pdf(b"\n\n junk before %PDF-1.4\n")
    assert not looks_like_pdf(b"%!PS-Adobe-3.0\n")
    assert not looks_like_pdf(b"")
