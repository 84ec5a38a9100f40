"""Random and damaged Illustrator and PDF files: a reader gives a Drawing or a WallkitError, and nothing else."""

import io
import json
import math
import zlib
from pathlib import Path

import pikepdf
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from importers.drawing import Drawing, control_points
from importers.errors import WallkitError
from importers.illustrator import read_illustrator
from importers.limits import MAX_COORDINATE
from importers.pdf import read_pdf

LIGHTHOUSE = (Path(__file__).parent / "drawings" / "lighthouse_ai5.ai").read_bytes()
SLOW_MACHINES = settings(suppress_health_check=[HealthCheck.too_slow])

WORDS = (
    b"m l L c C v V y Y h H n N f F s S b B * *u *U u U q Q W A XR D Lb Ln LB Xw g G k K x X Xa XA Xx Xk p P w Bb Bg "
    b"BB To Tp TP TO T XI ` ~ : ; X! / [ ] { } << >> ( ) (a) (N) (\\050 /Name /AI11Text /Mesh "
    b"0 1 -1 2.5 .5 5. 1e3 1e999 nan -0 99999999999 %AI3_Note:x %_ %_f %_/XMLUID_:_(a)_; %%BeginData:_3 %%EndData "
    b"%%EndSetup %%PageTrailer %%Trailer %AI5_BeginRaster %AI5_EndRaster %AI3_BeginPattern %AI3_EndPattern "
    b"%%BeginDocument:_a %%EndDocument %AI9_PrivateDataBegin %AI9_DataStream \xc5\xd0\xd3\xc6 \xff \x00"
)
PDF_WORDS = (
    b"m l c v y h re f F f* B B* b b* S s n W W* q Q cm w Do sh g rg k G RG K sc scn SC SCN cs CS BMC BDC EMC BT ET "
    b"Tj TJ ' \" BI ID EI gs d j /OC /A /B /X /Me [ ] << >> ( ) (a) <0 > % 0 1 -1 2.5 .5 1e3 99999999999 nan \xff \x00"
)


def soup(words):
    ends = st.sampled_from([b" ", b"\n", b"\r", b"\r\n", b""])
    word = st.sampled_from([word.replace(b"_", b" ") if b":" in word else word for word in words.split(b" ")])
    return st.lists(st.tuples(word, ends), max_size=120).map(lambda pairs: b"".join(w + e for w, e in pairs))


@st.composite
def damaged(draw, data):
    """Cut, double, overwrite and shuffle pieces of a file."""
    for _ in range(draw(st.integers(1, 6))):
        start = draw(st.integers(0, len(data)))
        stop = draw(st.integers(start, min(len(data), start + 400)))
        piece = draw(
            st.sampled_from([b"", data[start:stop] * 2, b"\xff", b"(", b"%", b"\r", b" 1e999 ", b"-", b"9" * 30])
        )
        data = data[:start] + piece + data[stop:]
    return data[: draw(st.integers(0, len(data)))] if draw(st.booleans()) else data


def check(read, data):
    """What a drawing must keep whatever it was read from."""
    try:
        drawing = read(data)
    except WallkitError:
        return
    assert isinstance(drawing, Drawing)
    for path in drawing.paths:
        assert path.subpaths
        for subpath in path.subpaths:
            assert [segment[0] for segment in subpath.segments].index("M") == 0
            assert all(segment[0] in "LC" for segment in subpath.segments[1:])
            numbers = [number for point in control_points(subpath.segments) for number in point]
            assert all(math.isfinite(number) and abs(number) <= MAX_COORDINATE for number in numbers)
    for problem in drawing.problems:
        assert problem.message
        assert problem.fix
        assert problem.severity in ("error", "warning", "info")
        assert problem.line is None or 1 <= problem.line <= data.count(b"\n") + data.count(b"\r") + 1
    json.dumps(drawing.to_json(), allow_nan=False)


@SLOW_MACHINES
@given(soup(WORDS))
def test_random_operators(text):
    check(read_illustrator, b"0 0 m 1 1 l " + text)


@SLOW_MACHINES
@given(damaged(LIGHTHOUSE))
def test_damaged_files(data):
    check(read_illustrator, data)


@SLOW_MACHINES
@given(st.binary(max_size=300))
def test_random_bytes(data):
    for head in (b"", b"%!PS\n%AI5_\n", b"\xc5\xd0\xd3\xc6", b"%PDF-1.4\n"):
        check(read_pdf if head.startswith(b"%PDF") else read_illustrator, head + data)


def make_pdf(content, private=b"", forms=b"0 0 1 1 re f /Me Do"):
    pdf = pikepdf.new()
    pdf.add_blank_page()
    group = pdf.make_indirect(pikepdf.Dictionary(Type=pikepdf.Name.OCG, Name="Layer"))
    pdf.Root.OCProperties = pikepdf.Dictionary(OCGs=[group], D=pikepdf.Dictionary(OFF=[group]))
    form = pdf.make_indirect(pdf.make_stream(forms, Subtype=pikepdf.Name.Form, Matrix=[1, 0, 0, 1, 2, 3]))
    resources = pikepdf.Dictionary(XObject={"/X": form, "/Me": form}, Properties={"/A": group})
    form.Resources = resources
    page = pdf.pages[0]
    page.Resources = resources
    page.Contents = pdf.make_stream(content)
    if private:
        blocks = pikepdf.Dictionary(AIPrivateData1=pdf.make_stream(private))
        page.PieceInfo = pikepdf.Dictionary(Illustrator=pikepdf.Dictionary(Private=blocks))
    out = io.BytesIO()
    pdf.save(out, compress_streams=False, object_stream_mode=pikepdf.ObjectStreamMode.disable)
    return out.getvalue()


PAGE = make_pdf(b"q 1 0 0 1 5 5 cm /OC /A BDC 0 0 m 5 5 l S /X Do EMC Q 1 0 0 rg 0 0 9 9 re f")
OWN = make_pdf(b"0 0 1 1 re f", b"%AI12_CompressedData" + zlib.compress(LIGHTHOUSE))


@settings(SLOW_MACHINES, max_examples=60)
@given(soup(PDF_WORDS), soup(PDF_WORDS))
def test_random_page_contents(content, form):
    check(read_pdf, make_pdf(content, forms=form))


@settings(SLOW_MACHINES, max_examples=60)
@given(st.one_of(damaged(PAGE), damaged(OWN)))
def test_damaged_pdf_files(data):
    check(read_pdf, data)


@settings(SLOW_MACHINES, max_examples=40)
@given(damaged(LIGHTHOUSE), st.integers(0, 20), st.booleans())
def test_damaged_own_data(data, cut, packed):
    packed_data = zlib.compress(data)
    private = b"%AI12_CompressedData" + packed_data[: len(packed_data) - cut] if packed else data
    check(read_pdf, make_pdf(b"0 0 1 1 re f", private))
