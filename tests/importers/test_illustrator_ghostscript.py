"""Whole files against Ghostscript: segments, paint operators and the box of all points.

The numbers beside each file are Ghostscript's, made by the command at the head of drawn_by_ghostscript.ps. Where
Ghostscript is installed they are measured again.
"""

import re
import shutil
import subprocess
from collections import Counter
from pathlib import Path

import pytest

from importers.illustrator import read_illustrator

HERE = Path(__file__).parent
# Ghostscript keeps coordinates in 1/256 pt.
GRID = 1 / 256

MEASURED = {
    "lighthouse_ai5.ai": {
        "segments": {"M": 11, "L": 22, "C": 4},
        "paint": {"b": 1, "f": 4, "S": 1, "s": 1, "F": 1, "n": 1, "guide": 2},
        "box": (-80.0, -4014.0, 600.0, 4626.0),
    },
}


def by_us(data):
    segments, paint = Counter(), Counter()
    drawing = read_illustrator(data)
    for path in drawing.paths:
        for subpath in path.subpaths:
            segments.update(segment[0] for segment in subpath.segments)
            letter = "nsfb"[2 * (path.fill is not None) + (path.stroke is not None)]
            paint["guide" if path.guide else letter if subpath.closed else letter.upper()] += 1
    return segments, paint, drawing.control_box()


def by_ghostscript(data, folder):
    text = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    start, stop = text.index(b"%%EndSetup"), text.index(b"%%PageTrailer")
    art = folder / "art.txt"
    art.write_bytes(text[start:stop] + b"\n")
    command = ["gs", "-q", "-dNODISPLAY", "-dBATCH", "-dNOSAFER", f"-sART={art}", HERE / "drawn_by_ghostscript.ps"]
    out = subprocess.run(command, capture_output=True, text=True, timeout=60, check=True).stdout
    segments = Counter(re.findall(r"(?m)^([MLC]) ", out))
    paint = Counter(re.findall(r"(?m)^paint (\w+)", out))
    numbers = [[float(word) for word in line.split()] for line in re.findall(r"(?m)^[MLC] (.*)$", out)]
    xs = [x for line in numbers for x in line[0::2]]
    ys = [y for line in numbers for y in line[1::2]]
    return segments, paint, (min(xs), min(ys), max(xs), max(ys))


@pytest.mark.parametrize("name", MEASURED)
def test_counts_are_those_that_ghostscript_gave(name):
    segments, paint, box = by_us((HERE / "drawings" / name).read_bytes())
    assert segments == MEASURED[name]["segments"]
    assert paint == MEASURED[name]["paint"]
    assert box == pytest.approx(MEASURED[name]["box"], abs=GRID)


@pytest.mark.skipif(shutil.which("gs") is None, reason="Ghostscript is not installed")
@pytest.mark.parametrize("name", MEASURED)
def test_ghostscript_still_says_so(name, tmp_path):
    data = (HERE / "drawings" / name).read_bytes()
    segments, paint, box = by_ghostscript(data, tmp_path)
    assert segments == MEASURED[name]["segments"]
    assert paint == MEASURED[name]["paint"]
    assert box == pytest.approx(MEASURED[name]["box"], abs=GRID)
