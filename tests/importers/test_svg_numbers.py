"""Numbers that are infinite, as written or once units and fonts are multiplied in, are said and never used."""

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from importers.numbers import NumberError, finite
from importers.svg import read_svg
from importers.svg.colour import parse_colour

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
    "the width of a stroke": ('<rect id="a" width="1" height="1" stroke="red" stroke-width="1e308in"/>', "", 1),
    "a width of a stroke that no coordinate has": (
        '<rect id="a" width="1" height="1" stroke="red" stroke-width="1e300em"/>',
        "",
        1,
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


# Each attribute and property that is read as a number, a length, an angle or a list of them: what has it, and the
# codes that its faults may have. The rest of the element is right.
READ = {
    **dict.fromkeys(("x", "y", "width", "height", "rx", "ry"), ("rect", {"bad-number", "bad-length"})),
    **dict.fromkeys(("cx", "cy", "r"), ("circle", {"bad-number", "bad-length"})),
    **dict.fromkeys(("x1", "y1", "x2", "y2"), ("line", {"bad-number", "bad-length"})),
    "points": ("polygon", {"bad-points"}),
    "d": ("path", {"bad-path-data"}),
    "stroke-width": ("rect", {"bad-number", "bad-length"}),
    **dict.fromkeys(("opacity", "fill-opacity", "stroke-opacity"), ("rect", {"bad-number", "bad-length"})),
    **dict.fromkeys(("transform", "translate", "rotate", "scale"), ("rect", {"bad-number", "bad-transform"})),
    "transform-origin": ("rect", {"bad-number", "bad-transform"}),
    "viewBox": ("svg", {"bad-number", "bad-length"}),
}
ONLY_ATTRIBUTES = {"x1", "y1", "x2", "y2", "points", "viewBox", "d"}  # in style sheets d is path("...")
ONLY_CSS = {"translate", "rotate", "scale"}
SHAPES = {
    "rect": 'stroke="red" width="3" height="4"',
    "circle": 'r="5"',
    "line": 'x2="1"',
    "polygon": "",
    "path": "",
    "svg": 'width="9" height="9"',
}
WRONG = ("1e400", "-1e400", "nan", "infinity", "garbage", "12foo", "1e400%", "calc(1px + )")
UNITS = {"rotate": "turn", "scale": "", "opacity": "", "fill-opacity": "", "stroke-opacity": "", "transform": "turn"}


def wrong_values(name):
    unit = UNITS.get(name, "px")
    values = (*WRONG, f"calc(infinity * 1{unit})", f"calc(1e308{unit} * 10)", f"max(1e400{unit}, 1{unit})")
    return [f"rotate({value})" if name == "transform" else value for value in values]


def elements(name, value):
    """The element with the value: as an attribute, in a style attribute, and by a style sheet."""
    tag, _ = READ[name]
    inner = '<rect width="1" height="1"/>' if tag == "svg" else ""
    bare = " ".join(part for part in SHAPES[tag].split() if not part.startswith(f"{name}="))
    turned = "rotate:3deg;" if name == "transform-origin" else ""
    if name not in ONLY_CSS:
        yield f'<{tag} {bare} style="{turned}" {name}="{value}">{inner}</{tag}>'
    if name not in ONLY_ATTRIBUTES:
        yield f'<{tag} {SHAPES[tag]} style="fill:red;{turned}{name}:{value}"/>'
        yield f"<style>{tag} {{ {turned}{name}:{value} }}</style><{tag} {SHAPES[tag]}/>"


@pytest.mark.parametrize("name", sorted(READ))
def test_what_cannot_be_read_is_a_problem_at_its_place_whatever_reads_it(name):
    for value in wrong_values(name):
        for body in elements(name, value):
            drawing = read_svg(f'<svg {NS} width="9" height="9">\n{body}</svg>'.encode())
            found = [problem for problem in drawing.problems if problem.code in READ[name][1]]
            assert found, body
            assert found[0].line == 2
            at = body[found[0].column - 1 :]
            assert at.startswith((f"<{READ[name][0]} ", f"{name}:")) or at.partition('"')[0] in value, body
            json.dumps(drawing.to_json(), allow_nan=False)


RIGHT = {
    "points": ("0,0 1,1 2,0", ""),
    "d": ("M0 0L1 1L2 0z", ""),
    "viewBox": ("0 0 1 1", ""),
    "transform": ("scale(2)", "none", ""),
    "rotate": ("3deg", "none", "calc(pi * 1rad)", "inherit"),
    "scale": ("2", "1 2", "50%", "inherit"),
    **dict.fromkeys(("opacity", "fill-opacity", "stroke-opacity"), ("0.5", "50%", "calc(1 / e)", "inherit")),
}


@pytest.mark.parametrize("name", sorted(READ))
def test_what_can_be_read_is_no_problem(name):
    for value in RIGHT.get(name, ("1px", "calc(1px * pi)", " 2% ", "0")):
        for body in elements(name, value):
            drawing = read_svg(f'<svg {NS} width="9" height="9">\n{body}</svg>'.encode())
            assert not [one for one in drawing.problems if one.code.startswith("bad-")], body


MARKS = {
    "dashes": ('<rect width="1" height="1" stroke="red" stroke-dasharray="1 1e400"/>', "1e400"),
    "dashes with a unit": ('<rect width="1" height="1" stroke="red" stroke-dasharray="1 1e308in"/>', "1e308in"),
    "dashes of calc()": ('<rect width="1" height="1" stroke="red" stroke-dasharray="calc(1e308px * 9)"/>', "calc"),
    "the start of dashes": ('<rect width="1" height="1" stroke="red" style="stroke-dashoffset:1e400"/>', "stroke-dash"),
    "the limit of a miter": ('<g stroke-miterlimit="-1e400"><rect width="1" height="1"/></g>', "-1e400"),
    "the place of a gradient": (
        '<linearGradient id="a" gradientTransform="rotate(1e400)"><stop/></linearGradient>'
        '<rect width="1" height="1" fill="url(#a)"/>',
        "1e400",
    ),
    "the place of a pattern": (
        '<pattern id="a" patternTransform="rotate(1)" width="1e308in"><rect/></pattern>'
        '<rect width="1" height="1" fill="url(#a)"/>',
        "1e308in",
    ),
}


@pytest.mark.parametrize("story", MARKS)
def test_an_infinite_number_that_changes_no_outline_is_said_as_that(story):
    body, at = MARKS[story]
    drawing = read_svg(f"<svg {NS}>\n{body}</svg>".encode())
    found = [problem for problem in drawing.problems if problem.code == "bad-number"]
    assert [(one.severity, one.line, one.column) for one in found] == [("info", 2, body.index(at) + 1)]
    assert len(drawing.paths) == 1


def test_a_fault_in_a_style_sheet_is_told_where_it_stands():
    sheet = "@font-face { src: url(x);\n}\nrect {\n  width: 3px;\n  height: tall; }"
    for opening in ("<style>", "<style>\n <![CDATA[", "<style><![CDATA["):
        closing = "]]>" if "CDATA" in opening else ""
        text = f'<svg {NS}>\n{opening}{sheet}{closing}</style><rect width="1" height="1"/></svg>'
        drawing = read_svg(text.encode())
        (problem,) = (one for one in drawing.problems if one.code == "bad-length")
        lines = text.splitlines()
        assert lines[problem.line - 1][problem.column - 1 :].startswith("height: tall")


def test_a_use_and_an_inner_svg_say_which_of_their_lengths_are_none():
    body = '<svg x="a"><rect id="b" width="1" height="1"/></svg><use href="#b" y="c"/><use href="#d" width="e"/>'
    drawing = read_svg(f'<svg {NS} width="1 mm">\n{body}<symbol id="d"/></svg>'.encode())
    found = [(one.message.split("=")[0], one.line) for one in drawing.problems if one.code == "bad-length"]
    assert sorted(found) == [("width", 1), ("width", 2), ("x", 2), ("y", 2)]


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


@given(st.lists(st.integers(0, 999), min_size=3, max_size=3))
def test_plain_colours_are_what_the_parser_of_css_makes_of_them(parts):
    """Written with a decimal point, or with an alpha, the same colour goes to tinycss2."""
    red, green, blue = parts
    assert parse_colour(f"rgb({red}, {green},{blue} )") == parse_colour(f"rgb({red}.0,{green},{blue})")
    word = "#" + "".join(f"{part % 256:02X}" for part in parts)
    assert parse_colour(word) == parse_colour(word.lower()) == parse_colour(f"{word}ff")
