"""`wallkit export` and `import -o level.tmj` as a stranger uses them."""

from __future__ import annotations

import json

import pytest
from levels import SAMPLES, wallkit_command

from wallkit.export import formats


def test_the_ending_decides_and_the_summary_says_what_was_written(tmp_path):
    result = wallkit_command("export", SAMPLES / "room.svg", "-o", tmp_path / "level.tmj")
    assert result.returncode == 0, result.stderr
    assert json.loads((tmp_path / "level.tmj").read_text())["type"] == "map"
    assert "16 walls as Tiled map, JSON (version 1.10)" in result.stderr
    assert result.stdout == ""


def test_import_to_an_ending_of_a_level_writes_the_same(tmp_path):
    for command in ("export", "import"):
        result = wallkit_command(command, SAMPLES / "lagoon.ai", "-o", tmp_path / f"{command}.tmx")
        assert result.returncode == 0, result.stderr
    assert (tmp_path / "export.tmx").read_bytes() == (tmp_path / "import.tmx").read_bytes()


def test_walls_a_scene_and_standard_input_are_taken_too(tmp_path):
    drawing = (SAMPLES / "pinball.svg").read_text()
    piped = wallkit_command("export", "-", "--format", "tmj", input=drawing)
    assert piped.returncode == 0, piped.stderr
    assert wallkit_command("import", SAMPLES / "pinball.svg", "-o", tmp_path / "walls.json").returncode == 0
    for file in (tmp_path / "walls.json", SAMPLES / "pinball.toml"):
        result = wallkit_command("export", file, "--format", "tmj")
        assert result.returncode == 0, result.stderr
        whole = json.loads(result.stdout)
        assert whole["type"] == "map"
        if file.suffix == ".json":
            assert result.stdout == piped.stdout


def test_arcs_stay_for_formats_that_keep_them_and_lines_are_for_the_others(tmp_path):
    arcs = wallkit_command("export", SAMPLES / "stadium.svg", "--arena", "--format", "svg")
    lines = wallkit_command("export", SAMPLES / "stadium.svg", "--arena", "--format", "svg", "--curves", "lines")
    assert " A" in arcs.stdout
    assert " A" not in lines.stdout


@pytest.mark.parametrize(
    ("arguments", "code", "helps"),
    [
        (["-o", "level.bmp"], "unknown-ending", ".tmj"),
        ([], "unknown-ending", "--format"),
        (["-o", "level.json"], "unknown-ending", ".planck.json"),
        (["-o", "level.tmj", "--format", "bmp"], "unknown-format", "tmj"),
        (["-o", "level.tmj", "--grid", "-1"], "bad-option", "from 0"),
        (["-o", "no/folder/level.tmj"], "cannot-write", "folder"),
    ],
)
def test_mistakes_end_with_words_and_write_nothing(arguments, code, helps, tmp_path):
    result = wallkit_command("export", SAMPLES / "room.svg", *arguments, cwd=tmp_path)
    assert result.returncode == 2
    assert code in result.stderr
    assert helps in result.stderr
    assert "Traceback" not in result.stderr
    assert list(tmp_path.iterdir()) == []


def test_the_list_names_every_format_with_its_ending():
    result = wallkit_command("export", "--list")
    assert result.returncode == 0
    assert [line.split()[:2] for line in result.stdout.splitlines()] == [
        [each.name, each.endings[0]] for each in formats().values()
    ]
