import csv
import io
import json
import math
import subprocess
import sys

import numpy as np
import pytest

SCENE = """
[[walls]]
vertices = [[0, 0], [400, 0], [400, 300], [0, 300]]
[[balls]]
position = [100, 100]
velocity = [30, 40]
radius = 10
[run]
bounces = 7
"""


@pytest.fixture
def scene(tmp_path):
    file = tmp_path / "scene.toml"
    file.write_text(SCENE)
    return file


@pytest.fixture
def wallkit(said):
    return said


def test_alone_it_prints_a_summary_that_fits_a_screen(wallkit, scene):
    code, out, err = wallkit("simulate", scene)
    assert (code, err) == (0, "")
    lines = out.splitlines()
    assert len(lines) < 24
    assert "1, radius 10, speed 50" in out
    assert "7 in " in out
    assert "bounce limit" in out
    assert "kept" in out


def test_csv_to_standard_output_leaves_the_summary_to_standard_error(wallkit, scene):
    code, out, err = wallkit("simulate", scene, "--format", "csv")
    rows = list(csv.DictReader(io.StringIO(out)))
    assert (code, len(rows)) == (0, 7)
    # The room with the disc's radius taken off, unfolded: the first wall is the upper one, at y = 290 after 4.75 s.
    assert float(rows[0]["time"]) == pytest.approx(4.75, rel=1e-15)
    assert rows[0]["wall"] == "0"
    assert "bounce limit" in err


def test_speed_and_angle_give_the_components_of_a_known_case(wallkit, scene):
    _, out, _ = wallkit("simulate", scene, "--format", "json", "--speed", 50, "--angle", 60, "--bounces", 1)
    contacts = json.loads(out)["contacts"]
    assert contacts["vx"][0] == pytest.approx(25, rel=1e-15)
    assert contacts["vy"][0] == pytest.approx(-43.30127018922193, rel=1e-15)


@pytest.mark.parametrize("ending", ["csv", "json", "npz", "svg", "png", "gif"])
def test_the_ending_decides_what_is_written(wallkit, scene, tmp_path, ending):
    target = tmp_path / f"run.{ending}"
    short = ["--seconds", 0.2] if ending == "gif" else []
    code, out, _ = wallkit("simulate", scene, "-o", target, *short)
    assert code == 0
    begins = {
        "csv": b"time,",
        "json": b'{"format": "wallkit-run"',
        "npz": b"PK",
        "svg": b"<svg",
        "png": b"\x89PNG",
        "gif": b"GIF89a",
    }
    assert target.read_bytes().startswith(begins[ending])
    assert str(target) in out


def test_an_unknown_ending_is_refused_before_any_work(wallkit, tmp_path):
    code, _, err = wallkit("simulate", tmp_path / "missing.ai", "-o", "run.xyz")
    assert code == 2
    assert "unknown-ending" in err
    assert ".csv" in err


def test_balls_at_random_are_the_same_for_the_same_seed_and_inside(wallkit, scene):
    first = wallkit("simulate", scene, "--balls", 20, "--seed", 5, "--format", "json", "--bounces", 2)[1]
    again = wallkit("simulate", scene, "--balls", 20, "--seed", 5, "--format", "json", "--bounces", 2)[1]
    other = wallkit("simulate", scene, "--balls", 20, "--seed", 6, "--format", "json", "--bounces", 2)[1]
    assert first == again != other
    balls = json.loads(first)["scene"]["balls"]
    places, radius = np.array([ball["position"] for ball in balls]), balls[0]["radius"]
    assert (places > radius).all()
    assert (places < np.array([400, 300]) - radius).all()


def test_options_override_the_scene(wallkit, scene):
    out = wallkit("simulate", scene, "--format", "json", "--ball", "50,60", "--velocity", "1,2", "--radius", 3,
                  "--restitution", 0.5, "--gravity", "0,-10", "--until", 1)[1]  # fmt: skip
    said = json.loads(out)["scene"]
    assert said["balls"] == [{"position": [50.0, 60.0], "velocity": [1.0, 2.0], "radius": 3.0}]
    assert said["gravity"] == [0.0, -10.0]
    assert said["run"] == {"until": 1.0}
    assert said["walls"]["walls"][0]["material"]["restitution"] == 0.5


@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        (["--ball", "1"], "--ball is '1'"),
        (["--ball", "1,nan"], "--ball is '1,nan'"),
        (["--velocity", "1,2", "--speed", "3"], "do not go together"),
        (["--ball", "1,2", "--balls", "3"], "do not go together"),
        (["--balls", "0"], "--balls is 0"),
        (["--tolerance", "0.1"], "only for drawings"),
    ],
)
def test_wrong_options_end_with_2_and_say_what_to_give(wallkit, scene, words, complaint):
    code, out, err = wallkit("simulate", scene, *words)
    assert (code, out) == (2, "")
    assert complaint in err
    assert "help" in err


def test_a_missing_file_ends_with_2(wallkit):
    code, _, err = wallkit("simulate", "nowhere.ai")
    assert code == 2
    assert "nowhere.ai" in err


def imported(file, modules):
    """Which of these modules a small run imports."""
    script = (
        "import sys; sys.argv = ['wallkit', 'simulate', sys.argv[1]]\n"
        "from wallkit.cli import main\n"
        "try: main()\n"
        "except SystemExit as ended: assert not ended.code\n"
        f"print(sorted({modules!r} & set(sys.modules)), file=sys.stderr)"
    )
    return subprocess.run([sys.executable, "-c", script, file], capture_output=True, text=True, check=True).stderr


def test_a_small_run_waits_for_no_compiler_and_no_big_library(scene):
    assert imported(scene, {"llvmlite", "scipy", "svgpathtools", "pikepdf", "PIL"}) == "[]\n"


def test_a_small_run_loads_only_what_it_uses(tmp_path):
    script = (
        "import sys; sys.argv = ['wallkit', 'simulate', 'samples/room.svg', '-o', sys.argv[1]]\n"
        "from wallkit.cli import main\n"
        "main()\n"
        "print(*sys.modules, file=sys.stderr)"
    )
    command = [sys.executable, "-c", script, tmp_path / "contacts.csv"]
    loaded = subprocess.run(command, capture_output=True, text=True, check=True).stderr.split()
    unused = ("shapely", "fractions", "zipfile", "wallkit.export", "wallkit.view", "wallkit.levels", "wallkit.accuracy",
              "wallkit.scene.lesson", "wallkit.walls.checking.widths", "wallkit.walls.importing.clips",
              "wallkit.walls.repairing.passes", "wallkit.walls.walls_json")  # fmt: skip
    assert [name for name in loaded if name.startswith(unused)] == []


def test_a_run_of_a_drawing_waits_for_no_reader_of_scenes(tmp_path):
    drawing = tmp_path / "room.svg"
    drawing.write_text(
        '<svg xmlns="http://www.w3.org/2000/svg"><path d="M0 0H90V90H0Z" fill="none" stroke="#000"/></svg>'
    )
    assert imported(drawing, {"tomllib", "wallkit.scene.scene_files"}) == "[]\n"


def test_the_default_ball_flies_at_50_units_and_30_degrees_from_the_roomiest_spot(wallkit, tmp_path):
    file = tmp_path / "walls.toml"
    file.write_text("[[walls]]\nvertices = [[0, 0], [100, 0], [100, 100], [0, 100]]\n")
    out = wallkit("simulate", file, "--format", "json")[1]
    ball = json.loads(out)["scene"]["balls"][0]
    assert ball["position"] == pytest.approx([50, 50], abs=0.5)
    assert ball["velocity"] == pytest.approx([50 * math.cos(math.pi / 6), 25], rel=1e-15)
    assert 0 < ball["radius"] < 10
    assert len(json.loads(out)["contacts"]["time"]) == 100


DRAWING = (
    '<svg xmlns="http://www.w3.org/2000/svg" width="400" height="300">'
    '<rect width="400" height="300" fill="#eee"/><path d="M180 100 C 240 90 260 180 200 200 Z" fill="#333"/>'
    '<g id="balls"><circle cx="60" cy="60" r="12"/><line x1="60" y1="60" x2="160" y2="120" stroke="#000"/></g></svg>'
)


def test_a_drawing_alone_says_what_it_took_for_what(wallkit, tmp_path):
    file = tmp_path / "room.svg"
    file.write_text(DRAWING)
    code, out, err = wallkit("simulate", file)
    assert (code, err) == (0, "")
    assert "the outermost walls are a room" in out
    assert "1 ball drawn on the layer 'balls'" in out
    assert "1, radius 12, speed 116.619" in out  # hypot(100, 60)
    assert "of the drawn curves; it" in out
    assert "wallkit check" in out


def test_a_drawing_on_standard_input_is_read_too(scene, tmp_path):
    said = subprocess.run(
        [sys.executable, "-m", "wallkit", "simulate", "-", "--bounces", "3"],
        input=DRAWING,
        capture_output=True,
        text=True,
        check=True,
    )
    assert said.stdout.startswith("standard input (SVG)")


def test_a_saved_run_flies_again(wallkit, scene, tmp_path):
    wallkit("simulate", scene, "-o", tmp_path / "run.json")
    again = wallkit("simulate", tmp_path / "run.json", "--format", "csv")[1]
    assert again == wallkit("simulate", scene, "--format", "csv")[1]


def test_lines_and_arcs_differ_in_the_walls_that_are_flown(wallkit, tmp_path):
    file = tmp_path / "room.svg"
    file.write_text(DRAWING)
    assert "arc" in wallkit("simulate", file, "--bounces", 2)[1]
    assert "arc" not in wallkit("simulate", file, "--bounces", 2, "--curves", "lines")[1].split("\n")[1]


def test_snap_closes_a_gap_before_the_balls_fly(wallkit, tmp_path):
    file = tmp_path / "gap.txt"
    file.write_text("0 0 m\n100 0 l\n100 100 l\n0 100 l\n0 1 l\n")
    assert "(1 open)" in wallkit("simulate", file)[1]
    assert "open)" not in wallkit("simulate", file, "--snap", 2)[1].split("\n")[1]


def test_scale_and_flip_act_on_walls_and_drawn_balls_alike(wallkit, tmp_path):
    file = tmp_path / "room.svg"
    file.write_text(DRAWING)
    out = wallkit("simulate", file, "--scale", 0.5, "--flip-y", "--format", "json", "--bounces", 1)[1]
    ball = json.loads(out)["scene"]["balls"][0]
    assert ball["position"] == pytest.approx([30, -30])
    assert ball["velocity"] == pytest.approx([50, -30])
    assert ball["radius"] == pytest.approx(6)


def test_a_dropped_ball_rests_in_the_closed_form_time(wallkit, tmp_path):
    """T = sqrt(2 h / g) (1 + e) / (1 - e): 1.35457092 s for h = 1, g = 9.81, e = 0.5."""
    file = tmp_path / "drop.toml"
    file.write_text(
        "gravity = [0, -9.81]\n[run]\nuntil = 10\n[[balls]]\nposition = [5, 1]\n"
        "[[walls]]\nvertices = [[0, 0], [10, 0], [10, 9], [0, 9]]\nmaterial = { restitution = 0.5 }\n"
    )
    out = wallkit("simulate", file, "--format", "json")[1]
    assert json.loads(out)["ending"] == ["at rest"]
    assert json.loads(out)["final"][0]["time"] == pytest.approx(1.35457092, abs=1e-8)
    assert "at rest" in wallkit("simulate", file)[1]


def test_a_ball_that_overlaps_a_wall_is_an_error_unless_it_may_settle(wallkit, scene):
    code, _, err = wallkit("simulate", scene, "--ball", "5,100", "--radius", 10)
    assert code == 2
    assert "overlap" in err
    code, out, _ = wallkit("simulate", scene, "--ball", "5,100", "--radius", 10, "--settle", "--format", "json")
    assert code == 0
    assert json.loads(out)["scene"]["balls"][0]["position"] == pytest.approx([10, 100], abs=1e-6)


def test_energy_under_gravity_counts_height_and_ends_with_none_at_the_bottom(wallkit, tmp_path):
    file = tmp_path / "drop.toml"
    text = (
        "gravity = [0, -10]\n[run]\nuntil = 50\n[[balls]]\nposition = [5, 4]\nradius = 1\n"
        "[[walls]]\nvertices = [[0, 0], [10, 0], [10, 9], [0, 9]]\nmaterial = { restitution = %s }\n"
    )
    file.write_text(text % 0.5)
    # It rests with its centre 1 above the floor, the lowest place that it can reach.
    assert "energy   0.00% left (kinetic and potential)" in wallkit("simulate", file)[1]
    file.write_text(text % 1)
    assert "energy   kept (kinetic and potential), to" in wallkit("simulate", file)[1]


def test_friction_and_drag_slow_balls_down_unless_they_are_0(wallkit, scene):
    code, out, _err = wallkit("simulate", scene, "--friction", 10, "--bounces", 100)
    assert code == 0
    assert " in 5 s" in out  # 50 / 10
    assert "at rest" in out
    code, out, _err = wallkit("simulate", scene, "--drag", 0.5, "--until", 2, "--format", "json")
    final = json.loads(out)["final"][0]
    assert math.hypot(final["vx"], final["vy"]) == pytest.approx(50 * math.exp(-1.0), rel=1e-12)
    scene.write_text("drag = 0.5\n" + SCENE)
    code, out, _err = wallkit("simulate", scene, "--drag", 0)
    assert "kept" in out
    code, out, err = wallkit("simulate", scene, "--friction", 1)
    assert code == 2
    assert "act together" in err


def test_a_run_that_drag_ends_can_be_written(wallkit, scene, tmp_path):
    code, out, _err = wallkit("simulate", scene, "--drag", 0.5, "-o", tmp_path / "run.json", "-o", tmp_path / "run.svg")
    assert code == 0
    assert "at rest" in out
    final = json.loads((tmp_path / "run.json").read_text())["final"][0]
    assert (final["vx"], final["vy"]) == (0.0, 0.0)


def test_real_units_a_ball_falls_as_on_earth(wallkit, tmp_path):
    """A drawing of 100 px a metre: from 5 m a ball is on the floor after sqrt(2 h / g), at sqrt(2 g h)."""
    (tmp_path / "room.svg").write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" width="800" height="600">'
        '<path d="M0 0H800V600H0Z" fill="none" stroke="black"/></svg>'
    )
    code, out, _ = wallkit("simulate", tmp_path / "room.svg", "--units", "1 m = 100 px", "--gravity", 9.81, "--ball",
                           "4,1", "--speed", 0, "--radius", 0, "--bounces", 1, "--format", "csv")  # fmt: skip
    assert code == 0
    time, _, x, y, _, vy = (float(part) for part in out.splitlines()[1].split(",")[:6])
    assert (x, y) == pytest.approx((4.0, 6.0), abs=1e-12)
    assert time == pytest.approx((2 * 5 / 9.81) ** 0.5, rel=1e-14)
    assert vy == pytest.approx(-((2 * 9.81 * 5) ** 0.5), rel=1e-14)
    assert "--gravity is 'heavy'" in wallkit("simulate", tmp_path / "room.svg", "--gravity", "heavy")[2]


@pytest.mark.parametrize(
    ("words", "option"),
    [
        (["--strobe", 1], "--strobe"),
        (["--fps", 20, "-o", "run.svg"], "--fps"),
        (["--strobe", 1, "-o", "run.gif"], "--strobe"),
        (["--colour", "speed", "-o", "run.html"], "--colour"),
        (["--theme", "dark", "-o", "run.svg"], "--theme"),
        (["--seed", 3], "--seed"),
        (["--ball-restitution", 0.5], "--ball-restitution"),
    ],
)
def test_an_option_that_would_do_nothing_is_refused_and_nothing_is_written(
    wallkit, scene, tmp_path, monkeypatch, words, option
):
    monkeypatch.chdir(tmp_path)
    before = sorted(tmp_path.iterdir())
    code, _, err = wallkit("simulate", scene, *words)
    assert code == 2
    assert f"{option}: only with" in err
    assert "leave it out" in err or "--balls" in err
    assert sorted(tmp_path.iterdir()) == before


def test_an_option_is_welcome_where_one_of_several_files_shows_it(wallkit, scene, tmp_path):
    words = ["-o", tmp_path / "run.svg", "-o", tmp_path / "run.csv", "--strobe", 1, "--size", 400]
    assert wallkit("simulate", scene, "--bounces", 3, *words)[0] == 0
    assert 'width="400"' in (tmp_path / "run.svg").read_text()


def test_that_points_never_meet_is_said(wallkit, scene):
    _, out, _ = wallkit("simulate", scene, "--meeting", "--ball", "50,60", "--radius", 0, "--bounces", 1)
    assert "balls are points, which never meet (--radius)" in out
