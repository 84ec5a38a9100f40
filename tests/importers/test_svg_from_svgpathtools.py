import pytest
import svgpathtools

from wallkit import DrawingError, drawing_from_svgpathtools, import_walls, read_drawing_text


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
