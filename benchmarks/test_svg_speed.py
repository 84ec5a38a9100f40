"""Reading an SVG of 50,000 segments, end to end to a Drawing, beside two readers that others use.

    pytest benchmarks/test_svg_speed.py --benchmark-group-by=group

One group a drawing, so that the ratios stand in one table of one run. The other two are asked for as little as
they offer: svgpathtools' svgstr2paths applies no transforms and reads no style.
"""

import io
import random
import warnings

import pytest

from importers.svg import read_svg

with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # both warn on new versions of what they use
    import svgelements
    import svgpathtools

SEGMENTS = 50_000


def one_path(segments):
    """One path of lines and curves in turn, absolute, numbers with blanks."""
    chance = random.Random(1)
    parts = ["M0 0"]
    for _ in range(segments // 2):
        numbers = [f"{chance.uniform(0, 1000):.3f}" for _ in range(8)]
        parts += ["L" + " ".join(numbers[:2]), "C" + " ".join(numbers[2:])]
    return f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1000 1000"><path d="{"".join(parts)}"/></svg>'


def many_paths(segments):
    """Paths of ten segments, relative, in a turned group, styled."""
    chance = random.Random(2)
    paths = []
    for _ in range(segments // 10):
        start = f"{chance.uniform(0, 1000):.2f},{chance.uniform(0, 1000):.2f}"
        lines = " ".join(f"{chance.uniform(-9, 9):.2f}" for _ in range(10))
        curves = " ".join(f"{chance.uniform(-9, 9):.2f}" for _ in range(30))
        paths.append(f'<path style="fill:none;stroke:#000000;stroke-width:0.5" d="m{start} l{lines} c{curves}"/>')
    body = "\n".join(paths)
    return f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1000 1000"><g transform="rotate(10)">{body}</g></svg>'


DRAWINGS = {"one path": one_path, "many paths": many_paths}
READERS = {
    "wallkit": lambda text: read_svg(text.encode()),
    "svgpathtools": lambda text: svgpathtools.svgstr2paths(text),
    "svgelements": lambda text: svgelements.SVG.parse(io.StringIO(text)),
}


@pytest.mark.parametrize("drawing", DRAWINGS)
@pytest.mark.parametrize("reader", READERS)
def test_read(benchmark, drawing, reader):
    benchmark.group = f"SVG of {SEGMENTS:,} segments, {drawing}"
    text = DRAWINGS[drawing](SEGMENTS)
    benchmark.pedantic(READERS[reader], args=(text,), rounds=3, warmup_rounds=1)


@pytest.mark.parametrize("drawing", DRAWINGS)
@pytest.mark.parametrize("size", [12_500, 25_000, 50_000, 100_000])
def test_the_cost_is_linear_in_the_size(benchmark, drawing, size):
    benchmark.group = f"SVG by size, {drawing}"
    benchmark.extra_info["segments"] = size
    text = DRAWINGS[drawing](size)
    data = benchmark.pedantic(READERS["wallkit"], args=(text,), rounds=3, warmup_rounds=1)
    assert sum(len(sub.segments) - 1 for path in data.paths for sub in path.subpaths) == size
