"""Coverage-guided fuzzing of the PDF reader; run by hand, not by pytest.

    pip install atheris
    PYTHONPATH=. python tests/fuzz/fuzz_pdf.py -max_total_time=600 FOLDER

The first byte chooses what the rest is: a file, the content of a page, a form, Illustrator's own data, or the
dictionary of an object stream; its highest bit reads all pages. Whatever
leaves the reader that is no WallkitError is a bug: keep the crasher in tests/importers/test_illustrator_crashers.py.
"""

from __future__ import annotations

import io
import json
import sys
import zlib

import atheris
import pikepdf

with atheris.instrument_imports(include=["importers"]):
    from importers.errors import WallkitError
    from importers.pdf import read_pdf


def make_file(data: bytes) -> bytes:
    """Wrap what the fuzzer made in a PDF, so that it need not invent one."""
    kind, rest = data[0] % 7, data[1:]
    if kind == 0:
        return b"%PDF-1.4\n" + rest
    if kind == 6:
        packed = zlib.compress(b"1 0 2 30 <</Type/Catalog/Pages 2 0 R>> <</Kids[3 0 R]>>")
        head = b"%PDF-1.5\n5 0 obj<<" + rest + b"/Filter/FlateDecode/N 2/First 9/Type/ObjStm"
        return head + b"/Length %d>>stream\n%s\nendstream endobj\ntrailer<</Root 1 0 R>>" % (len(packed), packed)
    pdf = pikepdf.new()
    pdf.add_blank_page()
    page = pdf.pages[0]
    group = pdf.make_indirect(pikepdf.Dictionary(Type=pikepdf.Name.OCG, Name="Layer"))
    pdf.Root.OCProperties = pikepdf.Dictionary(OCGs=[group], D=pikepdf.Dictionary(OFF=[group]))
    rule = pdf.make_indirect(pikepdf.Dictionary(Type=pikepdf.Name.OCMD, VE=[pikepdf.Name.Not, group]))
    unseen = pikepdf.Dictionary({"/ca": 0, "/LW": 2})
    tiles = pdf.make_stream(b"0 0 1 1 re f", PatternType=1, Resources=pikepdf.Dictionary())
    page.Annots = [pikepdf.Dictionary(Subtype=pikepdf.Name.Square)]
    form = pdf.make_indirect(pdf.make_stream(rest if kind == 2 else b"0 0 1 1 re f", Subtype=pikepdf.Name.Form))
    masked = pikepdf.Dictionary(SMask=pikepdf.Dictionary(S=pikepdf.Name.Alpha, G=form))
    form.Resources = page.Resources = pikepdf.Dictionary(
        XObject={"/X": form},
        Properties={"/A": group, "/B": rule},
        ExtGState={"/S": unseen, "/M": masked},
        Pattern={"/T": tiles, "/H": pikepdf.Dictionary(PatternType=2)},
        ColorSpace={"/P": pikepdf.Array([pikepdf.Name.Pattern, pikepdf.Name.DeviceRGB])},
    )
    page.Contents = pdf.make_stream(rest if kind == 1 else b"/OC /A BDC /X Do EMC")
    if kind == 3:
        name = (pikepdf.Name.LZWDecode, pikepdf.Name.RunLengthDecode, pikepdf.Name.ASCII85Decode)[len(rest) % 3]
        page.Contents = pikepdf.Stream(pdf, rest, Filter=name)
    if kind >= 4:
        own = b"%AI12_CompressedData" + zlib.compress(rest) if kind == 5 else rest
        private = pikepdf.Dictionary(AIPrivateData1=pdf.make_stream(own))
        page.PieceInfo = pikepdf.Dictionary(Illustrator=pikepdf.Dictionary(Private=private))
    out = io.BytesIO()
    pdf.save(out, compress_streams=False)
    return out.getvalue()


def read_once(data: bytes) -> None:
    """Read what the fuzzer made."""
    if not data:
        return
    try:
        drawing = read_pdf(make_file(data), "fuzz", "all" if data[0] >= 128 else None)
    except WallkitError:
        return
    json.dumps(drawing.to_json(), allow_nan=False)


if __name__ == "__main__":
    atheris.Setup(sys.argv, read_once)
    atheris.Fuzz()
