"""Clips, masks and the end of the picture: shapes are taken whole, and what of them is not seen is said."""

import pytest

from importers.svg import read_svg

HEAD = '<svg xmlns="http://www.w3.org/2000/svg" width="100" height="100">'
CLIPS = """<defs><clipPath id="disc"><circle cx="50" cy="50" r="20"/></clipPath>
<clipPath id="square"><rect x="30" y="30" width="40" height="40"/></clipPath>
<clipPath id="turned" transform="rotate(45 50 50)"><rect x="40" y="40" width="20" height="20"/></clipPath>
<clipPath id="unit" clipPathUnits="objectBoundingBox"><rect width=".5" height="1"/></clipPath>
<clipPath id="both" clip-path="url(#square)"><rect x="60" y="0" width="40" height="100"/></clipPath>
<clipPath id="empty"/><clipPath id="words"><text>a</text></clipPath>
<clipPath id="itself" clip-path="url(#itself)"><rect x="30" y="30" width="40" height="40"/></clipPath>
<clipPath id="shown"><use href="#shape"/><rect display="none" width="100" height="100"/></clipPath>
<rect id="shape" x="30" y="30" width="40" height="40"/>
<mask id="mask"><rect width="100" height="100" fill="white"/></mask></defs>"""
INSIDE = '<rect name="in" x="45" y="45" width="5" height="5"/>'
OUTSIDE = '<rect id="out" x="1" y="1" width="5" height="5"/>'
ACROSS = '<rect id="across" x="45" y="45" width="50" height="5"/>'


def read(body):
    drawing = read_svg(f"{HEAD}{CLIPS}{body}</svg>".encode())
    counted = [p for p in drawing.problems if p.code in ("clip-not-applied", "mask-not-applied")]
    named = [(p.code, p.name) for p in drawing.problems if p.code in ("outside-clip", "outside-picture")]
    number = (
        0 if not counted else int(counted[0].message.partition(" times")[0]) if "times" in counted[0].message else 1
    )
    return number, named


# How the clip is asked for; how many of three shapes (inside, outside, across) it cuts, and which it leaves nothing of
ASKED = {
    'clip-path="url(#disc)"': (3, ["out"]),
    'clip-path="url(#square)"': (2, ["out"]),  # the one inside is not cut, and of a rectangle that is sure
    "style=\"clip-path:url('#square')\"": (2, ["out"]),
    'clip-path="url(#turned)"': (3, ["out"]),
    'clip-path="url(#empty)"': (3, ["", "out", "across"]),
    'clip-path="url(#words)"': (3, []),
    'clip-path="url(#itself)"': (3, ["out"]),
    'clip-path="url(#shown)"': (2, ["out"]),
    'clip-path="url(#both)"': (3, ["", "out"]),
    'style="clip-path:circle(10px)"': (3, []),
    'mask="url(#mask)"': (3, []),
    'clip-path="url(#nothing)"': (0, []),
    'clip-path="none"': (0, []),
    'mask="none"': (0, []),
    'clip-path="url(#square)" transform="translate(200)" style="transform:none"': (2, ["out"]),
}


@pytest.mark.parametrize("asked", ASKED)
def test_shapes_under_a_clip_are_counted_and_those_outside_of_it_named(asked):
    cut, outside = ASKED[asked]
    number, named = read(f"<g {asked}>{INSIDE}{OUTSIDE}{ACROSS}</g>")
    assert number == cut
    assert named == [("outside-clip", name) for name in outside]


def test_a_clip_on_a_shape_is_in_the_coordinates_of_that_shape():
    assert read('<rect id="a" width="9" height="9" transform="translate(40 40)" clip-path="url(#square)"/>') == (
        1,
        [("outside-clip", "a")],
    )
    assert read(
        '<rect width="9" height="9" transform="translate(-10 -10)" x="45" y="45" clip-path="url(#square)"/>'
    ) == (
        0,
        [],
    )


def test_a_clip_in_units_of_the_box_cuts_each_shape_for_itself():
    assert read(f'<g clip-path="url(#unit)">{OUTSIDE}{ACROSS}</g>')[1] == []
    assert read('<rect x="5" y="5" width="5" height="5" clip-path="url(#unit)"/>') == (1, [])


def test_clips_on_clips_and_on_what_is_shown_again_add_up():
    group = f'<g id="g" clip-path="url(#square)">{INSIDE}</g>'
    assert read(f'{group}<use href="#g" x="15"/>') == (0, [])
    assert read(f'<g clip-path="url(#both)"><g clip-path="url(#square)">{INSIDE}</g></g>') == (
        1,
        [("outside-clip", "")],
    )


def test_a_stroke_that_reaches_into_a_clip_is_seen():
    line = '<path id="l" d="M25 0V100" stroke="red" stroke-width="{}"/>'
    assert read(f'<g clip-path="url(#square)">{line.format(1)}</g>')[1] == [("outside-clip", "l")]
    assert read(f'<g clip-path="url(#square)">{line.format(20)}</g>')[1] == []


@pytest.mark.parametrize(
    ("body", "outside"),
    [
        ('<rect id="a" x="-744" y="-414" width="185" height="99"/>', ["a"]),
        ('<rect id="a" x="-10" width="20" height="5"/><circle id="b" r="300"/>', []),
        ('<path id="a" d="M-5 -5H200"/>', ["a"]),
        ('<path id="a" d="M-5 -5Q50 40 110 -5"/>', []),
        ('<rect id="a" x="120" width="5" height="5" display="none"/>', []),
        ('<svg width="10" height="10"><rect id="a" x="20" width="5" height="5"/></svg>', ["a"]),
        ('<svg width="10" height="10" overflow="visible"><rect id="a" x="20" width="5" height="5"/></svg>', []),
        ('<svg x="50" width="10" height="10" viewBox="0 0 1 1"><rect id="a" width="1" height="1"/></svg>', []),
    ],
)
def test_what_is_outside_the_picture_is_named(body, outside):
    assert read(body) == (0, [("outside-picture", name) for name in outside])


def test_a_drawing_without_a_size_has_no_outside():
    drawing = read_svg(HEAD.replace("100", "0").encode() + b'<rect x="500" width="1" height="1"/></svg>')
    assert [problem.code for problem in drawing.problems] == ["no-size"]
