import pytest

from wallkit.view.canvas import Canvas
from wallkit.view.write import PictureError, write_picture


def test_the_ending_says_how_a_picture_is_written(tmp_path):
    write_picture(tmp_path / "a.SVG", Canvas(10, 10))
    write_picture(tmp_path / "a.png", Canvas(10, 10))
    assert (tmp_path / "a.SVG").read_bytes().startswith(b"<svg")
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")


def test_another_ending_is_refused_and_nothing_written(tmp_path):
    with pytest.raises(PictureError, match=r"\.svg, \.png"):
        write_picture(tmp_path / "a.jpg", Canvas(10, 10))
    assert list(tmp_path.iterdir()) == []
