"""Path data: against svgpathtools where both read, by law where a law holds, and fault by fault."""

import math
import warnings

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from svg_sampling import points_along

from importers.svg import path_data
from importers.svg.path_data import parse_path_data

with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # its own imports warn on new versions of what it uses
    import svgpathtools

SIZES = {"M": 2, "L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2, "Z": 0}
NUMBERS = st.floats(-1000, 1000, allow_subnormal=False).map(lambda number: round(number, 3))


@st.composite
def path_texts(draw):
    """Right path data, with arcs, in both cases of letters, spaced or run together."""
    text = f"M{draw(NUMBERS)} {draw(NUMBERS)}"
    for step in range(draw(st.integers(1, 12))):
        kind = draw(st.sampled_from("MLHVCSQTZA"))
        letter = kind if draw(st.booleans()) else kind.lower()
        if kind == "A":
            flags = f"{draw(st.integers(0, 1))} {draw(st.integers(0, 1))}"
            radii = f"{draw(st.floats(1, 500))} {draw(st.floats(1, 500))} {draw(st.integers(-400, 400))}"
            # never an arc of no length, which svgpathtools cannot hold
            text += f"{letter}{radii} {flags} {20_000 + step},{draw(NUMBERS)}"
        else:
            times = draw(st.integers(1, 2)) if SIZES[kind] else 1
            numbers = [str(draw(NUMBERS)) for _ in range(SIZES[kind] * times)]
            text += letter + draw(st.sampled_from([" ", ",", " , ", "\n"])).join(numbers)
    return text


def drawn(subpaths):
    """Our segments as (kind, start, control points, end), closing lines put in, arcs in one piece or in halves."""
    for sub in subpaths:
        start = here = complex(*sub.segments[0][1:])
        for segment in sub.segments[1:]:
            numbers = segment[1:] if segment[0] != "A" else segment[6:]
            points = [complex(x, y) for x, y in zip(numbers[0::2], numbers[1::2], strict=True)]
            yield segment, here, points
            here = points[-1]
        if sub.closed and here != start:
            yield ("L", start.real, start.imag), here, [start]


@given(path_texts())
@settings(max_examples=60)
def test_a_second_reader_agrees(text):
    """Segment by segment the same kinds and points as svgpathtools gives; arcs by their ends and middles."""
    subpaths, fault = parse_path_data(text)
    assert fault is None
    theirs = iter(svgpathtools.parse_path(text))
    half = None
    for segment, start, points in drawn(subpaths):
        if half is None:
            other = next(theirs)
        size = 1e-9 * max(1.0, abs(start), *map(abs, points))
        if segment[0] == "A":
            assert isinstance(other, svgpathtools.Arc)
            if half is None and abs(other.end - points[-1]) > size:
                half = (segment, start, points[-1])  # of a half arc: its middle is theirs
                assert abs(other.point(0.5) - points[-1]) <= 1e-4 * abs(other.radius)
                continue
            if half is None:
                middle = points_along([("M", start.real, start.imag), segment], 2)[-2]
                # half-way by angle, for both; theirs finds the centre of a nearly half arc to half the digits
                assert abs(other.point(0.5) - complex(*middle)) <= 1e-4 * abs(other.radius)
            half = None
        else:
            kinds = {"L": svgpathtools.Line, "Q": svgpathtools.QuadraticBezier, "C": svgpathtools.CubicBezier}
            assert isinstance(other, kinds[segment[0]])
            assert other.bpoints()[1:] == pytest.approx(points, abs=size)
        assert abs(other.end - points[-1]) <= size
    assert next(theirs, None) is None


@given(st.text(alphabet="MmZzLlHhVvCcSsQqTtAa0123456789.,-+eE \n#", max_size=80))
@settings(max_examples=300)
def test_any_text_gives_its_right_beginning_and_says_where_it_ends(text):
    subpaths, fault = parse_path_data(text)
    for sub in subpaths:
        assert sub.segments[0][0] == "M"
        assert all(segment[0] in "LQCA" for segment in sub.segments[1:])
        assert not any(math.isnan(number) for segment in sub.segments for number in segment[1:])
    if fault is not None:
        assert 0 <= fault.offset <= len(text)
        assert fault.message


@given(path_texts(), st.integers(0, 400))
@settings(max_examples=60)
def test_what_stands_before_an_error_is_used_whole(text, cut):
    """With rubbish put in, the segments are the first ones of the right text."""
    cut = min(cut, len(text))
    whole = [segment for sub in parse_path_data(text)[0] for segment in sub.segments]
    broken, fault = parse_path_data(text[:cut] + "#" + text[cut:])
    part = [segment for sub in broken for segment in sub.segments]
    assert fault is not None
    assert fault.offset <= cut
    # the last number before the rubbish may be a shorter one than was meant: its segment may differ
    assert part[:-2] == whole[: len(part[:-2])]


@pytest.mark.parametrize(
    ("text", "offset", "words"),
    [
        ("M 30 40 L 110 160 L 150#80", 23, "'#'"),
        ("M 30 40 L 110 160 L 150", 23, "2 numbers"),
        ("L 10 10", 0, "begin with M"),
        ("10 10", 0, "begin with M"),
        ("M 1 1 L 5 5,", 11, "comma"),
        ("M 1 1,, 5 5", 6, "comma"),
        ("M 1 1 Z 5 5", 8, "takes none"),
        ("M 1 1 A 5 5 0 2 1 8 8", 14, "large-arc flag"),
        ("M 1 1 A 5 5 0 0 7 8 8", 16, "sweep flag"),
        ("M 1 1 A 5 5 0 0 1", 17, "7 numbers"),
        ("M 1 1 L 1e999 5", 8, "too large"),
        ("M 1 1 L 5", 9, "2 numbers"),
        ("M 1 1 L 5 L 6 6", 9, "2 numbers"),
        ("M 1 1 5 L 6 6", 7, "2 numbers"),
        ("M 1 1 L 20. 30", 10, "'.'"),
    ],
)
def test_a_fault_is_found_where_it_stands(text, offset, words):
    _, fault = parse_path_data(text)
    assert fault is not None
    assert (fault.offset, words in fault.message) == (offset, True), fault


def test_a_half_circle_is_given_in_quarters_whose_centre_is_well_known():
    """The centre of a half arc comes from the root of a difference that is all rounding; quarters have none."""
    subpaths, _ = parse_path_data("M 0.1 0.2 a 0.3 0.3 0 0 1 0.6 0 a .3 .3 0 0 1 -.6 0 z")
    assert [segment[0] for segment in subpaths[0].segments] == ["M", "A", "A", "A", "A"]
    points = points_along(subpaths[0].segments)
    # 0.1 + 0.6 and the radius are rounded to a few ulp of 1; quarters keep that
    assert abs((points - [0.4, 0.2]) ** 2).sum(axis=1) == pytest.approx(0.09, abs=1e-15)


@pytest.mark.parametrize("radius", ["1e-3", "7.0710678118654755"])
def test_the_middle_of_a_half_arc_is_right_to_the_last_digits(radius):
    """Radii that are too small for the chord, or just reach: the chord is a diameter, its middle the centre."""
    subpaths, _ = parse_path_data(f"M 50 50 A {radius} {radius} 0 0 1 60 60")
    assert subpaths[0].segments[1][-2:] == pytest.approx((60, 50), abs=1e-13)


@given(st.floats(0.1, 100), st.floats(0.1, 100), st.integers(-180, 180), st.booleans(), st.booleans(), NUMBERS, NUMBERS)
def test_an_arc_lies_on_its_ellipse(rx, ry, degrees, large, sweep, x, y):
    """Undone, every point of an arc is at distance 1 from one centre, and the arc has the asked-for size."""
    text = f"M 0 0 A {rx} {ry} {degrees} {int(large)} {int(sweep)} {x} {y}"
    subpaths, fault = parse_path_data(text)
    assert fault is None
    arcs = [segment for segment in subpaths[0].segments if segment[0] == "A"]
    if not arcs:
        assert x == y == 0
        return
    assert arcs[-1][-2:] == (x, y)
    assert all(arc[1] >= rx and arc[2] >= ry for arc in arcs)
    assert all(math.isclose(arc[1] / arc[2], rx / ry, rel_tol=1e-12) for arc in arcs)


CURVE = "1.5 2 -3,4 5 6.25"


@pytest.mark.parametrize(
    "data",
    [
        f"M1 2C{CURVE}C{CURVE}C{CURVE}Z",
        f"M1 2c{CURVE}c{CURVE}c{CURVE}L1 1c{CURVE}c{CURVE}",
        f"M1 2C{CURVE}c{CURVE}C{CURVE} {CURVE} {CURVE}C{CURVE}",
        f"M1 2C{CURVE} 6 5 4 3 2 6.25 6 5 4 3 2 6.25C{CURVE}",
        f"M1 2C{CURVE}C{CURVE}S1 2 3 4C{CURVE}C{CURVE}T5 6",
        f"M1 2C{CURVE}C{CURVE} 1 2 3C{CURVE}",
        f"M1 2C{CURVE}C{CURVE}C1 2 3 4 5C{CURVE}",
        f"M1 2C{CURVE}C1.5.5 3 4 5 6C{CURVE}C{CURVE}",
        f"M1 2C{CURVE}C{CURVE}C{CURVE}C",
        f"M1 2C{CURVE}C{CURVE}C{CURVE}M3 4Zc{CURVE}c{CURVE}",
    ],
)
def test_curves_in_a_row_are_those_that_are_read_one_by_one(data, monkeypatch):
    together = parse_path_data(data)
    monkeypatch.setattr(path_data, "_same_again", lambda *_: 0)
    assert repr(together) == repr(parse_path_data(data))
