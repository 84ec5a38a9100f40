#!/usr/bin/env bash
# pdfplumber 0.11.10: what a good engineer guesses and what happens.
#
# Input: a PDF page with half a circle: two Bezier curves and the chord that closes them.
# Guess: the `pts` of an entry of page.curves are points of the curve, or its control points.
# What happens: they are the ends of the pieces only: three corners and the first again, a triangle. The area inside is 64 %
#   of the drawn one. The control points are kept in another key, `path`.
set -euo pipefail
cd "$(mktemp -d)"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check pdfplumber==0.11.10
venv/bin/python -I - <<'PYTHON'
import io
import math
import sys
from importlib.metadata import version

import pdfplumber

K = 50 * 0.5522847498  # the usual four curves of a circle of radius 50
CONTENT = f"50 100 m 50 {100 + K} {100 - K} 150 100 150 c {100 + K} 150 150 {100 + K} 150 100 c h S".encode()
objects = [
    b"<< /Type /Catalog /Pages 2 0 R >>",
    b"<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
    b"<< /Type /Page /Parent 2 0 R /MediaBox [0 0 200 200] /Contents 4 0 R >>",
    b"<< /Length %d >>\nstream\n%s\nendstream" % (len(CONTENT), CONTENT),
]
pdf, places = b"%PDF-1.4\n", []
for number, body in enumerate(objects, 1):
    places.append(len(pdf))
    pdf += b"%d 0 obj\n%s\nendobj\n" % (number, body)
table = len(pdf)
pdf += b"xref\n0 5\n0000000000 65535 f \n" + b"".join(b"%010d 00000 n \n" % place for place in places)
pdf += b"trailer << /Size 5 /Root 1 0 R >>\nstartxref\n%d\n%%%%EOF\n" % table

print("pdfplumber", version("pdfplumber"))
(curve,) = pdfplumber.open(io.BytesIO(pdf)).pages[0].curves
points = curve["pts"]
area = abs(sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(points, points[1:]))) / 2
drawn = math.pi * 50**2 / 2
print("pts:", points)
print(f"area inside pts {area:.0f}, drawn {drawn:.0f}")
sys.exit(int(len(points) != 4 or abs(area - 2500) > 1))  # 1: this has changed
PYTHON
