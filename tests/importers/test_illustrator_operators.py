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
