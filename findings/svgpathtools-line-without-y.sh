#!/usr/bin/env bash
# svgpathtools 1.8.0: what a good engineer guesses and what happens.
#
# Input: an SVG with a line that has x1 and x2 only. SVG says that an attribute which is not there is 0, and optimisers
#   (svgo, scour) leave such zeros out; a circle without cx and cy is the same case.
# Guess: svg2paths reads a level line at y = 0.
# What happens: KeyError: 'y1', for the whole file. The circle is read at 0, 0.
set -euo pipefail
cd "$(mktemp -d)"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check svgpathtools==1.8.0 numpy==2.3.5 scipy==1.16.3
venv/bin/python -I - <<'PYTHON'
import pathlib
import sys
from importlib.metadata import version

from svgpathtools import svg2paths

print("svgpathtools", version("svgpathtools"))


def read(body: str) -> str:
    pathlib.Path("drawing.svg").write_text(f'<svg xmlns="http://www.w3.org/2000/svg">{body}</svg>')
    try:
        return svg2paths("drawing.svg")[0][0].d()
    except KeyError as error:
        return f"KeyError: {error}"


circle, line = read('<circle r="5"/>'), read('<line x1="1" x2="9"/>')
print("circle:", circle)
print("line:", line)
sys.exit(int(not circle.startswith("M") or line != "KeyError: 'y1'"))  # 1: this has changed
PYTHON
