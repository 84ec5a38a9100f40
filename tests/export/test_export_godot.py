"""Godot scenes: read by godot_parser, and played by Godot 3 itself without a window."""

from __future__ import annotations

import json

import numpy as np
import pytest
from levels import TABLE, Start, problems_of, program, run, sample, text_of, three_walls

import wallkit
from wallkit.export import ExportOptions, build_level
from wallkit.walls import Material

SECONDS = 30
GAME = """
extends SceneTree

# Six balls that slide and bounce in the level, and the two checks of walls on their way: places as JSON at the end.
func _init():
    var file = File.new()
    file.open("res://game.json", File.READ)
    var game = parse_json(file.get_as_text())
    file.close()
    var level = load("res://level.tscn").instance()
    get_root().add_child(level)
    var balls = []
    for velocity in game["velocities"]:
        var ball = RigidBody2D.new()
        var shape = CollisionShape2D.new()
        shape.shape = CircleShape2D.new()
        shape.shape.radius = game["radius"]
        ball.add_child(shape)
        ball.position = Vector2(game["x"], game["y"])
        ball.gravity_scale = 0
        ball.linear_damp = 0
        ball.linear_velocity = Vector2(velocity[0], velocity[1])
        ball.can_sleep = false
        ball.collision_layer = 2
        ball.collision_mask = 1
        ball.continuous_cd = RigidBody2D.CCD_MODE_CAST_SHAPE
        ball.physics_material_override = PhysicsMaterial.new()
        ball.physics_material_override.friction = 0
        get_root().add_child(ball)
        balls.append(ball)
    for _step in range(int(game["seconds"] * 60)):
        yield(self, "physics_frame")
    var places = []
    var speeds = []
    for ball in balls:
        places.append([ball.position.x, ball.position.y])
        speeds.append(ball.linear_velocity.length())
    var names = []
    for child in level.get_children():
        var notes = child.get_meta_list()
        names.append(child.get_meta("wallkit_name") if "wallkit_name" in notes else child.name)
    print("RESULT " + to_json({"places": places, "speeds": speeds, "names": names}))
    quit()
"""


def play(tmp_path, walls, x, y, radius, velocities, seconds):
    godot = program("godot3-server", "godot3")
    game = {"x": x, "y": y, "radius": radius, "velocities": velocities, "seconds": seconds}
    (tmp_path / "level.tscn").write_text(text_of(walls, "tscn3"), encoding="utf-8")
    (tmp_path / "game.json").write_text(json.dumps(game))
    (tmp_path / "game.gd").write_text(GAME.replace("    ", "\t"))
    (tmp_path / "project.godot").write_text("config_version=4\n")
    home = {"HOME": str(tmp_path), "PATH": "/usr/bin:/bin:/usr/games"}
    out = run([godot, "--path", str(tmp_path), "--fixed-fps", "60", "-s", "game.gd"], env=home)
    (line,) = [line for line in out.splitlines() if line.startswith("RESULT ")]
    return json.loads(line.removeprefix("RESULT "))


@pytest.mark.parametrize("name", ["room.svg", "pinball.svg"])
def test_godot_keeps_all_balls_inside(name, tmp_path):
    start = Start(sample(name), "down", False)
    result = play(tmp_path, sample(name), start.x, start.y, start.radius, start.velocities(150.0), SECONDS)
    assert start.lost(result["places"]) == 0


def test_godot_keeps_names_takes_the_walls_bounce_and_passes_one_way_walls_from_behind(tmp_path):
    lines = [[(100.0, 0.0), (100.0, 400.0)], [(0.0, 300.0), (300.0, 300.0)]]  # outward: right, and up on the screen
    names = ["a/b", "Wände"]
    materials = [Material(0.8, 1.0), Material(1.0, 1.0)]
    walls = wallkit.Walls.from_polylines(lines, False, sides="outward", names=names, material=materials)
    walls.y_axis = "down"
    result = play(tmp_path, walls, 200.0, 100.0, 5.0, [[-150.0, 0.0], [0.0, 150.0]], 2)
    assert result["names"] == names
    # Met from the right: 0.8 of it. Godot finds the ball some way inside the wall, and its push out of there is 1 % off
    assert result["speeds"][0] == pytest.approx(120, rel=0.02)
    assert result["places"][0][0] > 100
    assert result["places"][1][1] < 300  # met from above, as drawn outward
    (tmp_path / "behind").mkdir()
    result = play(tmp_path / "behind", walls, 50.0, 350.0, 5.0, [[150.0, 0.0], [0.0, -150.0]], 2)
    assert result["places"][0][0] > 300
    assert result["places"][1][1] < 100
    assert result["speeds"] == pytest.approx([150, 150], rel=1e-3)


@pytest.mark.filterwarnings("ignore::DeprecationWarning")  # godot_parser calls pyparsing by its old words
@pytest.mark.parametrize("name", ["room.svg", "mushroom.svg", "pinball.svg", "stadium.svg"])
def test_godot_parser_reads_every_bit_of_scene_format_3(name):
    godot_parser = pytest.importorskip("godot_parser")
    walls = sample(name)
    scene = godot_parser.parse(text_of(walls, "tscn"))
    nodes = list(scene.get_sections("node"))
    polygons = [section["polygon"] for section in nodes if section.header.attributes["type"] == "CollisionPolygon2D"]
    rings = [wall for wall in walls if wall.closed]
    assert len(polygons) == len(rings)
    for polygon, wall in zip(polygons, rings, strict=True):
        assert np.array_equal(np.reshape(polygon.args, (-1, 2)), wall.vertices)
    assert all(section["build_mode"] == 1 for section in nodes if "polygon" in section.properties)
    resources = scene.get_sections("sub_resource")
    assert scene.get_sections("gd_scene")[0].header.attributes["load_steps"] == len(resources) + 1


@pytest.mark.parametrize("format", ["tscn", "tscn3"])
def test_nodes_have_names_that_godot_allows_and_no_two_alike(format):
    names = ["cabinet", "cabinet", 'a.:@/"%b']
    text = text_of(three_walls(names=names), format)
    bodies = [line for line in text.splitlines() if 'type="StaticBody2D"' in line]
    assert [line.split('"')[1] for line in bodies] == ["cabinet", "cabinet 2", "a______b"]
    (problem,) = [
        problem for problem in problems_of(three_walls(names=names), format) if problem.code != "export-rounded"
    ]
    assert (problem.code, problem.name) == ("export-renamed", "cabinet")
    assert "2 of 3 walls" in problem.message


def test_one_way_edges_look_along_the_outward_normal():
    square = wallkit.Walls.from_polylines([[(0.0, 0.0), (8.0, 0.0), (8.0, 6.0), (0.0, 6.0)]], sides="outward")
    square.y_axis = "down"
    lines = text_of(square, "tscn").splitlines()
    angles = [float(line.split("= ")[1]) for line in lines if line.startswith("rotation")]
    up = np.column_stack([np.sin(angles), -np.cos(angles)])  # the node's own (0, -1), turned
    (wall,) = build_level(square, ExportOptions(), y_axis="down").walls
    assert up == pytest.approx(square[0].normals, abs=1e-15)
    assert lines.count("one_way_collision = true") == len(wall.vertices)


def test_all_samples_have_a_scene_for_both_versions():
    for name in TABLE:
        for format, word in (("tscn", "PackedVector2Array"), ("tscn3", "PoolVector2Array")):
            assert text_of(sample(name), format).count(word) == TABLE[name][0]
