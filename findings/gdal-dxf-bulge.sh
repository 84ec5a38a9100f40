#!/usr/bin/env bash
# GDAL 3.11.4 (in the wheel of pyogrio 0.12.1): what a good engineer guesses and what happens.
#
# Input: a DXF with one LWPOLYLINE from (0, 0) to (10, 0) and a bulge, which is tan(angle / 4) of an arc, so that
#   1 is a half circle and 3 an arc of 286 degrees. DXF sets no limit on it, and ezdxf draws all of them.
# Guess: an arc of length radius * angle: 41.64 for 3, and as much for -3.
# What happens: above +1 GDAL draws the complementary arc, on the other side of the chord: 10.72 for 3. It is right
#   for -3, and for all from -1 to 1. An arc of more than a half circle has to be cut in two to be safe.
set -euo pipefail
cd "$(mktemp -d)"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check pyogrio==0.12.1 numpy==2.3.5 shapely==2.1.2
venv/bin/python -I - <<'PY'
import math

import pyogrio
import shapely

print("pyogrio", pyogrio.__version__, "GDAL", pyogrio.__gdal_version_string__)


def length(bulge):
    with open("arc.dxf", "w") as file:
        tags = [(0, "SECTION"), (2, "ENTITIES"), (0, "LWPOLYLINE"), (8, "0"), (90, 2), (70, 0), (10, 0.0), (20, 0.0)]
        tags += [(42, bulge), (10, 10.0), (20, 0.0), (0, "ENDSEC"), (0, "EOF")]
        file.write("".join(f"{code}\n{value}\n" for code, value in tags))
    _, _, geometry, _ = pyogrio.raw.read("arc.dxf")
    return shapely.from_wkb(geometry[0]).length


for bulge, right in ((1.0, True), (-1.0, True), (0.5, True), (-3.0, True), (-1.5, True), (3.0, False), (1.5, False)):
    angle = 4 * math.atan(abs(bulge))
    truth = angle * 10 * (1 + bulge * bulge) / (4 * abs(bulge))
    found = length(bulge)
    print(f"bulge {bulge:+}: arc of length {truth:.2f}, GDAL draws {found:.2f}")
    assert (abs(found - truth) < 0.01 * truth) == right, "this has changed"
PY
