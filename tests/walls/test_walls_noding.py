"""Walls cut where they meet, beside what GEOS makes of them."""

import numpy as np
import pytest
import shapely

from wallkit.geometry.triangulation import triangulate
from wallkit.scene.starting_places import roomiest
from wallkit.walls import Walls
from wallkit.walls.checking.material import Solids
from wallkit.walls.checking.part_material import in_material
from wallkit.walls.checking.self_check import straight_edges
from wallkit.walls.crossings import find_touches
from wallkit.walls.noding import noded

RNG = np.random.default_rng(8)
SQUARE = np.array([(0.0, 0.0), (8.0, 0.0), (8.0, 8.0), (0.0, 8.0)])
STEPS = RNG.integers(0, 6, (12, 9, 2)).astype(float)
TURNS = np.linspace(0, np.pi, 60, endpoint=False)
CASES = {
    "one ring": ([SQUARE], True),
    "lines that cross": (list(RNG.uniform(0, 9, (40, 2, 2))), False),
    "rings that cross themselves": (list(RNG.uniform(0, 9, (5, 12, 2))), True),
    "polylines on a lattice": (list(STEPS), False),  # vertices on edges, shared edges, folds, copies of pieces
    "rings on a lattice": (list(STEPS), True),
    "squares side by side": ([SQUARE + np.array((8, 4)) * i for i in range(4)], True),
    "a ring twice, and backwards": ([SQUARE, SQUARE[::-1], SQUARE / 2], True),
    "there and half back, and beyond": ([[(0, 0), (6, 0), (3, 0)], [(1, 3), (4, 3), (-2, 3)]], False),
    "one in the other's middle": ([[(0, 0), (9, 3)], [(3, 1), (6, 2)], [(0, 0), (9, 3)]], False),
}


def pieces_of(lines, closed):
    walls = Walls.from_polylines(lines, closed=closed)
    edges = straight_edges(walls)
    a, b, _, _ = noded(edges, find_touches(edges))
    rings = [np.vstack([line, line[:1]]) if closed else np.array(line) for line in lines]
    given = np.array([shapely.LineString(ring) for ring in rings])
    return edges, shapely.linestrings(np.stack([a, b], axis=1)), given


def faces(lines):
    return np.sort(shapely.area(shapely.get_parts(shapely.polygonize([*lines]))))


@pytest.mark.parametrize("case", CASES)
def test_pieces_are_those_of_geos_and_meet_at_their_ends_only(case):
    edges, pieces, given = pieces_of(*CASES[case])
    judge = shapely.get_parts(shapely.node(shapely.multilinestrings(given)))
    whole = shapely.union_all(given)
    assert shapely.length(pieces).sum() == pytest.approx(shapely.length(whole), rel=1e-12)
    assert shapely.hausdorff_distance(shapely.multilinestrings(pieces), whole) < 1e-9
    np.testing.assert_allclose(faces(pieces), faces(judge), rtol=1e-9, atol=1e-9)
    one, two = shapely.STRtree(pieces).query(pieces, predicate="intersects")
    one, two = one[one < two], two[one < two]
    assert shapely.touches(pieces[one], pieces[two]).all()
    ends = shapely.get_coordinates(pieces)
    corners = edges.vertices[np.unique(np.concatenate([edges.start, edges.stop]))]
    assert {tuple(point) for point in corners.tolist()} <= {tuple(point) for point in ends.tolist()}  # to the bit


def test_lines_through_one_point_meet_in_one_point():
    lines = [5 * np.array([(-np.cos(t), -np.sin(t)), (np.cos(t), np.sin(t))]) + 0.3 for t in TURNS]
    _, pieces, _ = pieces_of(lines, False)
    assert len(pieces) == 2 * len(TURNS)
    inner = np.unique(shapely.get_coordinates(pieces), axis=0)
    assert len(inner) == 2 * len(TURNS) + 1


def test_what_meets_nothing_is_given_as_it_is():
    walls = Walls.from_polylines([(SQUARE - 4) * k for k in (1, 2, 3)])
    edges = straight_edges(walls)
    a, b, _, _ = noded(edges, find_touches(edges))
    assert a.tobytes() == edges.a.tobytes()
    assert b.tobytes() == edges.b.tobytes()


def test_the_roomiest_spot_of_a_scribble_is_found_and_that_of_a_tangle_is_not_looked_for():
    scribble = Walls.from_polylines([RNG.uniform(0, 100, (60, 2))])
    spot = roomiest(scribble)
    line = shapely.LinearRing(scribble.vertices)
    assert shapely.distance(line, shapely.Point(spot.x, spot.y)) == pytest.approx(spot.room, rel=1e-3)
    assert roomiest(Walls.from_polylines(list(RNG.uniform(0, 100, (1000, 2, 2))), closed=False)) is None


@pytest.mark.parametrize("case", [name for name, (_, closed) in CASES.items() if closed] + ["some open", "deep"])
def test_material_of_parts_is_what_is_counted_along_rays(case):
    lines, closed = CASES.get(case, CASES["rings on a lattice"])
    if case == "deep":  # solids and holes in each other, one in its own way
        lines = [(SQUARE - 4) * k for k in range(1, 60)]
    lines = [line[:: (1, -1)[index % 3 == 0]] for index, line in enumerate(lines)]
    some = np.arange(len(lines)) % 4 > 0 if case == "some open" else closed
    walls = Walls.from_polylines(lines, closed=some)
    edges = straight_edges(walls)
    touches = find_touches(edges)
    pieces = noded(edges, touches)
    mesh = triangulate(pieces.a, pieces.b)
    solids = Solids.of(walls, edges)
    triangles = shapely.polygons(mesh.points[mesh.corners])
    places = mesh.points[mesh.corners[shapely.area(triangles) > 1e-9]].mean(axis=1)
    found = in_material(solids, mesh, pieces, touches.copy_of, places)

    ends = np.tile((1e3 * np.pi, 1e3 * np.e), (len(places), 1))  # by even-odd, on ways that meet no vertex
    rays = shapely.linestrings(np.stack([places, ends], axis=1))
    level, outermost, largest = np.zeros(len(places)), np.full(len(places), solids.around), np.zeros(len(places))
    for number in np.flatnonzero(walls.closed).tolist():
        sides = shapely.linestrings(np.stack([lines[number], np.roll(lines[number], -1, axis=0)], axis=1))
        around = shapely.intersects(rays[:, None], sides).sum(axis=1) % 2 == 1
        level += np.where(around, solids.sign[number], 0)
        outer = around & (solids.size[number] >= largest)
        outermost[outer], largest[outer] = solids.sign[number] < 0, solids.size[number]
    assert found.tolist() == np.where(level == 0, outermost, level > 0).tolist()
