"""Where lines meet is found once for all who ask, and is the same whichever way round walls run."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
import shapely
from drawn import drawing, line, path, square
from hypothesis import given
from hypothesis import strategies as st

from importers.drawing import DrawnPath, Subpath
from wallkit.geometry import triangulation
from wallkit.geometry.rings import turned
from wallkit.scene import starting_places
from wallkit.scene.look_over import given_of, look_over
from wallkit.scene.opening import open_scene
from wallkit.scene.wishes import Wishes
from wallkit.walls import Walls, met_lines
from wallkit.walls.checking import loose_ends, open_ends
from wallkit.walls.checking.free_space import free_space, free_space_among
from wallkit.walls.checking.meetings import meetings, on_edge
from wallkit.walls.checking.open_ends import Surroundings
from wallkit.walls.checking.self_check import straight_edges, validate
from wallkit.walls.import_options import ImportOptions
from wallkit.walls.met_lines import MetLines
from wallkit.walls.roles import levels_of, said_of


def counted(monkeypatch, module, name):
    """A list that grows by one with each call of a function of a module."""
    calls, inner = [], getattr(module, name)

    def count(*arguments):
        calls.append(name)
        return inner(*arguments)

    monkeypatch.setattr(module, name, count)
    return calls


TILES = [path(square(60 * i, 60 * j, 60)) for i in range(3) for j in range(3)]
DASHES = [path(line((30 * i, 30 * j), (30 * i + 20, 30 * j))) for i in range(9) for j in range(9)]
HATCH = [path(line((-1, k), (9, k))) for k in range(9)] + [path(line((k + 0.5, -1), (k + 0.5, 9))) for k in range(9)]


@pytest.mark.parametrize("paths", [TILES, DASHES, HATCH], ids=["tiles", "dashes", "hatch"])
def test_a_check_of_a_drawing_looks_once_where_lines_meet(monkeypatch, paths):
    """Tiles are turned inside out on the way, for there is no room but in them; dashes stand in a crowd."""
    monkeypatch.setattr(starting_places, "MOST_STANDING", 50)
    touches = counted(monkeypatch, met_lines, "find_touches")
    meshes = counted(monkeypatch, triangulation, "triangulate")
    opened = open_scene(drawing(*paths), Wishes(put_ball=False))
    look = look_over(given_of(opened), None)
    assert look.space.complete
    assert (len(touches), len(meshes)) == (1, 1)


def test_arcs_are_looked_at_twice_for_their_chords_are_finer_where_a_ball_is_put(monkeypatch):
    touches = counted(monkeypatch, met_lines, "find_touches")
    half = [("M", 0.0, 0.0), ("A", 50.0, 50.0, 0.0, False, True, 100.0, 0.0), ("L", 0.0, 0.0)]
    arcs = DrawnPath([Subpath(half, True)], stroke="#000000")
    opened = open_scene(drawing(arcs), Wishes(importing=ImportOptions.of(curves="arcs"), put_ball=False))
    assert opened.scene.walls.has_arcs
    look_over(given_of(opened), None)
    assert len(touches) == 2


@pytest.mark.parametrize("count", [1, 2, 4])
def test_walls_turned_round_meet_where_they_did(count):
    """The same rooms, in the same order, as of turned walls looked at afresh; what moves is another set of lines."""
    walls = Walls.from_polylines(list(np.random.default_rng(count).uniform(0, 100, (count, 5, 2))))
    met = MetLines.of(walls, straight_edges(walls))
    vertices, _ = turned(walls.vertices, walls.bulges, walls.offsets, walls.closed)
    back = replace(walls, vertices=vertices)
    assert met.same_as(walls, turned_too=False)
    assert met.same_as(back)
    assert not met.same_as(back, turned_too=False)
    spaces = free_space(back), free_space_among(back, straight_edges(back), met)
    rooms, same = (space.closed_rooms for space in spaces)
    assert same == pytest.approx(rooms, abs=1e-9)  # crossings of turned lines differ by rounding of 100
    assert [gap.width for gap in spaces[1].gaps] == pytest.approx([gap.width for gap in spaces[0].gaps], abs=1e-9)
    vertices[-1, 0] = np.nextafter(vertices[-1, 0], np.inf)
    assert not met.same_as(replace(walls, vertices=vertices))


def test_surroundings_of_ends_are_measured_once_however_often_the_reach_is_shortened(monkeypatch):
    lines = [[(30 * i, 30 * j), (30 * i + 29.9, 30 * j)] for i in range(20) for j in range(20)]
    monkeypatch.setattr(loose_ends, "MOST_NEAR", 2000)
    measured = counted(monkeypatch, open_ends, "exact_edges")
    found = validate(Walls.from_polylines(lines, closed=False))
    assert "tangled" in [problem.code for problem in found]
    assert len(measured) == 1


# Whole numbers, for boxes that touch; steps about what counts as rounding there, and any numbers.
coordinate = st.integers(-4, 4).map(float) | st.floats(-4, 4) | st.floats(-1e-10, 1e-10).map(lambda step: 2.0 + step)
corner = st.tuples(coordinate, coordinate)
edge = st.tuples(corner, corner).filter(lambda ends: ends[0] != ends[1])


def every_pair(edges, bulges):
    """What is around edges, each a wall of its own, and the numbers of all pairs."""
    walls = Walls.from_polylines(np.array(edges), closed=False, bulges=[[bulge, 0.0] for bulge in bulges])
    one, two = (index.ravel() for index in np.indices((len(edges), len(edges))))
    return Surroundings.of(walls), one, two


@given(st.lists(edge, min_size=2, max_size=8))
def test_boxes_of_edges_meet_where_exact_fractions_say(edges):
    """Boxes are exact, and a difference is rounded once: nothing that is no farther than the margin is left out."""
    scene, one, two = every_pair(edges, [0.0] * len(edges))
    margin = Fraction(1e3 * scene.there)
    boxes = [[sorted(map(Fraction, across)) for across in zip(*ends, strict=True)] for ends in edges]
    for a, b, met in zip(one.tolist(), two.tolist(), scene.boxes_meet(one, two).tolist(), strict=True):
        apart = max(max(p[0] - q[1], q[0] - p[1]) for p, q in zip(boxes[a], boxes[b], strict=True))
        assert met if apart <= margin else apart <= margin * (1 + Fraction(1, 2**52)) or not met
        if shapely.intersects(*shapely.linestrings([edges[a], edges[b]])):
            assert met


@given(st.lists(st.tuples(edge, st.just(0.0) | st.floats(-3, 3)), min_size=2, max_size=8))
def test_edges_that_have_a_point_in_common_have_boxes_that_meet(edges):
    """Of lines and arcs: to look at the boxes first leaves out no point that would be found without."""
    scene, one, two = every_pair([ends for ends, _ in edges], [bulge for _, bulge in edges])
    e, f = scene.edges.take(one), scene.edges.take(two)
    with np.errstate(all="ignore"):
        common = np.any([on_edge(e, point) & on_edge(f, point) for point in meetings(e, f).T], axis=0)
    assert not (common & (one != two) & ~scene.boxes_meet(one, two)).any()


@pytest.mark.parametrize("name", ["", "wing", "balls", "sensor:goal", "wing #one-way", "wing [restitution=0.5]"])
@pytest.mark.parametrize("tags", [{}, {"one-way": ""}, {"text": "a"}])
def test_a_path_without_levels_says_what_it_says_with_them(name, tags):
    for one in (
        DrawnPath([], layer=name, tags=tags),
        DrawnPath([], name=name, tags=tags),
        DrawnPath([], groups=(name, "arm"), tags=tags),
    ):
        assert said_of(one) == said_of(replace(one, levels=levels_of(one)))


def test_ends_are_mended_the_same_however_many_are_looked_at_together(monkeypatch):
    rng = np.random.default_rng(3)
    sticks = rng.uniform(0, 100, (80, 1, 2)) + rng.uniform(-8, 8, (80, 3, 2))
    walls = Walls.from_polylines(list(sticks), closed=False)
    found = loose_ends.loose_ends(walls, 6.0)
    assert {end.kind for end in found} == {"corner", "bridge", "extend", "foot", "trim"}
    monkeypatch.setattr(open_ends, "_AT_ONCE", 7)
    assert loose_ends.loose_ends(walls, 6.0) == found


def test_a_face_is_searched_once_for_its_roomiest_spot(monkeypatch):
    """Lines from one point: whether the space around them is nearly closed, and whether it has room, ask the same."""
    turn = np.arange(12) * 2 * np.pi / 12
    rays = [path(line((0, 0), (100 * np.cos(t), 100 * np.sin(t)))) for t in turn.tolist()]
    searches = counted(monkeypatch, starting_places, "_searched")
    opened = open_scene(drawing(*rays), Wishes(put_ball=False))
    assert opened.scene.walls.solid is not None
    assert len(searches) == 1
