#!/usr/bin/env bash
# svglib 2.3.2: what a good engineer guesses and what happens.
#
# Input: a square of 10 by 10, drawn in an inner svg of 50 by 50 whose viewBox is 10 by 10; and the same as a symbol, used 50 by 50.
# Guess: 50 by 50 units of the file both times, as in any browser, which are 37.5 points of the drawing that comes out.
# What happens: the inner svg is made 28.125 points, for its size is turned from px into points once for itself and once more with
#   everything around it. The symbol's viewBox is not looked at: its square stays 10 by 10. Parts of a drawing that were made to
#   fit do not meet, and nothing is said.
set -euo pipefail
cd "$(mktemp -d)"
python3 -m venv venv && venv/bin/pip install -q svglib==2.3.2
cat > run.py <<'PY'
from importlib.metadata import version
from pathlib import Path

from svglib.svglib import svg2rlg

print("svglib", version("svglib"))


def size(body):
    """Width and height of what is drawn, in units of the file."""
    head = '<svg xmlns="http://www.w3.org/2000/svg" width="100" height="100" viewBox="0 0 100 100">'
    Path("drawing.svg").write_text(f"{head}{body}</svg>")
    x0, y0, x1, y1 = svg2rlg("drawing.svg").getBounds()
    found = round((x1 - x0) / 0.75, 6), round((y1 - y0) / 0.75, 6)
    print(body, "->", found)
    return found


square = '<rect width="10" height="10"/>'
assert size(f'<g transform="scale(5)">{square}</g>') == (50, 50)
assert size(f'<svg width="50" height="50" viewBox="0 0 10 10">{square}</svg>') == (37.5, 37.5)
assert size(f'<symbol id="s" viewBox="0 0 10 10">{square}</symbol><use href="#s" width="50" height="50"/>') == (10, 10)
PY
venv/bin/python run.py
