"""The bridge to svgpathtools, both ways: no bit is lost, and what it cannot hold is refused by name."""

from pathlib import Path

import numpy as np
import pytest
import svgpathtools
from hypothesis import given, settings
from hypothesis import strategies as st

from wallkit import (
    Drawing,
    DrawingError,
    DrawnPath,
    Subpath,
    Walls,
    drawing_from_svgpathtools,
    import_walls,
    read_drawing,
    read_drawing_text,
)

SAMPLES = sorted(
    path for path in (Path(__file__).parents[2] / "samples").iterdir() if path.suffix in (".svg", ".ai", ".txt")
)


@pytest.mark.parametrize(
    "d",
    [
        "M 0 0 L 10 0 L 10 8 Z",
        "M 0 0 Q 5 9 10 0 C 12 3 14 3 16 0",
        "M 0 0 A 5 3 20 1 0 8 2 L 4 9",
        "M 0 0 H 4 V 4 Z M 9 9 h 4 v 4 z",
    ],
)
def test_paths_of_svgpathtools_make_the_walls_that_their_file_makes(d):
    ours = read_drawing_text(f'<svg xmlns="http://www.w3.org/2000/svg"><path fill="none" d="{d}"/></svg>')
    theirs = drawing_from_svgpathtools([svgpathtools.parse_path(d)])
    expected, got = import_walls(ours, tolerance=0.01), import_walls(theirs, tolerance=0.01)
    assert got.closed.tolist() == expected.closed.tolist()
    assert got.vertices == pytest.approx(expected.vertices)


def test_something_else_than_a_segment_is_named():
    with pytest.raises(DrawingError, match="a segment is a "):
        drawing_from_svgpathtools([[svgpathtools.Line(0, 1), _Spiral()]])


class _Spiral:
    start = end = 1 + 0j


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ("M 0 0", "a str is not a list of paths"),
        (None, "a NoneType is not a list of paths"),
        (3, "a int is not a list of paths"),
        ({"d": []}, "a dict is not a list of paths"),
        ([None], "a NoneType is not a path"),
        ([["M0 0"]], "path 0 cannot be read"),
        (svgpathtools.parse_path("M0 0 L1 1"), "a Line is not a path"),
        (([svgpathtools.parse_path("M0 0 L1 1")], [{}]), "a segment is a Path, not a segment; svg2paths gives"),
        ([[svgpathtools.Line(0, None)]], "path 0 cannot be read"),
        ([[svgpathtools.Line(0, complex("nan"))]], "not all finite"),
        ([[svgpathtools.Line(complex("inf"), 1)]], "not all finite"),
        ([[svgpathtools.CubicBezier(0, 1e10, 2, 3)]], "at most 1e"),
    ],
)
def test_what_is_no_list_of_paths_or_no_number_is_refused_by_name(given, said):
    with pytest.raises(DrawingError) as caught:
        drawing_from_svgpathtools(given)
    assert said in caught.value.message
    assert caught.value.fix


@pytest.mark.parametrize("file", SAMPLES, ids=lambda path: path.name)
def test_every_sample_goes_there_and_back_without_a_bit_changed(file):
    drawing = read_drawing(file)
    back = drawing_from_svgpathtools(drawing.to_svgpathtools(), units=drawing.units, y_axis=drawing.y_axis)
    assert repr([path.to_json() for path in back.paths]) == repr([path.to_json() for path in drawing.paths])
    assert [path.levels for path in back.paths] == [path.levels for path in drawing.paths]


numbers = st.floats(-1e6, 1e6)
radii = st.floats(1e-3, 1e3)
flags = st.sampled_from([0, 1])
segments = st.one_of(
    st.tuples(st.just("L"), numbers, numbers),
    st.tuples(st.just("Q"), *[numbers] * 4),
    st.tuples(st.just("C"), *[numbers] * 6),
    st.tuples(st.just("A"), radii, radii, st.floats(0, 360), flags, flags, st.floats(1e7, 2e7), numbers),
)
subpaths = st.builds(
    lambda start, drawn, closed: Subpath([("M", *start), *drawn], closed),
    st.tuples(numbers, numbers),
    st.lists(segments, max_size=4, unique_by=lambda segment: segment[-2:]),
    st.booleans(),
)


@settings(max_examples=60)
@given(st.lists(subpaths, min_size=1, max_size=3))
def test_any_path_goes_there_and_back_without_a_bit_changed(parts):
    """Pens that only move, parts that touch, open ones that end where they begin: it has no word for these."""
    parts = [*parts, Subpath([("M", 0.0, 0.0), ("L", 1.0, 0.0), ("L", 0.0, 0.0)], closed=False)]
    parts = [*parts, Subpath([("M", 0.0, 0.0), ("L", 3.0, 0.0), ("L", 0.0, -0.0)], closed=True)]
    (path,) = Drawing("px", "down", paths=[DrawnPath(parts)]).to_svgpathtools()
    (back,) = drawing_from_svgpathtools([path]).paths
    assert repr(back.subpaths) == repr(parts)


def test_segments_that_were_changed_count_as_they_are_now():
    square = Subpath([("M", 0.0, 0.0), ("L", 4.0, 0.0), ("L", 4.0, 4.0)], closed=True)
    (path,) = Drawing("px", "down", paths=[DrawnPath([square], name="ramp")]).to_svgpathtools()
    path[-1] = svgpathtools.Line(4 + 4j, 1 + 1j)  # it does not close any more
    (back,) = drawing_from_svgpathtools([path]).paths
    assert (back.subpaths[0].closed, back.subpaths[0].segments[-1]) == (False, ("L", 1.0, 1.0))


def test_walls_are_paths_whose_points_lie_on_their_arcs():
    """Against the centre and radius of the arc: bulge tan(angle / 4) over a chord of 2 r sin(angle / 2)."""
    turn = np.array([0.3, -1.7, 3.0, -2.9, 4.5])  # radians of each edge
    corners = np.array([[0, 0], [9, 1], [12, 8], [5, 13], [-4, 6]], dtype=float)
    walls = Walls.from_polylines([corners], bulges=[np.tan(turn / 4)])
    (path,) = walls.to_svgpathtools()
    assert [type(segment).__name__ for segment in path] == ["Arc"] * 5
    for angle, arc in zip(turn, path, strict=True):
        assert np.radians(arc.delta) == pytest.approx(angle, rel=1e-7)
        assert arc.radius.real == pytest.approx(abs(arc.end - arc.start) / (2 * np.sin(abs(angle) / 2)))
    again = import_walls(drawing_from_svgpathtools([path]), curves="arcs", tolerance=1e-9)
    assert sum(4 * np.arctan(again.bulges)) == pytest.approx(sum(turn), abs=1e-6)


@pytest.mark.parametrize("source", [lambda path: path, lambda path: [path], lambda path: (path,)])
def test_paths_are_a_source_of_walls(source):
    path = svgpathtools.parse_path("M 0 0 L 40 0 L 40 30 Z")
    assert import_walls(source(path)).vertices.tolist() == [[0, 0], [40, 0], [40, 30]]
