"""What a strict type checker sees of wallkit from outside, and what print() shows."""

from pathlib import Path

import numpy as np
import pytest

import wallkit
from wallkit import Balls, Material, Scene, WallkitError, Walls

ROOT = Path(__file__).parents[2]
RIGHT = """
import numpy as np

import wallkit

walls = wallkit.Walls.from_polylines([[(0, 0), (0, 10), (10, 10), (10, 0)]], sides="both")
balls = wallkit.Balls([(5, 5), (6, 6)], np.array([[3, 4], [1, 2]]), radius=0.5)
rows, columns = balls.position.shape
fastest: float = float(np.hypot(*balls.velocity.T).max())
some: wallkit.Balls = balls.take(balls.radius > 0.1)
first: wallkit.Walls = walls.take([0]).straightened()
run = wallkit.simulate(wallkit.Scene(first, some, gravity=(0.0, -9.81)), until=3.0)
x: float = run.position(np.linspace(0.0, 3.0, 7))[:, 0, 0].sum()
totals = wallkit.survey(wallkit.prepare(run.scene), bounces=10)
hits: int = int(totals.hits.sum())
"""
WRONG = """
import wallkit

balls = wallkit.Balls("here", [(3, 4)], radius=None)  # line 4
walls = wallkit.Walls.from_polylines([], sides="outwrd")  # line 5
wallkit.simulate(wallkit.Scene(walls), mode="fast")  # line 6
"""
SQUARE = [(0.0, 0.0), (0.0, 10.0), (10.0, 10.0), (10.0, 0.0)]


def test_strict_mypy_takes_right_code_of_a_user_and_sees_what_is_wrong(tmp_path, monkeypatch, request):
    api = pytest.importorskip("mypy.api", reason="mypy is not installed (extra dev)")
    files = {tmp_path / "right.py": RIGHT, tmp_path / "wrong.py": WRONG}
    for file, text in files.items():
        file.write_text(text, encoding="utf-8")
    monkeypatch.setenv("MYPYPATH", str(ROOT))
    monkeypatch.chdir(tmp_path)
    kept = getattr(request.config, "cache", None)  # pytest's own folder, so that numpy is looked at once
    cache = str(kept.mkdir("mypy") if kept is not None else tmp_path / "mypy")
    options = ["--strict", "--follow-imports=silent", f"--cache-dir={cache}", "--config-file=", "--no-pretty"]
    said, broken, _ = api.run([*options, "right.py", "wrong.py"])
    assert not broken
    errors = [line for line in said.splitlines() if ": error: " in line]
    assert {line.split(": error: ")[0] for line in errors} == {"wrong.py:4", "wrong.py:5", "wrong.py:6"}, said


def room():
    inner = [(2.0, 2.0), (4.0, 2.0), (4.0, 4.0), (2.0, 4.0)]
    return Walls.from_polylines(
        [SQUARE, inner, [(6.0, 6.0), (8.0, 8.0)]],
        [True, True, False],
        bulges=[None, [0.5, 0.0, 0.25, 0.0], None],
        sides=["both", "outward", "both"],
        material=[Material(), Material(0.5), Material(0.25)],
        names=["room", "pillar", "stick"],
        layers=["a", "b", "c"],
    )


def test_balls_are_taken_by_number_mask_and_slice():
    balls = Balls([(1, 2), (3, 4), (5, 6)], [(1, 0), (2, 0), (3, 0)], [0.1, 0.2, 0.3])
    for choice, kept in (([2, 0], [2, 0]), ([False, True, True], [1, 2]), (slice(None, None, -1), [2, 1, 0]), ([], [])):
        taken = balls.take(choice)
        assert taken.position.tolist() == balls.position[kept].tolist()
        assert taken.velocity.tolist() == balls.velocity[kept].tolist()
        assert taken.radius.tolist() == balls.radius[kept].tolist()
    assert len(balls.take(1)) == 1


def test_walls_are_taken_with_all_that_belongs_to_them():
    walls = room()
    taken = walls.take([2, 1])
    assert [wall.name for wall in taken] == ["stick", "pillar"]
    for new, old in zip(taken, (walls[2], walls[1]), strict=True):
        for name in ("layer", "closed", "depth", "sides", "material"):
            assert getattr(new, name) == getattr(old, name)
        for name in ("vertices", "bulges", "normals"):
            assert np.array_equal(getattr(new, name), getattr(old, name))
    assert walls.take(slice(None)) == walls
    assert len(walls.take([])) == 0
    assert walls.take([True, False, False])[0].name == "room"


def test_a_run_of_some_balls_is_the_run_that_they_make_alone():
    balls = Balls([(1, 5), (5, 1), (9, 9)], [(3.0, 2.0), (1.0, 4.0), (-2.0, -5.0)], [0.1, 0.2, 0.3])
    scene = Scene(Walls.from_polylines([SQUARE]), balls, sensors=Walls.from_polylines([[(0, 4), (9, 4)]], False))
    run = wallkit.simulate(scene, until=20.0)
    for choice in ([2, 0], [1], [], slice(None, None, -1)):
        taken, alone = (
            run.take(choice),
            wallkit.simulate(Scene(scene.walls, balls.take(choice), sensors=scene.sensors), 20.0),
        )
        assert taken.contacts.tobytes() == alone.contacts.tobytes()
        assert taken.final.tobytes() == alone.final.tobytes()
        assert taken.ending == alone.ending
        assert taken.position(7.5).tobytes() == alone.position(7.5).tobytes()


def test_straightened_walls_are_lines_within_the_distance_asked_for():
    circle = Walls.from_polylines([[(-1.0, 0.0), (1.0, 0.0)]], bulges=[[1.0, 1.0]])
    lines = circle.straightened(1e-3)
    assert not lines.has_arcs
    middles = (lines.vertices[lines.edge_starts] + lines.vertices[lines.edge_ends]) / 2
    sagitta = 1.0 - np.hypot(*middles.T)
    assert 0.0 < sagitta.max() <= 1e-3
    assert np.abs(np.hypot(*lines.vertices.T) - 1.0).max() < 1e-15  # vertices lie on the circle, but for rounding
    assert lines.measured_error == 1e-3
    assert len(lines.take([0])) == 1
    assert circle.take([0]).straightened(1e-3) == lines


def test_nothing_prints_more_than_two_lines():
    scene = Scene(room(), Balls(np.full((500, 2), 5.0), np.ones((500, 2))), gravity=(0.0, -9.81), sensors=room())
    drawing = wallkit.read_drawing_text(
        '<svg xmlns="http://www.w3.org/2000/svg"><path d="M0 0L9 9L3 4"/></svg>', "a.svg"
    )
    run = wallkit.simulate(scene, bounces=2)
    things = [run, scene, scene.walls, scene.balls, scene.walls[1], wallkit.survey(scene, bounces=2), drawing]
    things += [drawing.paths[0], wallkit.World(scene), wallkit.prepare(scene)]
    for thing in things:
        assert 10 < len(repr(thing)) < 300, repr(thing)
        assert repr(thing).count("\n") <= 1
        assert str(thing) == repr(thing)
    assert repr(scene.balls) == "<Balls: 500, radius 0, speed 1.41421>"
    assert repr(scene.walls) == "<Walls: 3 walls (1 open), 9 edges (2 arcs), 10 x 10, y up>"
    assert repr(drawing) == "<Drawing: SVG 'a.svg', 1 path, 1 subpath with 2 segments, px, y down>"
    assert repr(run).startswith("<Run: 500 balls, 1,000 bounces in ")


def test_a_run_of_nothing_prints_too():
    scene = Scene(Walls.from_polylines([]))
    assert repr(scene) == "<Scene: <Walls: 0 walls, 0 edges, 0 x 0, y up>, <Balls: 0>>"
    assert repr(wallkit.simulate(scene, until=1.0)) == "<Run: 0 balls, 0 bounces in 0 s>"


def test_balls_do_not_change_under_a_scene():
    balls = Balls((1, 2), (3, 4), 1)
    with pytest.raises(AttributeError):
        balls.radius = -1.0
    with pytest.raises(WallkitError):
        Balls((1, 2), (3, 4), -1)
