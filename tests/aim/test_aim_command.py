"""`wallkit aim` as a stranger uses it: words, JSON, pictures, errors."""

import json
from importlib import resources

import jsonschema
import pytest

import wallkit

ROOM = ("samples/room.svg", "--curves", "lines", "--from", "720,345", "--to", "297,523,10", "--bounces", 5)


def test_it_tells_the_windows_and_how_sure_it_is(said):
    code, out, err = said("aim", *ROOM)
    assert (code, err) == (0, "")
    assert "21 windows within 5 bounces, 0.118801 rad in all; the widest 0.0293694 rad at 164.848130 degrees" in out
    assert "complete above 1e-12 rad, by unfolding" in out
    assert "164.848130     0.0293694         2  wall-middle, piano" in out
    assert "and 9 narrower ones (--json)" in out
    assert "--speed" not in out  # nobody needs to know what does not matter


def test_json_is_as_its_schema_says_and_as_the_library_has_it(said):
    code, out, err = said("aim", *ROOM, "--json")
    found = json.loads(out)
    schema = json.loads((resources.files("wallkit.schemas") / "aim.schema.json").read_text("utf-8"))
    jsonschema.Draft202012Validator.check_schema(schema)
    jsonschema.validate(found, schema)
    assert code == 0
    assert "21 windows" in err
    walls = wallkit.import_walls("samples/room.svg", curves="lines")
    windows = wallkit.aim(wallkit.Scene(walls), (720, 345), (297, 523, 10), 5)
    assert [one["low"] for one in found["windows"]] == windows.low.tolist()
    assert [one["high"] for one in found["windows"]] == windows.high.tolist()
    first = found["windows"][0]
    assert first["names"] == [walls.names[wall] for wall in first["word"]]
    assert [walls.edge_offsets[one["wall"]] + one["edge"] for one in first["edges"]] == list(windows[0].edges)


def test_pictures(said, tmp_path):
    code, out, _ = said("aim", *ROOM, "-o", tmp_path / "aim.svg")
    assert code == 0
    assert "wrote    " in out
    picture = (tmp_path / "aim.svg").read_text("utf-8")
    assert picture.count('class="wk-beam') == 12 * 6 + 3 * 5 + 4 * 4 + 2 * 3  # a wedge for each flight of each window
    assert 'class="wk-target"' in picture
    assert "21 windows within 5 bounces" in picture
    code, _, err = said("aim", *ROOM, "-o", tmp_path / "aim.pdf")
    assert code == 2
    assert "unknown-ending" in err


LEVEL = """<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 70" width="100" height="70">
<path id="room" d="M0 0H100V70H0Z" fill="none" stroke="black"/>
<circle id="goal" data-target="hole" cx="67" cy="41" r="3"/>
<g id="balls" data-role="ball"><circle cx="20" cy="30" r="2"/></g></svg>"""


def test_the_ball_and_the_target_of_the_drawing(said, tmp_path):
    level = tmp_path / "level.svg"
    level.write_text(LEVEL, encoding="utf-8")
    code, out, _ = said("aim", level, "--to", "hole", "--bounces", 2)
    assert code == 0
    assert "(20, 30), a ball of radius 2, to (67, 41), radius 3" in out
    assert "13 windows within 2 bounces" in out
    code, _, err = said("aim", level, "--to", "whole", "--bounces", 2)
    assert code == 2
    assert "'hole'" in err


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        (("--to", "1,2"), "bad-target"),
        (("--to", "1,2,-3"), "bad-target"),
        (("--from", "here"), "--from is 'here'"),
        (("--from", "0,0,0"), "--from is '0,0,0'"),
        (("--most-beams", "50"), "too-many-beams"),
        (("--radius", "200"), "overlap"),
    ],
)
def test_errors_say_what_to_do(said, changed, words):
    code, _, err = said("aim", *ROOM, *changed)
    assert code == (3 if words == "too-many-beams" else 2)
    assert words in err
    assert "= help:" in err
