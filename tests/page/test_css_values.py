"""Values of properties are taken, or told as wrong, as a browser takes them (CSS.supports) and paints them."""

import pytest

from importers.svg import read_svg
from importers.svg.colour import parse_colour

NS = 'xmlns="http://www.w3.org/2000/svg"'
VALUES = {
    "fill-rule": ["nonzero", "EvenOdd", "odd", "even-odd", "1", "inherit"],
    "clip-rule": ["evenodd", "both"],
    "visibility": ["hidden", "collapse", "none", "false"],
    "overflow": ["visible", "clip", "overlay", "none", "-moz-hidden-unscrollable"],
    "transform-box": ["fill-box", "view-box", "padding-box"],
    "fill": [
        *("none", "red", "#12", "#1234", "rgb(1,2,3)", "rgb(a)", "nonee", "currentColor", "undefined", "transparent"),
        *("url(#a) none", "url(#a) currentColor", "url(#a)red", "url(#a) blak", "url(#a) url(#b)", "url(#a), red"),
        *("red icc-color(a, 1)", "oklch(62.3% 0.214 259.815)", "hsl(120 50% 50%)", "context-fill", "none none"),
    ],
    "color": ["red", "none", "currentcolor", "rd"],
    "font-size": ["12", "12px", "0", "-1px", "large", "huge", "50%", "calc(1px + 1em)", "1.2.3px"],
    "line-height": ["normal", "1.2", "-1", "12px", "tall"],
    "d": [
        *("none", "path('M0 0H1')", "path('M0 0,1 1')", "path('')", "path(M0 0)", "M0 0H1", "path(evenodd, 'M0 0')"),
        *("path('x')", "path('M0 0H1 x')", "path('M0 0H')", "path('L0 0')"),
    ],
    "display": [
        *("none", "block", "contents", "inline-table", "inline flow-root", "flow block", "list-item flow inline"),
        *("run-in", "inline block", "block block", "none block", "flex list-item", "-ms-flexbox", "blok"),
    ],
}


def told(name, value):
    """Whether a fault is told of a declaration in a style sheet, at its place."""
    text = f'<svg {NS}><style>\n rect {{{name}:{value}}}</style><rect width="1" height="1"/><path d=""/></svg>'
    if name == "d":
        text = text.replace("rect {", "path {")
    found = [problem for problem in read_svg(text.encode()).problems if problem.code in ("bad-value", "bad-length")]
    return found and [(problem.line, problem.column) for problem in found] == [(2, 8)]


@pytest.mark.browser
def test_a_value_is_told_where_a_browser_does_not_take_it(browser):
    page = browser.new_page()
    for name, values in VALUES.items():
        for value in values:
            taken = page.evaluate("([name, value]) => CSS.supports(name, value)", [name, value])
            if name == "transform-box" and not taken:
                continue  # told as bad-transform, of which test_svg_numbers.py knows
            assert bool(told(name, value)) is not taken, (name, value)
    page.close()


COLOURS = [
    *("oklch(0.5 0.1 20)", "oklab(0.5 0.1 -0.05)", "oklch(62.3% 0.214 259.815)", "oklch(1 0 0)", "oklch(70% 0.4 150)"),
    *("lab(50 20 -30)", "lch(50 40 120)", "lab(8 0 0)", "color(display-p3 0.3 0.6 0.01)", "color(display-p3 1 0 0)"),
    *("color(srgb 0.5 0.2 0.1)", "color(srgb-linear 0.5 0.2 0.001)", "color(xyz 0.2 0.5 0.1)"),
    *("color(xyz-d50 0.2 0.5 0.1)", "hwb(120 10% 20%)", "oklch(none 0.1 0)"),
]


@pytest.mark.browser
def test_colours_are_those_that_a_browser_paints(browser):
    page = browser.new_page()
    painted = page.evaluate(
        """colours => colours.map(colour => {
        const pen = document.createElement("canvas").getContext("2d");
        pen.fillStyle = colour;
        pen.fillRect(0, 0, 1, 1);
        return [...pen.getImageData(0, 0, 1, 1).data.slice(0, 3)];
    })""",
        COLOURS,
    )
    page.close()
    for colour, theirs in zip(COLOURS, painted, strict=True):
        ours = parse_colour(colour)
        parts = [int(ours[i : i + 2], 16) for i in (1, 3, 5)]
        # A part at the middle of two bytes is rounded either way: the browser works in floats of 32 bits
        assert max(abs(a - b) for a, b in zip(parts, theirs, strict=True)) <= 1, colour


def test_a_fit_that_is_wrong_is_told_where_a_view_box_is_fitted():
    inner = '<svg viewBox="0 0 1 1" preserveAspectRatio="{}"><rect width="1" height="1"/></svg>'
    for text, wrong in (("xMinYMax slice", 0), ("", 0), (" none ", 0), ("xminymin", 1), ("defer none", 1), ("a b", 1)):
        found = read_svg(f"<svg {NS}>\n{inner.format(text)}</svg>".encode()).problems
        assert [(one.code, one.line) for one in found] == [("bad-value", 2)] * wrong, text
    free = '<svg preserveAspectRatio="garbage"><rect width="1" height="1"/></svg>'
    assert not read_svg(f"<svg {NS}>{free}</svg>".encode()).problems
