"""Scene files and walls of strangers: numbers that no double holds, keys and rules that would take hours."""

import json

import pytest

from importers.errors import LimitError, WallkitError
from wallkit import Balls, Scene, Walls, import_walls, simulate
from wallkit.globs import MOST_LETTERS, fits
from wallkit.scene.scene_files import read_scene
from wallkit.simulation.run_files import load, save
from wallkit.toml_text import MOST_NAMES, parse_toml
from wallkit.walls.import_options import ImportOptions
from wallkit.walls.walls_json import dumps, loads

HUGE, LONG = "1" + "0" * 400, "1" + "0" * 5000
TRIANGLE = '{"closed": true, "vertices": [[0, 0], [1, 0], [1, 1]]}'
SCENES = {
    "a whole number beyond doubles": f'{{"walls": [{TRIANGLE}], "gravity": [0, {HUGE}]}}',
    "one with more digits than Python reads": f'{{"walls": [{TRIANGLE}], "gravity": [0, {LONG}]}}',
    "the same in TOML": f"gravity = [0, {LONG}]\n",
    "seconds of frames": f"[lesson]\ntitle = 'a'\nway = 'stop'\ndt = {HUGE}\n",
    "an option": f"drawing = 'a.svg'\n[import]\ntolerance = {HUGE}\n",
    "bounces": f"[run]\nbounces = {HUGE}\n",
    "the mass of a ball": f"[[balls]]\nposition = [0, 0]\nmass = {HUGE}\n",
}


@pytest.mark.parametrize("kind", SCENES)
def test_numbers_in_a_scene_that_no_double_holds_are_refused(kind):
    with pytest.raises(WallkitError, match=r"digits|not a finite number|tolerance is"):
        read_scene(SCENES[kind].encode())


PARTS = {
    "a depth beyond 64 bits": f'"walls": [{{"depth": {HUGE}, "closed": true, "vertices": [[0, 0], [1, 0]]}}]',
    "a depth that is infinite": '"walls": [{"depth": 1e999, "closed": true, "vertices": [[0, 0], [1, 0]]}]',
    "a tolerance": f'"walls": [], "tolerance": {HUGE}',
    "the place of a problem": '"walls": [], "problems": [{"code": "a", "severity": "info", "message": "", "x": 1e999}]',
    "a problem that is none": '"walls": [], "problems": [{"code": 1, "severity": "info", "message": ""}]',
    "a marker": '"walls": [], "markers": [{"kind": "spawn", "x": 1e999, "y": 0}]',
    "a marker beyond doubles": f'"walls": [], "markers": [{{"kind": "spawn", "x": {HUGE}, "y": 0}}]',
}


@pytest.mark.parametrize("kind", PARTS)
def test_numbers_of_walls_that_are_none_are_refused(kind):
    with pytest.raises(WallkitError):
        loads(f'{{"format": "wallkit-walls", "version": 1, {PARTS[kind]}}}')


def test_problems_of_walls_read_back():
    problem = {"code": "open-path", "severity": "info", "message": "m", "fix": "f", "layer": "l", "name": "n"}
    problem |= {"line": 3, "column": 4, "x": 0.5, "y": -1.0, "excerpt": "a\n^"}
    text = json.dumps({"format": "wallkit-walls", "version": 1, "walls": [json.loads(TRIANGLE)], "problems": [problem]})
    assert json.loads(dumps(loads(text)))["problems"] == [problem]


@pytest.mark.parametrize("key", ["a" + ".a" * 40 + " = 1", "[" + "'a' . " * 40 + "b]", "b={" + 'c."d".' * 20 + "e=1}"])
def test_a_key_of_many_names_is_refused_before_it_is_parsed(key):
    with pytest.raises(LimitError, match="names with dots") as caught:
        read_scene(f"# scene\ngravity = 1\n{key}\n".encode())
    assert caught.value.line == 3


def test_a_key_of_as_many_names_as_may_be_is_parsed():
    key = ".".join("abcdefgh" * 4)
    assert key.count(".") + 1 == MOST_NAMES
    assert list(parse_toml(f"{key} = 1\nb = 1.5\nc = '1.2.3'\n")) == ["a", "b", "c"]


def scene_with(rules, walls):
    rows = [{"layer": "a*b", "restitution": 0.5}] * rules
    return json.dumps({"walls": [{**json.loads(TRIANGLE), "layer": "ab"}] * walls, "materials": rows}).encode()


def test_rules_are_charged_by_the_walls_that_they_are_matched_with(monkeypatch):
    monkeypatch.setattr("importers.limits.MAX_STEPS", 30_000)
    read_scene(scene_with(20, 100))
    with pytest.raises(LimitError, match="rules matched with walls"):
        read_scene(scene_with(400, 100))


def drawing_of(layers):
    paths = "".join(
        f'<g inkscape:groupmode="layer" inkscape:label="wall {n}"><path d="M0 0h1"/></g>' for n in range(layers)
    )
    spaces = 'xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"'
    return f"<svg {spaces}>{paths}</svg>"


def test_globs_on_layers_are_charged_by_the_names_that_they_are_matched_with(monkeypatch, tmp_path):
    drawn = tmp_path / "layers.svg"
    drawn.write_text(drawing_of(40))
    monkeypatch.setattr("importers.limits.MAX_STEPS", 30_000)
    assert len(import_walls(drawn, layers=["* 3", "wall 7"] * 20)) == 2
    with pytest.raises(LimitError, match="matched with globs"):
        import_walls(drawn, layers=["wall*"] * 400)


def test_long_globs_are_refused_since_python_reads_them_in_the_square_of_their_length():
    assert fits("abc", "a*c")
    assert not fits("abC", "a*c")
    with pytest.raises(LimitError, match="letters of a glob"):
        fits("a", "[" * (MOST_LETTERS + 1))
    scene = {"walls": [json.loads(TRIANGLE)], "materials": [{"layer": "[" * 9_000, "restitution": 1}]}
    with pytest.raises(LimitError, match="letters of a glob"):
        read_scene(json.dumps(scene).encode())


def test_options_say_what_number_they_take():
    with pytest.raises(WallkitError, match="scale is 1000") as caught:
        ImportOptions(scale=10**400)
    assert caught.value.fix == "give a number above 0"


@pytest.mark.parametrize("change", [("time", HUGE), ("ball", HUGE)])
def test_numbers_of_a_saved_run_that_no_double_holds_are_refused(change, tmp_path):
    column, number = change
    scene = Scene(Walls.from_polylines([[(0, 0), (4, 0), (4, 4), (0, 4)]]), Balls([[2, 1]], [[1.0, 0.5]]))
    save(simulate(scene, bounces=3), tmp_path / "run.json")
    value = json.loads((tmp_path / "run.json").read_text())
    value["contacts"][column][0] = int(number)
    (tmp_path / "run.json").write_text(json.dumps(value))
    with pytest.raises(WallkitError, match="this is no run"):
        load(tmp_path / "run.json")
