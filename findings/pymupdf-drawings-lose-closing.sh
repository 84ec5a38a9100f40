#!/usr/bin/env bash
# PyMuPDF 1.26.6: what a good engineer guesses and what happens.
#
# Input: a PDF page with a triangle that is closed by the operator `h`, and the same with a line back to its start.
# Guess: page.get_drawings() tells them apart by its key `closePath`, which is there for that.
# What happens: both are three lines with closePath False, equal but for their place. A closed wall and a line that ends
#   where it began differ in every drawing program (joins, what a pen fills), and the closing line of `h` has become a drawn
#   one, so a reader has to guess closing from equal ends.
set -euo pipefail
cd "$(mktemp -d)"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check pymupdf==1.26.6
venv/bin/python -I - <<'PYTHON'
import sys
from importlib.metadata import version

import pymupdf

print("PyMuPDF", version("pymupdf"))


def drawing(content: bytes):
    document = pymupdf.open()
    page = document.new_page(width=100, height=100)
    xref = document.get_new_xref()
    document.update_object(xref, "<<>>")
    document.update_stream(xref, content)
    page.set_contents(xref)
    (found,) = page.get_drawings()
    return found["closePath"], [item[0] for item in found["items"]], [tuple(item[2]) for item in found["items"]]


by_operator = drawing(b"10 10 m 20 10 l 20 20 l h S")
by_line = drawing(b"10 10 m 20 10 l 20 20 l 10 10 l S")
print("closed by h:", by_operator)
print("closed by a line:", by_line)
sys.exit(int(by_operator != by_line or by_operator[0] is not False))  # 1: this has changed
PYTHON
