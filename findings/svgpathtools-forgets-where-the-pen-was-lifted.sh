#!/usr/bin/env bash
# svgpathtools 1.8.0: what a good engineer guesses and what happens.
#
# Input: paths of two subpaths, where the second begins in the very point in which the first ends: two closed triangles that share
#   a corner, and a closed triangle with an open line from its corner.
# Guess: continuous_subpaths() gives the two outlines that are drawn, and the triangles are closed.
# What happens: one outline each. A path is a list of segments, and a new subpath is one that does not begin where the last one ended;
#   what M and Z say is forgotten. The two triangles are one closed line through the corner twice, the triangle with the line is open,
#   and d() writes them so. Where the second begins a little beside, all is right.
set -euo pipefail
cd "$(mktemp -d)"
python3 -m venv venv && venv/bin/pip install -q svgpathtools==1.8.0
cat > run.py <<'PY'
from importlib.metadata import version

from svgpathtools import parse_path

print("svgpathtools", version("svgpathtools"))


def closed(d):
    """Of each subpath, whether it is closed."""
    path = parse_path(d)
    found = [part.isclosed() for part in path.continuous_subpaths()]
    print(d, "->", path.d(), found)
    return found


assert closed("M0 0H10V10ZM0 0H-10V-10Z") == [True]
assert closed("M0 0H10V10ZM0 0V-5") == [False]
assert closed("M0 0H10V10ZM0.001 0V-5") == [True, False]
PY
venv/bin/python run.py
