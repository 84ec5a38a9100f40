#!/usr/bin/env bash
# shapely 2.2.0 with GEOS 3.14.1: what a good engineer guesses and what happens.
#
# Input: the outline of a square of 10 by 10, to be given a thickness of 1 on one side; and three sides of it, for comparison.
# Guess: buffer(outline, 1, single_sided=True) is the strip along it: 36 of area inside, 44 outside with mitred corners.
# What happens: inside it is the square of 8 by 8 that the strip would leave (64), outside the square itself, with no thickness at
#   all (100): each time what the inner border of the strip encloses. A ring or a closed line, both windings and signs: the same. Of
#   the open line it is the strip. A hollow wall comes out solid, or with its middle filled and its wall gone.
set -euo pipefail
cd "$(mktemp -d)"
python3 -m venv venv && venv/bin/pip install -q shapely==2.2.0
cat > run.py <<'PY'
import shapely

print("shapely", shapely.__version__, "GEOS", shapely.geos_version_string)
corners = [(0, 0), (10, 0), (10, 10), (0, 10)]


def areas(line):
    """Of the buffer to the left, and to the right."""
    found = [shapely.buffer(line, d, single_sided=True, join_style="mitre").area for d in (1, -1)]
    print(line, "->", found)
    return found


assert areas(shapely.LinearRing(corners)) == [64, 100]
assert areas(shapely.LineString([*corners, corners[0]])) == [64, 100]
assert areas(shapely.LinearRing(corners[::-1])) == [100, 64]
assert areas(shapely.LineString(corners)) == [28, 32]
PY
venv/bin/python run.py
