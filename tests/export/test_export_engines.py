"""Levels in engines of Python, C and C++: balls stay inside, and with the winding reversed they do not."""

from __future__ import annotations

import importlib.util
import json
import math
from pathlib import Path

import numpy as np
import pytest
from levels import TABLE, Start, program, run, sample, text_of, three_walls

import wallkit
from wallkit.walls import Material

SECONDS = 30.0
SPEED = 6.0  # m/s in levels of 20 m; every bounce of it is above the engines' 1 m/s

C_PROGRAM = Path(__file__).parent / "engines"


def loaded(text):
    module = {}
    exec(compile(text, "level.py", "exec"), module)
    return module


def pymunk_ball(space, x, y, radius, velocity):
    import pymunk

    body = pymunk.Body(1.0, math.inf)
    body.position, body.velocity = (x, y), velocity
    shape = pymunk.Circle(body, radius)
    shape.elasticity, shape.friction, shape.filter = 1.0, 0.0, pymunk.ShapeFilter(group=1)
    space.add(body, shape)
    return body


@pytest.mark.parametrize("name", TABLE)
def test_pymunk_keeps_all_balls_inside(name):
    pymunk = pytest.importorskip("pymunk")
    start, space = Start(sample(name), "down", False), pymunk.Space()
    loaded(text_of(sample(name), "pymunk"))["add_walls"](space)
    speed = 300.0  # px/s; a step of 1/240 s is then 1.25 px, below the radius
    balls = [pymunk_ball(space, start.x, start.y, start.radius, velocity) for velocity in start.velocities(speed)]
    for _ in range(int(SECONDS * 240)):
        space.step(1 / 240)
    assert start.lost([ball.position for ball in balls]) == 0
    speeds = [ball.velocity.length for ball in balls]
    assert max(speeds) < 1.1 * speed  # with neighbours known, seams give at most some hundredths


def test_pymunk_gives_back_the_walls_part_and_passes_one_way_walls_from_behind():
    pymunk = pytest.importorskip("pymunk")
    line = [(100.0, 0.0), (100.0, 100.0)]  # outward is (dy, -dx): to the right
    walls = wallkit.Walls.from_polylines([line], False, sides="outward", material=Material(0.8, 1.0))
    walls.y_axis = "down"
    for x, vx, after in ((150.0, -60.0, 48.0), (50.0, 60.0, 60.0)):
        space = pymunk.Space()
        loaded(text_of(walls, "pymunk"))["add_walls"](space)
        ball = pymunk_ball(space, x, 50.0, 5.0, (vx, 0.0))
        for _ in range(480):
            space.step(1 / 240)
        assert ball.velocity.x == pytest.approx(after, rel=1e-9)


def box2d_places(build, start, *flags):
    out = run([str(build), *map(repr, (start.x, start.y, start.radius, SPEED, SECONDS))])
    return json.loads(out)


def compiled(tmp_path, compiler, source, walls, name, ending, *flags):
    (tmp_path / f"level{ending}").write_text(text_of(walls, name), encoding="utf-8")
    built = tmp_path / "game"
    run([compiler, "-O1", f"-I{tmp_path}", str(C_PROGRAM / source), "-o", str(built), *flags])
    return built


def box2d_v3(tmp_path, walls):
    found = importlib.util.find_spec("pyb2d3")
    if found is None or found.origin is None:
        pytest.skip("Box2D v3 is not installed: its headers and library come with the package pyb2d3")
    home = Path(found.origin).resolve().parents[1]
    library = next(home.glob("lib*/libbox2d.a"), None)
    if library is None:
        pytest.skip("pyb2d3 is installed without the headers and library of Box2D")
    flags = [f"-I{home / 'include'}", str(library), "-lm", "-lpthread"]
    return compiled(tmp_path, program("gcc"), "box2d_v3.c", walls, "box2d-v3", ".h", *flags)


def box2d_v24(tmp_path, walls):
    if not Path("/usr/include/box2d/b2_world.h").exists():
        pytest.skip("Box2D 2.4 is not installed (Debian's libbox2d-dev)")
    return compiled(tmp_path, program("g++"), "box2d_v24.cpp", walls, "box2d-v24", ".hpp", "-lbox2d")


def inside_out(walls):
    """The same closed walls, each reversed: their normals point into the material."""
    assert walls.closed.all()
    result = wallkit.Walls.from_polylines([wall.vertices[::-1] for wall in walls])
    result.depth, result.y_axis = walls.depth, walls.y_axis
    return result


@pytest.mark.parametrize("name", ["room.svg", "lagoon.ai"])
@pytest.mark.parametrize("build", [box2d_v3, box2d_v24])
def test_box2d_keeps_all_balls_inside(build, name, tmp_path):
    start = Start(sample(name), "up", True)
    assert start.lost(box2d_places(build(tmp_path, sample(name)), start)) == 0


@pytest.mark.parametrize("build", [box2d_v3, box2d_v24])
def test_box2d_loses_balls_when_the_winding_is_reversed(build, tmp_path):
    start = Start(sample("sinai.svg"), "up", True)
    (tmp_path / "right").mkdir()
    assert start.lost(box2d_places(build(tmp_path / "right", sample("sinai.svg")), start)) == 0
    assert start.lost(box2d_places(build(tmp_path, inside_out(sample("sinai.svg"))), start)) > 0


@pytest.mark.parametrize("build", [box2d_v3, box2d_v24])
def test_names_triangles_and_open_walls_compile(build, tmp_path):
    walls = three_walls(names=['say "?\\', "Wände\n", ""], layers=["a", "a", "\N{TENNIS RACQUET AND BALL}"])
    build(tmp_path, walls)


@pytest.mark.parametrize("name", ["sinai.svg", "pinball.svg"])
def test_box2d_of_python_loads_the_rube_file_and_keeps_all_balls_inside(name):
    box2d = pytest.importorskip("Box2D")
    start, whole = Start(sample(name), "up", True), json.loads(text_of(sample(name), "rube"))
    world = box2d.b2World(gravity=(0, 0))
    (walls,) = whole["body"]
    body = world.CreateStaticBody(position=tuple(walls["position"].values()))
    for fixture in walls["fixture"]:
        vertices = list(zip(fixture["chain"]["vertices"]["x"], fixture["chain"]["vertices"]["y"], strict=True))
        loop = "prevVertex" in fixture["chain"]
        assert loop == (vertices[0] == vertices[-1])
        shape = box2d.b2ChainShape(**({"vertices_loop": vertices[:-1]} if loop else {"vertices_chain": vertices}))
        body.CreateFixture(shape=shape, friction=fixture["friction"], restitution=fixture["restitution"])
    balls = []
    for velocity in start.velocities(SPEED):
        ball = world.CreateDynamicBody(position=(start.x, start.y), linearVelocity=velocity, bullet=True)
        shape = box2d.b2CircleShape(radius=start.radius)
        ball.CreateFixture(shape=shape, density=1, friction=0, restitution=0, groupIndex=-1)
        balls.append(ball)
    for _ in range(int(SECONDS * 60)):
        world.Step(1 / 60, 8, 3)
    assert start.lost([tuple(ball.position) for ball in balls]) == 0


def test_close_vertices_are_merged_for_box2d_and_it_is_said():
    from levels import problems_of

    close = [(0.0, 0.0), (10.0, 0.0), (10.0, 0.001), (10.0, 10.0), (0.0, 10.0)]
    walls = wallkit.Walls.from_polylines([close], names=["box"])
    (fixture,) = json.loads(text_of(walls, "rube"))["body"][0]["fixture"]
    assert len(fixture["chain"]["vertices"]["x"]) == 5  # four, and the first again
    (merged,) = [problem for problem in problems_of(walls, "rube") if problem.code == "export-merged"]
    assert merged.message.startswith("1 of 1 wall")
    kept = json.loads(text_of(walls, "rube", min_spacing=0.0))["body"][0]["fixture"][0]
    assert len(kept["chain"]["vertices"]["x"]) == 6


def test_every_edge_of_the_sample_is_in_the_python_module():
    walls = sample("room.svg")
    listed = loaded(text_of(walls, "pymunk"))["WALLS"]
    for entry, wall in zip(listed, walls, strict=True):
        assert np.array_equal(entry["points"], wall.vertices)
        assert (entry["name"], entry["closed"]) == (wall.name, wall.closed)
