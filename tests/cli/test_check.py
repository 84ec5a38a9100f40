"""`wallkit check` as a stranger uses it."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from importlib import resources

import jsonschema
import pytest

LEAKY = (
    '<svg xmlns="http://www.w3.org/2000/svg"><path id="room" fill="none" stroke="black" d="M0 30V0H100V60H0V{}"/></svg>'
)
CLEAN = '<svg xmlns="http://www.w3.org/2000/svg"><rect id="room" width="100" height="60"/></svg>'


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
def leaky(tmp_path):
    file = tmp_path / "leaky.svg"
    file.write_text(LEAKY.format(30.5))
    return file


def test_nothing_to_find_ends_with_0(tmp_path):
    file = tmp_path / "clean.svg"
    file.write_text(CLEAN)
    result = wallkit("check", file)
    assert (result.returncode, result.stderr) == (0, "")
    assert "no leak" in result.stdout


def test_findings_end_with_1_and_name_place_and_fix(leaky):
    result = wallkit("check", leaky)
    assert result.returncode == 1
    assert "warning[leak]" in result.stdout
    assert "(0, 30.25)" in result.stdout
    assert "--snap 0.5" in result.stdout


@pytest.mark.parametrize(("radius", "leaks"), [(0.2499, 1), (0.2501, 0)])
def test_leaks_for_a_ball_as_json(leaky, tmp_path, radius, leaks):
    picture = tmp_path / "check.svg"
    result = wallkit("check", leaky, "--radius", radius, "--json", "--preview", picture)
    report = json.loads(result.stdout)
    assert len(report["leaks"]) == leaks
    assert [problem["code"] for problem in report["problems"]].count("leak") == leaks
    assert ("wk-way" in picture.read_text().split("</style>")[1]) == bool(leaks)
    assert report["gaps"][0]["width"] == 0.5
    schema = json.loads((resources.files("wallkit.schemas") / "check.schema.json").read_text("utf-8"))
    jsonschema.validate(report, schema)


def test_walls_are_checked_as_drawings_are(leaky, tmp_path):
    out = tmp_path / "walls.json"
    assert wallkit("import", leaky, "-o", out).returncode == 0
    report = json.loads(wallkit("check", out, "--json").stdout)
    assert report["leaks"][0]["width"] == 0.5


def test_a_negative_radius_is_a_usage_error(leaky):
    result = wallkit("check", leaky, "--radius", -1)
    assert result.returncode == 2
    assert "radius" in result.stderr


WITH_BALLS = """<svg xmlns="http://www.w3.org/2000/svg">
<path id="room" fill="none" stroke="black" d="M0 30V0H100V60H0V32"/>
<g id="balls"><circle cx="50" cy="30" r="{}"/></g></svg>"""


@pytest.mark.parametrize(("radius", "leaks"), [(0.9, 1), (1.1, 0)])
def test_the_ball_that_is_drawn_is_the_one_that_is_looked_at(tmp_path, radius, leaks):
    file = tmp_path / "balls.svg"
    file.write_text(WITH_BALLS.format(radius))
    result = wallkit("check", file)
    assert result.stdout.count("warning[leak]") == leaks
    assert f"assumed: a ball of radius {radius}" in result.stdout


def test_a_scene_is_checked_with_the_drawing_that_it_names(leaky, tmp_path):
    scene = tmp_path / "scene.toml"
    scene.write_text('drawing = "leaky.svg"\n[[balls]]\nposition = [50, 30]\nvelocity = [1, 0]\nradius = 0.2\n')
    report = json.loads(wallkit("check", scene, "--json").stdout)
    assert report["radius"] == pytest.approx(0.2)
    assert len(report["leaks"]) == 1


def test_the_largest_ball_that_fits_is_told(tmp_path):
    file = tmp_path / "clean.svg"
    file.write_text(CLEAN)
    assert "largest ball that fits in a room: radius 30," in wallkit("check", file).stdout


def test_standard_input_is_read():
    result = wallkit("check", "-", stdin=CLEAN)
    assert (result.returncode, result.stderr) == (0, "")


def test_what_is_no_drawing_is_an_error_and_not_a_finding(tmp_path):
    file = tmp_path / "words.svg"
    file.write_text("no drawing at all")
    assert wallkit("check", file).returncode == 2


def test_the_fix_that_is_told_mends_it(leaky):
    result = wallkit("check", leaky, "--snap", 0.5)
    assert (result.returncode, result.stderr) == (0, "")


def test_a_drawing_without_walls_is_a_finding():
    result = wallkit("check", "-", stdin='<svg xmlns="http://www.w3.org/2000/svg"/>')
    assert result.returncode == 1
    assert "warning[no-walls]" in result.stdout


OPEN_FRAME = """<svg xmlns="http://www.w3.org/2000/svg"><g fill="#555">
<path d="M0 0H300V85H280V20H20V180H280V115H300V200H0Z"/><rect id="block" x="150" y="60" width="80" height="80"/></g>
<g id="balls">{}</g></svg>"""
IN_BLOCK, BESIDE = '<circle cx="190" cy="100" r="6"/>', '<circle cx="70" cy="100" r="6"/>'


@pytest.mark.parametrize("balls", [IN_BLOCK + BESIDE, BESIDE + IN_BLOCK])
def test_a_leak_and_a_ball_in_material_are_findings_whichever_is_drawn_first(balls):
    result = wallkit("check", "-", "--json", stdin=OPEN_FRAME.format(balls))
    report = json.loads(result.stdout)
    assert result.returncode == 1
    assert [gap["width"] for gap in report["leaks"]] == [30]
    (ball,) = (problem for problem in report["problems"] if problem["code"] == "ball-in-material")
    assert (ball["x"], ball["y"], ball["name"]) == (190, 100, "block")


DIVIDED = """<svg xmlns="http://www.w3.org/2000/svg">
<rect id="frame" width="300" height="200" fill="none" stroke="#000"/>
<rect x="145" width="10" height="90" fill="#555"/><rect x="145" y="102" width="10" height="98" fill="#555"/></svg>"""


@pytest.mark.parametrize(("radius", "codes"), [(5.9, []), (6.1, ["unreachable"])])
def test_a_door_that_is_too_narrow_shuts_a_room(radius, codes):
    result = wallkit("check", "-", "--json", "--arena", "--radius", radius, stdin=DIVIDED)
    report = json.loads(result.stdout)
    assert [problem["code"] for problem in report["problems"] if problem["severity"] == "warning"] == codes
    assert result.returncode == len(codes)
