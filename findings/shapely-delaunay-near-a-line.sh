#!/usr/bin/env bash
# shapely 2.1.2 (GEOS 3.13.1): what a good engineer guesses and what happens.
#
# Input: four points, three of them on one line but for the rounding of their coordinates, as feet of perpendiculars are.
# Guess: delaunay_triangles gives Delaunay triangles, since its predicates are exact.
# What happens: a triangle without any width comes out beside one whose circle holds the fourth point, half its radius
#   deep. Whoever relies on empty circles (narrowest gaps, nearest neighbours) has to turn such edges himself.
set -euo pipefail
cd "$(mktemp -d)"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check shapely==2.1.2 numpy==2.3.5
venv/bin/python -I - <<'PYTHON'
import sys

import numpy as np
import shapely

POINTS = np.array([
    (-5.102785461294518, -14.904538032110967),
    (0.18441137427280907, -3.2301572750554595),
    (4.319214951465968, -9.446517458383342),
    (-1.1281396115455458, -6.1283319502277),
])
print(f"shapely {shapely.__version__}, GEOS {shapely.geos_version_string}")
deepest = 0.0
for triangle in shapely.get_parts(shapely.delaunay_triangles(shapely.multipoints(POINTS))):
    a, b, c = shapely.get_coordinates(triangle)[:3]
    u, v = b - a, c - a
    twice = u[0] * v[1] - u[1] * v[0]
    if abs(twice) < 1e-9:
        print("a triangle without width")
        continue
    centre = a + np.array([v[1] * (u @ u) - u[1] * (v @ v), u[0] * (v @ v) - v[0] * (u @ u)]) / (2 * twice)
    radius = np.hypot(*(a - centre))
    deepest = max(deepest, 1 - np.hypot(*(POINTS - centre).T).min() / radius)
print(f"deepest point in a circle: {deepest:.2f} of its radius")
sys.exit(int(deepest < 0.4))  # 1: this has changed
PYTHON
