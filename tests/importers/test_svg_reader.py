"""What the SVG reader says besides outlines: names, layers, paints, tags, and where things are wrong."""

import cmath
import math
import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from svg_sampling import points_along

from importers.boxes import box_of_segments
from importers.errors import DrawingError, LimitError
from importers.svg import looks_like_svg, read_svg
from importers.svg.matrix import multiply, rotation, transform
from importers.svg.reader import Reader
from importers.svg.source import parse

NS = (
    'xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" '
    'xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" '
    'xmlns:sodipodi="http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd"'
)


def svg(body, head='viewBox="0 0 100 100"'):
    return read_svg(f"<svg {NS} {head}>{body}</svg>".encode(), "a.svg")


def only(drawing):
    assert len(drawing.paths) == 1
    return drawing.paths[0]


def codes(drawing):
    return [problem.code for problem in drawing.problems]


# --- names, layers, tags


def test_inkscape_layers_have_their_labels_and_are_hidden_and_locked_as_inkscape_has_them():
    drawing = svg(
        '<g id="layer1" inkscape:groupmode="layer" inkscape:label="Walls of stone">'
        '<g id="g5"><rect id="r" inkscape:label="north" width="5" height="5"/></g></g>'
        '<g id="layer2" inkscape:groupmode="layer" inkscape:label="Notes" style="display:none"'
        ' sodipodi:insensitive="true"><g inkscape:groupmode="layer" inkscape:label="Inner">'
        '<circle r="3"/></g></g><g id="loose"><path d="M0 0H5"/></g>'
    )
    assert [(layer.name, layer.visible, layer.locked) for layer in drawing.layers] == [
        ("Walls of stone", True, False),
        ("Notes", False, True),
        ("Inner", False, True),
    ]
    north, circle, loose = drawing.paths
    assert (north.name, north.layer, north.groups) == ("north", "Walls of stone", ("g5",))
    assert (circle.layer, circle.visible, circle.locked) == ("Inner", False, True)
    assert (loose.layer, loose.groups) == ("", ("loose",))


def test_top_groups_with_ids_are_the_layers_of_a_file_that_knows_no_layers():
    drawing = svg('<g id="Walls"><g id="Inner"><rect width="5" height="5"/></g></g><g><rect width="4" height="4"/></g>')
    assert [layer.name for layer in drawing.layers] == ["Walls"]
    assert [(path.layer, path.groups) for path in drawing.paths] == [("Walls", ("Inner",)), ("", ("",))]


@pytest.mark.parametrize(
    ("written", "meant"),
    [("Layer_1", "Layer 1"), ("a_x5F_b", "a_b"), ("_x31_2_x20_x", "12 x"), ("wall_2_", "wall"), ("_xE4_", "\xe4")],
)
def test_illustrator_ids_are_decoded(written, meant):
    text = (
        f'<!-- Generator: Adobe Illustrator 27.0, SVG Export Plug-In --><svg {NS}><g id="{written}">'
        f'<rect id="{written}" width="5" height="5"/></g></svg>'
    )
    path = only(read_svg(text.encode()))
    assert (path.name, path.layer) == (meant, meant)


def test_ids_of_other_programs_keep_their_underscores():
    assert only(svg('<rect id="left_wall_1_" width="5" height="5"/>')).name == "left_wall_1_"


def test_a_name_is_the_label_or_data_name_or_id_or_title_and_else_that_of_the_use():
    drawing = svg(
        '<defs><rect id="" width="2" height="2"><title> the  box </title></rect>'
        '<g id="g"><path d="M0 0H2"/></g></defs><use id="here" href="#g"/>'
        '<rect id="i" data-name="d" width="1" height="1"/><rect id="i2" width="1" height="1"><title>t</title></rect>'
        '<rect width="1" height="1"><title>t</title></rect>'
    )
    assert [path.name for path in drawing.paths] == ["here", "d", "i2", "t"]


def test_data_attributes_become_tags_and_come_down_from_groups():
    drawing = svg(
        '<g data-material="rubber" data-x="1"><rect data-x="2" data-name="n" width="1" height="1"/></g>'
        '<rect width="1" height="1"/>'
    )
    assert [path.tags for path in drawing.paths] == [{"material": "rubber", "x": "2"}, {}]


# --- paint


def test_paint_is_inherited_resolved_and_named():
    drawing = svg(
        '<linearGradient id="l"><stop/></linearGradient><pattern id="p"><path d="M0 0h1v1z"/></pattern>'
        '<g fill="currentColor" color="rgb(10%,20%,30%)" stroke-width="2">'
        '<rect width="1" height="1" transform="scale(2 8)" stroke="red"/><rect width="1" height="1" fill="url(#l)"/>'
        '<rect width="1" height="1" fill="url(#p)" fill-rule="evenodd"/>'
        '<rect width="1" height="1" fill="url(#none) lime" stroke="url(#none)"/><rect width="1" height="1" fill="qwe"/>'
        '<rect width="1" height="1" style="fill:none;stroke:hsl(120,100%,50%)"/></g>'
    )
    fills = [path.fill for path in drawing.paths]
    assert fills == ["#1a334c", "gradient", "pattern", "#00ff00", "#1a334c", None]
    assert [path.stroke for path in drawing.paths] == ["#ff0000", None, None, None, None, "#00ff00"]
    assert drawing.paths[0].stroke_width == pytest.approx(8.0)  # 2 times the root of 2 * 8
    assert drawing.paths[1].stroke_width is None
    assert [path.fill_rule for path in drawing.paths][1:3] == ["nonzero", "evenodd"]


def test_what_is_hidden_is_listed_and_marked():
    drawing = svg(
        '<g visibility="hidden"><rect width="1" height="1"/><rect visibility="visible" width="1" height="1"/></g>'
        '<rect display="none" width="1" height="1"/><svg width="0"><rect width="1" height="1"/></svg>'
    )
    assert [path.visible for path in drawing.paths] == [False, True, False, False]


# --- places


def test_an_error_in_path_data_is_told_by_line_and_column_over_lines_references_and_entities():
    text = (
        '<?xml version="1.0"?>\n<!DOCTYPE svg [<!ENTITY e "M 1 1">]>\n<!-- <path d="M 0 0 #"/> -->\n'
        f'<svg {NS}>\n  <path id="one"\n     d="M 10&#x20;20\n    L 30 40\n    L 50 #60"/>\n'
        '<path d="&e; L 5 5 ?"/></svg>'
    )
    drawing = read_svg(text.encode(), "a.svg")
    first, second = drawing.problems
    assert (first.code, first.line, first.column, first.name) == ("bad-path-data", 8, 10, "one")
    assert first.excerpt == '    L 50 #60"/>\n         ^'
    assert (first.x, first.y) == (30.0, 40.0)
    assert second.line == 9  # the column is where the entity stands, whose text is not in the line
    assert [path.line for path in drawing.paths] == [5, 9]


@pytest.mark.parametrize("line_end", ["\n", "\r\n"])
def test_places_hold_with_both_line_ends_and_beyond_line_65535(line_end):
    blank = line_end * 70_000
    text = f'<svg {NS}>{blank}<path d="M 0 0{line_end}L 1 1{line_end}L x"/></svg>'
    problem = read_svg(text.encode()).problems[0]
    assert (problem.line, problem.column) == (70_003, 3)


def test_every_element_that_is_left_out_is_counted_with_its_first_place():
    drawing = svg(
        '\n<text>a</text>\n<text>b</text><image href="x.png"/><foreignObject/>\n<defs><rect id="used" width="1"'
        ' height="1"/>\n<circle r="1"/></defs><use href="#used"/><clipPath><path d="M0 0H1"/></clipPath>'
        '<qwe/><f:x xmlns:f="urn:f"/><script/><rect width="0" height="3"/><circle/>'
        '<switch><g/><rect width="1" height="1"/></switch><use href="#nothing"/><use href="b.svg#c"/>'
    )
    told = {problem.message: (problem.code, problem.line) for problem in drawing.problems}
    assert told["2 times: <text> has no outlines and is left out"] == ("text-left-out", 2)
    assert told["<image> has no outlines and is left out"] == ("image-left-out", 3)
    assert told["shape in <defs> is not drawn by itself"][0] == "not-drawn"
    assert told["shape in <clipPath> is not drawn by itself"][0] == "not-drawn"
    for code in ("unknown-element", "foreign-element", "not-run", "nothing-drawn", "not-chosen", "bad-use"):
        assert code in codes(drawing)
    assert [path.name for path in drawing.paths] == ["used"]


@pytest.mark.parametrize(
    ("body", "code"),
    [
        ('<rect width="4furlongs" height="5"/>', "bad-length"),
        ('<rect width="4" height="5" transform="turn(5)"/>', "bad-transform"),
        ('<polygon points="1,1 2,2 x"/>', "bad-points"),
        ('<polygon points="1,1 2,2 3"/>', "bad-points"),
        ('<rect width="5vw" height="5"/>', "assumed-unit"),
        ('<rect width="1e10" height="5"/>', "bad-coordinate"),
        ("<style>@import url(a.css);</style>", "css-skipped"),
        ("<style>rect:qwe{fill:red}</style>", "css-skipped"),
        ('<style media="print">rect{fill:red}</style>', "css-skipped"),
    ],
)
def test_what_is_not_followed_is_reported(body, code):
    assert code in codes(svg(body))


def test_a_file_without_the_namespace_is_read_with_a_warning():
    drawing = read_svg(b'<svg viewBox="0 0 5 5"><g><rect width="3" height="2"/></g></svg>')
    assert len(drawing.paths) == 1
    assert codes(drawing) == ["missing-namespace"]


@pytest.mark.parametrize(
    ("text", "line", "column"),
    [("<svg>\n<g>\n</svg>", 3, 7), ("<svg>\n  <rect width=5/></svg>", 2, 15), ("<svg", 1, 5)],
)
def test_broken_xml_is_an_error_with_its_place(text, line, column):
    with pytest.raises(DrawingError) as caught:
        read_svg(text.encode(), "a.svg")
    assert (caught.value.code, caught.value.line) == ("bad-xml", line)
    assert abs(caught.value.column - column) <= 1  # libxml2 stands before or behind the sign that is wrong


def test_bytes_of_another_encoding_are_reported_and_the_outlines_read():
    drawing = read_svg(f'<svg {NS}>\n<rect id="T\xfcr" width="5" height="4"/></svg>'.encode("latin-1"))
    assert only(drawing).name == "T\N{REPLACEMENT CHARACTER}r"
    assert codes(drawing) == ["bad-encoding"]
    assert "line 2" in drawing.problems[0].message


def test_an_unknown_encoding_is_named():
    for name in ("klingon", "hex", "idna", "punycode", "undefined", "unicode_escape", "utf-7"):
        data = f'<?xml version="1.0" encoding="{name}"?><svg>\xff</svg>'.encode("latin-1")
        with pytest.raises(DrawingError) as caught:
            read_svg(data)
        assert caught.value.code == "bad-encoding"


def test_a_limit_error_knows_its_file():
    with pytest.raises(LimitError) as caught:
        read_svg(f'<svg {NS}><g transform="{"scale(1)" * 10_001}"/></svg>'.encode(), "deep.svg")
    assert (caught.value.file, caught.value.exit_code) == ("deep.svg", 3)


def test_what_looks_like_svg():
    assert looks_like_svg(b"<svg/>")
    assert looks_like_svg(b'  <?xml version="1.0"?>\n<!-- a -->\n<x:svg xmlns:x="http://www.w3.org/2000/svg"/>')
    assert looks_like_svg("<svg></svg>".encode("utf-16"))
    assert not looks_like_svg(b"<!DOCTYPE html><html><svg></svg></html>")
    assert not looks_like_svg(b"24 803 m")


# --- arcs through matrices

MATRICES = st.tuples(*[st.floats(-3, 3).map(lambda number: round(number, 3))] * 6).filter(
    lambda m: abs(m[0] * m[3] - m[1] * m[2]) > 1e-2
)
ARCS = st.tuples(
    st.floats(0.5, 50),
    st.floats(0.5, 50),
    st.floats(-180, 180),
    st.integers(0, 1),
    st.integers(0, 1),
    st.floats(0.1, 0.99),
    st.floats(-math.pi, math.pi),
)


def an_arc(rx, ry, degrees, large, sweep, part, direction):
    """An arc whose chord is that part of the ellipse's diameter, in that direction."""
    turn = cmath.exp(1j * math.radians(degrees))
    unit = 2 * part * cmath.exp(1j * direction)
    end = complex(unit.real * rx, unit.imag * ry) * turn
    return [("M", 0.0, 0.0), ("A", rx, ry, degrees, large, sweep, end.real, end.imag)]


@given(ARCS, MATRICES)
def test_an_arc_stays_exact_through_every_matrix(arc, matrix):
    """Every point of the arc, mapped, is on the mapped arc: at distance 1 from its centre on its unit circle.

    The bound: a radius far smaller than the other loses digits by their ratio (the condition of the matrix),
    and a chord near the diameter, here at most 0.99 of it, loses a factor of 1 / sqrt(1 - 0.99^2) = 7.
    """
    segments = an_arc(*arc)
    mapped = transform(segments, matrix)
    rx, ry, degrees = mapped[1][1:4]
    a, b, c, d, e, f = matrix
    before = points_along(segments, 50)
    wanted = before @ np.array([[a, b], [c, d]]) + [e, f]
    got = points_along(mapped, 50)
    condition = max(rx / ry, ry / rx)
    near = 1e-13 * condition * max(1.0, np.abs(wanted).max())
    assert got[0] == pytest.approx(wanted[0], abs=near)
    assert got[-1] == pytest.approx(wanted[-1], abs=near)
    # the parameters run alike up to a shift, so compare where points are, not which
    turn = cmath.exp(-1j * math.radians(degrees))
    unit = [(complex(*point) * turn) for point in wanted]
    unit = np.array([complex(z.real / rx, z.imag / ry) for z in unit])
    own = [(complex(*point) * turn) for point in got]
    own = np.array([complex(z.real / rx, z.imag / ry) for z in own])
    centre = _centre(own)
    assert np.abs(np.abs(unit - centre) - 1).max() <= 1e-11 * condition * max(1.0, abs(centre))
    assert np.abs(unit[25] - own[25]) <= 1e-9 * condition * max(1.0, abs(centre))


def _centre(points):  # of the circle through the first, the middle and the last
    a, b, c = points[1], points[len(points) // 2], points[-1]
    w = (c - a) / (b - a)
    return (b - a) * (w - abs(w) ** 2) / (2j * w.imag) + a


@given(ARCS, MATRICES)
def test_the_box_of_an_arc_holds_it_and_is_no_larger(arc, matrix):
    mapped = transform(an_arc(*arc), matrix)
    points = points_along(mapped, 4000)
    low, high = points.min(axis=0), points.max(axis=0)
    box = box_of_segments(mapped)
    size = float(np.abs(points).max()) + 1.0
    # 4,000 steps of at most a whole turn miss an extreme by at most r (2 pi / 4000)^2 / 8
    radius = max(mapped[1][1:3])
    assert [*low, *high] == pytest.approx(box, abs=radius * 4e-7 + 1e-9 * size)
    assert box[0] <= low[0] + 1e-9 * size
    assert box[3] >= high[1] - 1e-9 * size


def test_quarter_turns_are_exact():
    for degrees in (-270, -90, 90, 180, 270, 360, 450):
        assert set(rotation(degrees)) <= {-1.0, 0.0, 1.0}
    assert multiply(rotation(90), rotation(270)) == (1.0, 0.0, 0.0, 1.0, 0.0, 0.0)


def test_a_circle_is_a_circle_after_rotation_and_even_scale():
    path = only(svg('<circle cx="3" cy="4" r="5" transform="rotate(33) scale(2)"/>'))
    radii = {number for segment in path.subpaths[0].segments[1:] for number in segment[1:3]}
    assert all(radius == pytest.approx(10, rel=1e-15) for radius in radii)
    assert len(path.subpaths[0].segments) == 5


def test_every_code_of_the_reader_is_in_the_list_for_people():
    root = Path(__file__).parents[2]
    source = "".join(file.read_text("utf-8") for file in (root / "importers" / "svg").glob("*.py"))
    source += (root / "importers" / "read.py").read_text("utf-8")
    before = r'code=|Problem\(\s*|notes\.(?:add|count)\(\s*|report\(|^    "\w+": \(|code = |else '
    found = set(re.findall(rf'(?:{before})"([a-z]+(?:-[a-z]+)+)"', source, re.M))
    assert {"bad-path-data", "not-a-drawing", "css-skipped", "text-left-out", "bad-points", "no-size"} <= found
    listed = set(re.findall(r"`([a-z-]+)`", (root / "docs" / "problems.md").read_text("utf-8")))
    assert found <= listed


def test_an_open_outline_in_a_group_that_is_filled_without_opacity_is_not_filled_and_its_json_says_null():
    drawing = svg(
        '<g style="fill:#000000; fill-opacity:0.0; stroke:#000000; stroke-width:0.5; stroke-opacity:1;">'
        '<path d="M30 10 A20 20 0 0 0 10 30"/></g>'
    )
    written = drawing.to_json()["paths"][0]
    assert (written["fill"], written["stroke"], written["stroke_width"]) == (None, "#000000", 0.5)


def test_a_chain_of_gradients_is_looked_at_once_whatever_asks_for_it():
    chain = "".join(f'<linearGradient id="g{i}" href="#g{i + 1}"/>' for i in range(2000))
    shapes = "".join(f'<rect width="1" height="1" fill="url(#g{i})"/>' for i in range(2000))
    reading = Reader(parse(f"<svg {NS}>{chain}{shapes}</svg>", ""))
    asked = []
    follow = reading.references.referred
    reading.references.referred = lambda element: asked.append(element) or follow(element)
    assert {path.fill for path in reading.read().paths} == {None}
    assert len(asked) == 2000


# --- what is not declared


@pytest.mark.parametrize("prefix", ["xlink", "sodipodi", "inkscape", "svg", "my"])
def test_a_prefix_that_is_not_declared_is_read_and_the_attribute_to_add_is_named(prefix):
    text = (
        '<?xml version="1.0"?><!-- <a b="> --><!DOCTYPE svg [ <!-- "] --> ]>\n<svg xmlns="http://www.w3.org/2000/svg">'
        f'\n<g {prefix}:href="#a" {prefix}:other="1"/><rect id="a" width="2" height="1"/><{prefix}:thing/></svg>'
    )
    drawing = read_svg(text.encode())
    problem = next(problem for problem in drawing.problems if problem.code == "undeclared-prefix")
    assert (problem.severity, problem.line) == ("warning", 3)
    assert f'xmlns:{prefix}="' in problem.fix
    assert only(drawing).line == 3


def test_a_use_with_an_undeclared_xlink_shows_its_target():
    drawing = read_svg(
        b'<svg xmlns="http://www.w3.org/2000/svg"><rect id="a" width="2" height="1"/><use xlink:href="#a"/></svg>'
    )
    assert len(drawing.paths) == 2


def test_more_undeclared_prefixes_than_anyone_forgets_are_an_error():
    names = "".join(f"<p{i}:x/>" for i in range(30))
    with pytest.raises(DrawingError, match="not well-formed"):
        read_svg(f"<svg {NS}>{names}</svg>".encode())


@pytest.mark.parametrize("subset", ["%u;", "<!ENTITY b 'c'> %u;", "<!-- %no; --> %u;"])
def test_declarations_that_are_not_there_are_an_error_and_not_an_empty_drawing(subset):
    text = f"<!DOCTYPE svg [\n {subset} <!ENTITY a \"<rect width='1' height='1'/>\"> ]><svg {NS}>&a;</svg>"
    with pytest.raises(DrawingError) as caught:
        read_svg(text.encode())
    assert (caught.value.code, caught.value.line) == ("unknown-entity", 2)


def test_a_reference_to_an_entity_of_a_document_type_elsewhere_is_said():
    text = (
        '<!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" "http://www.w3.org/Graphics/SVG/1.1/DTD/svg11.dtd">'
        f"<svg {NS}>\n<!-- &no; --><![CDATA[&no;]]>&shapes;<rect width='1' height='1'/></svg>"
    )
    drawing = read_svg(text.encode())
    problem = next(problem for problem in drawing.problems if problem.code == "unknown-entity")
    assert (problem.severity, problem.line, problem.column) == ("error", 2, text.splitlines()[1].index("&shapes") + 1)
    assert len(drawing.paths) == 1


def test_a_place_in_a_line_as_long_as_the_file_has_its_column_and_its_surroundings():
    text = f'<svg {NS}>{"<g/>" * 20_000}<path d="M0 0L#"/>{"<g/>" * 20_000}</svg>'
    problem = read_svg(text.encode()).problems[0]
    assert problem.column == text.index("#") + 1
    line, caret = problem.excerpt.split("\n")
    assert len(line) < 110
    assert line[caret.index("^")] == "#"
