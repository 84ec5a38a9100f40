"""PDF drawings, made here: what stands on a page, its paints, forms, layers and what is left out."""

import io

import pikepdf
import pytest
from pdf_making import make, read, saved, segments
from pikepdf import Array, Dictionary, Name

from importers.pdf import read_pdf


def test_every_segment_and_every_paint_of_a_page():
    drawing = read(
        b"0 0 m 1 0 l 2 1 3 2 4 3 c 5 5 6 6 v 7 7 8 8 y h S\n"
        b"10 20 30 40 re f 1 1 m 2 2 l F 1 1 m 2 1 l f* 1 1 m 2 2 l B 1 1 m 2 2 l B* 1 1 m 2 2 l b 1 1 m 2 2 l b*\n"
        b"1 1 m 2 2 l s 0 0 200 100 re W n 0 0 5 5 re W* n 3 3 m 4 4 l n"
    )
    first, rectangle, *others = drawing.paths
    assert segments(first) == [
        [("M", 0, 0), ("L", 1, 0), ("C", 2, 1, 3, 2, 4, 3), ("C", 4, 3, 5, 5, 6, 6), ("C", 7, 7, 8, 8, 8, 8)]
    ]
    assert first.subpaths[0].closed
    assert segments(rectangle) == [[("M", 10, 20), ("L", 40, 20), ("L", 40, 60), ("L", 10, 60)]]
    marks = [(bool(p.fill), bool(p.stroke), p.subpaths[0].closed, p.fill_rule == "evenodd", p.clip) for p in others]
    assert marks == [
        (True, False, False, False, False),  # F
        (True, False, False, True, False),  # f*
        (True, True, False, False, False),  # B
        (True, True, False, True, False),  # B*
        (True, True, True, False, False),  # b
        (True, True, True, True, False),  # b*
        (False, True, True, False, False),  # s
        (False, False, True, False, True),  # W n
        (False, False, True, False, True),  # W* n
        (False, False, False, False, False),  # n
    ]
    assert (drawing.problems, drawing.units, drawing.y_axis) == ([], "pt", "up")


def test_transforms_are_applied_and_come_back():
    drawing = read(b"q 2 0 0 3 10 20 cm 1 w q 0 1 -1 0 0 0 cm 1 2 m 3 4 l S Q 1 1 m 2 2 l S Q 1 1 m 2 2 l S")
    assert [segments(path)[0] for path in drawing.paths] == [
        [("M", 6, 23), ("L", 2, 29)],  # (x, y) -> (-y, x) -> (2 x + 10, 3 y + 20)
        [("M", 12, 23), ("L", 14, 26)],
        [("M", 1, 1), ("L", 2, 2)],
    ]
    assert [path.stroke_width for path in drawing.paths] == pytest.approx([6**0.5, 6**0.5, 1])


def test_forms_are_drawn_where_they_are_used():
    def resources(pdf):
        inner = pdf.make_stream(
            b"0 0 1 1 re f",
            Type=Name.XObject,
            Subtype=Name.Form,
            BBox=Array([0, 0, 9, 9]),
            Matrix=Array([1, 0, 0, 1, 5, 7]),
        )
        outer = pdf.make_stream(
            b"2 0 0 2 0 0 cm /In Do 1 0 0 rg",
            Type=Name.XObject,
            Subtype=Name.Form,
            Resources=Dictionary(XObject=Dictionary(In=inner)),
        )
        return Dictionary(XObject=Dictionary(Out=outer))

    drawing = read(b"q 1 0 0 1 100 0 cm /Out Do Q /Out Do 0 0 1 1 re f", resources)
    assert [path.subpaths[0].segments[0] for path in drawing.paths] == [("M", 110, 14), ("M", 10, 14), ("M", 0, 0)]
    assert {path.fill for path in drawing.paths} == {"#000000"}  # the red does not leave its form


def test_a_form_that_draws_itself_ends():
    def resources(pdf):
        form = pdf.make_indirect(pdf.make_stream(b"0 0 1 1 re f /Me Do", Subtype=Name.Form))
        form.Resources = Dictionary(XObject=Dictionary(Me=form))
        return Dictionary(XObject=Dictionary(Me=form))

    drawing = read(b"/Me Do", resources)
    assert len(drawing.paths) == 1
    assert [problem.code for problem in drawing.problems] == ["recursive-form"]


def layers_of(pdf):
    shown, hidden, locked = (
        pdf.make_indirect(Dictionary(Type=Name.OCG, Name=name)) for name in ("Shown", "Hidden", "Locked")
    )
    pdf.Root.OCProperties = Dictionary(
        OCGs=Array([shown, hidden, locked]),
        D=Dictionary(ON=Array([shown, locked]), OFF=Array([hidden]), Locked=Array([locked])),
    )
    either = Dictionary(Type=Name.OCMD, OCGs=Array([hidden, shown]))
    both = Dictionary(Type=Name.OCMD, OCGs=Array([hidden, shown]), P=Name.AllOn)
    return Dictionary(Properties=Dictionary(A=shown, B=hidden, C=locked, E=either, F=both))


def test_optional_content_is_layers():
    square = b" 0 0 1 1 re f "
    drawing = read(
        b"/OC /A BDC" + square + b"/OC /B BDC" + square + b"/Span BMC" + square + b"EMC EMC EMC"
        b"/OC /C BDC" + square + b"EMC /OC /E BDC" + square + b"EMC /OC /F BDC" + square + b"EMC" + square,
        layers_of,
    )
    assert [(layer.name, layer.visible, layer.locked) for layer in drawing.layers] == [
        ("Shown", True, False),
        ("Hidden", False, False),
        ("Locked", True, True),
    ]
    assert [(path.layer, path.visible, path.locked) for path in drawing.paths] == [
        ("Shown", True, False),
        ("Hidden", False, False),
        ("Hidden", False, False),
        ("Locked", True, True),
        ("Hidden", True, False),  # any of its layers is on
        ("Hidden", False, False),  # not all are
        ("", True, False),
    ]


def test_colours():
    def resources(pdf):
        spot = Array([Name.Separation, Name("/Red"), Name.DeviceCMYK, Dictionary(FunctionType=2, N=1, Domain=[0, 1])])
        return Dictionary(ColorSpace=Dictionary(S=spot, P=Name.Pattern, I=Array([Name.ICCBased, pdf.make_stream(b"")])))

    drawing = read(
        b"0.2 g 0 0 1 1 re f 1 0 0 rg 0 0 1 1 re f 0 1 1 0 k 0 0 1 1 re f /S cs 1 scn 0 0 1 1 re f 0 scn 0 0 1 1 re f\n"
        b"/P cs /P0 scn 0 0 1 1 re f /I cs 0 0.5 1 sc 0 0 1 1 re f 0.5 G 1 0 1 RG 0 0 0 1 K 3 w 0 0 1 1 re S",
        resources,
    )
    assert [path.fill for path in drawing.paths[:-1]] == [
        "#333333", "#ff0000", "#ff0000", "#000000", "#ffffff", "pattern", "#0080ff",
    ]  # fmt: skip
    assert (drawing.paths[-1].stroke, drawing.paths[-1].stroke_width) == ("#000000", 3)


def test_what_is_left_out_is_said():
    def resources(pdf):
        image = pdf.make_stream(b"\x00", Subtype=Name.Image, Width=1, Height=1)
        return Dictionary(XObject=Dictionary(I=image))

    drawing = read(
        b"BT /F0 12 Tf (Hello \\) Q S) Tj ET BT ET /I Do /Nothing Do /Sh sh 1 2 zz\n"
        b"BI /W 1 /H 1 /BPC 8 /CS /G ID \x00 EI 0 0 1 1 re f",
        resources,
    )
    assert [problem.code for problem in drawing.problems] == [
        "text-left-out", "image-left-out", "missing-object", "shading-left-out", "unknown-operator",
    ]  # fmt: skip
    assert [problem.message for problem in drawing.problems][1] == "2 pixel images are left out"
    assert len(drawing.paths) == 1


def test_strings_dictionaries_comments_and_names_are_passed_over():
    drawing = read(
        b"/a#20b gs % 1 1 m 2 2 l S\n/Tag << /K [ (1 1 m) <31> << >> ] >> DP (2 2 l S) Tj <0a> Tj 0 0 1 1 re f"
    )
    assert len(drawing.paths) == 1
    assert drawing.problems == []


@pytest.mark.parametrize(
    ("content", "code"),
    [
        (b"1 1 l 2 2 l S", "no-current-point"),
        (b"0 0 m 5 l 2 2 l S", "bad-operands"),
        (b"0 0 m 1 2 3 l S", None),
        (b"Q 0 0 m 1 1 l S", "unbalanced"),
        (b"EMC 0 0 m 1 1 l S", "unbalanced"),
        (b"0 0 m 2000000000 1 l S 0 0 m 1 1 l S", "bad-coordinate"),
        (b"1 0 0 cm 0 0 m 1 1 l S", "bad-operands"),
        (b"1 1 g 0 0 m 1 1 l S", "bad-attribute"),
    ],
)
def test_what_is_wrong_is_said_and_the_rest_is_used(content, code):
    drawing = read(content)
    assert len(drawing.paths) == 1
    assert [problem.code for problem in drawing.problems] == ([code] if code else [])


def test_what_the_page_does_to_its_units_is_said():
    drawing = read(b"0 0 1 1 re f", UserUnit=10, Rotate=90)
    assert [problem.code for problem in drawing.problems] == ["user-unit", "rotated-page"]
    assert segments(drawing.paths[0])[0][2] == ("L", 1, 1)


OVERFLOWING = b"1 0 0 " + b"9" * 38 + b" 0 0 cm "


@pytest.mark.parametrize(
    "content",
    [OVERFLOWING * 9, b"1e300 0 0 1e300 0 0 cm " * 2, b"1e400 0 0 1 0 0 cm", b"1e300 0 0 1e300 0 0 cm /X Do"],
    ids=["many", "two", "one", "a form's own"],
)
def test_a_matrix_that_overflows_is_a_bad_number_and_nothing_is_drawn_with_it(content):
    def with_form(pdf):
        matrix = [100_000, 0, 0, 100_000, 0, 0]
        inner = pdf.make_stream(b"5 0 m 10 0 l S", Subtype=Name.Form, Matrix=Array(matrix))
        outer = pdf.make_stream(
            b"/X Do", Subtype=Name.Form, Matrix=Array(matrix), Resources=Dictionary(XObject=Dictionary(X=inner))
        )
        return Dictionary(XObject=Dictionary(X=outer))

    drawing = read(b"q 2 0 0 2 7 8 cm " + content + b" 5 0 m 10 0 l S Q 1 1 m 2 2 l S", with_form)
    assert [(problem.code, problem.severity, problem.x, problem.y) for problem in drawing.problems][:1] == [
        ("bad-number", "error", 7, 8)
    ]
    assert segments(drawing.paths[-1]) == [[("M", 1, 1), ("L", 2, 2)]]
    assert all(abs(number) < 1e9 for path in drawing.paths for part in segments(path)[0] for number in part[1:])


@pytest.mark.parametrize("numbers", [b"1e400 0", b"-1e400 1e400", b"1 1000000001"])
def test_a_coordinate_that_is_none_is_never_in_the_result(numbers):
    drawing = read(numbers + b" m 10 0 l S 0 1 1 0 0 0 cm " + numbers + b" m 10 0 l S")
    assert drawing.paths == []
    assert [problem.code for problem in drawing.problems] == ["bad-coordinate"]


def opacities(pdf):
    states = {
        "/F": Dictionary(ca=0),
        "/S": Dictionary(CA=0),
        "/B": Dictionary(ca=0, CA=0),
        "/L": Dictionary(ca=1, LW=3),
    }
    group = Dictionary(S=Name.Transparency)
    form = {"Subtype": Name.Form, "Resources": Dictionary(ExtGState=Dictionary(L=states["/L"]))}
    forms = {
        "/G": pdf.make_stream(b"/L gs 0 0 1 1 re B", Group=group, **form),
        "/P": pdf.make_stream(b"0 0 1 1 re B", **form),
    }
    return Dictionary(ExtGState=Dictionary(states), XObject=Dictionary(forms))


@pytest.mark.parametrize(
    ("content", "paints"),
    [
        (b"0 0 1 1 re B", (True, True)),
        (b"/F gs 0 0 1 1 re B", (False, True)),
        (b"/S gs 0 0 1 1 re B", (True, False)),
        (b"/B gs 0 0 1 1 re B", (False, False)),
        (b"q /B gs Q 0 0 1 1 re B", (True, True)),
        (b"/B gs /L gs 0 0 1 1 re B", (True, False)),
        (b"/B gs /P Do", (False, False)),  # a plain form takes the state over
        (b"/F gs /P Do", (False, True)),
        (b"/F gs /G Do", (False, False)),  # a group is drawn as a whole, with the opacity of fills
        (b"/S gs /G Do", (True, True)),
        (b"/F gs /G Do 0 0 1 1 re B", (False, True)),  # and afterwards all is as before
        (b"/Missing gs 0 0 1 1 re B", (True, True)),
        (b"0 0 1 1 re n", (False, False)),
    ],
)
def test_paint_without_opacity_is_no_paint(content, paints):
    path = read(content, opacities).paths[-1]
    assert (path.fill is not None, path.stroke is not None) == paints
    assert (path.stroke_width is not None) == paints[1]


def test_a_set_of_attributes_sets_the_line_width():
    assert read(b"/L gs 0 0 1 1 re S", opacities).paths[0].stroke_width == 3


@pytest.mark.parametrize(
    ("expression", "shown"),
    [
        ("[/Not %s]", (True, False)),
        ("[/Not %o]", (False, True)),
        ("[/And %o %s]", (False,)),
        ("[/Or %s %o]", (True,)),
        ("[/And [/Or %s %o] [/Not %s]]", (True,)),
        ("[/And]", (True,)),
        ("[/Or]", (False,)),
    ],
)
def test_visibility_expressions_decide_before_rules(expression, shown):
    """%o stands for a group that is on, %s for one that is off."""

    def optional(pdf):
        on = pdf.make_indirect(Dictionary(Type=Name.OCG, Name="on"))
        off = pdf.make_indirect(Dictionary(Type=Name.OCG, Name="off"))
        pdf.Root.OCProperties = Dictionary(OCGs=[on, off], D=Dictionary(OFF=[off]))
        names = {"%o": on, "%s": off}

        def parsed(text):
            parts = Array()
            while not text[0].startswith("]"):
                token = text.pop(0)
                parts.append(parsed(text) if token == "[" else names.get(token) or Name(token))
            text.pop(0)
            return parts

        tokens = expression.replace("[", "[ ").replace("]", " ]").split()[1:]
        member = Dictionary(Type=Name.OCMD, OCGs=on, P=Name.AllOff, VE=parsed(tokens))
        return Dictionary(Properties=Dictionary(A=pdf.make_indirect(member)))

    assert read(b"/OC /A BDC 0 0 1 1 re f EMC", optional).paths[0].visible == shown[0]


ANNOTATIONS = [
    {"Subtype": Name.Square},
    {"Subtype": Name.FileAttachment, "AP": "picture"},
    {"Subtype": Name.Square, "F": 2},  # hidden
    {"Subtype": Name.Ink, "F": 32},  # not to be viewed
    {"Subtype": Name.Popup, "AP": "picture"},
    {"Subtype": Name.Link},  # a place to click, which paints nothing
    {"Subtype": Name.Link, "AP": "picture"},
]


def test_annotations_that_viewers_show_are_counted():
    pdf = make(b"0 0 1 1 re f")
    picture = pdf.make_stream(b"0 0 1 1 re f", Subtype=Name.Form)
    entries = [{k: Dictionary(N=picture) if v == "picture" else v for k, v in item.items()} for item in ANNOTATIONS]
    pdf.pages[0].Annots = Array([*(pdf.make_indirect(Dictionary(**entry)) for entry in entries), 7])
    (problem,) = read_pdf(saved(pdf)).problems
    assert (problem.code, problem.severity) == ("annotation-left-out", "warning")
    assert problem.message.startswith("3 annotations (first a Square)")


def test_art_in_tiles_is_told_and_shadings_are_no_tiles():
    document = pikepdf.new()
    page = document.add_blank_page(page_size=(100, 100))
    tile = document.make_stream(b"0 0 3 3 re f")
    tile.PatternType, tile.PaintType, tile.TilingType = 1, 1, 1
    tile.BBox, tile.XStep, tile.YStep = [0, 0, 5, 5], 5, 5
    shading = pikepdf.Dictionary(PatternType=2)
    page.Resources = pikepdf.Dictionary(Pattern=pikepdf.Dictionary(P0=tile, P1=shading))
    page.Contents = document.make_stream(
        b"/Pattern cs /P0 scn 10 10 20 20 re f 1 0 0 rg 0 0 5 5 re f /Pattern cs /P1 scn 40 10 9 9 re f"
        b" /Pattern CS /P0 SCN 50 50 9 9 re S"
    )
    data = io.BytesIO()
    document.save(data)
    drawing = read_pdf(data.getvalue())
    (told,) = [problem for problem in drawing.problems if problem.code == "pattern-left-out"]
    assert told.message.startswith("2 shapes")
    assert (told.x, told.y) == (10, 10)
    assert [path.fill or path.stroke for path in drawing.paths] == ["pattern", "#ff0000", "pattern", "pattern"]
