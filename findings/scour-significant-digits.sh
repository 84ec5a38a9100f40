#!/usr/bin/env bash
# scour 0.38.2: what a good engineer guesses and what happens.
#
# Input: an SVG of 20000 by 20000 with a triangle whose corners have up to three digits behind the point.
# Guess: a precision of 5, the default of the tool behind Inkscape's "optimised SVG", means 5 digits behind the point,
#   as in svgo and in most such tools; nothing changes.
# What happens: it means 5 digits in all. 12345.678 becomes 12346, and because paths are made relative after the first
#   point is rounded, the second corner, which a rounding to 5 digits leaves within 0.5, is 0.32 off as well.
set -euo pipefail
cd "$(mktemp -d)"
python3 -m venv venv
venv/bin/pip install -q scour==0.38.2
venv/bin/python - <<'PY'
import re
from importlib.metadata import version

from scour.scour import scourString

drawn = (
    '<svg xmlns="http://www.w3.org/2000/svg" width="20000" height="20000" viewBox="0 0 20000 20000">'
    '<path d="M12345.678 0.125L12399.5 7.25 12350.25 88.875z"/></svg>'
)
data = re.search(r' d="([^"]*)"', scourString(drawn))[1]
numbers = [float(number) for number in re.findall(r"-?[\d.]+", data)]
second = numbers[0] + numbers[2]
print(f"scour {version('scour')} writes {data}; the corner at 12399.5 is at {second:g}")
assert data.startswith("m12346 ") and abs(second - 12399.822) < 1e-6, "this has changed"
PY
