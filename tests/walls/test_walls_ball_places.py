"""Balls and goals in material, and in rooms that nothing leads out of."""

from __future__ import annotations

import math

import numpy as np
import pytest
from drawn import drawing, line, path, polygon, square

from wallkit.walls import Walls
from wallkit.walls.checking.ball_places import ball_problems, goal_problems
from wallkit.walls.checking.free_space import free_space
from wallkit.walls.checking.leaks import leak_problems, reach_of
from wallkit.walls.importing.pipeline import import_walls

# A thick frame, open to the right by 30, with a solid block in it.
OPEN_FRAME = [(0, 0), (300, 0), (300, 85), (280, 85), (280, 20), (20, 20),
              (20, 180), (280, 180), (280, 115), (300, 115), (300, 200), (0, 200)]  # fmt: skip
BLOCK = square(150, 60, 80)
IN_BLOCK, BESIDE = (190.0, 100.0), (60.0, 100.0)


def found(walls, *balls, radius=5.0):
    places = np.array(balls, dtype=float).reshape(-1, 2)
    problems = ball_problems(free_space(walls), walls, places, np.full(len(places), radius))
    return [(problem.code, problem.name, (problem.x, problem.y)) for problem in problems]


@pytest.mark.parametrize("balls", [(IN_BLOCK, BESIDE), (BESIDE, IN_BLOCK)])
def test_a_leak_is_found_whichever_ball_is_drawn_first(balls):
    walls = import_walls(drawing(path(polygon(*OPEN_FRAME)), path(BLOCK, name="block")))
    space = free_space(walls)
    reach = reach_of(space, walls, 5.0, np.array(balls))
    assert [problem.code for problem in leak_problems(space, reach)] == ["leak"]
    assert [gap.width for gap in space.leaks(5)] == [30]
    assert found(walls, *balls) == [("ball-in-material", "block", IN_BLOCK)]


def test_a_ball_in_material_does_not_turn_the_level_inside_out():
    frame = path(square(0, 0, 200), name="frame"), path(square(10, 10, 180), name="inside")
    walls = import_walls(drawing(*frame, path(square(120, 50, 40), name="block")))
    assert found(walls, (140, 70), (40, 100)) == [("ball-in-material", "block", (140, 70))]
    # it touches x = 10, y = 190 and the corner (120, 90): (110 - r)^2 + (100 - r)^2 = r^2
    assert free_space(walls).closed_rooms[:, 2].max() == pytest.approx(210 - math.sqrt(22000), rel=1e-6)


def test_a_ball_outside_all_rooms_is_told():
    walls = import_walls(drawing(path(square(0, 0, 50)), path(square(20, 20, 5))), arena=True)
    assert found(walls, (10, 10), (70, 10)) == [("ball-in-material", "", (70, 10))]


def vault(opening=0.0):
    """A thick box 40 wide, with an opening in its right side."""
    if not opening:
        return [path(square(100, 100, 40), name="vault"), path(square(105, 105, 30), name="hollow")]
    low, high = 120 - opening / 2, 120 + opening / 2
    ring = [(100, 100), (140, 100), (140, low), (135, low), (135, 105), (105, 105),
            (105, 135), (135, 135), (135, high), (140, high), (140, 140), (100, 140)]  # fmt: skip
    return [path(polygon(*ring), name="vault")]


@pytest.mark.parametrize(("opening", "codes"), [(0.0, ["shut-in"]), (12.0, [])])
def test_a_ball_in_a_vault_without_opening_is_shut_in(opening, codes):
    walls = import_walls(drawing(path(square(0, 0, 200)), path(square(10, 10, 180)), *vault(opening)))
    assert [code for code, *_ in found(walls, (50, 50), (120, 120))] == codes


def test_a_single_ball_in_a_box_of_its_own_is_shut_in_by_the_room_around():
    walls = import_walls(drawing(path(square(0, 0, 200)), path(square(10, 10, 180)), *vault()))
    assert found(walls, (120, 120)) == [("shut-in", "", (120, 120))]
    assert found(walls, (50, 50)) == []


def test_a_vault_in_the_open_holds_its_ball():
    walls = import_walls(drawing(*vault(), path(line((0, 0), (300, 0)))))
    assert found(walls, (50, 50), (120, 120)) == [("shut-in", "", (120, 120))]


def test_balls_in_a_plain_outline_are_in_a_room():
    assert found(import_walls(drawing(path(square(0, 0, 50)))), (10, 10), (40, 40)) == []


@pytest.mark.parametrize(("opening", "codes"), [(0.0, ["unreachable"]), (12.0, [])])
def test_a_goal_that_walls_part_from_every_ball_is_told(opening, codes):
    walls = import_walls(drawing(path(square(0, 0, 200)), path(square(10, 10, 180)), *vault(opening)))
    goal = Walls.from_polylines([[(110, 110), (110, 130)]], closed=False, names=["goal"])
    problems = goal_problems(free_space(walls), goal, np.array([[50.0, 50.0]]))
    assert [problem.code for problem in problems] == codes
    assert [problem.name for problem in problems] == ["goal"] * len(codes)


def test_no_walls_have_no_balls_in_them():
    assert found(Walls.from_polylines([]), (1, 2)) == []
