"""Illustrator's operators one by one: what each draws, paints, marks and leaves out."""

import pytest

from importers.illustrator import looks_like_illustrator, read_illustrator

ARROW = b"24 803 m\n69 828 l\n108 775 l\n31 757 l\n24 803 l\n"
ARROW_SEGMENTS = [("M", 24, 803), ("L", 69, 828), ("L", 108, 775), ("L", 31, 757), ("L", 24, 803)]


def read_one(text):
    drawing = read_illustrator(text)
    assert drawing.problems == []
    (path,) = drawing.paths
    return path


@pytest.mark.parametrize("line_end", [b"\n", b"\r", b"\r\n", b" "])
@pytest.mark.parametrize("layer", [b"", b"(Layer 1) Ln\n"])
def test_pasted_text_is_one_path_with_its_very_numbers(line_end, layer):
    text = (layer + ARROW).replace(b"\n", line_end)
    assert looks_like_illustrator(text)
    path = read_one(text)
    assert path.subpaths[0].segments == ARROW_SEGMENTS
    assert path.layer == ("Layer 1" if layer else "")
    assert path.groups == ()


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be"])
@pytest.mark.parametrize("text", ["24 803 m 69 828 l", "(Öffnung) Ln\r\n24 803 m\r\n69 828 l\r\n"])
def test_pasted_text_comes_as_editors_save_it(encoding, text):
    if encoding in ("utf-16-le", "utf-16-be"):
        text = "\ufeff" + text
    data = text.encode(encoding)
    assert looks_like_illustrator(data)
    path = read_one(data)
    assert path.subpaths[0].segments == [("M", 24, 803), ("L", 69, 828)]
    assert path.layer == ("Öffnung" if "Ö" in text else "")


def test_every_spelling_of_a_segment():
    path = read_one(
        b"0 0 m 1 0 l 2 0 L 3 1 4 2 5 3 c 6 1 7 2 8 3 C 9 9 10 10 v 11 11 12 12 V 13 13 14 14 y 15 15 16 16 Y S"
    )
    assert path.subpaths[0].segments == [
        ("M", 0, 0),
        ("L", 1, 0),
        ("L", 2, 0),
        ("C", 3, 1, 4, 2, 5, 3),
        ("C", 6, 1, 7, 2, 8, 3),
        ("C", 8, 3, 9, 9, 10, 10),  # v: the first control point is the current point
        ("C", 10, 10, 11, 11, 12, 12),
        ("C", 13, 13, 14, 14, 14, 14),  # y: the second control point is the end
        ("C", 15, 15, 16, 16, 16, 16),
    ]


@pytest.mark.parametrize(
    ("operator", "closed", "filled", "stroked"),
    [
        ("n", True, False, False),
        ("N", False, False, False),
        ("f", True, True, False),
        ("F", False, True, False),
        ("s", True, False, True),
        ("S", False, False, True),
        ("b", True, True, True),
        ("B", False, True, True),
    ],
)
def test_lower_case_paint_closes_and_upper_case_does_not(operator, closed, filled, stroked):
    # The ends coincide on purpose: whether that closes a wall is not for a reader to say.
    path = read_one(ARROW + operator.encode())
    assert path.subpaths[0].closed is closed
    assert (path.fill is not None, path.stroke is not None) == (filled, stroked)
    assert path.stroke_width == (1.0 if stroked else None)


def test_h_closes_and_drawing_goes_on_from_the_start():
    path = read_one(b"1 2 m 5 2 L 5 6 L h 9 9 L S")
    assert [subpath.closed for subpath in path.subpaths] == [True, False]
    assert path.subpaths[1].segments == [("M", 1, 2), ("L", 9, 9)]


def test_capital_h_does_nothing():
    assert read_one(b"1 2 m 5 2 L H 5 6 L S").subpaths[0].segments[-1] == ("L", 5, 6)


def test_a_single_point_is_a_path():
    path = read_one(b"202 482 m F")
    assert path.subpaths[0].segments == [("M", 202, 482)]


def test_a_compound_path_is_one_path_painted_by_its_last_operator():
    path = read_one(b"1 g 0 G *u 0 0 m 9 0 L 9 9 L f *u 2 2 m 3 2 L 3 3 L n *U 0.5 g 5 5 m 6 5 L 6 6 L b *U")
    assert [subpath.segments[0][1:] for subpath in path.subpaths] == [(0, 0), (2, 2), (5, 5)]
    assert (path.fill, path.stroke) == ("#808080", "#000000")


def test_hidden_members_of_a_compound_path_stay_apart():
    drawing = read_illustrator(b"*u 0 0 m 9 0 L 9 9 L f 1 Xw 2 2 m 3 2 L 3 3 L f 0 Xw 5 5 m 6 5 L 6 6 L f *U")
    assert [(path.visible, len(path.subpaths)) for path in drawing.paths] == [(False, 1), (True, 2)]


def test_clipping_paths_are_marked_and_paint_comes_back_after_them():
    drawing = read_illustrator(b"0.2 g q 0 0 m 9 0 L 9 9 L h W n 1 g 1 1 m 2 1 L 2 2 L f Q 3 3 m 4 3 L 4 4 L f")
    clip, inner, outer = drawing.paths
    assert (clip.clip, clip.fill, clip.subpaths[0].closed) == (True, None, True)
    assert (inner.clip, inner.groups, inner.fill) == (False, ("",), "#ffffff")
    assert (outer.clip, outer.groups, outer.fill) == (False, (), "#333333")


def test_a_painted_clipping_path_is_art_too():
    assert read_one(b"q 0 0 m 9 0 L 9 9 L h W f Q").clip is False


@pytest.mark.parametrize("guide", [b"(N) *", b"(S) *", b"N\n150 0 m 150 9 L (N) *"])
def test_guides_are_marked(guide):
    assert read_illustrator(b"150 -4014 m 150 4626 L " + guide).paths[-1].guide


@pytest.mark.parametrize(
    ("operators", "fill"),
    [
        (b"0 g", "#000000"),
        (b"0 0 0 0.2 k", "#cccccc"),
        (b"0 1 1 0 k", "#ff0000"),
        (b"0 0.5 1 Xa", "#0080ff"),
        (b"0.1 0.2 0.3 0.4 1 0.5 0 Xa", "#ff8000"),
        (b"0 1 1 0 (TCL RED) 0 x", "#ff0000"),
        (b"0 1 1 0 (TCL RED) 0.5 x", "#ff8080"),
        (b"0 1 1 0 (Tint) 0 0 Xx", "#ff0000"),
        (b"0 1 1 0 1 0.5 0 (Tint) 0 1 Xk", "#ff8000"),
        (b"(Bricks) 0 0 1 1 0 0 0 0 0 [1 0 0 1 0 0] p", "pattern"),
    ],
)
def test_colours(operators, fill):
    drawing = read_illustrator(operators + b" 0 0 m 1 0 L 1 1 L f")
    assert drawing.paths[0].fill == fill
    assert drawing.problems == []


def test_a_gradient_is_named_and_its_path_counted_once():
    drawing = read_illustrator(
        b"0 0 m 9 0 L 9 9 L\nBb\n0 0 0 0 Bh\n1 (Sunset) 0 5 0 9 1 0 0 1 0 0 Bg\n13 0 0 -13 50 547 Bm\nf\n0 BB\n"
        b"0 g 0 0 m 1 0 L 1 1 L f"
    )
    assert [path.fill for path in drawing.paths] == ["gradient", "#000000"]


def test_stroke_width_and_fill_rule():
    drawing = read_illustrator(b"2.5 w 1 XR 0 0 m 1 0 L 1 1 L b 0 XR 0 0 m 1 0 L 1 1 L f")
    assert [(path.stroke_width, path.fill_rule) for path in drawing.paths] == [(2.5, "evenodd"), (None, "nonzero")]


@pytest.mark.parametrize(
    ("arguments", "visible", "locked", "printing"),
    [
        (b"1 1 1 1 0 0 0 79 128 255", True, False, True),  # AI 3 to 7: ten arguments
        (b"0 1 0 0 0 0 1 0 79 128 255 0 50", False, True, False),  # AI 8: thirteen
        (b"1 1 0 1 0 0 1 0 79 128 255 0 50 0", True, True, True),  # AI 9 and later: fourteen
    ],
)
def test_layers_say_what_they_show(arguments, visible, locked, printing):
    drawing = read_illustrator(arguments + b" Lb (Walls) Ln 0 0 m 1 0 L 1 1 L f LB 0 0 m 1 0 L f")
    (layer,) = drawing.layers
    assert (layer.name, layer.visible, layer.locked, layer.printing) == ("Walls", visible, locked, printing)
    inside, outside = drawing.paths
    assert (inside.layer, inside.visible, inside.locked) == ("Walls", visible, locked)
    assert (outside.layer, outside.visible, outside.locked) == ("", True, False)


def test_layers_in_layers():
    drawing = read_illustrator(
        b"0 1 1 1 0 0 0 0 0 0 Lb (House) Ln 1 1 1 1 0 0 0 0 0 0 Lb (Room) Ln 0 0 m 1 0 L f LB 0 0 m 2 0 L f LB"
    )
    assert [layer.name for layer in drawing.layers] == ["House", "Room"]
    # The room is shown, but the house around it is not.
    assert [(path.layer, path.visible) for path in drawing.paths] == [("Room", False), ("House", False)]


def test_a_layers_own_lock_and_hiding_end_before_its_first_object():
    text = b"0 1 0 1 0 0 0 0 0 0 Lb (Old) Ln 1 A 1 Xw 0 A 0 Xw 0 0 m 1 0 L f LB"
    (path,) = read_illustrator(text).paths
    assert (path.visible, path.locked) == (False, True)


def test_hidden_and_locked_objects_and_groups():
    drawing = read_illustrator(
        b"1 Xw 0 0 m 1 0 L f 0 Xw 1 A 0 0 m 2 0 L f 0 A 1 Xw u 0 Xw 0 0 m 3 0 L f u 0 0 m 4 0 L f U U 0 0 m 5 0 L f"
    )
    marks = {path.subpaths[0].segments[1][1]: (path.visible, path.locked) for path in drawing.paths}
    assert marks == {1: (False, False), 2: (True, True), 3: (False, False), 4: (False, False), 5: (True, False)}


def test_names_follow_their_objects():
    drawing = read_illustrator(
        b"u\n0 0 m\n1 0 L\nf\n%_/ArtDictionary :\n%_/XMLUID : (Left_x5F_hole_2_) ; (AI10_ArtUID) ,\n%_;\n%_\n"
        b"*u\n0 0 m\n1 0 L\nf\n*U\n%_/ArtDictionary :\n%_(Ring \\(inner\\)) /UnicodeString (AIArtName) ,\n%_;\n%_\n"
        b"U\n%_/ArtDictionary :\n%_/XMLUID : (Both_parts) ; (AI10_ArtUID) ,\n%_;\n%_\n0 0 m\n3 0 L\nf\n"
    )
    assert [path.name for path in drawing.paths] == ["Left_hole", "Ring (inner)", ""]
    assert [path.groups for path in drawing.paths] == [("Both parts",), ("Both parts",), ()]


def test_a_name_of_hidden_art_is_not_the_name_of_the_path_before():
    drawing = read_illustrator(
        b"0 0 m\n1 0 L\nf\n%_0 0 m\n%_9 9 L\n%_f\n%_/ArtDictionary :\n%_/XMLUID : (Original) ; (AI10_ArtUID) ,\n%_;\n"
    )
    assert [path.name for path in drawing.paths] == [""]


def test_slices_are_no_art():
    text = b"0 0 m 1 0 L 1 1 L n\n%_/XMLUID : (_x3C_Slice_x3E__1_) ; (AI10_ArtUID) ,\n"
    assert read_one(text).guide


def test_notes_are_tags_until_the_next_note():
    drawing = read_illustrator(b"%AI3_Note: material=rubber\n0 0 m 1 0 L f\n0 0 m 2 0 L f\n%AI3_Note:\n0 0 m 3 0 L f")
    assert [path.tags for path in drawing.paths] == [{"note": "material=rubber"}] * 2 + [{}]


def test_what_is_left_out_is_said_once_a_kind_with_its_first_place():
    drawing = read_illustrator(
        b"0 0 m 1 0 L f\n"
        b"0 To\n1 0 0 1 10 10 0 Tp\n0 0 m 100 0 L N\nTP\n(Hello) Tx\nTO\n"
        b"0 To\n1 0 0 1 10 30 0 Tp\nTP\nTO\n"
        b"/SymbolInstance :\n(Lamp) /SymbolRef ,\n1 0 0 -1 5 5 /RTransformMatrix ,\n;\n"
        b"/AI11Text :\n0 /FrameIndex ,\n/Art :\nX=\n1 1 m\n5 1 L\n5 5 L\nn\nX+\n; /ConfiningPath ,\n;\n"
        b"/Mesh X!\n2 /Version X#\n/End X!\n"
        b"1 2 3 glorp\n0 0 m 2 0 L f\n"
    )
    found = {problem.code: problem for problem in drawing.problems if problem.code != "object-left-out"}
    assert found["text-left-out"].message == "3 text objects are left out"
    assert (found["text-left-out"].line, found["text-left-out"].column) == (2, 3)
    assert (found["unknown-operator"].line, found["unknown-operator"].column) == (30, 7)
    assert found["unknown-operator"].excerpt == "1 2 3 glorp"
    objects = [problem.message for problem in drawing.problems if problem.code == "object-left-out"]
    assert objects == ["an object of the kind SymbolInstance is left out", "an object of the kind Mesh is left out"]
    # Frames of texts are listed, but are nothing that anybody sees.
    assert [path.visible for path in drawing.paths] == [True, False, False, True]


def test_texts_of_version_1():
    drawing = read_illustrator(b"0 0 m 1 0 L f\n/_Times-Roman 14 0 0 2 z\n[ 1 0 0 1 46 23] e\n(-1) t\nT\n")
    assert [problem.code for problem in drawing.problems] == ["text-left-out"]


def test_before_a_broken_operator_all_is_used():
    drawing = read_illustrator(b"0 0 m\n10 0 L\n10 10 20 20 c\n0 10 L\nf\n5 5 m\n6 5 L\n6 6 L\nf\n")
    cut, whole = drawing.paths
    assert (cut.subpaths[0].segments, cut.subpaths[0].closed) == ([("M", 0, 0), ("L", 10, 0)], False)
    assert len(whole.subpaths[0].segments) == 3
    (problem,) = drawing.problems
    assert (problem.code, problem.line, problem.column, problem.x, problem.y) == ("bad-operands", 3, 13, 10, 0)
    assert problem.excerpt == "10 10 20 20 c"


def test_a_path_without_a_first_point_begins_at_its_first_end():
    drawing = read_illustrator(b"u 69 828 l 108 775 l 31 757 l U")
    assert drawing.paths[0].subpaths[0].segments == [("M", 69, 828), ("L", 108, 775), ("L", 31, 757)]
    assert [problem.code for problem in drawing.problems] == ["no-current-point"]


@pytest.mark.parametrize("number", [b"1e999", b"-2000000000", b"1" + b"0" * 30])
def test_a_path_with_an_absurd_coordinate_is_left_out(number):
    drawing = read_illustrator(b"0 0 m\n" + number + b" 5 L\nf\n1 1 m 2 2 L f")
    assert [path.subpaths[0].segments[0] for path in drawing.paths] == [("M", 1, 1)]
    assert [(problem.code, problem.line) for problem in drawing.problems] == [("bad-coordinate", 1)]


@pytest.mark.parametrize("path", [b"%s 5 L", b"5 %s L", b"1 1 %s 5 v", b"1 1 5 %s v", b"1 1 5 %s y", b"1 1 2 2 %s 5 c"])
def test_a_path_that_begins_at_an_absurd_end_is_left_out(path):
    drawing = read_illustrator(path % b"1e999" + b" 9 9 L f\n1 1 m 2 2 L f")
    assert [path.subpaths[0].segments[0] for path in drawing.paths] == [("M", 1, 1)]
    assert [problem.code for problem in drawing.problems] == ["no-current-point", "bad-coordinate"]


@pytest.mark.parametrize("number", [b"nan", b"inf", b"1_0", b"0x10", b"24,5"])
def test_what_python_takes_for_a_number_is_none(number):
    drawing = read_illustrator(b"0 0 m 1 0 L f\n0 0 m " + number + b" 5 L f")
    assert {"unknown-operator", "bad-operands"} <= {problem.code for problem in drawing.problems}


@pytest.mark.parametrize("text", [b"U", b"Q", b"LB", b"*U"])
def test_what_closes_nothing_is_said(text):
    drawing = read_illustrator(b"0 0 m 1 0 L f " + text + b" 0 0 m 2 0 L f")
    assert len(drawing.paths) == 2
    assert [problem.code for problem in drawing.problems] == ["unbalanced"]


def test_numbers_left_over_do_not_matter():
    assert read_one(b"7 0 0 m 8 9 1 0 L f").subpaths[0].segments == [("M", 0, 0), ("L", 1, 0)]


@pytest.mark.parametrize(
    ("text", "what"),
    [
        (b"%!PS\n/box { 0 0 moveto 9 0 lineto closepath stroke } def\nbox showpage\n", False),
        (b"%!PS-Adobe-3.0\n%AI5_FileFormat 3\n%%EndSetup\n", True),
        (b"Dear Sir, 24 points were given.\n", False),
        (b"", False),
        (b"\x89PNG\r\n\x1a\n", False),
        (b"<svg xmlns='http://www.w3.org/2000/svg'><text>1 2 m</text></svg>", False),
        (b"24 803 m", True),
        (b"(Layer 1) Ln\r", True),
    ],
)
def test_what_it_is_is_told_by_the_content(text, what):
    assert looks_like_illustrator(text) is what
