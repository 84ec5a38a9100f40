"""`wallkit import` as a stranger uses it: data on stdout, words on stderr, exit codes."""

from __future__ import annotations

import json
import os
import subprocess
import sys

import pytest

pytest.importorskip("importers.read")

SVG = """<svg xmlns="http://www.w3.org/2000/svg" width="100" height="60">
<rect id="room" width="100" height="60" fill="none" stroke="black"/>
<circle id="pin" cx="50" cy="30" r="10"/>
<path id="gap" d="M5 5 L20 5 L20 20" fill="none" stroke="black"/>
</svg>
"""


def wallkit(*arguments, stdin=None):
    return subprocess.run(
        [sys.executable, "-m", "wallkit", *map(str, arguments)],
        input=stdin,
        capture_output=True,
        text=True,
        timeout=120,
        env=os.environ | {"NO_COLOR": "1"},
    )


@pytest.fixture
def room(tmp_path):
    file = tmp_path / "room.svg"
    file.write_text(SVG)
    return file


def test_pasted_text_from_standard_input():
    result = wallkit("import", "-", stdin="24 803 m\n69 828 l\n108 775 l\n31 757 l\n24 803 l\n")
    assert result.returncode == 0, result.stderr
    whole = json.loads(result.stdout)
    assert whole["source"]["file"] == "-"
    walls = whole["walls"]
    assert len(walls) == 1
    assert walls[0]["closed"]
    assert sorted(walls[0]["vertices"]) == [[24, 803], [31, 757], [69, 828], [108, 775]]
    assert len(walls[0]["normals"]) == 4
    assert "1 wall (1 closed), 4 edges" in result.stderr


def test_data_to_a_file_and_summary_to_stderr(room, tmp_path):
    out = tmp_path / "walls.json"
    result = wallkit("import", room, "-o", out)
    assert result.returncode == 0, result.stderr
    assert result.stdout == ""
    whole = json.loads(out.read_text())
    assert [wall["name"] for wall in whole["walls"]] == ["room", "pin", "gap"]
    assert whole["solid"] == {"room": True, "how": "paint", "why": "the shape 'pin' is filled and in it"}
    assert [wall["depth"] for wall in whole["walls"]] == [1, 2, 2]
    assert [problem["code"] for problem in whole["problems"]] == ["open-path"]
    assert "open-path" in result.stderr
    assert "3 walls (2 closed, 1 open)" in result.stderr


def test_unknown_ending_and_missing_file_are_usage_errors(room, tmp_path):
    result = wallkit("import", room, "-o", tmp_path / "walls.bmp")
    assert result.returncode == 2
    assert "unknown-ending" in result.stderr
    result = wallkit("import", tmp_path / "missing.svg")
    assert result.returncode == 2
    assert "Traceback" not in result.stderr


def test_bad_option_is_a_usage_error(room):
    result = wallkit("import", room, "--tolerance", "-1")
    assert result.returncode == 2
    assert "tolerance" in result.stderr


def test_snap_closes_the_gap_and_says_so(tmp_path):
    file = tmp_path / "gap.svg"
    file.write_text('<svg xmlns="http://www.w3.org/2000/svg"><path d="M0 30V0H100V60H0V30.5" fill="none"/></svg>')
    result = wallkit("import", file, "--snap", "0.5")
    whole = json.loads(result.stdout)
    assert [wall["closed"] for wall in whole["walls"]] == [True]
    assert [problem["code"] for problem in whole["problems"]][-2:] == ["repaired-snap", "repaired-join"]
    assert "moved by at most 0.25" in result.stderr


def test_arcs_and_preview(room, tmp_path):
    picture = tmp_path / "walls.svg"
    result = wallkit("import", room, "--curves", "arcs", "--preview", picture)
    assert result.returncode == 0, result.stderr
    assert "bulges" in json.loads(result.stdout)["walls"][1]
    assert picture.read_text().startswith("<svg")
