"""Snapping: ends move along their own lines, no straight wall bends, nothing new crosses, and its advice ends."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
import shapely
from drawn import circle, codes, drawing, line, path
from hypothesis import given, settings
from hypothesis import strategies as st

from wallkit.walls import Walls
from wallkit.walls.importing.pipeline import import_walls
from wallkit.walls.repairing.loose_walls import to_lines
from wallkit.walls.repairing.passes import repair
from wallkit.walls.repairing.repairs import Repairs
from wallkit.walls.repairing.snapping import snap_ends

# A frame that is not quite closed, drawn in two strokes; a post from its top; one that sticks out at the bottom by 0.9.
FRAME, LEFT = [(10, 10), (90, 10), (90, 60), (10.4, 60)], [(10, 59.5), (10, 10.3)]
POST, STICK = [(30, 10), (30, 40)], [(60, 60.9), (60, 30), (75, 20)]


def strokes(*lines):
    return drawing(*(path(line(*points), stroke="#000000") for points in lines))


def advice(walls):
    """The figures that problems propose for --snap."""
    return [float(figure) for problem in walls.problems for figure in re.findall(r"--snap ([\d.e-]+)", problem.fix)]


def test_what_sticks_out_is_told_with_its_length_and_trimmed():
    walls = import_walls(strokes(FRAME, LEFT, STICK))
    (problem,) = (p for p in walls.problems if p.code == "overshoot")
    assert problem.message == "an open end sticks out 0.9 beyond another wall"
    assert "crossing" not in codes(walls)
    mended = import_walls(strokes(FRAME, LEFT, STICK), repairs=Repairs(snap=0.91))
    (stick,) = (wall for wall in mended if not wall.closed)
    assert sorted(stick.vertices.tolist()) == [[60, 30], [60, 60], [75, 20]]


def test_a_frame_of_strokes_stays_straight_and_closes():
    walls = import_walls(strokes(FRAME, LEFT, POST, STICK), repairs=Repairs(snap=1))
    (frame,) = (wall for wall in walls if wall.closed)
    assert sorted(frame.vertices.tolist()) == [[10, 10], [10, 60], [90, 10], [90, 60]]
    assert [problem for problem in walls.problems if problem.severity != "info"] == []


@pytest.mark.parametrize(
    "lines",
    [
        [FRAME, LEFT, POST, STICK],
        [[(0, 0), (50, 0)], [(20, 0.3), (45, 9)], [(10, -0.5), (30, 12)]],
        [[(0, 0), (50, 20)], [(50.2, 20.3), (50, 60)], [(49, 19), (80, 0)]],
    ],
)
def test_following_the_advice_ends(lines):
    asked = [max(advice(import_walls(strokes(*lines))))]
    for _ in range(5):
        left = advice(import_walls(strokes(*lines), repairs=Repairs(snap=asked[-1])))
        if not left:
            break
        assert max(left) > asked[-1]
        asked.append(max(left))
    assert not left


def test_an_end_is_drawn_on_along_its_own_line():
    walls = repair(Walls.from_polylines([[(0, 0), (10, 0)], [(5, 4), (6, 1)]], closed=False), Repairs(snap=1.1)).walls
    # from (6, 1) on by (1, -3) / 3
    assert walls.vertices[2:].ravel() == pytest.approx([5, 4, 6 + 1 / 3, 0])
    assert walls.vertices[3, 1] == 0


def test_an_end_is_drawn_on_to_an_arc_itself():
    walls = import_walls(
        drawing(path(circle(0, 0, 10)), path(line((15, 6), (10.1, 6)))), curves="arcs", repairs=Repairs(snap=3)
    )
    (stick,) = (wall for wall in walls if not wall.closed)
    assert np.hypot(*stick.vertices[-1]) == pytest.approx(10, rel=1e-15)
    assert stick.vertices[-1, 1] == 6
    assert [problem.code for problem in walls.problems if problem.severity != "info"] == []


def test_an_arc_that_sticks_out_is_shortened_and_keeps_its_circle():
    """A quarter circle from (10, 0), 0.5 above the floor y = 0.5 at its start."""
    arc = [("M", 10, 0), ("A", 10, 10, 0, 0, 1, 0, 10)], False
    floor = line((-20, 0.5), (20, 0.5))
    walls = import_walls(drawing(path(arc), path(floor)), curves="arcs", repairs=Repairs(snap=0.6))
    wall = next(wall for wall in walls if wall.bulges.any())
    assert wall.vertices[0] == pytest.approx([math.sqrt(100 - 0.25), 0.5])
    assert wall.bulges[0] == pytest.approx(math.tan((math.pi / 2 - math.asin(0.05)) / 4))
    assert [problem.code for problem in walls.problems if problem.severity != "info"] == []


def test_a_curve_whose_start_is_within_the_snap_of_its_own_next_edges_is_left_alone():
    t = np.linspace(0, math.pi, 40)
    arch = np.stack([30 * np.cos(t), 30 * np.sin(t)], axis=1)
    done = repair(Walls.from_polylines([arch], closed=False), Repairs(snap=3.0))
    assert done.changes == []


def test_no_edge_is_added_across_a_wall():
    """Two ends 1 apart with a wall between, which both stop short of."""
    lines = [[(0, 0), (9.5, 0)], [(10.5, 0.1), (20, 0.1)], [(10, -5), (10, 5)]]
    walls = import_walls(strokes(*lines), repairs=Repairs(snap=1.2))
    assert [wall.vertices.tolist() for wall in walls][:2] == [[[0, 0], [10, 0]], [[10, 0.1], [20, 0.1]]]
    assert "crossing" not in codes(walls)


def proper_crossings(lines):
    shapes = [shapely.LineString(one.vertices) for one in lines]
    return {(i, j) for i, one in enumerate(shapes) for j, two in enumerate(shapes) if i < j and _cross(one, two)}


def _cross(one, two):
    """They meet farther than rounding from all ends."""
    ends = shapely.MultiPoint([one.coords[0], one.coords[-1], two.coords[0], two.coords[-1]])
    met = shapely.get_parts(one.intersection(two))
    return bool((shapely.distance(met, ends) > 1e-9).any())


@settings(max_examples=40)
@given(st.integers(0, 100_000), st.floats(0.1, 3))
def test_random_sticks_stay_straight_and_cross_nothing_new(seed, snap):
    rng = np.random.default_rng(seed)
    start = rng.uniform(0, 20, (10, 2))
    angle = rng.uniform(0, 2 * math.pi, 10)
    along = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    sticks = np.stack([start, start + rng.uniform(4, 12, 10)[:, None] * along], axis=1)
    before = to_lines(Walls.from_polylines(list(sticks), closed=False))
    after, *_ = snap_ends(before, snap)
    assert proper_crossings(after) <= proper_crossings(before)
    for stick, left in zip(sticks, after, strict=True):
        (dx, dy), (x, y) = stick[1] - stick[0], (left.vertices - stick[0]).T
        off = np.abs(dx * y - dy * x) / math.hypot(dx, dy)
        # two vertices stay on the stick's line; what else is there are edges that were added at its ends
        assert (off < 1e-9).sum() >= 2
    again, count, *_ = snap_ends(after, snap)
    assert count == 0
    assert all((a.vertices == b.vertices).all() for a, b in zip(again, after, strict=True))
