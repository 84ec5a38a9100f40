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
