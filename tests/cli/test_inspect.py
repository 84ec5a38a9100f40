import json
from importlib import resources

import jsonschema
import pytest
import typer
from typer.testing import CliRunner

from wallkit.cli import inspect as command

DRAWING = """<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 50">
  <g id="Room"><rect id="outer" x="10" y="5" width="80" height="40"/></g>
  <g id="Things" style="display:none"><circle id="ball" cx="30" cy="25" r="4"/></g>
  <text>hello</text>
  <path id="broken" d="M 1 2 L 3 4 L 5"/>
</svg>
"""


def run(tmp_path, *options):
    app = typer.Typer()
    command.register(app)
    file = tmp_path / "room.svg"
    file.write_text(DRAWING)
    return CliRunner().invoke(app, [str(file), *options])


def test_one_screen_shows_layers_paths_boxes_units_and_what_is_left_out(tmp_path):
    result = run(tmp_path)
    assert result.exit_code == 0
    assert len(result.stdout.splitlines()) < 24
    for words in ("units    px, y axis down", '"Room"', '"Things"', "hidden", "x 10 to 90", "3 (3 subpaths", "4 arcs"):
        assert words in result.stdout
    assert "bad-path-data" in result.stderr
    assert "room.svg:5:39" in result.stderr
    assert "<text>" in result.stderr


def test_the_json_is_the_whole_drawing_and_nothing_else_on_standard_output(tmp_path):
    result = run(tmp_path, "--json")
    data = json.loads(result.stdout)
    assert data["format"] == "wallkit-drawing"
    assert [path["name"] for path in data["paths"]] == ["outer", "ball", "broken"]
    assert [path["visible"] for path in data["paths"]] == [True, False, True]
    assert data["paths"][0]["subpaths"][0]["segments"][0] == ["M", 10.0, 5.0]
    assert {problem["code"] for problem in data["problems"]} == {"bad-path-data", "text-left-out"}


STORIES = {
    "every kind of segment": '<path d="M0 0 L1 1 H5 V6 C1 2 3 4 5 6 Q1 2 3 4 A5 6 7 0 1 20 9 Z"/><circle r="4"/>',
    "hidden, painted, tagged": '<g id="a" data-x="y" display="none"><rect width="5" height="4" stroke="red"/></g>',
    "nothing": "",
    "problems of every kind of place": '<text/><path d="M0 0 #"/><use href="#no"/><rect width="5x" height="3"/>',
}


@pytest.mark.parametrize("story", STORIES)
def test_the_json_keeps_to_its_schema(story, tmp_path):
    app = typer.Typer()
    command.register(app)
    file = tmp_path / "a.svg"
    file.write_text(f'<svg xmlns="http://www.w3.org/2000/svg">{STORIES[story]}</svg>')
    schema = json.loads((resources.files("wallkit.schemas") / "drawing.schema.json").read_text("utf-8"))
    jsonschema.Draft202012Validator.check_schema(schema)
    jsonschema.validate(json.loads(CliRunner().invoke(app, [str(file), "--json"]).stdout), schema)
