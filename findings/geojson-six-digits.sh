#!/usr/bin/env bash
# geojson 3.2.0: what a good engineer guesses and what happens.
#
# Input: a point with the coordinates 0.123456789012 and 12345.678901234, as text.
# Guess: geojson.loads gives the numbers of the text, as json.loads does; if anything rounds, it is dumps.
# What happens: loads itself rounds to six decimals, and what is dumped again has them. A grid of a millionth of a degree
#   (0.1 m) is fine for a map and not for a level drawn in metres. `precision=` takes it back, for objects that one makes;
#   loads has no such argument, and the way out is geojson.geometry.DEFAULT_PRECISION.
set -euo pipefail
cd "$(mktemp -d)"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check geojson==3.2.0
venv/bin/python -I - <<'PYTHON'
import json
import sys
from importlib.metadata import version

import geojson

TEXT = '{"type": "Point", "coordinates": [0.123456789012, 12345.678901234]}'
print("geojson", version("geojson"))
loaded = geojson.loads(TEXT)["coordinates"]
print("json:", json.loads(TEXT)["coordinates"])
print("geojson.loads:", loaded)
geojson.geometry.DEFAULT_PRECISION = 15
more = geojson.loads(TEXT)["coordinates"]
print("with DEFAULT_PRECISION = 15:", more)
sys.exit(int(loaded != [0.123457, 12345.678901] or more != [0.123456789012, 12345.678901234]))  # 1: this has changed
PYTHON
