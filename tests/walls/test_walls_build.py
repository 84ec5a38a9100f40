"""From a drawing to walls: what is taken, what is closed, how it is nested, what is reported."""

from __future__ import annotations

import numpy as np
import pytest
from drawn import circle, codes, drawing, line, path, polygon, square

from importers.errors import LimitError
from wallkit.walls.importing.pipeline import import_walls
from wallkit.walls.walls import WallsError

PASTED = [("M", 24, 803), ("L", 69, 828), ("L", 108, 775), ("L", 31, 757), ("L", 24, 803)]


def test_pasted_text_becomes_a_closed_wall_of_its_own_numbers():
    walls = import_walls(drawing(path((PASTED, False))))
    assert walls.closed.tolist() == [True]
    assert sorted(map(tuple, walls.vertices.tolist())) == [(24, 803), (31, 757), (69, 828), (108, 775)]
    assert walls.problems == []
    middle = (walls.vertices[walls.edge_starts] + walls.vertices[walls.edge_ends]) / 2
    centre = walls.vertices.mean(axis=0)  # of a convex quadrilateral: every outward normal points away from it
    assert (((middle - centre) * walls.normals).sum(axis=1) > 0).all()
    assert np.allclose(np.hypot(*walls.normals.T), 1, rtol=1e-15)


def test_winding_in_the_file_never_decides():
    for clockwise in (False, True):
        outer = path(square(0, 0, 30, clockwise))
        hole = path(square(5, 5, 20, clockwise))
        island = path(square(10, 10, 5, clockwise))
        walls = import_walls(drawing(island, outer, hole))
        assert walls.depth.tolist() == [2, 0, 1]
        material = walls.to_shapely().geoms[0]
        assert material.area == 30 * 30 - 20 * 20 + 5 * 5
        for wall in walls:
            middle = (wall.vertices + np.roll(wall.vertices, -1, axis=0)) / 2
            from shapely import points

            assert not material.contains(points(middle + 0.1 * wall.normals)).any()
            assert material.contains(points(middle - 0.1 * wall.normals)).all()


def test_arena_is_solid_outside():
    walls = import_walls(drawing(path(square(0, 0, 30)), path(square(5, 5, 5))), arena=True)
    assert walls.depth.tolist() == [1, 2]
    assert walls[0].normals[0].tolist() in ([1.0, 0.0], [0.0, 1.0])  # into the room


def test_what_is_left_out_is_counted_by_kind():
    walls = import_walls(
        drawing(
            path(square(0, 0, 9)),
            path(square(0, 0, 9), guide=True),
            path(square(1, 0, 9), guide=True),
            path(square(0, 0, 9), clip=True),
            path(square(0, 0, 9), visible=False),
            path(circle(3, 3, 1), layer="balls"),
        )
    )
    assert len(walls) == 1
    messages = {problem.code: problem.message for problem in walls.problems}
    assert messages["left-out-guide"].startswith("2 paths")
    assert set(messages) == {"left-out-guide", "left-out-clip", "left-out-hidden", "left-out-balls"}
    assert {problem.severity for problem in walls.problems} == {"info"}


def test_hidden_paths_on_request():
    walls = import_walls(drawing(path(square(0, 0, 9), visible=False)), hidden=True)
    assert len(walls) == 1


def test_layers_by_glob_of_layer_or_group():
    d = drawing(
        path(square(10, 10, 1), layer="Walls 1"),
        path(square(0, 0, 2), layer="x", groups=("Walls 2",)),
        path(square(0, 0, 3)),
    )
    walls = import_walls(d, layers=["Walls*"])
    assert len(walls) == 2
    assert codes(walls) == ["left-out-other-layer"]
    with pytest.raises(WallsError, match="no layer fits 'wal\\*'"):
        import_walls(d, layers=["wal*"])


def test_open_path_is_two_sided_and_reported_with_its_gap():
    walls = import_walls(drawing(path(line((0, 0), (10, 0), (10, 5)))), sides="outward")
    assert walls.closed.tolist() == [False]
    assert walls.sides == ("both",)
    assert codes(walls) == ["open-path"]
    assert "11.1803" in walls.problems[0].message
    assert (walls.problems[0].x, walls.problems[0].y) == (10, 5)


def test_open_path_that_nearly_closes_is_a_warning_and_a_line_is_none():
    nearly = path(line((0, 0), (10, 0), (10, 10), (0, 10), (0, 0.5)))
    walls = import_walls(drawing(nearly, path(line((20, 0), (30, 0), (30, 5)))))
    assert [problem.severity for problem in walls.problems if problem.code == "open-path"] == ["warning", "info"]
    assert "--snap 0.5" in walls.problems[0].fix


def test_filled_open_path_is_closed_as_painted():
    walls = import_walls(drawing(path(line((0, 0), (10, 0), (10, 5)), fill="#000000")))
    assert walls.closed.tolist() == [True]
    assert codes(walls) == ["closed-as-filled"]


def test_a_filled_straight_line_stays_a_line():
    walls = import_walls(drawing(path(line((0, 0), (10, 0)), fill="#000000")))
    assert walls.closed.tolist() == [False]
    assert codes(walls) == ["open-path"]


def test_points_and_edges_without_length_are_reported():
    walls = import_walls(
        drawing(
            path(line((1, 1), (1, 1))),
            path(([("M", 2, 2)], False)),
            path(([("M", 3, 3), ("L", 3, 3), ("L", 3, 3)], True)),
            path(polygon((0, 0), (5, 0), (5, 0), (5, 5), (0, 0))),
            path(polygon((7, 7), (9, 9))),
        )
    )
    assert [len(wall.vertices) for wall in walls] == [3, 2]
    assert walls.closed.tolist() == [True, False]
    assert sorted(codes(walls)) == [
        "flat-path",
        "one-point-path",
        "one-point-path",
        "one-point-path",
        "open-path",
        "zero-length-edge",
        "zero-length-edge",
        "zero-length-edge",
    ]


def test_scale_and_flip():
    walls = import_walls(drawing(path((PASTED, False)), y_axis="down"), scale=2.0, flip_y=True)
    assert walls.y_axis == "up"
    assert sorted(map(tuple, walls.vertices.tolist())) == [(48, -1606), (62, -1514), (138, -1656), (216, -1550)]
    assert walls.units == ""


def test_a_flipped_arc_bows_the_other_way():
    half = [("M", 0, 0), ("A", 5, 5, 0, 0, 1, 10, 0)], True
    plain, flipped = import_walls(drawing(path(half))), import_walls(drawing(path(half)), flip_y=True)
    assert plain.vertices[:, 1].min() == pytest.approx(-5, abs=0.02)
    assert flipped.vertices[:, 1].max() == pytest.approx(5, abs=0.02)


@pytest.mark.parametrize(
    "option", [{"tolerance": 0.0}, {"tolerance": float("nan")}, {"scale": 0}, {"curves": "splines"}]
)
def test_options_out_of_range(option):
    with pytest.raises(WallsError):
        import_walls(drawing(path(square(0, 0, 1))), **option)


def test_too_many_vertices_hits_the_limit():
    with pytest.raises(LimitError, match="2,000,000"):
        import_walls(drawing(path(circle(0, 0, 1e9))), tolerance=1e-9)


def test_an_empty_drawing_gives_no_walls():
    walls = import_walls(drawing())
    assert len(walls) == 0
    assert walls.vertices.shape == (0, 2)
