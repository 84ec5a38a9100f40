#!/usr/bin/env bash
# shapely 2.1.2: what a good engineer guesses and what happens.
#
# Input: a point with the coordinate 0.39465431434570064, written as well-known text with rounding_precision=-1, which
#   the manual explains as "use the full precision", and with the attribute `wkt`.
# Guess: the text reads back to the same number, as Python's repr does.
# What happens: 16 digits are written, 0.3946543143457006, which is the neighbouring number. A vertex that two
#   geometries share no longer is one after a round trip. rounding_precision=17 keeps every number.
set -euo pipefail
cd "$(mktemp -d)"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check shapely==2.1.2 numpy==2.3.5
venv/bin/python -I - <<'PY'
import shapely

print("shapely", shapely.__version__, "GEOS", shapely.geos_version_string)
x = 0.39465431434570064
point = shapely.Point(x, 1)
for how, text in (
    ("rounding_precision=-1", shapely.to_wkt(point, rounding_precision=-1)),
    ("wkt", point.wkt),
    ("rounding_precision=17", shapely.to_wkt(point, rounding_precision=17)),
):
    again = shapely.from_wkt(text).x
    print(f"{how}: {text}, reads back {'the same' if again == x else 'as another number'}")
    assert (again == x) == (how == "rounding_precision=17"), "this has changed"
assert shapely.from_wkt(f"POINT ({x!r} 1)").x == x, "reading is to blame, not writing"
PY
