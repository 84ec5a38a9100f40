#!/usr/bin/env bash
# svgelements 1.9.6: what a good engineer guesses and what happens.
#
# Input: path data with a point at (0.1234567890123456, 12345678.123456789).
# Guess: Path(text).d() writes numbers that read back as the same floats, as repr of a float does.
# What happens: twelve significant digits: 12345678.1235 comes back, 4e-5 from the point. The path in memory is exact; each
#   time it is written and read, points that two paths share may part by the last of twelve digits.
set -euo pipefail
cd "$(mktemp -d)"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check svgelements==1.9.6
venv/bin/python -I - <<'PYTHON'
import sys
from importlib.metadata import version

from svgelements import Path

print("svgelements", version("svgelements"))
path = Path("M0 0L0.1234567890123456 12345678.123456789")
end = path[1].end
text = path.d()
back = Path(text)[1].end
print("in memory:", end.x, end.y)
print("written:  ", text)
print("read back:", back.x, back.y)
sys.exit(int(end.y != 12345678.123456789 or back.y == end.y))  # 1: this has changed
PYTHON
