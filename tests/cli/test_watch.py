"""`--watch`: a saved file is told once, when it is whole and at rest. No test waits: looks and waits are ours."""

from __future__ import annotations

import json
import os
import sys

import pytest

import wallkit
from wallkit.cli import main
from wallkit.cli.watching import repeat
from wallkit.watch_file import Watch, watched_paths

ROOM = '<svg xmlns="http://www.w3.org/2000/svg"><rect width="{}" height="30" fill="none" stroke="#000"/></svg>'


class Disk:
    """Files with stamps and contents as a test says; a file that is not there has neither."""

    def __init__(self, **files):
        self.files = files

    def look(self, path):
        found = self.files.get(path.stem)
        return None if found is None else (len(found[0]), found[1], 1)

    def digest(self, path):
        found = self.files.get(path.stem)
        return None if found is None else found[0].encode()


def watch_on(disk):
    return Watch("a.svg", disk.look, disk.digest)


def looks(watch, disk, *states):
    """What the watch tells at each state of the file a: (content, time), or None where there is none."""
    told = []
    for state in states:
        disk.files["a"] = state
        told.append(watch.changed())
    return told


def test_a_change_is_told_once_when_two_looks_see_the_same():
    disk = Disk(a=("old", 1))
    assert looks(watch_on(disk), disk, ("old", 1), ("new", 2), ("new", 2), ("new", 2)) == [False, False, True, False]


def test_a_file_that_is_still_being_written_is_waited_for():
    disk = Disk(a=("old", 1))
    states = [("n", 2), ("ne", 3), ("new", 4), ("new", 5), ("new", 5)]
    assert looks(watch_on(disk), disk, *states) == [False, False, False, False, True]


def test_a_file_that_is_away_for_a_moment_is_no_change_before_it_is_back():
    disk = Disk(a=("old", 1))
    states = [None, None, None, ("new", 2), ("new", 2)]
    assert looks(watch_on(disk), disk, *states) == [False, False, False, False, True]


def test_what_was_saved_without_a_change_is_not_told():
    disk = Disk(a=("old", 1))
    assert looks(watch_on(disk), disk, ("old", 2), ("old", 2), ("old", 3), ("old", 3)) == [False] * 4


def test_a_change_back_between_two_looks_is_none_and_one_told_later_is_another():
    disk = Disk(a=("old", 1))
    watch = watch_on(disk)
    assert looks(watch, disk, ("new", 2), ("old", 3), ("old", 3)) == [False, False, False]
    assert looks(watch, disk, ("new", 4), ("new", 4), ("old", 5), ("old", 5)) == [False, True, False, True]


def test_a_file_that_was_not_there_at_first_is_told_when_it_comes():
    disk = Disk(a=None)
    assert looks(watch_on(disk), disk, None, ("new", 1), ("new", 1)) == [False, False, True]


def test_a_scene_is_watched_with_the_drawing_that_it_names(tmp_path):
    (tmp_path / "level.svg").write_text(ROOM.format(40))
    (tmp_path / "scene.toml").write_text('drawing = "level.svg"\n')
    (tmp_path / "scene.json").write_text('{"walls": "level.json"}')
    assert watched_paths(tmp_path / "scene.toml") == [tmp_path / "scene.toml", tmp_path / "level.svg"]
    assert watched_paths(tmp_path / "scene.json") == [tmp_path / "scene.json", tmp_path / "level.json"]
    assert watched_paths(tmp_path / "level.svg") == [tmp_path / "level.svg"]
    watch = Watch(tmp_path / "scene.toml")
    saved(tmp_path / "level.svg", ROOM.format(50))
    assert [watch.changed(), watch.changed(), watch.changed()] == [False, True, False]


def saved(path, text):
    """Save as drawing programs do: a new file renamed over the old one."""
    (path.parent / "new").write_text(text)
    os.replace(path.parent / "new", path)  # noqa: PTH105


def waits(*steps):
    """Between two looks do the next step; when there is none left, interrupt."""
    steps = iter(steps)

    def wait(seconds):
        assert seconds == 0.2
        step = next(steps, None)
        if step is None:
            raise KeyboardInterrupt
        step()

    return wait


def test_a_command_is_done_at_once_and_again_after_each_change(tmp_path, capsys):
    file = tmp_path / "a.svg"
    file.write_text("1")
    seen = []
    nothing = lambda: None  # noqa: E731
    steps = (nothing, lambda: saved(file, "2"), nothing, nothing, lambda: saved(file, "3"), nothing)
    repeat(str(file), lambda: seen.append(file.read_text()), waits(*steps))
    assert seen == ["1", "2", "3"]
    assert capsys.readouterr().err.count("a.svg has changed") == 2


def test_an_error_is_told_and_the_next_change_is_tried(tmp_path, capsys):
    file = tmp_path / "a.svg"
    file.write_text("no drawing")
    walls = []
    steps = (lambda: saved(file, ROOM.format(40)), lambda: None)
    repeat(str(file), lambda: walls.append(len(wallkit.import_walls(file))), waits(*steps))
    assert walls == [1]
    assert "a.svg" in capsys.readouterr().err


def test_standard_input_cannot_be_watched():
    with pytest.raises(wallkit.WallkitError, match="standard input cannot be watched"):
        repeat("-", lambda: None)


@pytest.mark.parametrize("command", ["import", "check", "simulate"])
def test_a_watching_command_writes_anew_what_was_saved(tmp_path, monkeypatch, capsys, command):
    file, out = tmp_path / "a.svg", tmp_path / "out.json"
    file.write_text(ROOM.format(40))
    widths = []

    def looked():
        told = capsys.readouterr().out
        walls = json.loads(told if command == "check" else out.read_text())
        if command == "check":
            return widths.append(walls["walls"])
        walls = walls["scene"]["walls"] if command == "simulate" else walls
        return widths.append(max(x for x, _ in walls["walls"][0]["vertices"]))

    steps = (looked, lambda: saved(file, ROOM.format(50)), lambda: None, looked)
    monkeypatch.setattr("time.sleep", None)
    monkeypatch.setattr(repeat, "__defaults__", (waits(*steps),))
    words = {"import": ["-o", out], "check": ["--json"], "simulate": ["-o", out, "--bounces", 3]}[command]
    monkeypatch.setattr(sys, "argv", ["wallkit", command, str(file), "--watch", *map(str, words)])
    with pytest.raises(SystemExit) as ended:
        main()
    assert not ended.value.code
    assert widths == ([1, 1] if command == "check" else [40, 50])
