"""Inputs that once made a reader fail: each was found by fuzzing, and each is read or refused in words now."""

import json

import pytest
from pdf_making import make, saved

from importers.errors import WallkitError
from importers.illustrator import read_illustrator
from importers.pdf import read_pdf

ILLUSTRATOR = {
    "a finding beside an infinite point": b"0 0 m\n1 0 0 0 0 1e999 c\n1 2 3 l\n1 2 3 4 5 c\nf",
    "an infinite line width": b"1e999 w 0 0 m 1 1 l S",
}
PAGES = {
    "a form without a name": b"Do 0 0 m 1 1 l S",
    "an infinite line width": b"1e999 w 0 0 m 1 1 l S",
    "a width scaled beyond all numbers": b"1e200 0 0 1e200 0 0 cm 9 w 0 0 m 0 0 l S",
}


@pytest.mark.parametrize("story", ILLUSTRATOR)
def test_illustrator(story):
    drawing = read_illustrator(ILLUSTRATOR[story])
    json.dumps(drawing.to_json(), allow_nan=False)
    assert drawing.problems


@pytest.mark.parametrize("story", PAGES)
def test_pages(story):
    try:
        drawing = read_pdf(saved(make(PAGES[story])))
    except WallkitError:
        return
    assert json.dumps(drawing.to_json(), allow_nan=False)
