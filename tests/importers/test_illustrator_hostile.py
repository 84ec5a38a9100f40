"""Hostile files, made here: each is refused by a limit's name, or read, within 512 MB and without a hang.

Each is read by a process of its own. That may have 512 MB more than before it read anything, and a time of the
processor that only a hang would use up; what each takes on a machine of 2024 is 0.1 to 4 s.
"""

import resource
import subprocess
import sys

import pytest

MEBIBYTE = 1 << 20
SECONDS = 30

PREPARE = """
import base64, io, resource, sys, zlib
import importers.pdf, importers.illustrator
import numpy, pikepdf, zstandard
from importers.errors import WallkitError
from pikepdf import Dictionary, Name

def pdf(content, forms=(), private=b""):
    document = pikepdf.new()
    document.add_blank_page()
    page = document.pages[0]
    page.Contents = document.make_stream(content)
    form = None
    for text in forms:
        inner = Dictionary(XObject=Dictionary(X=form)) if form is not None else Dictionary()
        form = document.make_stream(text, Subtype=Name.Form, Resources=inner)
    if form is not None:
        page.Resources = Dictionary(XObject=Dictionary(X=form))
    if private:
        blocks = {f"/AIPrivateData{i}": document.make_stream(block) for i, block in enumerate(private, 1)}
        page.PieceInfo = Dictionary(Illustrator=Dictionary(Private=Dictionary(blocks)))
    out = io.BytesIO()
    document.save(out)
    return out.getvalue()

def packed_structure(kind, size):
    head = b"%PDF-1.5\\n1 0 obj<</Type/" + kind + b"/N 1/First 4/Filter/FlateDecode/Length 9>>stream\\n"
    return head + zlib.compress(bytes(size), 9) + b"\\nendstream endobj\\ntrailer<</Root 1 0 R>>"

def read(data):
    mapped = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (mapped + 512 * 1048576, mapped + 512 * 1048576))
    reader = importers.pdf.read_pdf if data.startswith(b"%PDF") else importers.illustrator.read_illustrator
    try:
        drawing = reader(data, "hostile")
    except WallkitError as error:
        print(type(error).__name__, error.message)
    else:
        print("read", len(drawing.paths), sorted({problem.code for problem in drawing.problems}))
"""

REFUSED = {
    "more than 64 MiB": ("bytes(64 * 1048576 + 1)", "size of the input, at most 64 MiB"),
    "a million lines": (
        "b'0 0 m ' + b'1 1 l ' * 1_100_000",
        "segments, paths and groups of a drawing, at most 1,000,000",
    ),
    "a million curves": ("b'0 0 m ' + b'1 1 2 2 3 3 c ' * 1_100_000", "at most 1,000,000"),
    "points and groups": ("b'0 0 m n u U ' * 300_000", "at most 1,000,000"),
    "millions of operators": ("b'0 0 m ' + b'n ' * 3_000_000", "operators of a drawing, at most 2,000,000"),
    "millions of words": ("b'0 0 m ' + b'word ' * 3_000_000", "operators of a drawing, at most 2,000,000"),
    "a million names": ("b'0 0 m n' + b'\\n%_/XMLUID : (a) ;' * 500_000", "operators of a drawing"),
    "20,000 groups in each other": ("b'u ' * 20_000 + b'0 0 m n ' + b'U ' * 20_000", "in each other, at most 256"),
    "20,000 clips in each other": ("b'q ' * 20_000 + b'0 0 m n'", "in each other, at most 256"),
    "20,000 layers in each other": ("b'1 1 1 1 Lb (a) Ln ' * 20_000", "in each other, at most 256"),
    "names of deep groups": (
        "b'u ' * 250 + b''.join(b'u 0 0 m N U\\n%%_/XMLUID : (a%d) ;\\n' % i for i in range(40_000))",
        "names of groups around paths",
    ),
    "an EPS of 200 MB": (
        "b'%!PS\\n%AI9_PrivateDataBegin\\n%AI9_DataStream\\n' + base64.a85encode(zlib.compress(bytes(200_000_000), 9))",
        "one compressed stream, at most 75 MB",
    ),
    "a page of 200 MB": ("pdf(bytes(200_000_000))", "one compressed stream, at most 75 MB"),
    "own data of 200 MB in zlib": (
        "pdf(b'', private=[b'%AI12_CompressedData' + zlib.compress(bytes(200_000_000), 9)])",
        "one compressed stream, at most 75 MB",
    ),
    "own data of 200 MB in zstd": (
        "pdf(b'', private=[b'%AI24_ZStandard_Data' + zstandard.ZstdCompressor().compress(bytes(200_000_000))])",
        "one compressed stream, at most 75 MB",
    ),
    "own data of 280 MB in pieces": ("pdf(b'', private=[bytes(7_000_000)] * 40)", "own data in a PDF, at most 75 MB"),
    "objects of 200 MB": ("packed_structure(b'ObjStm', 200_000_000)", "one compressed stream, at most 75 MB"),
    "a table of 200 MB": ("packed_structure(b'XRef', 200_000_000)", "one compressed stream, at most 75 MB"),
    "a page of boxes": ("pdf(b'1 1 1 1 re f ' * 200_000)", "segments and paths of a drawing"),
    "a page of millions of operators": ("pdf(b'n ' * 3_000_000)", "operators of a drawing, at most 2,000,000"),
    "a page of 20,000 states": ("pdf(b'q ' * 20_000)", "in each other (q), at most 256"),
    "a page of 20,000 marks": ("pdf(b'/a BMC ' * 20_000)", "marked contents in each other, at most 256"),
    "300 forms in each other": ("pdf(b'/X Do', [b'0 0 m n'] + [b'/X Do'] * 300)", "forms in each other, at most 256"),
    "ten forms, ten times each, nine times over": (
        "pdf(b'/X Do', [b'0 0 1 1 re f'] + [b'/X Do ' * 10] * 9)",
        "at most",
    ),
    "a million definitions": (
        "b'%!PS\\n%AI3_Note\\n' + b'/a { {' * 1_000_000 + b'%%EndProlog\\n0 0 m 1 1 l f'",
        "definitions of a PostScript program, at most 100,000",
    ),
    "a name in disguise": ("packed_structure(b'X#52ef', 200_000_000)", "one compressed stream, at most 75 MB"),
    "nothing, four times, twenty times over": (
        "pdf(b'/X Do', [b' '] + [b'/X Do ' * 4] * 20)",
        "operators of a drawing, at most 2,000,000",
    ),
}

READ = {
    "a number of a million digits": ("b'0 0 m ' + b'9' * 1_000_000 + b' 1 l f'", "bad-coordinate"),
    "ten million parentheses": ("b'0 0 m 1 1 l f ' + b'(' * 10_000_000", "open-string"),
    "ten million braces": ("b'0 0 m 1 1 l f ' + b'{' * 900_000", "read 1"),
    "a million blocks of Adobe's without an end": (
        "b'%!PS\\n%AI3_Note\\n' + b'%%BeginProcSet: Adobe_x\\n' * 1_000_000 + b'%%EndProlog\\n0 0 m 1 1 l f'",
        "read 1 []",
    ),
    "definitions in strings and blanks": (
        "b'%!PS\\n%AI3_Note\\n' + (b'/' + b'a' * 40 + b' ' * 40) * 200_000 + b'/a {(((' * 90_000 + "
        "b'\\n%%EndProlog\\n0 0 m 1 1 l f'",
        "read 1 []",
    ),
    "long numbers and no operator": ("b'0 0 m 1 1 l f ' + (b'1' * 40 + b' ' * 20) * 300_000", "read 1 []"),
    "20,000 compound paths in each other": ("b'*u ' * 20_000 + b'0 0 m n ' + b'*U ' * 20_000", "read 1 []"),
    "a million kinds of objects": (
        "b'0 0 m n ' + b''.join(b'/A%d : ; ' % i for i in range(300_000))",
        "object-left-out",
    ),
    "ten million blanks": ("b'0 0 m' + b' ' * 10_000_000 + b'n'", "read 1 []"),
    "dictionaries in dictionaries": (
        "b'%PDF-1.4\\n1 0 obj\\n' + b'<</A ' * 300_000 + b'>>' * 300_000 + b'\\nendobj\\ntrailer<</Root 1 0 R>>'",
        "DrawingError the PDF is broken",
    ),
    "arrays in arrays": ("b'%PDF-1.4\\n1 0 obj\\n' + b'[' * 1_000_000", "DrawingError the PDF is broken"),
}


def answer_of(make):
    process = subprocess.run(
        [sys.executable, "-c", f"{PREPARE}\nread({make})"],
        capture_output=True,
        text=True,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS)),
        check=False,
    )
    assert process.returncode == 0, process.stderr[-500:]
    return process.stdout


@pytest.mark.parametrize("story", REFUSED)
def test_a_limit_is_named(story):
    make, limit = REFUSED[story]
    answer = answer_of(make)
    assert answer.startswith("LimitError limit hit: ")
    assert limit in answer


@pytest.mark.parametrize("story", READ)
def test_what_is_only_odd_is_read_or_refused_in_words(story):
    make, words = READ[story]
    assert words in answer_of(make)
