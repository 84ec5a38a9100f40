"""Twice the text is at most 2.3 times the work: the calls that the readers of operators make, counted and not timed."""

import contextlib
import io
import sys

import pikepdf
import pytest

from importers.errors import WallkitError
from importers.illustrator import read_illustrator
from importers.pdf import read_pdf

SIZE = 6_000  # bytes of the smaller text

# Pieces of text between bars; \n, \r, \0 and \s stand for what does not show.
ILLUSTRATOR = r"""
1 1 m 2 2 L S\n|1\s|e\s|word\s|(a\n|(a)\s|(\|{|{a}\s|[|<|/a\s|/m{moveto}def\s|*u 1 1 m 2 2 L f\s|*u\n*U\n|u\nU\n|q\nQ\n
1 1 1 1 Lb (a) Ln LB\n|To\nTO\n|/A : ;\n|%_(a\n|%_/XMLUID : (a) ;\n|%_ (AIArtName)|%AI3_Note:x\n|%AI5_BeginRaster\n
%AI5_EndRaster\n|%%BeginData: 3\n|%_%%BeginData: 9 Hex Bytes\n|%%BeginDocument\n|%AI3_BeginPattern\n|%%Page: 1\n|%|\r
\0|\s
%AI3_BeginPattern\n%AI3_EndPattern\n|%%BeginProcSet: Adobe_a\n|gsave translate\s
/Dictionary : 1 1 /RealPointRelToROrigin\n(PositionPoint1) (ArtboardArray)\n
"""
PAGE = r"""
1 1 m 2 2 l S\s|1\s|e\s|word\s|(a|(a) Tj\s|(\|<a|<<|[|/a#41\s|%\s|q Q\s|1 0 0 1 0 0 cm\s|/OC /A BDC EMC\s|/S gs\s
/X Do\s
/C cs 1 scn\s|BI ID x EI\s|BI\s|BT (a) Tj ET\s|1 1 1 1 re W n\s|\0|\s
"""


def pieces(text):
    text = text.replace("\n", "|")
    for sign, meant in ((r"\n", "\n"), (r"\r", "\r"), (r"\0", "\0"), (r"\s", " ")):
        text = text.replace(sign, meant)
    return [piece.encode() for piece in text.split("|") if piece]


def page_of(content):
    pdf = pikepdf.new()
    pdf.add_blank_page()
    pdf.pages[0].Contents = pdf.make_stream(content)
    out = io.BytesIO()
    pdf.save(out)
    return out.getvalue()


def calls(read, data):
    """Count the calls of functions, compiled ones too, that reading takes."""
    count = 0

    def note(_frame, event, _argument):
        nonlocal count
        count += event in ("call", "c_call")

    sys.setprofile(note)
    try:
        read(data)
    except WallkitError:
        pass
    finally:
        sys.setprofile(None)
    return count


def ratio(read, make, unit):
    few, many = (make(unit * (size // len(unit))) for size in (SIZE, 2 * SIZE))
    read(few)  # once before, for what is imported and compiled late
    return calls(read, many) / calls(read, few)


def careless(read):
    def reading(data):
        with contextlib.suppress(WallkitError):
            read(data)

    return reading


@pytest.mark.parametrize("unit", pieces(ILLUSTRATOR), ids=lambda unit: repr(unit)[2:26])
def test_work_of_illustrators_text_grows_with_its_length(unit):
    assert ratio(careless(read_illustrator), lambda text: b"%!PS\n%AI3_\n0 0 m 1 1 L S\n" + text, unit) < 2.3


@pytest.mark.parametrize("unit", pieces(PAGE), ids=lambda unit: repr(unit)[2:26])
def test_work_of_a_page_grows_with_its_length(unit):
    assert ratio(careless(read_pdf), page_of, unit) < 2.3
