#!/usr/bin/env bash
# fonttools 4.60.1, svgelements 1.9.6, svg.path 7.0, svgpathtools 1.7.1: what a good engineer guesses and what happens.
#
# Input: the three arcs for which SVG says what to do: one with a radius of 0 (a straight line), one that ends where it
#   starts (left out), and one with negative radii (the sign is dropped).
# Guess: four readers of SVG paths do that: a line of 107.70, nothing, half a circle of 157.08.
# What happens: fontTools leaves the straight line out, so that a wall is missing. svgelements has the right box and a
#   length of 0. svg.path refuses the third. svgpathtools stops at the second with an AssertionError without words, the
#   whole path with it.
set -euo pipefail
cd "$(mktemp -d)"
python3 -m venv venv
venv/bin/pip install -q fonttools==4.60.1 svgelements==1.9.6 svg.path==7.0 svgpathtools==1.7.1
venv/bin/python - <<'PY'
import warnings
from importlib.metadata import version

from fontTools.pens.recordingPen import RecordingPen
from fontTools.svgLib.path import parse_path as fonttools_path
from svg.path import parse_path as svg_path
from svgelements import Path
from svgpathtools import parse_path as svgpathtools_path

warnings.simplefilter("ignore")  # svgpathtools says that it makes the first one a line


def told(measure, data):
    try:
        return f"{measure(data):.2f}"
    except Exception as error:
        return type(error).__name__


def lines(data):
    pen = RecordingPen()
    fonttools_path(data, pen)
    return sum(name in ("lineTo", "curveTo") for name, _ in pen.value)


names = ["fonttools", "svgelements", "svg.path", "svgpathtools"]
measures = [lines, lambda d: Path(d).length(), lambda d: svg_path(d).length(), lambda d: svgpathtools_path(d).length()]
arcs = ["M0 0A0 10 0 0 1 100 40", "M0 0A5 5 0 0 1 0 0L3 4", "M0 0A-50 -50 0 0 1 100 0"]
found = {name: [told(measure, arc) for arc in arcs] for name, measure in zip(names, measures, strict=True)}
for name, row in found.items():
    print(name, version(name), ", ".join(row), "(pieces)" if name == "fonttools" else "(length)")
assert found == {
    "fonttools": ["0.00", "1.00", "2.00"],
    "svgelements": ["0.00", "5.00", "157.08"],
    "svg.path": ["107.70", "5.00", "InvalidPathError"],
    "svgpathtools": ["107.70", "AssertionError", "157.08"],
}, "this has changed"
PY
