#!/usr/bin/env bash
# fpdf2 2.8.4: what a good engineer guesses and what happens.
#
# Input: one triangle on a page in points, drawn by polygon() and by new_path(), with corners of six digits behind the
#   point.
# Guess: both write the same corners, with the digits that were given or some fixed number of them.
# What happens: polygon() (and line(), rect() and circle()) write two digits, new_path() four. In a drawing in
#   centimetres, where a unit is 28 points, the two differ by as much as 0.005 points; walls drawn by one and by the
#   other do not meet.
set -euo pipefail
cd "$(mktemp -d)"
python3 -m venv venv
venv/bin/pip install -q fpdf2==2.8.4 pikepdf==10.0.2
venv/bin/python - <<'PY'
import io
import re
from importlib.metadata import version

import pikepdf
from fpdf import FPDF

CORNERS = [(100.123456, 100.004949), (200.987654, 100.1), (150.5, 180.333333)]


def written(draw):
    pdf = FPDF(unit="pt", format=(500, 500))
    pdf.add_page()
    draw(pdf)
    with pikepdf.open(io.BytesIO(bytes(pdf.output()))) as document:
        content = document.pages[0].Contents.read_bytes().decode()
    return re.search(r"(\S+) \S+ m", content)[1]


def by_path(pdf):
    with pdf.new_path() as path:
        path.move_to(*CORNERS[0])
        for corner in CORNERS[1:]:
            path.line_to(*corner)
        path.close()


polygon, path = written(lambda pdf: pdf.polygon(CORNERS, style="D")), written(by_path)
print(f"fpdf2 {version('fpdf2')}: x = 100.123456 is {polygon} by polygon() and {path} by new_path()")
assert (polygon, path) == ("100.12", "100.1235"), "this has changed"
PY
