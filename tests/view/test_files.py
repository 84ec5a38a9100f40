import os
import stat
from pathlib import Path

import pytest

from wallkit.write_file import FileError, open_whole, write_whole


def test_text_is_written_as_utf8_with_its_line_ends(tmp_path):
    write_whole(tmp_path / "walls.json", "Wände\r\n")
    assert (tmp_path / "walls.json").read_bytes() == b"W\xc3\xa4nde\r\n"


def test_an_interrupt_leaves_the_old_file_and_no_temporary_one(tmp_path, monkeypatch):
    target = tmp_path / "run.csv"
    target.write_text("old")

    def interrupted(self, target):
        raise KeyboardInterrupt

    monkeypatch.setattr(Path, "replace", interrupted)
    with pytest.raises(KeyboardInterrupt):
        write_whole(target, "new")
    assert [path.name for path in tmp_path.iterdir()] == ["run.csv"]
    assert target.read_text() == "old"


def test_permissions_and_links_of_an_existing_file_are_kept(tmp_path):
    target = tmp_path / "run.csv"
    target.write_text("old")
    target.chmod(0o640)
    link = tmp_path / "latest.csv"
    link.symlink_to(target)
    write_whole(link, b"new")
    assert link.is_symlink()
    assert target.read_bytes() == b"new"
    assert stat.S_IMODE(target.stat().st_mode) == 0o640


def test_a_device_is_written_to_not_replaced():
    write_whole(os.devnull, "gone")
    assert stat.S_ISCHR(Path(os.devnull).stat().st_mode)


def test_a_missing_folder_is_named_with_what_to_do(tmp_path):
    with pytest.raises(FileError, match=r"make the folder .*nowhere first"):
        write_whole(tmp_path / "nowhere" / "run.csv", "x")


def test_a_folder_is_no_file(tmp_path):
    with pytest.raises(FileError, match="it is a folder"):
        write_whole(tmp_path, "x")


def _write_half(target):
    with open_whole(target) as stream:
        stream.write("half\n")
        raise KeyboardInterrupt


def test_a_file_that_is_not_written_to_its_end_does_not_appear(tmp_path, capfdbinary):
    for target in (tmp_path / "level.tmj", "-"):
        with pytest.raises(KeyboardInterrupt):
            _write_half(target)
    assert list(tmp_path.iterdir()) == []
    assert capfdbinary.readouterr().out == b""
    with open_whole(tmp_path / "level.tmj") as stream:
        stream.write("Wände\r\n")
    assert (tmp_path / "level.tmj").read_bytes() == b"W\xc3\xa4nde\r\n"
