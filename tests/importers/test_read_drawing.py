import gc
import gzip
import io
import sys

import pytest

import wallkit
from importers.errors import LimitError
from importers.read import read_drawing, read_drawing_text

ROOM = '<svg xmlns="http://www.w3.org/2000/svg"><rect id="room" width="30" height="20"/></svg>'
PASTED = "24 803 m\n69 828 l\n108 775 l\n31 757 l\n24 803 l\n"


def names(drawing):
    return [path.name for path in drawing.paths]


def test_what_a_file_is_is_told_by_its_content_not_its_ending(tmp_path):
    (tmp_path / "room.ai").write_text(ROOM)
    (tmp_path / "pasted.svg").write_text(PASTED)
    assert read_drawing(tmp_path / "room.ai").units == "px"
    assert read_drawing(str(tmp_path / "pasted.svg")).units == "pt"


def test_gzip_and_utf16_and_a_byte_order_mark_are_read():
    for data in (
        gzip.compress(ROOM.encode()),
        ROOM.encode("utf-16"),
        ROOM.encode("utf-16-le"),
        ROOM.encode("utf-16-be"),
        b"\xef\xbb\xbf" + ROOM.encode(),
        b'<?xml version="1.0" encoding="UTF-16"?>' + ROOM.encode(),
        b'<?xml version="1.0" encoding="latin-1"?>' + ROOM.replace("room", "\xfcber").encode("latin-1"),
    ):
        assert len(read_drawing_text(data).paths) == 1


def test_the_pasted_text_keeps_its_numbers_from_text_bytes_file_objects_and_standard_input(monkeypatch):
    first = ("M", 24.0, 803.0)
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(PASTED.encode())))
    for drawing in (
        read_drawing_text(PASTED),
        read_drawing_text(PASTED.encode()),
        read_drawing(io.StringIO(PASTED)),
        read_drawing(io.BytesIO(PASTED.encode())),
        read_drawing("-"),
    ):
        assert drawing.paths[0].subpaths[0].segments[0] == first
        assert len(drawing.sha256) == 64


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"\x89PNG\r\n\x1a\n" + bytes(50), "PNG"),
        (b"\xff\xd8\xff\xe0" + bytes(50), "JPEG"),
        (b"  0\nSECTION\n  2\nHEADER\n", "DXF"),
        (b"PK\x03\x04" + bytes(50), "ZIP"),
        (b"<!DOCTYPE html><html><body>hello</body></html>", "web page"),
        (b"<gpx><trk/></gpx>", "without an svg element"),
        (b'{"a": 1}', "JSON"),
        (b"\x00\x01\x02\x03 rubbish", "binary"),
        (b"Dear Sir or Madam,\n", "text without any path"),
    ],
)
def test_what_is_not_a_drawing_is_named_with_what_to_do(data, words):
    with pytest.raises(wallkit.DrawingError) as caught:
        read_drawing_text(data, "it")
    assert caught.value.code == "not-a-drawing"
    assert words in caught.value.message
    assert caught.value.fix
    assert caught.value.exit_code == 2


@pytest.mark.parametrize("data", [b"", b"  \r\n\t", b"\x00\x00", gzip.compress(b"", mtime=0)])
def test_an_empty_file_is_called_empty(data):
    with pytest.raises(wallkit.DrawingError) as caught:
        read_drawing_text(data)
    assert caught.value.code == "empty-file"


def test_a_missing_file_proposes_the_one_that_was_meant_and_a_folder_is_called_one(tmp_path):
    (tmp_path / "room.svg").write_text(ROOM)
    with pytest.raises(wallkit.DrawingError) as caught:
        read_drawing(tmp_path / "rom.svg")
    assert "room.svg" in caught.value.fix
    with pytest.raises(wallkit.DrawingError, match="folder"):
        read_drawing(tmp_path)
    with pytest.raises(wallkit.DrawingError):
        read_drawing("a\x00b")


def test_a_damaged_gzip_says_so():
    with pytest.raises(wallkit.DrawingError) as caught:
        read_drawing_text(gzip.compress(ROOM.encode() * 50)[:-20])
    assert caught.value.code == "bad-gzip"


def test_reading_leaves_the_cycle_collector_as_it_was():
    text = '<svg xmlns="http://www.w3.org/2000/svg"><path d="M0,0H9V9Z"/></svg>'
    gc.freeze()
    try:
        aside = gc.get_freeze_count()
        wallkit.read_drawing_text(text)
        assert gc.isenabled()
        assert gc.get_freeze_count() <= aside  # what is freed is no longer there
        assert gc.get_freeze_count() > aside / 2
    finally:
        gc.unfreeze()
    gc.disable()
    try:
        wallkit.read_drawing_text(text)
        assert not gc.isenabled()
    finally:
        gc.enable()
    wallkit.read_drawing_text(text)
    assert gc.isenabled()
    assert gc.get_freeze_count() == 0


def test_names_are_counted_for_each_path_that_bears_them(monkeypatch):
    monkeypatch.setattr("importers.read.MAX_NAME_LETTERS", 10_000)
    group = f'<svg xmlns="http://www.w3.org/2000/svg"><g id="{"a" * 100}">%s</g></svg>'
    rectangle = '<rect width="1" height="1"/>'
    assert len(read_drawing_text(group % (rectangle * 40)).paths) == 40
    with pytest.raises(LimitError, match="letters of names"):
        read_drawing_text(group % (rectangle * 100))
    layer = f"1 1 1 1 0 0 79 128 255 Lb\n({'a' * 100}) Ln\n" + "0 0 m 1 0 l 1 1 l s\n" * 101 + "LB\n"
    with pytest.raises(LimitError, match="letters of names"):
        read_drawing_text(layer)
