"""Path data that are read in whole arrays: the same segments as letter by letter, and nothing that is not plain."""

import random

import pytest

from importers.drawing import Subpath
from importers.read import read_drawing_text
from importers.svg import plain_paths
from importers.svg.matrix import transform, transformed
from importers.svg.path_data import parse_path_data
from importers.svg.plain_paths import PlainPaths

ODD_NUMBERS = (".5", "-.5", "5.", "-", "--1", "1e3", "0", "-0", "00012", "+3", "1.2.3", "1_0", "..", "")
LONG_NUMBERS = ("123456789012345", "1234567890123456", "0.123456789012345", "0.1234567890123456", ".000000000000001")
ODD_ENDS = (" Z ", "z", "Z Z", "Z1", "Z,", "é", "\0", " 1 2", "M1 2", "h3", " L")


@pytest.fixture
def all_sizes(monkeypatch):
    monkeypatch.setattr(plain_paths, "LEAST", 1)


def number(rng, odd):
    if rng.random() < odd:
        return rng.choice(ODD_NUMBERS + LONG_NUMBERS)
    return f"{rng.uniform(-1000, 1000):.{rng.randint(0, 11)}f}"


def between(rng, odd):
    return rng.choice((", ", " ,", ",,", "", " , ", "\n", ",  ")) if rng.random() < odd else rng.choice(", ")


def path_data(rng, odd):
    """Some M, L, C and Z, or small ones; ``odd`` of it is what only a careful reader can tell right from wrong."""
    small = rng.random() < 0.4
    text = rng.choice("Mm") + number(rng, odd) + between(rng, odd) + number(rng, odd)
    for _ in range(rng.randint(0, 5)):
        letter = rng.choice("cClLSZQHVMAmst") if rng.random() < odd else rng.choice("cl" if small else "CL")
        count = {"C": 6, "L": 2}.get(letter.upper(), rng.randint(0, 7)) * rng.choice((1, 1, 2)) + (rng.random() < odd)
        gaps = [between(rng, odd) for _ in range(count - 1)] + [rng.choice(("", " "))]
        text += letter + "".join(number(rng, odd) + gap for gap in gaps[:count])
    return text + (rng.choice(ODD_ENDS) if rng.random() < 3 * odd else rng.choice(("", "Z")))


@pytest.mark.parametrize(("odd", "least"), [(0.0, 900), (0.02, 300), (0.3, 1)])
def test_what_is_read_at_once_is_what_is_read_letter_by_letter(all_sizes, odd, least):
    rng = random.Random(1)
    read = 0
    for _ in range(20):
        texts = [path_data(rng, odd) for _ in range(60)]
        plain = PlainPaths(texts)
        for text in texts:
            found = plain.get(text)
            if found is not None:
                assert ([repr(found)], None) == (list(map(repr, parse_path_data(text)[0])), parse_path_data(text)[1])
                read += 1
    assert read >= least


def test_texts_do_not_lean_on_their_neighbours(all_sizes):
    whole = "M1 2L3 4 5 6Z"
    texts = ["5 6", whole, " ", ",", whole + " ", "-", "L7 8", "M1 2L3 4,", "M1 2", "Z", ""]
    plain = PlainPaths(texts)
    assert [plain.get(text) is not None for text in texts] == [text.startswith(whole) for text in texts]


def test_a_fault_in_a_long_path_keeps_its_place():
    good = "M0,0" + "C1,2 3,4 5,6" * 40
    for wrong in ("C1,2 3,4 5,", "L1,,2", "C1e999,0 0,0 0,0", "?"):
        text = f'<svg xmlns="http://www.w3.org/2000/svg"><path d="{good}Z"/>\n<path d="{good}{wrong}"/></svg>'
        drawing = read_drawing_text(text)
        (problem,) = [one for one in drawing.problems if one.code == "bad-path-data"]
        fault = parse_path_data(good + wrong)[1]
        assert (problem.line, problem.column) == (2, fault.offset + len('<path d="') + 1)
        assert problem.message == fault.message
        assert [len(path.subpaths[0]) for path in drawing.paths] == [41, 41]


@pytest.mark.parametrize("matrix", [(1, 0, 0, 1, 0, 0), (1, 0, 0, 1, 0.5, -0.25), (0.7, 0.1, -0.3, 1.3, 5.0, 1e-3)])
def test_columns_are_moved_as_segments_are(all_sizes, matrix):
    text = path_data(random.Random(3), 0.0)
    (subpath,), _ = parse_path_data(text)
    moved = transformed(PlainPaths([text]).get(text), tuple(map(float, matrix)))
    assert moved.columns is not None
    assert len(moved) == len(subpath)
    assert moved.start == transform(subpath.segments, matrix)[0][1:]
    assert moved == Subpath(transform(subpath.segments, matrix), subpath.closed)
    assert moved.columns is None  # its list may be changed now


def test_no_more_is_read_ahead_than_may_be_drawn(all_sizes, monkeypatch):
    monkeypatch.setattr(plain_paths, "MAX_ELEMENTS", 100)
    monkeypatch.setattr(plain_paths, "_AT_ONCE", 1)
    texts = [f"M0 {number}" + "L1 2" * 29 for number in range(9)]
    plain = PlainPaths(texts)
    assert [plain.get(text) is not None for text in texts] == [True] * 4 + [False] * 5


def test_what_a_transform_throws_out_of_all_bounds_is_told_without_a_warning():
    data = "M0,0" + "L100,200 300,400" * 20
    text = f'<svg xmlns="http://www.w3.org/2000/svg"><path transform="scale(1e307)" d="{data}"/></svg>'
    drawing = read_drawing_text(text)
    assert [one.code for one in drawing.problems if one.severity == "error"] == ["bad-coordinate"]
