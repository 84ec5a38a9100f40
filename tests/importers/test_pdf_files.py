"""PDF drawings and newer Illustrator files, made here: pages, forms, layers, Illustrator's own data."""

import io
import zlib

import pikepdf
import pytest
import zstandard
from pikepdf import Array, Dictionary, Name

from importers.errors import DrawingError
from importers.pdf import looks_like_pdf, read_pdf

OWN_DATA = (
    b"%!PS-Adobe-3.0 \r%%Creator: Adobe Illustrator(R) 24.0\r%%AI8_CreatorVersion: 28.7.3\r%%EndComments\r%%EndSetup\r"
    b"%AI5_BeginLayer\r1 1 1 1 0 0 1 0 79 128 255 0 50 0 Lb\r(Shown) Ln\r0 0 m\r9 0 L\r9 9 L\rf\r"
    b"1 Xw\r1 1 m\r2 1 L\r2 2 L\rf\r0 Xw\rLB\r%AI5_EndLayer--\r"
    b"%AI5_BeginLayer\r0 1 0 1 0 0 1 0 79 128 255 0 50 0 Lb\r(Hidden) Ln\r3 3 m\r4 3 L\r4 4 L\rs\rLB\r%AI5_EndLayer--\r"
    b"%%PageTrailer\r%%Trailer\r%%EOF\r"
)
HEADER = b"%%BoundingBox: 0 0 9 9\r%AI7_Thumbnail: 8 8 8\r"


def make(content=b"", resources=None, **page):
    pdf = pikepdf.new()
    pdf.add_blank_page(page_size=(200, 100))
    pdf.pages[0].Contents = pdf.make_stream(content)
    if resources is not None:
        pdf.pages[0].Resources = resources(pdf)
    for key, value in page.items():
        pdf.pages[0][f"/{key}"] = value
    return pdf


def saved(pdf, **options):
    out = io.BytesIO()
    pdf.save(out, **options)
    return out.getvalue()


def read(content, resources=None, **page):
    return read_pdf(saved(make(content, resources, **page)))


def segments(path):
    return [subpath.segments for subpath in path.subpaths]


def with_own_data(data, size=65_536, content=b"0 0 50 50 re f", key="/AIPrivateData"):
    pdf = make(content)
    blocks = [data[start : start + size] for start in range(0, len(data), size)]
    private = Dictionary({f"{key}{i}": pdf.make_stream(block) for i, block in enumerate(blocks, 1)})
    pdf.pages[0].PieceInfo = Dictionary(Illustrator=Dictionary(Private=private, LastModified="D:20260101"))
    return saved(pdf)


@pytest.mark.parametrize(
    "data",
    [
        OWN_DATA,
        HEADER + b"%AI12_CompressedData" + zlib.compress(OWN_DATA),
        b"%AI24_ZStandard_Data" + zstandard.ZstdCompressor().compress(OWN_DATA) + bytes(100),
    ],
    ids=["plain", "zlib", "zstd"],
)
@pytest.mark.parametrize("size", [50, 65_536])
def test_illustrators_own_data_come_first(data, size):
    drawing = read_pdf(with_own_data(data, size))
    assert drawing.kind == "Illustrator 28 (PDF with Illustrator's own data)"
    assert [(path.layer, path.visible, path.locked) for path in drawing.paths] == [
        ("Shown", True, False),
        ("Shown", False, False),
        ("Hidden", False, True),
    ]
    assert [layer.visible for layer in drawing.layers] == [True, False]
    assert [path.line for path in drawing.paths] == [None] * 3
    assert drawing.problems == []


def test_without_anything_in_its_own_data_the_page_is_read_and_that_is_said():
    drawing = read_pdf(with_own_data(b"%AI12_CompressedData" + b"broken"))
    assert [path.subpaths[0].segments[0] for path in drawing.paths] == [("M", 0, 0)]
    assert [(problem.code, problem.severity) for problem in drawing.problems] == [("page-content", "info")]
    assert "page content" in drawing.kind


def test_damaged_own_data_give_what_stands_before_the_damage():
    many = OWN_DATA.replace(b"0 0 m\r", b"".join(b"%d 7 m\r%d 9 L\rS\r" % (i * i, i) for i in range(3000)) + b"0 0 m\r")
    packed = zlib.compress(many)
    drawing = read_pdf(with_own_data(b"%AI12_CompressedData" + packed[: len(packed) // 2]))
    assert 0 < len(drawing.paths) < 3000
    assert [(problem.code, problem.severity) for problem in drawing.problems] == [("damaged-stream", "error")]


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


@pytest.mark.parametrize("packing", ["/FlateDecode", "/ASCIIHexDecode", "/ASCII85Decode", "/RunLengthDecode"])
def test_contents_in_pieces_and_packed(packing):
    import base64

    pack = {
        "/FlateDecode": zlib.compress,
        "/ASCIIHexDecode": lambda raw: raw.hex().encode() + b">",
        "/ASCII85Decode": lambda raw: base64.a85encode(raw) + b"~>",
        "/RunLengthDecode": lambda raw: bytes([len(raw) - 1]) + raw + b"\x80",
    }[packing]
    pdf = make()
    pieces = [pikepdf.Stream(pdf, pack(piece), Filter=Name(packing)) for piece in (b"0 0 m 5 0", b"l 5 5 l f")]
    pdf.pages[0].Contents = Array([pdf.make_indirect(piece) for piece in pieces])
    drawing = read_pdf(saved(pdf, compress_streams=False))
    assert segments(drawing.paths[0]) == [[("M", 0, 0), ("L", 5, 0), ("L", 5, 5)]]
    assert drawing.problems == []


def test_a_stream_that_nobody_can_read_is_said():
    pdf = make()
    pdf.pages[0].Contents = pikepdf.Stream(pdf, b"\xff\xd8", Filter=Name.DCTDecode)
    drawing = read_pdf(saved(pdf))
    assert [problem.code for problem in drawing.problems] == ["damaged-stream"]


def test_resources_are_inherited():
    pdf = make(b"/X Do")
    pdf.Root.Pages.Resources = Dictionary(XObject=Dictionary(X=pdf.make_stream(b"0 0 1 1 re f", Subtype=Name.Form)))
    del pdf.pages[0].Resources
    assert len(read_pdf(saved(pdf)).paths) == 1


def test_what_the_page_does_to_its_units_is_said():
    drawing = read(b"0 0 1 1 re f", UserUnit=10, Rotate=90)
    assert [problem.code for problem in drawing.problems] == ["user-unit", "rotated-page"]
    assert segments(drawing.paths[0])[0][2] == ("L", 1, 1)


def test_further_pages_are_said():
    pdf = make(b"0 0 1 1 re f")
    pdf.add_blank_page()
    pdf.add_blank_page()
    drawing = read_pdf(saved(pdf))
    assert [problem.message for problem in drawing.problems] == ["the file has 2 more pages; only the first is read"]


def test_a_file_with_an_empty_password_opens_and_another_does_not():
    pdf = make(b"0 0 1 1 re f")
    assert len(read_pdf(saved(pdf, encryption=pikepdf.Encryption(owner="o", user=""))).paths) == 1
    with pytest.raises(DrawingError, match="encrypted"):
        read_pdf(saved(pdf, encryption=pikepdf.Encryption(owner="o", user="u")))


def test_object_streams_are_read():
    data = saved(make(b"0 0 1 1 re f"), object_stream_mode=pikepdf.ObjectStreamMode.generate)
    assert b"/ObjStm" in data
    assert len(read_pdf(data).paths) == 1


def test_a_broken_table_of_objects_is_mended():
    data = saved(make(b"0 0 1 1 re f"))
    assert len(read_pdf(data[: data.rindex(b"xref")]).paths) == 1
    assert len(read_pdf(data.replace(b"startxref", b"startxxxx")).paths) == 1


@pytest.mark.parametrize(
    ("data", "code"),
    [
        (b"%PDF-1.4\n", "broken-pdf"),
        (b"%PDF-1.4\n1 0 obj\n" + b"[" * 100_000, "broken-pdf"),
        (b"%PDF-1.4\n1 0 obj<</Type/Catalog>>endobj\ntrailer<</Root 1 0 R>>", "broken-pdf"),
        (saved(pikepdf.new()), "no-pages"),
    ],
)  # fmt: skip
def test_what_cannot_be_opened_is_refused_with_advice(data, code):
    with pytest.raises(DrawingError) as caught:
        read_pdf(data, "plan.ai")
    assert (caught.value.code, caught.value.file) == (code, "plan.ai")
    assert caught.value.fix


def test_what_it_is_is_told_by_the_content():
    assert looks_like_pdf(b"%PDF-1.7\n")
    assert looks_like_pdf(b"\n\n junk before %PDF-1.4\n")
    assert not looks_like_pdf(b"%!PS-Adobe-3.0\n")
    assert not looks_like_pdf(b"")


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


@pytest.mark.parametrize(
    ("data", "key"),
    [(OWN_DATA, "/AIPDFPrivateData"), (b"%AI24_ZStandard_Data" + zstandard.compress(OWN_DATA), "/AIPDFPrivateData")],
    ids=["plain", "zstd"],
)
@pytest.mark.parametrize("size", [50, 65_536])
def test_own_data_of_a_pdf_saved_with_editing_capabilities_are_read(data, key, size):
    as_ai, as_pdf = read_pdf(with_own_data(data, size)), read_pdf(with_own_data(data, size, key=key))
    assert as_pdf.to_json() == as_ai.to_json()
    assert [layer.name for layer in as_pdf.layers] == ["Shown", "Hidden"]


def test_own_data_in_one_stream_are_read():
    pdf = make(b"0 0 50 50 re f")
    private = pdf.make_stream(b"%AI24_ZStandard_Data" + zstandard.compress(OWN_DATA))
    pdf.pages[0].PieceInfo = Dictionary(Illustrator=Dictionary(Private=private))
    assert [layer.name for layer in read_pdf(saved(pdf)).layers] == ["Shown", "Hidden"]


def test_own_data_under_an_unknown_name_are_missed_aloud():
    drawing = read_pdf(with_own_data(OWN_DATA, key="/AIFutureData"))
    assert [(problem.code, problem.severity) for problem in drawing.problems] == [("page-content", "info")]
    assert segments(drawing.paths[0])[0][0] == ("M", 0, 0)


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


def three_pages():
    pdf = pikepdf.new()
    for index in range(3):
        pdf.add_blank_page(page_size=(200, 100))
        pdf.pages[index].Contents = pdf.make_stream(b"%d 0 9 9 re f" % index)
    pdf.pages[1].MediaBox = Array([-50, 0, 30, 70])
    return saved(pdf)


def test_a_page_is_chosen_by_its_number():
    first = read_pdf(three_pages())
    assert [problem.code for problem in first.problems] == ["several-pages"]
    for page in (1, 2, 3):
        drawing = read_pdf(three_pages(), page=page)
        assert segments(drawing.paths[0])[0][0] == ("M", page - 1, 0)
        assert (len(drawing.paths), drawing.problems, drawing.artboards) == (1, [], [])


def test_all_pages_stand_side_by_side():
    drawing = read_pdf(three_pages(), page="all")
    assert [segments(path)[0][0] for path in drawing.paths] == [("M", 0, 0), ("M", 251, 0), ("M", 282, 0)]
    assert [(board.x_min, board.x_max, board.y_max) for board in drawing.artboards] == [
        (0, 200, 100),
        (200, 280, 70),
        (280, 480, 100),
    ]
    assert drawing.problems == []


@pytest.mark.parametrize("page", [0, -1, 4, "two", 1.5, True])
def test_a_page_that_there_is_not_is_an_error(page):
    with pytest.raises(DrawingError) as caught:
        read_pdf(three_pages(), page=page)
    assert caught.value.code == "no-such-page"


ARTBOARDS = (
    b"%!PS-Adobe-3.0 \r%%Creator: Adobe Illustrator(R) 24.0\r%%AI8_CreatorVersion: 28.7.3\r%%EndComments\r"
    b"%_/Array :\r%_/Dictionary :\r%_0 0 /RealPointRelToROrigin\r%_ (PositionPoint1) ,\r"
    b"%_200 -150 /RealPointRelToROrigin\r%_ (PositionPoint2) ,\r%_(left) /UnicodeString (Name) ,\r%_;\r"
    b"%_/Dictionary :\r%_250 0 /RealPointRelToROrigin\r%_ (PositionPoint1) ,\r"
    b"%_450 -150 /RealPointRelToROrigin\r%_ (PositionPoint2) ,\r%_(right) /UnicodeString (Name) ,\r%_;\r"
    b"%_; (ArtboardArray) ,\r%%EndSetup\r"
    b"20 -20 m\r90 -20 L\r90 -90 L\rf\r270 -20 m\r340 -20 L\r340 -90 L\rf\r190 -9 m\r260 -9 L\rS\r%%PageTrailer\r"
)


def with_artboards():
    pdf = pikepdf.open(io.BytesIO(with_own_data(ARTBOARDS)))
    pdf.add_blank_page(page_size=(200, 150))
    return saved(pdf)


def test_the_art_of_all_artboards_is_read_and_no_page_is_missed():
    drawing = read_pdf(with_artboards())
    assert (len(drawing.paths), drawing.problems) == (3, [])
    assert [board.name for board in drawing.artboards] == ["left", "right"]
    assert len(read_pdf(with_artboards(), page="all").paths) == 3


@pytest.mark.parametrize(("page", "starts"), [(1, [20, 190]), (2, [270, 190])])
def test_an_artboard_is_chosen_by_its_number(page, starts):
    drawing = read_pdf(with_artboards(), page=page)
    assert [segments(path)[0][0][1] for path in drawing.paths] == starts
    (problem,) = drawing.problems
    assert (problem.code, problem.severity) == ("other-artboards", "info")
    assert problem.message.startswith("1 path is outside artboard")


def test_an_artboard_that_there_is_not_is_an_error():
    with pytest.raises(DrawingError, match="there is no page 3: the drawing has 2"):
        read_pdf(with_artboards(), page=3)


def moved_table(data, number):
    """Write an object's place in the table of objects ten bytes too far."""
    place = data.index(b"\n%d 0 obj" % number) + 1
    return data.replace(b"%010d 00000 n" % place, b"%010d 00000 n" % (place + 10))


@pytest.mark.parametrize("number", [1, 2, 3], ids=["catalogue", "pages", "page"])
def test_a_table_that_tells_a_wrong_place_is_mended(number):
    data = saved(make(b"0 0 1 1 re f"), object_stream_mode=pikepdf.ObjectStreamMode.disable)
    assert moved_table(data, number) != data
    assert len(read_pdf(moved_table(data, number)).paths) == 1


@pytest.mark.parametrize("root", [b"/Root 99 0 R", b"/Root null", b"/Root 4 0 R", b"/Rot 1 0 R"])
def test_a_file_without_a_catalogue_is_broken_in_words(root):
    data = saved(make(b"0 0 1 1 re f"), object_stream_mode=pikepdf.ObjectStreamMode.disable)
    data = data.replace(b"/Root 1 0 R", root).replace(b"/Type /Catalog", b"/Typo /Catalog")
    with pytest.raises(DrawingError) as caught:
        read_pdf(data)
    assert caught.value.code in ("broken-pdf", "no-pages")


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
