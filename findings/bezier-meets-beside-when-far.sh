#!/usr/bin/env bash
# bezier 2024.6.20: what a good engineer guesses and what happens.
#
# Input: an arch 10 wide and 7.5 high and the level line through its middle, cut with Curve.intersect where they stand and moved
#   by 10, 1000, 100000, a million and ten million along both axes, as drawings in map coordinates are. All coordinates are whole.
# Guess: two points each time, on both curves to the rounding of such coordinates, 1e-9 at a million.
# What happens: up to 100000 so it is. From a million on the first of the two is the middle of both, where the arch is 2.5
#   above the line, a quarter of its width away from it, and nothing is said. Curves are to be moved to the origin before they are
#   cut.
set -euo pipefail
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check bezier==2024.6.20 numpy==2.3.5
venv/bin/python -I - <<'PYTHON'
import sys
from importlib.metadata import version

import bezier
import numpy as np

ARCH = np.array([[0.0, 0.0, 10.0, 10.0], [0.0, 10.0, 10.0, 0.0]])
LINE = np.array([[0.0, 10.0], [5.0, 5.0]])


def apart(moved):
    arch = bezier.Curve.from_nodes(np.asfortranarray(ARCH + moved))
    line = bezier.Curve.from_nodes(np.asfortranarray(LINE + moved))
    on_arch, on_line = (np.asfortranarray(row) for row in arch.intersect(line))
    gaps = arch.evaluate_multi(on_arch) - line.evaluate_multi(on_line)
    return [float(f"{gap:.1e}") for gap in np.hypot(*gaps)]


print("bezier", version("bezier"))
changed = False
for moved in (0, 10, 1000, 100_000, 1_000_000, 10_000_000):
    found = apart(moved)
    print(f"moved by {moved}: the two points are {found} from one curve to the other")
    changed |= (max(found) > 1) != (moved >= 1_000_000)
sys.exit(int(changed))  # 1: this has changed
PYTHON
