"""PDF files made for tests: a page with contents and resources, and one with Illustrator's own data."""

import io

import pikepdf
from pikepdf import Dictionary

from importers.pdf import read_pdf


def make(content=b"", resources=None, **page):
    pdf = pikepdf.new()
    pdf.add_blank_page(page_size=(200, 100))
    pdf.pages[0].Contents = pdf.make_stream(content)
    if resources is not None:
        pdf.pages[0].Resources = resources(pdf)
    for key, value in page.items():
        pdf.pages[0][f"/{key}"] = value
    return pdf


def saved(pdf, **options):
    out = io.BytesIO()
    pdf.save(out, **options)
    return out.getvalue()


def read(content, resources=None, **page):
    return read_pdf(saved(make(content, resources, **page)))


def segments(path):
    return [subpath.segments for subpath in path.subpaths]


def with_own_data(data, size=65_536, content=b"0 0 50 50 re f", key="/AIPrivateData"):
    pdf = make(content)
    blocks = [data[start : start + size] for start in range(0, len(data), size)]
    private = Dictionary({f"{key}{i}": pdf.make_stream(block) for i, block in enumerate(blocks, 1)})
    pdf.pages[0].PieceInfo = Dictionary(Illustrator=Dictionary(Private=private, LastModified="D:20260101"))
    return saved(pdf)
