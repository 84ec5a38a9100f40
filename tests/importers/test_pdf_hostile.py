"""Hostile PDF files, written here byte by byte: refused by name or read, in 5 s of the processor and 512 MB."""

import math
import resource
import subprocess
import sys

import pytest
from processor import slowness

SECONDS = 5  # on the processor for which they are stated

PREPARE = """
import resource, sys, zlib
import importers.pdf
import numpy, pikepdf
from importers.errors import WallkitError

def pdf(*objects, page=b"", root=b"", kids=b"[3 0 R]"):
    # Objects 1 to 3 are the catalogue, the pages and the page; those given follow from 4.
    first = [b"<</Type/Catalog/Pages 2 0 R" + root + b">>", b"<</Type/Pages/Kids " + kids + b"/Count 1>>"]
    first.append(b"<</Type/Page/Parent 2 0 R/MediaBox[0 0 300 200]" + page + b">>")
    out, places = bytearray(b"%PDF-1.7\\n"), []
    for number, text in enumerate([*first, *objects], 1):
        places.append(len(out))
        out += b"%d 0 obj\\n" % number + text + b"\\nendobj\\n"
    table = len(out)
    out += b"xref\\n0 %d\\n0000000000 65535 f \\n" % (len(places) + 1)
    out += b"".join(b"%010d 00000 n \\n" % place for place in places)
    out += b"trailer<</Size %d/Root 1 0 R>>\\nstartxref\\n%d\\n%%%%EOF" % (len(places) + 1, table)
    return bytes(out)

def stream(data, head=b""):
    packed = zlib.compress(data, 9)
    return b"<<" + head + b"/Filter/FlateDecode/Length %d>>stream\\n" % len(packed) + packed + b"\\nendstream"

def form(data, inner=b""):
    return stream(data, b"/Type/XObject/Subtype/Form/BBox[0 0 9 9]/Resources<</XObject<<" + inner + b">>>>")

def layered(expression, *groups):
    content = stream(b"/OC /A BDC 0 0 9 9 re f EMC " * 1000)
    page = b"/Contents 4 0 R/Resources<</Properties<</A 5 0 R>>>>"
    return pdf(content, b"<</Type/OCMD" + expression + b">>", *groups, page=page, root=b"/OCProperties<</D<<>>>>")

def read(data):
    mapped = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (mapped + 512 * 1048576, mapped + 512 * 1048576))
    used = int(sum(resource.getrusage(resource.RUSAGE_SELF)[:2])) + 1
    resource.setrlimit(resource.RLIMIT_CPU, (used + SECONDS, used + SECONDS))
    try:
        drawing = importers.pdf.read_pdf(data, "hostile")
    except WallkitError as error:
        print(type(error).__name__, error.message)
    else:
        print("read", len(drawing.paths), sorted({problem.code for problem in drawing.problems}))
"""

GROUP = "b'<</Type/OCG/Name(a)>>'"

DRAWN = "page=b'/Contents 4 0 R/Resources<</XObject<</X 5 0 R>>>>'"
PAGE = "page=b'/Contents 4 0 R'"

STORIES = {
    "one stream named 90,000 times": (
        "pdf(stream(b'0 0 m ' + b' ' * 100_000), page=b'/Contents[' + b'4 0 R ' * 90_000 + b']')",
        "content of a page, at most 75 MB",
    ),
    "an empty stream named 200,000 times": (
        "pdf(stream(b''), page=b'/Contents[' + b'4 0 R ' * 200_000 + b']')",
        "streams of a page's content, at most 100,000",
    ),
    "a form of blanks drawn 400,000 times": (
        f"pdf(stream(b'/X Do ' * 400_000), form(b' ' * 1_000_000), {DRAWN})",
        "forms as often as they are drawn, at most 256 MB",
    ),
    "a form of one long word drawn 400,000 times": (
        f"pdf(stream(b'/X Do ' * 400_000), form(b'a' * 1_000_000), {DRAWN})",
        "forms as often as they are drawn, at most 256 MB",
    ),
    "a form of numbers before blanks": (
        f"pdf(stream(b'/X Do ' * 400_000), form((b'1 ' * 8 + b' ' * 200) * 5000), {DRAWN})",
        "operators of a drawing, at most 2,000,000",
    ),
    "one word of 70 MB": (f"pdf(stream(b'a' * 70_000_000), {PAGE})", "unknown-operator"),
    "one name of 70 MB": (f"pdf(stream(b'/' + b'#41' * 23_000_000), {PAGE})", "read 0 []"),
    "long numbers and no operator": (f"pdf(stream((b'1' * 40 + b' ' * 20) * 1_200_000), {PAGE})", "read 0 []"),
    "short numbers and no operator": (
        f"pdf(stream(b'1 ' * 37_000_000), {PAGE})",
        "operators of a drawing, at most 2,000,000",
    ),
    "a page array of 2 million entries": (
        "pdf(b'[' + b'null ' * 1_900_000 + b'3 0 R]', kids=b'4 0 R')",
        "read 0 []",
    ),
    "a page array of 20 million entries": (
        "pdf(b'[' + b'0 ' * 20_000_000 + b'3 0 R]', kids=b'4 0 R')",
        "values in the objects of a PDF, at most 2,000,000",
    ),
    "the same 400,000 pages": ("pdf(b'[' + b'3 0 R ' * 400_000 + b']', kids=b'4 0 R')", "read 0 []"),
    "nodes of pages that name each other": (
        "pdf(b'<</Kids[2 0 R 5 0 R 5 0 R]>>', b'<</Kids[4 0 R 4 0 R 2 0 R]>>', kids=b'[4 0 R 5 0 R 3 0 R]')",
        "read 0 []",
    ),
    "nodes of pages, two for each, 40 deep": (
        "pdf(*[b'<</Kids[%d 0 R %d 0 R]>>' % (n, n) for n in range(5, 45)], b'0', kids=b'[4 0 R 3 0 R]')",
        "pages of a PDF, at most 50,000",
    ),
    "expressions in each other": (
        "layered(b'/VE ' + b'[/Not ' * 400 + b'6 0 R' + b']' * 400, " + GROUP + ")",
        "visibility expressions in each other, at most 32",
    ),
    "expressions that double": (
        "layered(b'/VE 6 0 R', *[b'[/And %d 0 R %d 0 R]' % (n, n) for n in range(7, 37)], " + GROUP + ")",
        "groups in visibility expressions of a PDF, at most 100,000",
    ),
    "an expression of itself": ("layered(b'/VE 6 0 R', b'[/Or 6 0 R]')", "visibility expressions in each other"),
    "a rule over 90,000 groups, asked 1,000 times": (
        "layered(b'/P/AllOn/OCGs[' + b'6 0 R ' * 90_000 + b']', " + GROUP + ")",
        "read 1000 []",
    ),
    "600,000 groups that are off": (
        "pdf(" + GROUP + f", {PAGE}, root=b'/OCProperties<</D<</OFF[' + b'4 0 R ' * 600_000 + b']>>>>')",
        "groups of optional content of a PDF, at most 100,000",
    ),
    "600,000 annotations": (
        "pdf(b'<</Subtype/Square>>', page=b'/Annots[' + b'4 0 R ' * 600_000 + b']')",
        "annotations of a PDF, at most 50,000",
    ),
    "half a million names as a page's resources": (
        "pdf(b'<<' + b''.join(b'/%x 0' % n for n in range(500_000)) + b'>>', page=b'/Resources 4 0 R')",
        "read 0 []",
    ),
    "a table of millions of entries": (
        "pdf(stream(bytes(9_000_000), b'/Type/XRef/W[1 1 0]/Size 9'))",
        "table of objects of a PDF, at most 8 MB",
    ),
    "many object streams without an end": (
        "pdf() + b' 1 0 obj<</N 1/First 1>>stream' * 90_000 + bytes(20_000_000)",
        "objects in each other in a PDF",
    ),
    "half a million filters": (
        "pdf(b'<</Length 9/Filter[' + b'/AHx' * 500_000 + b']>>stream\\n123456789\\nendstream', " + PAGE + ")",
        "read 0 ['damaged-stream']",
    ),
    "half a million digits and letters in ASCIIHex": (
        "pdf(b'<</Length 40000000/Filter/AHx>>stream\\n' + b'a x ' * 10_000_000 + b'\\nendstream', " + PAGE + ")",
        "read 0 [",
    ),
    "10 million objects": ("pdf() + b' obj' * 10_000_000", "objects of a PDF, at most 1,000,000"),
    "5 million objects with brackets": ("pdf() + b' obj [' * 5_000_000", "values in the objects of a PDF"),
    "a comment of 60 MB": ("pdf(b'%' * 60_000_000 + b'\\n0')", "read 0 []"),
    "a list of 30 million parentheses": ("pdf(b'[' + b'(' * 30_000_000)", "values in the objects"),
}


@pytest.mark.parametrize("story", STORIES)
def test_no_small_pdf_stops_the_reader(story):
    make, words = STORIES[story]
    process = subprocess.run(
        [sys.executable, "-c", f"{PREPARE}\nSECONDS = {math.ceil(SECONDS * slowness())}\nread({make})"],
        capture_output=True,
        text=True,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CORE, (0, 0)),
        check=False,
    )
    assert process.returncode == 0, process.stderr[-500:]
    assert words in process.stdout
