"""PostScript programs: refused unless Ghostscript is asked for, which then gives what other programs see in them."""

import os
import shlex
import shutil
import subprocess
import sys

import pytest

from importers import ghostscript
from importers.errors import DrawingError, LimitError
from importers.illustrator import read_illustrator
from importers.read import read_drawing, read_drawing_text

needs_ghostscript = pytest.mark.skipif(shutil.which("gs") is None, reason="Ghostscript is not installed")

# A drawing in pure PostScript: a room, a filled triangle, and a curve that is moved and scaled.
DRAWING = b"""%!PS-Adobe-3.0 EPSF-3.0
%%BoundingBox: 10 15 290 190
%%EndComments
1 setlinewidth newpath 20 20 moveto 280 20 lineto 280 180 lineto 20 180 lineto closepath stroke
newpath 45 100 moveto 95 100 lineto 70 150 lineto closepath fill
gsave 10 20 translate 2 2 scale newpath 50 30 moveto 60 30 80 40 80 60 curveto stroke grestore
showpage
"""
BOXES = [(20, 20, 280, 180), (45, 100, 95, 150), (110, 80, 170, 140)]

OWN_NAMES = b"""%!PS-Adobe-3.0 EPSF-3.0
%%Creator: nobody
%%BoundingBox: 0 0 200 100
%%EndComments
%%BeginProlog
/m {moveto} bind def /l {lineto} bind def /k {closepath} bind def /p {stroke} bind def
/T {translate} bind def /Z {scale} bind def
%%EndProlog
0 100 T 0.1 -0.1 Z
200 200 m 1800 200 l 1000 900 l k p
showpage
%%EOF
"""


def box(path):
    points = [
        segment[at : at + 2] for sub in path.subpaths for segment in sub.segments for at in range(1, len(segment), 2)
    ]
    xs, ys = zip(*points, strict=True)
    return min(xs), min(ys), max(xs), max(ys)


def boxes(drawing):
    return [box(path) for path in drawing.paths if not path.clip]


@pytest.mark.parametrize(
    "program",
    [
        DRAWING,
        OWN_NAMES,
        OWN_NAMES.replace(b"/m {moveto} bind def", b"/m/moveto load def"),
        OWN_NAMES.replace(b"%%BeginProlog\n", b"").replace(b"%%EndProlog\n", b""),
        OWN_NAMES.replace(b"{moveto}", b"{ 2 div exch 2 div exch moveto }").replace(
            b"nobody", b"Adobe Illustrator(TM) 3"
        ),
        OWN_NAMES.replace(b"/Z {", b"/re {").replace(b"nobody", b"Adobe Illustrator(TM) 3"),
        OWN_NAMES.replace(b"nobody", b"Adobe Illustrator(TM) 3.2"),  # T and Z move the axes
        b"%!\n%%EndProlog\n10 20 translate\n0 0 m\n9 0 L\n9 9 L\nf\n",
        b"%!\n%%Creator: Adobe Illustrator(TM) 3.2\n%%EndProlog\n[2 0 0 2 0 0] concat\n0 0 m\n9 0 L\n9 9 L\nf\n",
    ],
    ids=["plain", "names", "names by load", "no prolog", "m halves", "re", "aliases", "moved", "moved by Illustrator"],
)
def test_a_program_is_refused_with_what_to_do(program):
    with pytest.raises(DrawingError) as caught:
        read_drawing_text(program, "room.eps")
    assert caught.value.code == "postscript-program"
    assert caught.value.exit_code == 2
    assert "-o room.pdf room.eps" in caught.value.fix


SHAPE = b"0 0 m\n9 0 L\n9 9 L\nf\n"
ILLUSTRATOR = b"%!PS-Adobe-2.0\n%%Creator: Adobe Illustrator(TM) 3.2\n"


@pytest.mark.parametrize(
    "text",
    [
        b"/m {moveto} def /l {lineto} def /c {curveto} def /*u { /N {/spth 0 def} def } def\n%%EndProlog\n" + SHAPE,
        b"%%BeginProcSet: Adobe_Mine 1.0\n/m {2 mul moveto} def /L {10 10 translate lineto} def\n%%EndProcSet\n"
        + SHAPE,
        b"gsave 10 20 translate grestore\n" + SHAPE,
        b"q 10 20 translate Q\n" + SHAPE,
        b"0 0 translate 1 1 scale 0 rotate [1 0 0 1 0 0] concat\n" + SHAPE,
        SHAPE + b"10 20 translate\n",
        b"/T {translate} def\n%%EndProlog\n" + SHAPE,  # defined, but never used
    ],
    ids=["its own words", "Adobe's", "restored", "restored by Q", "nowhere", "afterwards", "unused"],
)
def test_illustrators_own_text_is_read_whatever_it_defines(text):
    drawing = read_illustrator(ILLUSTRATOR + text)
    assert boxes(drawing) == [(0, 0, 9, 9)]


def test_unknown_operators_are_counted_under_their_own_names():
    drawing = read_illustrator(b"1 glorp 2 blarg " + SHAPE + b"3 glorp\n")
    assert [(problem.code, problem.message) for problem in drawing.problems] == [
        ("unknown-operator", "the operator glorp is not known and was skipped 2 times"),
        ("unknown-operator", "the operator blarg is not known and was skipped"),
    ]


# --- programs by other programs -----------------------------------------------------------------------------


def made_by_command(folder, name, *command):
    program = shutil.which(command[0])
    if program is None:
        pytest.skip(f"{command[0]} is not installed")
    subprocess.run([program, *command[1:]], cwd=folder, check=True, capture_output=True)
    return (folder / name).read_bytes()


def pdf_of(folder):
    (folder / "in.eps").write_bytes(DRAWING)
    made_by_command(folder, "in.pdf", "gs", "-q", "-dSAFER", "-dEPSCrop", "-sDEVICE=pdfwrite", "-o", "in.pdf", "in.eps")


def by_ghostscript(folder):
    (folder / "in.eps").write_bytes(DRAWING)
    return made_by_command(
        folder, "out.eps", "gs", "-q", "-dSAFER", "-dEPSCrop", "-sDEVICE=eps2write", "-o", "out.eps", "in.eps"
    )


def by_pdftops(folder):
    pdf_of(folder)
    return made_by_command(folder, "out.eps", "pdftops", "-eps", "in.pdf", "out.eps")


def by_cairo(folder):
    pdf_of(folder)
    return made_by_command(folder, "out.eps", "pdftocairo", "-eps", "in.pdf", "out.eps")


def by_fig2dev(folder):
    (folder / "in.fig").write_text(
        "#FIG 3.2\nLandscape\nCenter\nInches\nLetter\n100.00\nSingle\n-2\n1200 2\n"
        "2 2 0 1 0 7 50 -1 -1 0.000 0 0 -1 0 0 5\n\t 600 600 3600 600 3600 2400 600 2400 600 600\n"
    )
    return made_by_command(folder, "out.eps", "fig2dev", "-L", "eps", "in.fig", "out.eps")


def by_matplotlib(folder):
    code = (
        "import matplotlib; matplotlib.use('ps'); import matplotlib.pyplot as plt\n"
        "from matplotlib.patches import Rectangle\n"
        "axes = plt.figure(figsize=(3, 2)).add_axes([0, 0, 1, 1]); axes.set_axis_off()\n"
        "axes.add_patch(Rectangle((0.1, 0.1), 0.8, 0.8, fill=False)); plt.savefig('out.eps')\n"
    )
    if subprocess.run([sys.executable, "-c", "import matplotlib"], capture_output=True, check=False).returncode:
        pytest.skip("matplotlib is not installed")
    subprocess.run([sys.executable, "-c", code], cwd=folder, check=True, capture_output=True)
    return (folder / "out.eps").read_bytes()


def by_inkscape(folder):
    (folder / "in.svg").write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" width="4in" height="3in" viewBox="0 0 400 300"><g fill="none" '
        'stroke="black"><rect x="40" y="30" width="300" height="200"/><path d="M60 60H120L90 110z"/>'
        '<path transform="translate(200 100) scale(2)" d="M0 0C10 0 30 10 30 30"/></g></svg>'
    )
    return made_by_command(folder, "out.eps", "inkscape", "in.svg", "-o", "out.eps")


def by_ipe(folder):
    (folder / "in.ipe").write_text(
        '<?xml version="1.0"?><!DOCTYPE ipe SYSTEM "ipe.dtd"><ipe version="70218" creator="nobody"><page>'
        '<path stroke="black">100 100 m 300 100 l 300 250 l 100 250 l h</path>'
        '<path fill="black" matrix="1 0 0 1 20 30">120 120 m 160 120 l 140 160 l h</path>'
        '<path stroke="black">20 0 0 20 240 180 e</path></page></ipe>'
    )
    return made_by_command(folder, "out.eps", "iperender", "-eps", "in.ipe", "out.eps")


def by_libreoffice(folder):
    (folder / "in.svg").write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" width="400" height="300"><g fill="none" stroke="black">'
        '<rect x="40" y="30" width="300" height="200"/><path d="M60 60H120L90 110z"/></g></svg>'
    )
    profile = f"-env:UserInstallation={(folder / 'profile').as_uri()}"
    return made_by_command(
        folder, "in.eps", "soffice", profile, "--headless", "--convert-to", "eps", "--outdir", str(folder), "in.svg"
    )


def by_scribus(folder):
    (folder / "draw.py").write_text(
        "import scribus\n"
        "from scribus import *; newDocument((400, 300), (0, 0, 0, 0), PORTRAIT, 1, UNIT_POINTS, PAGE_1, 0, 1)\n"
        "room, pillar = scribus.createRect(20, 20, 300, 200), scribus.createEllipse(100, 80, 60, 40)\n"
        "scribus.setFillColor('None', room); scribus.setLineColor('Black', room)\n"
        "scribus.setFillColor('Black', pillar); scribus.setLineColor('None', pillar)\n"
        "scribus.savePageAsEPS('out.eps')\n"
    )
    if shutil.which("scribus") is None:
        pytest.skip("scribus is not installed")
    return made_by_command(folder, "out.eps", "xvfb-run", "-a", "scribus", "-g", "-ns", "-py", "draw.py")


PROGRAMS = [
    by_ghostscript, by_pdftops, by_cairo, by_fig2dev, by_matplotlib, by_inkscape, by_ipe, by_libreoffice, by_scribus
]  # fmt: skip


@pytest.mark.parametrize("make", PROGRAMS)
def test_what_programs_write_is_never_read_as_illustrators_operators(make, tmp_path):
    with pytest.raises(DrawingError) as caught:
        read_drawing_text(make(tmp_path), "out.eps")
    assert caught.value.code == "postscript-program"


def boxes_by_mupdf(folder, data):
    """Give the boxes of the paths that MuPDF finds in a program that Ghostscript has made a PDF of, y up."""
    fitz = pytest.importorskip("fitz", reason="MuPDF (pymupdf) is not installed")
    (folder / "judged.eps").write_bytes(data)
    made_by_command(
        folder, "judged.pdf", "gs", "-q", "-dSAFER", "-dEPSCrop", "-sDEVICE=pdfwrite", "-o", "judged.pdf", "judged.eps"
    )
    page = fitz.open(folder / "judged.pdf")[0]
    found = []
    for drawing in page.get_drawings():
        x1, y1, x2, y2 = drawing["rect"]
        found.append((x1, page.rect.height - y2, x2, page.rect.height - y1))
    return found


@needs_ghostscript
@pytest.mark.parametrize("make", PROGRAMS)
def test_ghostscript_reads_what_programs_write_as_mupdf_sees_it(make, tmp_path):
    data = make(tmp_path)
    drawing = read_drawing_text(data, "out.eps", via="ghostscript")
    assert drawing.kind.endswith("(run by Ghostscript)")
    # MuPDF has the page's corner at 0, 0, this reader where the file has it: sizes and distances must agree.
    # Ghostscript writes tenths of a hundredth of a point, MuPDF keeps single precision: 0.01 is ample.
    ours, judged = boxes(drawing), boxes_by_mupdf(tmp_path, data)
    assert len(ours) == len(judged) > 0
    shift = [ours[0][0] - judged[0][0], ours[0][1] - judged[0][1]] * 2
    for mine, other in zip(ours, judged, strict=True):
        assert mine == pytest.approx([a + b for a, b in zip(other, shift, strict=True)], abs=0.01)


# --- Ghostscript as a reader --------------------------------------------------------------------------------


@needs_ghostscript
@pytest.mark.parametrize(
    "change",
    [
        (b"10 15 290 190", b"10 15 290 190"),
        (b"10 15 290 190", b"0 0 300 200"),
        (b"10 15 290 190", b"-30 -40 300 200"),
        (b"10 15 290 190\n", b"10 15 290 190\n%%HiResBoundingBox: 10.5 15.25 289.5 189.5\n"),
        (b" EPSF-3.0", b""),  # a page, not a picture for another page
        (b"\n", b"\r\n"),
    ],
    ids=["as it is", "from 0", "from below 0", "high resolution", "a page", "CRLF"],
)
def test_ghostscript_gives_the_coordinates_of_the_file(change):
    drawing = read_drawing_text(DRAWING.replace(*change), "room.eps", via="ghostscript")
    # Six digits of numbers below 1,000.
    assert boxes(drawing) == [pytest.approx(found, abs=0.001) for found in BOXES]
    assert [path.stroke is not None for path in drawing.paths] == [True, False, True]
    assert drawing.problems == []


@needs_ghostscript
def test_ghostscript_follows_names_of_a_programs_own():
    drawing = read_drawing_text(OWN_NAMES, via="ghostscript")
    (path,) = drawing.paths
    assert path.subpaths[0].closed
    points = [segment[1:] for segment in path.subpaths[0].segments]
    assert points == [pytest.approx(point, abs=0.001) for point in [(20, 80), (180, 80), (100, 10)]]


@needs_ghostscript
def test_the_advice_of_the_message_works(tmp_path):
    (tmp_path / "a room.eps").write_bytes(DRAWING)
    with pytest.raises(DrawingError) as caught:
        read_drawing(tmp_path / "a room.eps")
    command = caught.value.fix.partition(": ")[2].partition(";")[0]
    subprocess.run(shlex.split(command), cwd=tmp_path, check=True)
    # The picture's corner becomes the page's: 10, 15 is taken off.
    expected = [(x1 - 10, y1 - 15, x2 - 10, y2 - 15) for x1, y1, x2, y2 in BOXES]
    assert boxes(read_drawing(tmp_path / "a room.pdf")) == [pytest.approx(found, abs=0.001) for found in expected]


@needs_ghostscript
def test_a_preview_around_a_program_does_no_harm():
    header = b"\xc5\xd0\xd3\xc6" + (30).to_bytes(4, "little") + len(DRAWING).to_bytes(4, "little") + bytes(18)
    drawing = read_drawing_text(header + DRAWING + b"preview", via="ghostscript")
    assert boxes(drawing) == [pytest.approx(found, abs=0.001) for found in BOXES]


@needs_ghostscript
def test_a_program_sees_no_other_file(tmp_path):
    secret = tmp_path / "secret.txt"
    secret.write_text("20 20 moveto 30 30 lineto stroke")
    for attempt in (b"(%s) run", b"(%s) (r) file pop", b"(%s) deletefile", b"(%s) (w) file pop"):
        program = b"%!PS\n" + attempt % os.fsencode(secret) + b" showpage\n"
        with pytest.raises(DrawingError, match=r"invalidfileaccess|ioerror") as caught:
            read_drawing_text(program, via="ghostscript")
        assert caught.value.code == "postscript-program"
    assert secret.read_text().startswith("20 20")


@needs_ghostscript
def test_a_program_without_an_end_is_ended(monkeypatch):
    monkeypatch.setattr(ghostscript, "_SECONDS", 1)
    with pytest.raises(LimitError, match="Ghostscript may take, at most 1 second"):
        read_drawing_text(b"%!PS\n{} loop\n", via="ghostscript")


@needs_ghostscript
def test_a_program_that_wants_all_memory_is_refused(monkeypatch):
    monkeypatch.setattr(ghostscript, "_MEMORY", 1 << 28)
    with pytest.raises(DrawingError, match="VMerror"):
        read_drawing_text(b"%!PS\n{ 60000 string } loop\n", via="ghostscript")


def test_without_ghostscript_that_is_said(monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(DrawingError) as caught:
        read_drawing_text(DRAWING, via="ghostscript")
    assert caught.value.code == "no-ghostscript"


@pytest.mark.parametrize(
    ("data", "via", "code"),
    [(DRAWING, "inkscape", "no-such-reader"), (b"<svg/>", "ghostscript", "not-a-drawing")],
)
def test_what_cannot_be_done_by_way_of_another_program_is_said(data, via, code):
    with pytest.raises(DrawingError) as caught:
        read_drawing_text(data, via=via)
    assert caught.value.code == code
