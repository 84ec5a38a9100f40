"""Selectors with combinators match what cssselect2 matches, which compiles each as a whole; and long ones do so too."""

import xml.etree.ElementTree as ET

import cssselect2
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from importers.limits import Work
from importers.svg import read_svg
from importers.svg.sheet import Sheet

PARTS = st.sampled_from(["g", "rect", ".a", "g.b", "*", "rect:first-child", ":not(.a)", ":is(g .a, rect)", "[id]"])
COMBINATORS = st.sampled_from([" ", ">", " > ", "+", " ~ ", "~"])
TREES = st.recursive(
    st.tuples(st.sampled_from(["g", "rect"]), st.sampled_from(["", "a", "b", "a b"]), st.just(())),
    lambda inner: st.tuples(
        st.sampled_from(["g", "rect"]), st.sampled_from(["", "a", "b"]), st.lists(inner, max_size=4).map(tuple)
    ),
    max_leaves=14,
)


@st.composite
def selectors(draw):
    parts = draw(st.lists(PARTS, min_size=1, max_size=4))
    text = parts[0]
    for part in parts[1:]:
        text += draw(COMBINATORS) + part
    return text


def element(name, classes, inner):
    made = ET.Element(name, {"class": classes} | ({"id": "x"} if classes == "a" else {}))
    made.extend(element(*one) for one in inner)
    return made


@settings(max_examples=300, deadline=None)
@given(tree=TREES, text=selectors())
def test_a_selector_matches_the_elements_that_cssselect2_finds(tree, text):
    root = element(*tree)
    matcher = cssselect2.Matcher()
    for compiled in cssselect2.compile_selector_list(text):
        matcher.add_selector(compiled, True)
    whole = cssselect2.ElementWrapper.from_xml_root(root)
    judged = [wrapper.etree_element for wrapper in whole.iter_subtree() if matcher.match(wrapper)]
    sheet = Sheet([(text + "{display:none}", lambda *_: None)], root, Work())
    assert [one for one in root.iter() if sheet.matches(one, None)] == judged


@pytest.mark.parametrize("text", ["g >", "> g", "g > > rect", "g,", "g::before rect", ":is(" + "g " * 11 + "g) rect"])
def test_what_is_no_selector_is_said_and_left_out(text):
    sheet, shape = f"<style>{text}{{display:none}}</style>", '<g><rect width="9" height="9"/></g>'
    drawing = read_svg(f'<svg xmlns="http://www.w3.org/2000/svg">{sheet}{shape}</svg>'.encode())
    assert [problem.code for problem in drawing.problems] == ["css-skipped"]
    assert [path.visible for path in drawing.paths] == [True]


@pytest.mark.parametrize("deep", [1, 30, 200])
def test_a_selector_may_be_as_long_as_the_drawing_is_deep(deep):
    sheet = "g " * deep + "rect{display:none}"
    inner = "<g>" * deep + '<rect width="9" height="9"/>' + "</g>" * deep
    outer = '<g><rect width="9" height="9"/></g>' if deep > 1 else '<rect width="9" height="9"/>'
    text = f'<svg xmlns="http://www.w3.org/2000/svg"><style>{sheet}</style>{inner}{outer}</svg>'
    assert [path.visible for path in read_svg(text.encode()).paths] == [False, True]
