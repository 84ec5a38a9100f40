import numpy as np
import pytest
import shapely

from importers.drawing import Drawing, DrawnPath, Subpath
from wallkit import SceneError, WallkitError, Walls, open_scene
from wallkit.scene import starting_places
from wallkit.scene.starting_places import Lines, has_room, roomiest, scattered
from wallkit.walls.importing.drawn_balls import drawn_balls

# A unit circle of four cubics, with the factor that every drawing program uses, 4/3 (sqrt 2 - 1).
K = 0.5522847498307936


def circle(x, y, r, layer="balls"):
    def c(*numbers):
        return ("C", *(value * r + (x, y)[index % 2] for index, value in enumerate(numbers)))

    segments = [
        ("M", x + r, y),
        c(1, K, K, 1, 0, 1),
        c(-K, 1, -1, K, -1, 0),
        c(-1, -K, -K, -1, 0, -1),
        c(K, -1, 1, -K, 1, 0),
    ]
    return DrawnPath([Subpath(segments, closed=True)], layer=layer)


def line(x0, y0, x1, y1, **marks):
    return DrawnPath([Subpath([("M", x0, y0), ("L", x1, y1)], closed=False)], layer="balls", **marks)


def test_a_circle_is_a_ball_and_a_line_from_its_centre_its_velocity():
    drawing = Drawing(
        "pt", "up", paths=[circle(10, 20, 3), line(10, 20, 60, 20), circle(50, 20, 2), circle(0, 0, 9, "walls")]
    )
    (first, second), problems = drawn_balls(drawing)
    assert (first.x, first.y, first.radius) == pytest.approx((10, 20, 3), rel=3e-4)  # four cubics are that round
    assert first.velocity == pytest.approx((50, 0))
    assert second.velocity is None
    assert problems == []


def test_an_exact_circle_of_arcs_keeps_its_numbers():
    arcs = Subpath([("M", 13, 20), ("A", 3, 3, 0, 0, 1, 7, 20), ("A", 3, 3, 0, 0, 1, 13, 20)], closed=True)
    (ball,), _ = drawn_balls(Drawing("px", "down", paths=[DrawnPath([arcs], layer="balls")]))
    assert (ball.x, ball.y, ball.radius) == pytest.approx((10, 20, 3), rel=1e-14)


def test_scale_and_flip_act_on_places_radii_and_velocities():
    (ball,), _ = drawn_balls(Drawing("pt", "up", paths=[circle(10, 20, 3), line(10, 20, 60, 25)]), scale=2, flip_y=True)
    assert (ball.x, ball.y, ball.radius) == pytest.approx((20, -40, 6), rel=3e-4)
    assert ball.velocity == pytest.approx((100, -10))


def test_what_is_no_ball_is_reported_with_its_place_and_hidden_ones_do_not_count():
    square = DrawnPath(
        [Subpath([("M", 0, 0), ("L", 9, 0), ("L", 9, 9), ("L", 0, 9)], closed=True)], layer="balls", line=7
    )
    hidden = circle(1, 1, 1)
    hidden.visible = False
    found, problems = drawn_balls(Drawing("pt", "up", paths=[square, line(5, 6, 7, 8), hidden]))
    assert found == []
    assert [(p.code, p.x, p.y) for p in problems] == [("not-a-ball", 0, 0), ("not-a-ball", 5, 6)]
    assert problems[0].line == 7


def ring(x0, y0, x1, y1, way=1):
    return [(x0, y0), (x1, y0), (x1, y1), (x0, y1)][::way]


@pytest.mark.parametrize(
    ("walls", "room"),
    [
        (Walls.from_polylines([ring(0, 0, 100, 100)]), 50),
        # the left half; in the right one is an obstacle that leaves next to nothing
        (Walls.from_polylines([ring(0, 0, 200, 100), ring(100, 0, 199, 99)]), 50),
        # not in the pillar, though it has more room: in a corner, sqrt(2) (80 - c) = c from the pillar's
        (Walls.from_polylines([ring(0, 0, 300, 300), ring(80, 80, 220, 220)]), 80 * 2**0.5 / (1 + 2**0.5)),
        # an open wall counts: a partition
        (Walls.from_polylines([ring(0, 0, 200, 90), [(110, 0), (110, 90)]], closed=[True, False]), 45),
        # nothing but an open wall, nearly a room
        (Walls.from_polylines([[(0, 0), (100, 0), (100, 100), (0, 100), (0, 1)]], closed=False), 50),
    ],
    ids=["box", "beside an obstacle", "pillar", "partition", "leaky"],
)
def test_the_roomiest_spot_is_as_far_from_all_walls_as_it_says(walls, room):
    spot = roomiest(walls)
    assert spot.room == pytest.approx(room, rel=0.02)
    lines = [shapely.LineString([*w.vertices, w.vertices[0]] if w.closed else w.vertices) for w in walls]
    assert shapely.MultiLineString(lines).distance(shapely.Point(spot.x, spot.y)) == pytest.approx(room, rel=0.02)


def test_no_ball_starts_inside_what_is_solid_from_outside():
    solid = Walls.from_polylines([ring(0, 0, 100, 100)], sides="outward")
    assert roomiest(solid) is None
    hollow = Walls.from_polylines([ring(0, 0, 100, 100), ring(30, 30, 90, 90, -1)], sides="outward")
    assert roomiest(hollow).room == pytest.approx(30, rel=0.02)


def test_an_open_line_beside_a_box_is_no_room():
    walls = Walls.from_polylines([ring(0, 0, 60, 60), [(0, 300), (400, 300)]], closed=[True, False])
    spot = roomiest(walls)
    assert (spot.x, spot.y, spot.room) == pytest.approx((30, 30, 30), rel=0.02)


def test_faces_of_many_rings_are_those_of_geos(monkeypatch):
    rng = np.random.default_rng(3)
    turn = np.arange(5) * (2 * np.pi / 5)
    rings = [(i, j, 0.48 * 0.4**k) for i in range(5) for j in range(5) for k in range(rng.integers(1, 6))]
    rings += [(x + 0.3, y, 0.1) for x, y, radius in rings if radius == 0.48]
    outlines = [np.stack([x + r * np.cos(turn), y + r * np.sin(turn)], axis=1) for x, y, r in rings]
    for lines in (outlines, [*outlines, outlines[4]], [*outlines, outlines[4] + 0.2]):  # apart, with a copy, crossing
        walls = Walls.from_polylines(lines)
        found = []
        for few in (0, len(lines) + 1):  # by nesting where nothing meets, and always by GEOS
            monkeypatch.setattr(starting_places, "_MANY_RINGS", few)
            found.append(sorted(shapely.to_wkb(shapely.normalize(Lines.of(walls).bounded))))
        assert found[0] == found[1]
        assert len(found[0]) >= len(outlines)


@pytest.mark.parametrize("seed", range(40))
def test_open_lines_have_the_faces_of_geos(seed):
    """Walks on a lattice and off it, that cross, touch, fold back and come back to where they began, or do not meet."""
    random = np.random.default_rng(seed)
    places = random.integers(0, 12, (random.integers(1, 5), random.integers(2, 6), 2)) * 1.0
    places += random.choice([0.0, 0.1]) * random.random(places.shape)
    walks = [walk[np.append(True, np.diff(walk, axis=0).any(axis=1))] for walk in places]
    walks = [walk if k % 2 else np.append(walk, walk[:1], axis=0) for k, walk in enumerate(walks) if len(walk) > 1]
    faces = shapely.get_parts(shapely.polygonize([shapely.union_all([*map(shapely.LineString, walks)])]))
    found = Lines.of(Walls.from_polylines(walks, closed=False)).bounded if walks else []
    assert sum(shapely.area(found)) == pytest.approx(sum(shapely.area(faces)), abs=1e-9)


def test_tiles_that_share_edges_are_a_face_each():
    tiles = Walls.from_polylines([ring(60 * i, 60 * j, 60 * i + 60, 60 * j + 60) for i in range(6) for j in range(5)])
    faces = Lines.of(tiles).bounded
    assert [face.area for face in faces] == [3600.0] * 30
    assert roomiest(tiles, anywhere=True).room == pytest.approx(30, rel=0.01)


def dashes(n):
    """A room from -20 to 3 n + 20 in which n^2 short lines stand, 3 apart."""
    lines = [[(3 * i, 3 * j), (3 * i + 2, 3 * j + 0.5)] for i in range(n) for j in range(n)]
    return Walls.from_polylines([ring(-20, -20, 3 * n + 20, 3 * n + 20), *lines], closed=[True, *[False] * n * n])


def test_the_roomiest_spot_among_thousands_of_lines_touches_two_walls_and_the_end_of_a_line(monkeypatch):
    # (c - r, c - r) for the corner (c, c) is r from the end (c - 21, c - 22.5): r^2 - 87 r + 21^2 + 22.5^2 = 0
    radius = (87 - np.sqrt(87**2 - 4 * (21**2 + 22.5**2))) / 2
    corner = 3 * 40 + 20
    monkeypatch.setattr(starting_places, "MOST_STANDING", 1599)
    spot = roomiest(dashes(40))
    assert (spot.x, spot.y, spot.room) == pytest.approx((corner - radius, corner - radius, radius), rel=1e-8)
    with pytest.raises(SceneError, match="1,599 lines stand in the room") as caught:
        scattered(dashes(40), spot, 5, 1.0, np.random.default_rng(1))
    assert "--ball" in caught.value.fix
    monkeypatch.setattr(starting_places, "MOST_STANDING", 1600)  # by GEOS
    assert roomiest(dashes(40)).room == pytest.approx(radius, abs=0.005 * 160)  # the tolerance that is asked of it


def test_whether_there_is_room_is_told_as_by_the_search_for_the_roomiest_spot():
    rng = np.random.default_rng(5)
    box = ring(0, 0, 100, 100)
    told = []
    for case in range(60):
        lines = [box, *rng.uniform(0, 100, (case % 5, 4, 2))][case % 2 :]
        closed = (rng.random(len(lines)) < 0.6).tolist()
        walls = Walls.from_polylines(lines, closed=closed, sides=("both", "outward")[case % 3 == 0])
        for anywhere in (False, True):
            assert has_room(walls, anywhere) == (roomiest(walls, anywhere) is not None)
            told.append(has_room(walls, anywhere))
    assert len(set(told)) == 2


def test_to_tell_whether_there_is_room_one_face_of_many_is_looked_at(monkeypatch):
    looked_at = []
    spot = starting_places._spot
    monkeypatch.setattr(starting_places, "_spot", lambda face, lines: looked_at.append(face) or spot(face, lines))
    nest = Walls.from_polylines([ring(-k, -k, k, k) for k in range(1, 600)])
    assert has_room(nest, anywhere=True)
    assert len(looked_at) == 1


def test_walls_without_room_have_no_spot():
    assert roomiest(Walls.from_polylines([])) is None
    assert roomiest(Walls.from_polylines([[(0, 0), (5, 0)]])) is None


def test_scattered_places_have_room_and_come_again_with_their_seed():
    walls = Walls.from_polylines([ring(0, 0, 100, 60), ring(40, 20, 60, 40)])
    spot = roomiest(walls)
    places = scattered(walls, spot, 300, 5.0, np.random.default_rng(3))
    assert np.array_equal(places, scattered(walls, spot, 300, 5.0, np.random.default_rng(3)))
    x, y = places.T
    assert ((x > 5) & (x < 95) & (y > 5) & (y < 55)).all()
    outside = np.hypot(np.maximum(abs(x - 50) - 10, 0), np.maximum(abs(y - 30) - 10, 0))
    assert (outside > 5).all()
    with pytest.raises(SceneError, match="no room"):
        scattered(walls, spot, 1, 30.0, np.random.default_rng(3))


@pytest.mark.parametrize(("lines", "said"), [(30, None), (150, "cross too often")])  # 900 and 22,500 crossings
def test_a_hatch_too_fine_to_cut_is_told_as_such(lines, said):
    across = [[("M", -5.0, k + 0.5), ("L", lines + 5.0, k + 0.5)] for k in range(lines)]
    down = [[("M", float(k), -5.0), ("L", float(k), lines + 5.0)] for k in range(lines)]
    paths = [DrawnPath([Subpath(line, False)], stroke="#000000") for line in across + down]
    drawing = Drawing("px", "down", paths=paths)
    if said is None:
        assert len(open_scene(drawing).scene.balls) == 1
        return
    with pytest.raises(WallkitError, match=said) as caught:
        open_scene(drawing)
    assert caught.value.code == "no-room"
