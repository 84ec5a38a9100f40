"""Reading an Illustrator 8 file of up to 200,000 segments, end to end to a Drawing.

pytest benchmarks/test_illustrator_speed.py
"""

import random

import pytest

from importers.illustrator import read_illustrator

HEAD = (
    b"%!PS-Adobe-3.0\r%%Creator: Adobe Illustrator(R) 8.0\r%%EndSetup\r1 1 1 1 0 0 0 0 79 128 255 0 50 Lb\r(Art) Ln\r"
)


def drawing(segments):
    """Closed paths of twenty segments, a third of them curves, numbers with four digits, CR line ends."""
    chance = random.Random(1)
    lines = [HEAD]
    for index in range(segments):
        if index % 20 == 0:
            lines.append(b"%.4f %.4f m\r" % (chance.uniform(0, 600), chance.uniform(0, 800)))
        count, operator = (6, b"C") if index % 3 == 0 else (2, b"L")
        lines.append(b" ".join(b"%.4f" % chance.uniform(0, 800) for _ in range(count)) + b" " + operator + b"\r")
        if index % 20 == 19:
            lines.append(b"s\r")
    return b"".join(lines) + b"LB\r%%PageTrailer\r%%Trailer\r"


@pytest.mark.parametrize("segments", [50_000, 100_000, 200_000])
def test_the_cost_is_linear_in_the_size(benchmark, segments):
    benchmark.group = "Illustrator 8 by size"
    benchmark.extra_info["segments"] = segments
    data = drawing(segments)
    read = benchmark.pedantic(read_illustrator, args=(data,), rounds=3, warmup_rounds=1)
    assert sum(len(subpath.segments) - 1 for path in read.paths for subpath in path.subpaths) == segments
