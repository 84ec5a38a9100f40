"""The records of edges and vertices: the same bits interpreted and compiled, and what geometry says they are."""

import math
from fractions import Fraction

import numpy as np
import pytest

from wallkit import Balls, Scene, Walls
from wallkit.simulation.edge_records import corners_of, lines_of
from wallkit.simulation.modelled import Modelled

RECORDS = ("lines", "arcs", "corners", "fans", "edge_wall", "ids")


def crooked(seed, bulge):
    """Open and closed walls of a few edges each, some of them without length."""
    rng = np.random.default_rng(seed)
    walls = [np.cumsum(rng.normal(0.0, 9.0, (count, 2)), axis=0) for count in (2, 2, 3, 5, 8, 13)]
    walls[4][3] = walls[4][2]
    bulges = [np.where(rng.random(len(wall)) < bulge, rng.uniform(-2.0, 2.0, len(wall)), 0.0) for wall in walls]
    return Walls.from_polylines(walls, [False, True, False, True, True, False], bulges=bulges, sides="outward")


@pytest.mark.parametrize("bulge", [0.0, 0.5])
@pytest.mark.parametrize("radius", [0.0, 2.0])
def test_interpreted_and_compiled_records_have_the_same_bits(radius, bulge):
    scene = Scene(crooked(1, bulge), Balls([[500.0, 500.0]], [[1.0, 0.0]], radius))
    one, other = (Modelled(scene, index="grid", machine_code=code).model for code in (False, True))
    assert (one.arcs is None) == (bulge == 0.0)
    for name in RECORDS:
        if getattr(one, name) is not None:
            assert getattr(one, name).tobytes() == getattr(other, name).tobytes(), name


def test_a_normal_is_a_quarter_turn_from_its_edge():
    walls = crooked(2, 0.0)
    lines, wall, around, along = lines_of(walls.vertices, walls.offsets, walls.closed, np.zeros(2))
    starts, ends = walls.vertices[walls.edge_starts], walls.vertices[walls.edge_ends]
    np.testing.assert_array_equal(wall, np.repeat(np.arange(len(walls)), np.diff(walls.edge_offsets)))
    assert np.count_nonzero(lines["length"]) == len(lines) - 1
    for line, (ax, ay), (bx, by) in zip(lines, starts.tolist(), ends.tolist(), strict=True):
        assert (line["ax"], line["ay"], line["bx"], line["by"]) == (ax, ay, bx, by)
        dx, dy = Fraction(bx) - Fraction(ax), Fraction(by) - Fraction(ay)
        if dx == dy == 0:
            assert (line["nx"], line["ny"], line["length"], line["twice"]) == (0.0, 0.0, 0.0, 0.0)
            continue
        # Each of the two is rounded a few times: as a part of the length that is some 2^-51.
        length = math.sqrt(dx * dx + dy * dy)
        assert abs(line["length"] - length) <= 2.0**-50 * length
        assert max(abs(line["nx"] - float(dy) / length), abs(line["ny"] + float(dx) / length)) <= 2.0**-49
        assert abs(line["twice"] * (line["nx"] ** 2 + line["ny"] ** 2) - 2.0) <= 2.0**-50
    closed = np.repeat(walls.closed, np.diff(walls.edge_offsets))
    assert around == pytest.approx(lines["length"][closed].sum(), rel=1e-12)
    assert along == pytest.approx(lines["length"][~closed].sum(), rel=1e-12)


def test_a_disc_touches_a_vertex_between_the_normals_of_its_edges():
    # a solid square, an open right angle: a quarter outside each corner, half a circle at a free end
    square, angle = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]], [[9.0, 0.0], [12.0, 0.0], [12.0, 5.0]]
    walls = Walls.from_polylines([square, angle], closed=[True, False])
    polylines = walls.vertices, walls.offsets, walls.closed, np.zeros(2)
    lines = lines_of(*polylines).records
    corners = corners_of(*polylines, lines, None, np.empty(0), 12.0, 1.0)
    assert corners.open.all()
    fans = np.array(corners.fans[["ux", "uy", "wx", "wy"]].tolist()) + 0.0
    down, right, up, left = [0.0, -1.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]
    assert fans[:4].tolist() == [left + down, down + right, right + up, up + left]
    assert fans[4:].tolist() == [up + down, down + right, right + left]
    assert corners.records["sx"].tolist() == [-1.0, 1.0, 1.0, -1.0, 0.0, 1.0, 1.0]


@pytest.mark.parametrize(("turn", "opens"), [(2.0**-40, True), (2.0**-46, False), (-(2.0**-40), True)])
def test_edges_that_go_straight_on_have_no_corner(turn, opens):
    vertices = np.array([[-1.0, 0.0], [0.0, 0.0], [1.0, turn]])
    polyline = vertices, np.array([0, 3]), np.array([False]), np.zeros(2)
    corners = corners_of(*polyline, lines_of(*polyline).records, None, np.empty(0), 1.0, 1.0)
    assert corners.open.tolist() == [True, opens, True]
    assert corners.fans["both"].tolist() == [0.0, 1.0, 0.0]  # so flat that a disc may come from either side
    around = corners_of(*polyline, lines_of(*polyline).records, None, np.empty(0), 1.0, 1.0, across=True)
    assert around.fans["both"].tolist() == [1.0, 1.0, 1.0]  # discs may stand across the edge, too
