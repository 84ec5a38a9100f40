"""Tangles: work grows no faster than what is drawn and crosses, and memory and time stay within bounds."""

from __future__ import annotations

import os
import subprocess
import sys

import numpy as np
import pytest
import shapely
from drawn import drawing, line, path, polygon, square

from importers.errors import LimitError
from wallkit.walls import Walls, crossings
from wallkit.walls.checking import loose_ends
from wallkit.walls.checking.free_space import free_space
from wallkit.walls.checking.leaks import leak_problems, reach_of
from wallkit.walls.checking.self_check import validate
from wallkit.walls.edge_tree import Edges
from wallkit.walls.importing.pipeline import import_walls

BOUNDED = """
import resource, sys
resource.setrlimit(resource.RLIMIT_DATA, (512 << 20, 512 << 20))
resource.setrlimit(resource.RLIMIT_CPU, (25, 25))
import numpy as np
from wallkit.walls import Walls
from wallkit.walls.crossings import find_touches
from wallkit.walls.edge_tree import Edges
from wallkit.walls.checking.free_space import free_space
from wallkit.walls.nesting import depths
from wallkit.walls.checking.self_check import validate
rng = np.random.default_rng(4)
walls = {}
found = validate(walls)
edges = Edges(walls.vertices, walls.offsets, walls.closed)
depths(edges, find_touches(edges).crossing_walls)
space = free_space(walls)
print(space.complete, "tangled" in [problem.code for problem in found])
"""
SQUARE = "[(0, 0), (600, 0), (600, 600), (0, 600)]"
TURN = "np.arange(401) * 200 * 2 * np.pi / 401"


@pytest.mark.parametrize(
    ("walls", "told"),
    [
        (f"Walls.from_polylines([rng.uniform(0, 1000, (400, 2)), np.array({SQUARE})])", "True False"),
        ("Walls.from_polylines(list(rng.uniform(0, 1000, (20, 150, 2))))", "False True"),
        ("Walls.from_polylines(list(rng.uniform(0, 1000, (500, 40, 2))), closed=False)", "False True"),
        ("Walls.from_polylines(list(rng.uniform(0, 1000, (7000, 2, 2))), closed=False)", "False True"),
        ("Walls.from_polylines([[(0, k / 1000), (9000, k / 1000)] for k in range(50)], closed=False)", "True False"),
        ("Walls.from_polylines([[(0, 0), (900, 0)]] * 400, closed=False)", "True False"),
        (f"Walls.from_polylines([np.stack([np.cos({TURN}), np.sin({TURN})], axis=1)])", "False False"),
        (
            "Walls.from_polylines([[(k, k), (900 - k, k), (900 - k, 900 - k), (k, 900 - k)] for k in range(400)])",
            "True False",
        ),
        (
            "Walls.from_polylines([np.array([(-k, -k), (k, -k), (k, k), (-k, k)]) / 9 for k in range(1, 2501)])",
            "True False",
        ),
    ],
    ids=["scribble", "scribbles", "polylines", "lines", "near", "same", "star", "nested", "about one centre"],
)
def test_a_tangle_ends_within_its_bounds_and_says_what_is_not_known(walls, told):
    """512 MB of data and 25 s of processor time, imports included."""
    done = subprocess.run(
        [sys.executable, "-c", BOUNDED.format(walls)],
        capture_output=True,
        text=True,
        timeout=300,
        env=os.environ | {"OPENBLAS_NUM_THREADS": "1"},
    )
    assert done.stdout.strip() == told, done.stderr


def looked_at(monkeypatch, walls):
    """How many pairs of edges are looked at for crossings."""
    count = 0
    inner = crossings._classify

    def counted(edges, first, second):
        nonlocal count
        count += len(first)
        return inner(edges, first, second)

    monkeypatch.setattr(crossings, "_classify", counted)
    crossings.find_touches(Edges(walls.vertices, walls.offsets, walls.closed))
    monkeypatch.setattr(crossings, "_classify", inner)
    return count


@pytest.mark.parametrize(
    "make",
    [
        lambda n: Walls.from_polylines([[(0, 0), (9, 0), (9, 9), (0, 9)]] * n + [[(20, 0), (29, 0), (29, 9)]]),
        lambda n: Walls.from_polylines([[(0, 0), (9, 0)]] * n, closed=False),
        lambda n: Walls.from_polylines([[(k, 0), (k + 1, 0), (k + 1, 1), (k, 1)] for k in range(n)]),
    ],
    ids=["identical squares", "identical lines", "tiles in a row"],
)
def test_twice_the_walls_is_at_most_twice_the_work(monkeypatch, make):
    few, many = (looked_at(monkeypatch, make(n)) for n in (500, 1000))
    assert many <= 2.3 * few + 10


def test_copies_are_told_once_each_and_nested_as_one():
    walls = import_walls(drawing(*[path(square(0, 0, 50))] * 40, path(square(10, 10, 5)), path(square(45, 10, 20))))
    codes = [problem.code for problem in walls.problems]
    assert codes.count("duplicate-wall") == 39
    assert codes.count("crossing") == 2
    assert walls.depth.tolist() == [0] * 40 + [1, 0]


def test_open_lines_that_cross_are_around_nothing():
    """Two open polylines that cross each other, bent around a third: they enclose nothing."""
    hook = line((0, 0), (100, 0), (100, 100), (0, 100))
    walls = import_walls(drawing(path(hook), path(line((50, -10), (50, 10))), path(line((30, 40), (60, 60)))))
    assert walls.depth.tolist() == [0, 0, 0]


def test_rings_that_cross_are_counted_by_even_and_odd():
    """Depth of small squares among random rings that cross, against shapely's polygons of a ring made valid."""
    rng = np.random.default_rng(7)
    rings = [rng.uniform(0, 100, (5, 2)) for _ in range(6)]
    spots = [(x, y) for x in range(5, 95, 9) for y in range(5, 95, 9)]
    small = [[(x, y), (x + 0.01, y), (x + 0.01, y + 0.01), (x, y + 0.01)] for x, y in spots]
    walls = import_walls(drawing(*(path(polygon(*map(tuple, ring))) for ring in [*rings, *small])))
    areas = [shapely.make_valid(shapely.Polygon(ring)) for ring in rings]
    clear = [
        index
        for index, spot in enumerate(small)
        if all(area.boundary.distance(shapely.Point(spot[0])) > 0.1 for area in areas)
    ]
    expected = [sum(area.contains(shapely.Point(small[index][0])) for area in areas) for index in clear]
    assert walls.depth[len(rings) :][clear].tolist() == expected
    assert max(expected) > 1


def test_a_tangle_is_told_by_check_and_no_gap_is_made_up():
    turn = np.arange(401) * 200 * 2 * np.pi / 401
    walls = Walls.from_polylines([np.stack([np.cos(turn), np.sin(turn)], axis=1)])
    space = free_space(walls)
    assert (space.gaps, len(space.closed_rooms)) == ([], 0)
    (problem,) = leak_problems(space, reach_of(space, walls, None, np.empty((0, 2))))
    assert (problem.code, problem.severity) == ("tangled", "warning")


def test_gaps_among_very_many_ends_are_looked_for_nearer_by_and_that_is_told(monkeypatch):
    lines = [[(30 * i, 30 * j), (30 * i + 29.9, 30 * j)] for i in range(20) for j in range(20)]
    walls = Walls.from_polylines(lines, closed=False)
    reach = 0.02 * np.hypot(599.9, 570)
    gaps = [problem for problem in validate(walls) if problem.code == "gap"]
    assert len(gaps) == 20 * 19
    monkeypatch.setattr(loose_ends, "MOST_NEAR", 2000)  # of 800 ends each has its own edge, and that beyond the gap
    with pytest.raises(LimitError, match="pairs of an open end and what is near it, at most 2,000"):
        loose_ends.loose_ends(walls, reach)
    found = {problem.code: problem for problem in validate(walls)}
    assert found["gap"].message == gaps[0].message
    assert found["tangled"].message.endswith(f"looked for up to {reach / 4:.3g} only")
    monkeypatch.setattr(loose_ends, "MOST_NEAR", 1)
    (problem,) = (problem for problem in validate(walls) if problem.code == "tangled")
    assert "gaps are not looked for" in problem.message


@pytest.mark.parametrize("turn", [0.0, 0.3])
def test_squares_in_each_other_take_as_many_points_as_they_have_corners_and_feet(turn):
    """Rings 1 wide; a disc in a corner touches two sides and the inner corner: r (1 + sqrt 2) = sqrt 2."""
    around = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    squares = [np.array([(k, k), (900 - k, k), (900 - k, 900 - k), (k, 900 - k)]) @ around for k in range(0, 400)]
    space = free_space(Walls.from_polylines(squares))
    radii = np.sort(space.closed_rooms[:, 2])
    assert (space.complete, space.gaps, len(radii)) == (True, [], 400)
    corner = 2**0.5 / (1 + 2**0.5)
    assert radii[-1] == pytest.approx(51, rel=1e-8)  # the innermost square's own inside
    assert radii[-16:-1] == pytest.approx(corner, rel=1e-8)
    assert radii[0] >= 0.5 * (1 - 1e-9)  # between two sides: of the other rooms one circle is looked at
    assert radii[-2] <= corner * (1 + 1e-9)
    assert len(space.parts.mesh.points) <= 4 * 400 + 8 * 399 + 4
