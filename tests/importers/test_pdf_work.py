"""What a page of a PDF asks for is charged by what it costs, not by the letters that ask for it."""

import io
import sys

import pikepdf
import pytest

from importers.errors import LimitError
from importers.pdf import painting, read_pdf


def page(content, form=b"", forms=1, **options):
    pdf = pikepdf.new()
    pdf.add_blank_page()
    layer = pdf.make_indirect(pikepdf.Dictionary(Type=pikepdf.Name.OCG, Name="Layer"))
    resources = pikepdf.Dictionary(
        XObject={}, Properties={"/A": layer}, ExtGState={"/S": pikepdf.Dictionary({"/ca": 1, "/LW": 2})}
    )
    pdf.pages[0].Resources = resources = pdf.make_indirect(resources)
    for name in ("/X", *(f"/X{n}" for n in range(1, forms))):
        resources.XObject[name] = pdf.make_stream(form, Subtype=pikepdf.Name.Form, Resources=resources, **options)
    pdf.pages[0].Contents = pdf.make_stream(content)
    out = io.BytesIO()
    pdf.save(out, compress_streams=False)
    return out.getvalue()


def calls(data):
    """Calls that Python makes in reading a file; each step of a generator is one."""
    count = 0

    def one_more(_frame, _event, _argument):
        nonlocal count
        count += 1

    sys.setprofile(one_more)
    try:
        read_pdf(data)
    finally:
        sys.setprofile(None)
    return count


def test_a_mark_costs_the_same_however_many_are_around_it():
    def marks(around, number):
        return page(b"/OC /A BDC " * around + b"/a BMC EMC " * number)

    read_pdf(marks(1, 1))  # what is imported late
    few, many = (calls(marks(around, 400)) - calls(marks(around, 0)) for around in (10, 200))
    assert many < 1.1 * few


def test_hidden_and_shown_layers_are_told_within_each_other():
    pdf = pikepdf.open(io.BytesIO(page(b"/OC /A BDC /a BMC 0 0 1 1 re f EMC EMC 0 0 1 1 re f")))
    layer = pdf.pages[0].Resources.Properties.A
    pdf.Root.OCProperties = pikepdf.Dictionary(OCGs=[layer], D=pikepdf.Dictionary(OFF=[layer]))
    out = io.BytesIO()
    pdf.save(out)
    paths = read_pdf(out.getvalue()).paths
    assert [(path.layer, path.visible) for path in paths] == [("Layer", False), ("", True)]


def test_a_form_looks_its_states_up_once_however_often_it_is_drawn(monkeypatch):
    asked = []
    found = painting.get
    monkeypatch.setattr(painting, "get", lambda where, key: asked.append(key) or found(where, key))
    read_pdf(page(b"/X Do " * 50, b"/S gs"))
    assert asked.count("/ExtGState") == 1


BOX = pikepdf.Array([0, 0, 1, 1])
# Each asks for little by its letters: 1,000 operators would do
COSTLY = {
    "images without data": page(b"BI EI " * 100),
    "forms": page(b"/X Do " * 150),
    "forms that differ": page(b"".join(b"/X%d Do " % n for n in range(1, 25)), forms=25),
    "forms with boxes": page(b"/X Do " * 60, BBox=BOX),
    "clips": page(b"0 0 m 9 0 l 9 9 l W n " * 90),
}


@pytest.mark.parametrize("kind", COSTLY)
def test_what_costs_more_than_its_letters_counts_as_so_many_operators(kind, monkeypatch):
    monkeypatch.setattr("importers.pdf.content.MAX_OPERATORS", 1_000)
    with pytest.raises(LimitError, match="operators of a drawing"):
        read_pdf(COSTLY[kind])
