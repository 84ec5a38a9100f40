"""Whatever an SVG file holds, only WallkitError leaves the reader, and what comes out can be written."""

import json
import re
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from importers.boxes import box_of
from importers.errors import WallkitError
from importers.svg import read_svg
from importers.svg.style import PROPERTIES

HERE = Path(__file__).parent
FILES = sorted((HERE / "svg").glob("*.svg"))
CRASHERS = sorted((HERE / "svg_crashers").glob("*"))

TAGS = re.findall(
    r"\w+", "g svg a use symbol switch defs clipPath rect circle ellipse line polyline polygon path text qwe style"
)
NAMES = [
    *sorted(PROPERTIES),
    *re.findall(r"\S+", "viewBox preserveAspectRatio points x1 y2 href id class style systemLanguage data-a"),
]
WORDS = re.findall(
    r"\S+",
    """10 -5 1e3 1e999 50% 2em 1ex 3vw 5mm 0 .5.5 nan inf auto none inherit initial unset center #a #b url(#a) red
    M0 0L1 1 A5 5 0 0 1 9 9 rotate(30) scale(0) scale(1e300) matrix(1 2 3 4 5 6) translate(1px,2%) calc(1px + 2%)
    min(1px,2em) fill-box hidden visible block contents evenodd ! important ; : { } ( ) , xMidYMid slice
    \\ ' " /* */""",
)
TEXTS = st.lists(st.sampled_from(WORDS), max_size=8).map(" ".join) | st.text(max_size=12)


def escape(text):
    for sign, entity in (("&", "&amp;"), ("<", "&lt;"), ('"', "&quot;")):
        text = text.replace(sign, entity)
    return "".join(c for c in text if c.isprintable() or c == " ")


@st.composite
def elements(draw, depth=0):
    tag = draw(st.sampled_from(TAGS))
    attributes = draw(st.dictionaries(st.sampled_from(NAMES), TEXTS, max_size=6))
    attributes["id"] = draw(st.sampled_from("ab"))
    if tag == "use":
        attributes["href"] = draw(st.sampled_from(["#a", "#b"]))
    inside = escape(draw(TEXTS)) if tag == "style" else ""
    if depth < 3 and tag != "style":
        inside = "".join(draw(st.lists(elements(depth + 1), max_size=3)))
    written = "".join(f' {name}="{escape(value)}"' for name, value in attributes.items())
    return f"<{tag}{written}>{inside}</{tag}>"


def read(data):
    """Read; a drawing must be one that can be written and measured, with arcs that have radii."""
    try:
        drawing = read_svg(data)
    except WallkitError as error:
        return error.code and error.message
    json.dumps(drawing.to_json(), allow_nan=False)
    box = box_of(drawing.paths)
    assert box is None or all(abs(number) < 1e10 for number in box)
    for path in drawing.paths:
        for sub in path.subpaths:
            assert sub.segments[0][0] == "M"
            assert all(segment[1] > 0 and segment[2] > 0 for segment in sub.segments if segment[0] == "A")
    return None


@given(st.lists(elements(), max_size=4), st.dictionaries(st.sampled_from(NAMES), TEXTS, max_size=3))
@settings(max_examples=50)
def test_a_soup_of_elements_and_attributes(parts, attributes):
    written = "".join(f' {name}="{escape(value)}"' for name, value in attributes.items())
    read(f'<svg xmlns="http://www.w3.org/2000/svg"{written}>{"".join(parts)}</svg>'.encode())


@given(
    st.sampled_from(FILES), st.lists(st.tuples(st.integers(0, 10**6), st.binary(max_size=6)), min_size=1, max_size=4)
)
@settings(max_examples=150)
def test_damaged_files(file, damage):
    data = bytearray(file.read_bytes())
    for place, put in damage:
        place %= len(data) + 1
        data[place : place + len(put) // 2] = put
    read(bytes(data))


@given(st.sampled_from(FILES), st.sampled_from(FILES), st.integers(0, 10**6), st.integers(0, 10**6))
@settings(max_examples=150)
def test_files_cut_and_put_together(one, other, here, there):
    first, second = one.read_bytes(), other.read_bytes()
    read(first[: here % len(first)] + second[there % len(second) :])


@given(st.binary(max_size=200))
@settings(max_examples=60)
def test_any_bytes(data):
    read(data)
    read(b"<svg xmlns='http://www.w3.org/2000/svg'>" + data)


@given(st.text(max_size=60))
@settings(max_examples=150)
def test_any_style_sheet(text):
    sheet = escape(text)
    read(f'<svg xmlns="http://www.w3.org/2000/svg"><style>{sheet}</style><rect style="{sheet}"/></svg>'.encode())


@pytest.mark.parametrize("file", CRASHERS, ids=lambda file: file.name)
def test_what_once_crashed_it(file):
    read(file.read_bytes())
