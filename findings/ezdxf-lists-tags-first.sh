#!/usr/bin/env bash
# ezdxf 1.4.2: what a good engineer guesses and what happens.
#
# Input: a drawing with one LWPOLYLINE of 200,000 points, written to a stream that forgets what it gets.
# Guess: writing takes next to no memory: the points lie in a packed numpy array, and the text goes to a stream.
# What happens: it takes more than 100 bytes for each point, several times the text itself: the tags of an entity are
#   listed, an object of its own for each point, before the first of them is written. One long wall decides how much
#   memory an export needs, not the file.
set -euo pipefail
cd "$(mktemp -d)"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check ezdxf==1.4.2
venv/bin/python -I - <<'PYTHON'
import math
import sys
import tracemalloc

import ezdxf

COUNT = 200_000


class Forgets:
    size = 0

    def write(self, text):
        self.size += len(text)
        return len(text)


def polyline(count):
    document = ezdxf.new("R2010")
    points = [(math.cos(k), math.sin(k)) for k in range(count)]
    document.modelspace().add_lwpolyline(points, close=True)
    return document


print("ezdxf", ezdxf.__version__)
polyline(10).write(Forgets())
document, stream = polyline(COUNT), Forgets()
tracemalloc.start()
document.write(stream)
peak = tracemalloc.get_traced_memory()[1]
print(f"text {stream.size / COUNT:.0f} bytes a point, memory while it is written {peak / COUNT:.0f} bytes a point")
sys.exit(int(peak < 100 * COUNT))  # 1: this has changed
PYTHON
