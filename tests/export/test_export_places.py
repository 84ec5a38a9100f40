"""Where a level ends up: origin, mirror, scale, grid; one room drawn with y up or down is the same game."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
from levels import problems_of, sample, text_of, three_walls

import wallkit
from wallkit.export import ExportError, ExportOptions, build_level
from wallkit.export.level import signed_areas_of
from wallkit.scene.scene import Balls, Scene


def mirrored(walls, about):
    """The same room drawn in a program whose y axis points the other way, reversed as the import would do."""
    lines = [wall.vertices * [1, -1] + [0, about] for wall in walls]
    lines = [line[::-1] if wall.closed else line for line, wall in zip(lines, walls, strict=True)]
    result = wallkit.Walls.from_polylines(lines, [wall.closed for wall in walls], sides=walls.sides)
    result.depth = walls.depth
    result.y_axis = "up" if walls.y_axis == "down" else "down"
    return result


def test_a_mirror_keeps_material_on_the_left_and_one_way_walls_facing_the_same_way():
    walls = three_walls(sides=["both", "outward", "outward"])
    level = build_level(walls, ExportOptions(), y_axis="down")
    assert np.sign(signed_areas_of(level.walls[:2])).tolist() == [1, -1]
    assert level.walls[0].vertices.tolist() == [[0, 6], [0, 0], [8, 0], [8, 6]]
    assert level.walls[2].vertices.tolist() == [[7, 3], [7, 5], [5, 5]]  # outward was below and right, and still is


def test_bulges_survive_a_mirror():
    half = wallkit.Walls.from_polylines([[(0.0, 0.0), (2.0, 0.0)]], bulges=[[1.0, 0.0]])
    half.y_axis = "up"  # bulge 1 from (0, 0) to (2, 0) bows to the right: down to y = -1
    (wall,) = build_level(half, ExportOptions(origin=(0, 0)), y_axis="down", arcs=True).walls
    assert wall.vertices.tolist() == [[0, 0], [2, 0]]
    assert wall.bulges.tolist() == [0.0, 1.0]  # from (2, 0) back to (0, 0), right of that is y = +1 in the numbers
    assert signed_areas_of([wall]) == pytest.approx([np.pi / 2])


@pytest.mark.parametrize("name", ["room.svg", "pinball.svg"])
def test_one_room_drawn_with_y_up_or_down_gives_the_same_level(name):
    drawn = sample(name)
    other = mirrored(drawn, 1024.0)
    for target in ("up", "down"):
        one, two = (build_level(walls, ExportOptions(origin="box"), y_axis=target) for walls in (drawn, other))
        for a, b in zip(one, two, strict=True):
            assert {tuple(p) for p in np.round(a.vertices, 9)} == {tuple(p) for p in np.round(b.vertices, 9)}
            if a.closed:
                assert signed_areas_of([a]) == pytest.approx(signed_areas_of([b]), abs=1e-7)


def test_the_same_game_is_played_in_both():
    drawn = replace(three_walls(), y_axis="down")
    games = []
    for walls in (drawn, mirrored(drawn, 6.0)):
        level = build_level(walls, ExportOptions(origin="box"), y_axis="down")
        placed = wallkit.Walls.from_polylines([w.vertices for w in level], [w.closed for w in level])
        run = wallkit.simulate(Scene(placed, balls=Balls([[1.0, 5.0]], [[1.0, -0.7]], 0.25)), bounces=20)
        games.append(np.array([run.contacts[column] for column in ("time", "x", "y")]))
    assert games[0].shape == (3, 20)
    assert games[0] == pytest.approx(games[1], abs=1e-9)


def test_the_page_the_box_or_a_point_is_the_origin():
    walls = three_walls()  # y up, 0..8 x 0..6

    def first(target, **options):
        return build_level(walls, ExportOptions(**options), y_axis=target).walls[2].vertices.min(axis=0).tolist()

    assert first("up") == [5, 1]
    assert first("down") == [5, 3]  # no page is known: mirrored about the top of the box
    assert first("down", page=(-1.0, -2.0, 20.0, 10.0)) == [6, 7]  # the upper left corner (-1, 10)
    assert first("up", page=(-1.0, -2.0, 20.0, 10.0)) == [6, 3]
    assert first("down", origin="3,4") == [2, 1]
    assert first("up", origin=(3, 4)) == [2, -3]
    assert first("up", origin="box", scale=2.0) == [10, 2]


def test_a_map_is_as_large_as_the_page_and_walls_off_it_are_told():
    walls = replace(three_walls(), y_axis="down")
    whole = json.loads(text_of(walls, "tmj", page=(0.0, 0.0, 640.0, 321.0)))
    assert (whole["width"], whole["height"]) == (20, 11)  # tiles of 32
    moved = replace(walls, vertices=walls.vertices - [3.0, 0.0])
    (problem,) = problems_of(moved, "tmj")
    assert problem.code == "export-outside"
    assert problem.message.startswith("2 of 3 walls")
    assert problems_of(moved, "tmj", origin="box") == []


def test_a_grid_rounds_and_says_how_far_and_walls_that_vanish_are_told():
    line = [(0.0, 0.0), (0.3, 0.2)]
    walls = wallkit.Walls.from_polylines([[(0.1, 0.0), (7.9, 0.0), (4.0, 5.6)], line], [True, False], names=["t", "x"])
    level = build_level(walls, ExportOptions(grid=1.0), y_axis="up")
    assert level.walls[0].vertices.tolist() == [[0, 0], [8, 0], [4, 6]]
    found = {problem.code: problem for problem in level.findings.problems}
    assert set(found) == {"export-rounded", "export-left-out"}
    assert "0.4" in found["export-rounded"].message
    assert found["export-left-out"].name == "x"
    assert found["export-left-out"].severity == "warning"


@pytest.mark.parametrize(
    "wrong",
    [
        {"scale": 0.0},
        {"grid": -1.0},
        {"origin": "left"},
        {"origin": "1,2,3"},
        {"origin": (float("nan"), 0.0)},
        {"max_vertices": 2},
        {"tolerance": float("inf")},
        {"colour": "red"},
    ],
)
def test_wrong_options_are_named(wrong, tmp_path):
    with pytest.raises(ExportError) as caught:
        three_walls().export(tmp_path / "level.tmj", **wrong)
    assert caught.value.code == "bad-option"
    assert next(iter(wrong)).replace("_", "-") in caught.value.message
    assert not (tmp_path / "level.tmj").exists()
