"""Every drawing in tests/importers/svg against what a browser shows of it (measure_svg_with_chromium.py)."""

import json
from pathlib import Path

import pytest
from svg_sampling import box, distance_to

from importers.boxes import box_of
from importers.svg import read_svg

HERE = Path(__file__).parent / "svg"
EXPECTED = json.loads((HERE / "expected.json").read_text("utf-8"))

# The browser computes in single precision and its arcs are cubics, which leave a circle by 2.7e-4 of its radius;
# its paths are measured as polylines of 4,000 steps.
TOLERANCE = 0.05


def visible(story):
    drawing = read_svg((HERE / f"{story}.svg").read_bytes(), f"{story}.svg")
    return [path for path in drawing.paths if path.visible]


def painted(path):
    """Whether fill and stroke put any colour on the screen, as the measuring script has it."""
    return " ".join(name for name in ("fill", "stroke") if getattr(path, name) is not None)


def test_every_drawing_has_been_measured():
    assert sorted(EXPECTED) == sorted(file.stem for file in HERE.glob("*.svg"))


@pytest.mark.parametrize("story", sorted(EXPECTED))
def test_the_shapes_that_a_browser_renders_where_it_renders_them_and_no_others(story):
    shapes, paths = EXPECTED[story], visible(story)
    assert len(paths) == len(shapes)
    for path, shape in zip(paths, shapes, strict=True):
        near = TOLERANCE + 1e-6 * max(map(abs, shape["box"]))
        assert painted(path) == shape["paint"]
        assert box(path) == pytest.approx(shape["box"], abs=near)
        assert box_of([path]) == pytest.approx(shape["box"], abs=near)
        for point in shape["points"]:
            assert distance_to(path, point) <= near
