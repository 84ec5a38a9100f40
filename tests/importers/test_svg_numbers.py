"""Numbers that are infinite, as written or once units and fonts are multiplied in, are said and never used."""

import json

import pytest

from importers.numbers import NumberError, finite
from importers.svg import read_svg

NS = 'xmlns="http://www.w3.org/2000/svg"'
INFINITE = {
    "an angle of an attribute": ('<rect id="a" width="1" height="1" transform="rotate(1e400)"/>', 'rotate("', 1),
    "a slope of an attribute": ('<rect id="a" width="1" height="1" transform="scale(1) skewX(1e400)"/>', "1e400", 1),
    "a product of scales": ('<rect id="a" width="1" height="1" transform="scale(1e200)scale(1e200)"/>', "", 1),
    "turns of a style": ('<rect id="a" width="1" height="1" style="transform:rotate(1e308turn)"/>', "", 1),
    "turns of calc()": ('<rect id="a" width="1" height="1" style="transform:rotate(calc(1e308turn*10))"/>', "", 1),
    "the larger of two angles": (
        '<rect id="a" width="1" height="1" style="transform:rotate(max(1e308turn,1deg))"/>',
        "",
        1,
    ),
    "a factor of calc()": ('<rect id="a" width="1" height="1" style="scale:calc(1e308*10)"/>', "", 1),
    "a slope of a style": ('<rect id="a" width="1" height="1" style="transform:skewX(1e308turn)"/>', "", 1),
    "an angle about another axis": ('<rect id="a" width="1" height="1" style="transform:rotateX(1e308turn)"/>', "", 1),
    "a rule": ('<style>rect{rotate:1e308turn}</style><rect id="a" width="1" height="1"/>', "", 1),
    "a length of a style": ('<rect id="a" width="1" height="1" style="x:1e400px"/>', "", 1),
    "a length within max()": ('<rect id="a" width="1" height="1" x="max(1e400px, 1px)"/>', "", 0),
    "inches": ('<rect id="a" width="1" height="1" x="1e308in"/>', "1e308in", 0),
    "inches of a line": ('<line id="a" x2="1e308in" stroke="red"/>', "1e308in", 0),
    "a translation": ('<rect id="a" width="1" height="1" style="transform:translate(1e308in)"/>', "", 0),
    "fonts of fonts": (
        '<g font-size="1e300"><g font-size="1e300em"><rect id="a" width="1ex" height="1"/></g></g>',
        "",
        0,
    ),
    "heights of lines": (
        '<g style="font-size:1e300px;line-height:1e300"><rect id="a" width="1lh" height="1"/></g>',
        "",
        0,
    ),
    "the width of a stroke": ('<rect id="a" width="1" height="1" stroke="red" stroke-width="1e308in"/>', "", 0),
    "a width of a stroke that no coordinate has": (
        '<rect id="a" width="1" height="1" stroke="red" stroke-width="1e300em"/>',
        "",
        0,
    ),
    "a viewBox within": ('<svg viewBox="0 0 1e400 1"><rect id="a" width="1" height="1"/></svg>', "1e400", 0),
    "a quotient of calc()": ('<rect id="a" width="calc(1e300px / 1e-300)" height="1"/>', "", 0),
}


@pytest.mark.parametrize("story", INFINITE)
def test_an_infinite_number_is_a_problem_with_its_place_and_not_in_the_drawing(story):
    body, at, left = INFINITE[story]
    text = f"<svg {NS}>\n{body}</svg>"
    drawing = read_svg(text.encode())
    problems = [problem for problem in drawing.problems if problem.code == "bad-number"]
    assert problems
    assert problems[0].severity == "error"
    assert problems[0].line == 2
    if at == "1e400" or at == "1e308in":
        assert problems[0].column == body.index(at) + 1
    assert len(drawing.paths) == left
    json.dumps(drawing.to_json(), allow_nan=False)


@pytest.mark.parametrize(
    "body",
    [
        '<rect width="1" height="1" style="transform:rotate(5)"/>',
        '<rect width="1" height="1" style="color:red; /* */ rotate:calc(3px)"/>',
        '<style>rect{scale:calc(50% + 1deg)}</style><rect width="1" height="1"/>',
        '<rect width="1" height="1" style="--a:3;transform:turn(var(--a))"/>',
    ],
)
def test_a_transform_of_css_that_is_wrong_is_said(body):
    drawing = read_svg(f"<svg {NS}>\n{body}</svg>".encode())
    assert [(problem.code, problem.line) for problem in drawing.problems] == [("bad-transform", 2)]
    assert len(drawing.paths) == 1


@pytest.mark.parametrize(
    "head", ['viewBox="0 0 1e400 1"', 'width="1e308in"', 'style="font-size:1e400px"', 'width="1e400"']
)
def test_an_infinite_size_of_the_drawing_is_said_and_its_outlines_stay(head):
    drawing = read_svg(f'<svg {NS} {head}><rect width="1" height="1"/></svg>'.encode())
    assert len(drawing.paths) == 1
    assert "bad-number" in [problem.code for problem in drawing.problems]


def test_more_digits_than_an_integer_may_have_are_no_css():
    digits = "1" * 5000
    for style in (f"width:{digits}px", f"--a:{digits};fill:var(--a)", f"transform:scale({digits})"):
        drawing = read_svg(f'<svg {NS}><rect style="{style}" width="2" height="1"/></svg>'.encode())
        assert len(drawing.paths) == 1


@pytest.mark.parametrize("value", [float("inf"), float("-inf"), float("nan")])
def test_the_gate_lets_nothing_through_that_is_not_finite(value):
    assert finite(1.5) == 1.5
    with pytest.raises(NumberError) as caught:
        finite(value, "x", 3)
    assert (caught.value.attribute, caught.value.offset) == ("x", 3)
