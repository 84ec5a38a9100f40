"""`wallkit simulate --way`: it says when and where a way parts from the exact path, and shows it."""

import pytest

# A disc of radius 10 in a room: its centre is at y = 290, the upper wall, after 4.75 s.
SCENE = """
[[walls]]
name = "room"
vertices = [[0, 0], [400, 0], [400, 300], [0, 300]]
[[balls]]
position = [100, 100]
velocity = [30, 40]
radius = 10
[run]
until = 8
"""


@pytest.fixture
def scene(tmp_path):
    file = tmp_path / "scene.toml"
    file.write_text(SCENE)
    return file


@pytest.mark.parametrize(
    ("way", "dt", "words"),
    [
        # stopped at (242.5, 290) for the rest of a frame that the exact ball ends at (250, 280)
        ("stop", 1, "stop in frames of 1 s: parts from the exact path at 5 s at (242.5, 290), 12.5 units off"),
        ("full-step", 1, "parts from the exact path at 5 s at (272.5, 250), 37.5 units off"),
        ("reflect-in-place", 1, "parts from the exact path at 5 s at (250, 220), 60 units off"),
        ("overlap", 1, "parts from the exact path at 5 s at (250, 300), 20 units off"),
        ("overlap", 3, "at 6 s at (280, 340), 100 units off; goes through wall 0 (room) at 6 s, and is lost"),
        ("exact", 1, "exact in frames of 1 s: never 1 % of the drawing off the exact path, up to 8 s"),
    ],
)
def test_the_summary_says_when_and_where_a_way_parts(said, scene, way, dt, words):
    code, out, err = said("simulate", scene, "--way", way, "--dt", dt)
    assert (code, err) == (0, "")
    (line,) = [line for line in out.splitlines() if line.startswith("  way ")]
    assert words in line


def test_frames_last_a_sixtieth_of_a_second_unless_told_and_are_exact_unless_told(said, scene):
    assert "stop in frames of 0.01667 s" in said("simulate", scene, "--way", "stop")[1]
    assert "exact in frames of 0.5 s" in said("simulate", scene, "--dt", 0.5)[1]
    assert "\n  way " not in said("simulate", scene)[1]


def test_of_many_balls_it_says_how_many_and_the_first(said, scene):
    _, out, _ = said("simulate", scene, "--balls", 9, "--seed", 4, "--radius", 5, "--way", "overlap", "--dt", 1.5)
    assert "of 9 balls part from their exact paths, the first (ball" in out
    assert "through walls, the first (ball" in out


@pytest.mark.parametrize("ending", ["svg", "png", "gif"])
def test_pictures_and_films_show_the_way(said, scene, tmp_path, ending):
    exact, wrong = tmp_path / f"exact.{ending}", tmp_path / f"wrong.{ending}"
    short = ["--seconds", 0.2] if ending == "gif" else []
    assert said("simulate", scene, "-o", exact, *short)[0] == 0
    assert said("simulate", scene, "-o", wrong, *short, "--way", "stop", "--dt", 1)[0] == 0
    assert exact.read_bytes() != wrong.read_bytes()


@pytest.mark.parametrize("ending", ["csv", "json", "npz", "html"])
def test_files_of_exact_runs_do_not_pretend_to_hold_a_way(said, scene, tmp_path, ending):
    target = tmp_path / f"run.{ending}"
    code, _, err = said("simulate", scene, "-o", target, "--way", "stop")
    assert code == 2
    assert "holds exact runs alone" in err
    assert not target.exists()


@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        (["--way", "stop", "--dt", "0"], "dt is"),
        (["--way", "stop", "--dt", "1e-9"], "frames"),
        (["--way", "stop", "--dt", "nan"], "--dt"),
        (["--way", "jump"], "'overlap'"),
        (["--way", "stop", "--heat", "-o", "a.svg"], "--heat"),
        (["--way", "stop", "--strobe", "0.5", "-o", "a.svg"], "--strobe"),
        (["--way", "stop", "--colour", "time", "-o", "a.svg"], "--colour time"),
    ],
)
def test_wrong_ways_end_with_2_and_say_what_to_give(said, scene, words, complaint):
    code, _, err = said("simulate", scene, *words)
    assert code == 2
    assert complaint in err
