"""Points under gravity that are thrown exactly at a vertex: they meet the face that looks at them, and stay inside."""

import numpy as np
import pytest
import shapely
from outlines import outline

from wallkit import Balls, Ending, Material, Scene, Walls, simulate, survey
from wallkit.kernels.flight import point_in_corner

GRAVITY = np.array([0.0, -10.0])
UP = [(0.0, 0.0), (8.0, 0.0), (10.0, 6.0), (12.0, 0.0), (20.0, 0.0), (20.0, 20.0), (0.0, 20.0)]
"""A room with a tip at (10, 6) that stands up from its floor, between edges 1 and 2."""
DOWN = [(0.0, 0.0), (20.0, 0.0), (20.0, 20.0), (12.0, 20.0), (10.0, 14.0), (8.0, 20.0), (0.0, 20.0)]
"""One that hangs down at (10, 14), between edges 3 and 4."""


def thrown_at(place, velocity, time):
    """Where a flight begins that comes to a place at a velocity, and its velocity there."""
    velocity = np.asarray(velocity)
    return np.asarray(place) - time * velocity + GRAVITY * time**2 / 2, velocity - GRAVITY * time


def thrown_with_drag_at(place, velocity, time, drag):
    """The same with drag k: v1 = v0 E + g f, p1 = p0 + v0 f + g s; E = e^(-k t), f = (1 - E) / k, s = (t - f) / k."""
    left, free = np.exp(-drag * time), -np.expm1(-drag * time) / drag
    start = (np.asarray(velocity) - GRAVITY * free) / left
    return np.asarray(place) - start * free - GRAVITY * (time - free) / drag, start


def inward(corners):
    """Normals into a room that is drawn counter-clockwise: to the left of its edges."""
    ways = np.roll(corners, -1, axis=0) - np.asarray(corners)
    return np.stack([-ways[:, 1], ways[:, 0]], axis=1) / np.hypot(*ways.T)[:, None]


@pytest.mark.parametrize("restitution", [0.0, 0.3, 0.5, 0.8, 1.0])
@pytest.mark.parametrize(
    ("room", "tip", "velocity", "edges"),
    [
        # the face whose line has the place from which the point comes, V - v t, on the room's side
        (UP, 2, (6.0, 1.0), {1}),
        (UP, 2, (6.0, -2.0), {1}),
        (UP, 2, (4.0, 9.0), {1}),
        (UP, 2, (-6.0, 1.0), {2}),
        (UP, 2, (-4.0, 9.0), {2}),
        (UP, 2, (0.0, -8.0), {1, 2}),
        (UP, 2, (1.0, -8.0), {1, 2}),
        (DOWN, 4, (6.0, 1.0), {4}),
        (DOWN, 4, (6.0, -3.0), {4}),
        (DOWN, 4, (-6.0, 2.0), {3}),
        (DOWN, 4, (-4.0, -9.0), {3}),
        (DOWN, 4, (0.0, 8.0), {3, 4}),
        (DOWN, 4, (-1.0, 8.0), {3, 4}),
    ],
)
def test_a_point_thrown_at_a_tip_meets_the_face_that_looks_at_it(room, tip, velocity, edges, restitution):
    start, speed = thrown_at(room[tip], velocity, 0.125)
    walls = Walls.from_polylines([room], material=Material(restitution))
    run = simulate(Scene(walls, Balls([start], [speed]), gravity=GRAVITY), until=5.0, bounces=200)
    contacts = run.contacts[run.contacts["kind"] == 0]
    assert contacts["edge"][0] in edges
    assert contacts["time"][0] == pytest.approx(0.125, abs=1e-9)
    assert run.ending[0] != Ending.LEFT_SCENE
    # all that it meets throws it off into the room
    normals = np.stack([contacts["nx"], contacts["ny"]], axis=1)
    assert normals == pytest.approx(inward(room)[contacts["edge"]], abs=1e-12)


@pytest.mark.parametrize("slope", [0.0, 0.3])
def test_a_point_that_comes_along_a_wall_to_its_end_flies_on(slope):
    # The floor ends at (10, 5 + 10 slope), and falls away upright. Restitution 0 has the point run along the floor, and
    # from its end it falls to y = 0, freely: at y0 + s t - 5 t^2 = 0, x = 10 + u t.
    room = [(0.0, 5.0), (10.0, 5.0 + 10 * slope), (10.0, 0.0), (60.0, 0.0), (60.0, 40.0), (0.0, 40.0)]
    end, way = np.array(room[1]), np.array([1.0, slope]) / np.hypot(1.0, slope)
    start, velocity = thrown_at(end - 1e-12 * way, 9.0 * way + (0.0, -1.0), 0.1)
    walls = Walls.from_polylines([room], material=Material(0.0))
    contacts = simulate(Scene(walls, Balls([start], [velocity]), gravity=GRAVITY), until=20.0).contacts
    struck = contacts[contacts["kind"] == 0]
    along = (9.0 * way + (0.0, -1.0)) @ way
    time = (along * way[1] + np.sqrt((along * way[1]) ** 2 + 20.0 * end[1])) / 10.0
    assert list(struck["edge"][:2]) == [0, 2]
    assert struck["x"][1] == pytest.approx(10.0 + along * way[0] * time, abs=1e-6)
    assert struck["y"][1] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("restitution", [0.0, 0.5])
def test_a_point_stopped_in_a_corner_overhead_between_two_of_three_walls_stays_between_them(restitution):
    # Three walls meet at the top of a tent and divide it into two cells. In each of them the point falls on the floor.
    top, feet = (1.0, 10.0), [(-9.0, 0.0), (2.0, 0.0), (6.0, 0.0)]
    polylines = [[feet[0], top, feet[2]], [top, feet[1]]]
    walls = Walls.from_polylines(polylines, closed=[True, False], material=Material(restitution))
    cells = [shapely.Polygon([top, feet[0], feet[1]]), shapely.Polygon([top, feet[1], feet[2]])]
    for cell, velocities in zip(cells, ([(2.0, 6.0), (4.0, 8.0)], [(-1.0, 4.0), (-3.0, 9.0)]), strict=True):
        starts, speeds = zip(*(thrown_at(top, velocity, 0.0625) for velocity in velocities), strict=True)
        assert shapely.contains_xy(cell, *np.transpose(starts)).all()
        run = simulate(Scene(walls, Balls(starts, speeds), gravity=GRAVITY), until=30.0)
        places = shapely.points(run.contacts["x"], run.contacts["y"])
        assert shapely.distance(cell, places).max() < 1e-9
        assert Ending.LEFT_SCENE not in run.ending


@pytest.mark.parametrize("velocity", [(0.0, -6.0), (0.5, -6.0), (-0.25, -7.0)])
@pytest.mark.parametrize(
    ("degrees", "restitution", "ending"),
    [
        # Reflections at two walls commute where their angle is pi / n, and where it is right and they take speed.
        (60.0, 1.0, Ending.TIME_REACHED),
        (90.0, 1.0, Ending.TIME_REACHED),
        (90.0, 0.5, Ending.TIME_REACHED),
        (50.0, 1.0, Ending.AMBIGUOUS_CORNER),
        (60.0, 0.5, Ending.AMBIGUOUS_CORNER),
    ],
)
def test_orders_of_bounces_are_compared_at_the_velocity_of_the_hit(degrees, restitution, ending, velocity):
    # Thrown up, with a velocity that recedes from both walls, and falling into the tip of a valley.
    half = 10.0 * np.tan(np.radians(degrees / 2))
    valley = Walls.from_polylines([[(0.0, 0.0), (half, 10.0), (-half, 10.0)]], material=Material(restitution))
    start, speed = thrown_at((0.0, 0.0), velocity, 0.875)
    assert speed[1] > 2.0 * abs(speed[0])
    run = simulate(Scene(valley, Balls([start], [speed]), gravity=GRAVITY), until=0.9)
    assert run.ending[0] == ending
    if restitution == 1.0 and ending == Ending.TIME_REACHED:  # n bounces: straight back, or mirrored where n is odd
        back = np.array([velocity[0] if degrees == 60.0 else -velocity[0], -velocity[1]])
        place = back * 0.025 + GRAVITY * 0.025**2 / 2
        assert (run.final["x"][0], run.final["y"][0]) == pytest.approx(tuple(place), abs=1e-9)


def ring(rng, bowed):
    """A random closed room about (0, 0) with tips: vertices, bulges."""
    count = int(rng.choice([4, 6, 9, 14]))
    angles = 2 * np.pi * (np.arange(count) + 0.8 * rng.random(count)) / count
    points = (100.0 * (1 - 0.7 * rng.random(count)))[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    return points, np.where(rng.random(count) < 0.6, rng.uniform(-0.15, 0.15, count), 0.0) * bowed


def shots_at_vertices(rng, points, room, missed, count=200):
    """Starts and velocities of points that fly exactly at vertices, whose way there is inside."""
    place, angle = points[rng.integers(0, len(points), count)], rng.uniform(0, 2 * np.pi, count)
    velocity = rng.choice([1.0, 10.0, 60.0], (count, 1)) * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    time = rng.uniform(0.01, 0.4, (count, 1))
    start, velocity = thrown_at(place, velocity, time)
    inside = shapely.contains_xy(room.buffer(-missed - 1e-6), *start.T)
    for part in np.linspace(0.05, 0.99, 20):
        t = part * time
        inside &= shapely.contains_xy(room, *(start + velocity * t + GRAVITY * t * t / 2).T)
    return start[inside], velocity[inside]


@pytest.mark.parametrize("bowed", [False, True])
@pytest.mark.parametrize("restitution", [0.0, 0.5, 1.0])
def test_no_point_thrown_exactly_at_a_vertex_leaves_its_room(restitution, bowed):
    rng = np.random.default_rng(int(10 * restitution) + bowed)
    thrown = 0
    for _ in range(25):
        points, bulges = ring(rng, bowed)
        room, missed = outline(points, bulges)
        if not room.is_valid:
            continue
        start, velocity = shots_at_vertices(rng, points, room, missed)
        if not len(start):
            continue
        walls = Walls.from_polylines([points], bulges=[bulges], material=Material(restitution))
        totals = survey(Scene(walls, Balls(start, velocity), gravity=GRAVITY), until=10.0, bounces=200)
        thrown += len(start)
        assert Ending.LEFT_SCENE not in totals.ending
        # chords miss their arcs by so much; positions are off by far less than 1e-9
        assert shapely.distance(room, shapely.points(totals.position)).max() < missed + 1e-9
    assert thrown > 300


def test_many_points_at_corners_end_where_each_does_alone():
    rng = np.random.default_rng(5)
    points, bulges = ring(rng, bowed=False)
    start, velocity = shots_at_vertices(rng, points, *outline(points, bulges), count=1500)
    walls = Walls.from_polylines([points], material=Material(0.6))
    scene = Scene(walls, Balls(start, velocity), gravity=GRAVITY)
    totals, run = survey(scene, until=3.0, bounces=100), simulate(scene, until=3.0, bounces=100)
    assert len(start) > 140  # more than fly in step at a time
    assert list(totals.ending) == list(run.ending)
    assert list(totals.bounces) == list(run.bounces)
    for name, column in zip(("x", "y"), totals.position.T, strict=True):
        assert list(column) == list(run.final[name])


@pytest.mark.parametrize("drag", [None, 0.1, 1.0])
@pytest.mark.parametrize("radius", [0.3, 0.01, 1e-4, 1e-6, 1e-8])
def test_a_disc_that_comes_over_a_corner_along_its_edge_meets_one_of_the_two(radius, drag):
    # It comes from afar to where it touches the very end of a slope, in the direction of the slope, and falls on to it:
    # with v^2 / r > g the vertex alone would be grazed, and the line alone is reached from below it, beside the edge.
    rng = np.random.default_rng(4)
    for _ in range(60):
        angle = rng.uniform(-0.7, 0.7)
        way = np.array([np.cos(angle), np.sin(angle)])
        normal = np.array([-way[1], way[0]])
        block = [np.zeros(2), 30.0 * way, 30.0 * way - 5.0 * normal, 6.0 * way - 5.0 * normal]
        block[3][1] -= 40.0  # its other edge at the vertex goes down, out of the way
        block[2][1] -= 40.0
        there, fast = radius * normal + rng.normal(0.0, 1e-12, 2), rng.uniform(20.0, 40.0) * way
        start, velocity = thrown_with_drag_at(there, fast, 0.8, drag) if drag else thrown_at(there, fast, 0.8)
        room = [(-90.0, -90.0), (90.0, -90.0), (90.0, 90.0), (-90.0, 90.0)]
        scene = Scene(Walls.from_polylines([room, block]), Balls([start], [velocity], radius), gravity=GRAVITY)
        scene.drag = drag
        contacts = simulate(scene, until=0.9, bounces=50).contacts
        assert len(contacts)
        assert contacts["time"][0] == pytest.approx(0.8, abs=1e-5)
        height = contacts["x"] * normal[0] + contacts["y"] * normal[1]
        assert height.min() > radius - 1e-9
        if contacts["edge"][0] < 0:  # places are sums of parts of some 100: 64 roundings of these are 7e-13
            far = np.hypot(contacts["x"][0], contacts["y"][0])
            # without drag a larger one by its quartic
            assert far == pytest.approx(radius, abs=1e-12 if drag or radius < 1e-5 else 1e-9)


def test_bounces_that_take_all_speed_in_a_thin_tip_are_counted_only_until_that_is_sure(monkeypatch):
    # In a tip of 5 degrees with e = 0.743 < (1 - sin a) / (1 + sin a) = 0.84 bounces have no end: each pair leaves
    # the part q of the speed, so that 2^-10 of 1e-9 of it is left after log(2^-10 1e-9) / log(q) pairs.
    turn, e = np.radians(5.0), 0.743
    pair = np.eye(2)
    for normal in ([0.0, 1.0], [-np.sin(turn), np.cos(turn)]):
        pair = pair - (1.0 + e) * np.outer(normal, normal) @ pair
    pairs = np.log(2.0**-10 * 1e-9) / np.log(np.abs(np.linalg.eigvals(pair)).max())
    turns, reflect = [], point_in_corner.reflect
    monkeypatch.setattr(point_in_corner, "reflect", lambda *given: turns.append(1) or reflect(*given))
    walls = Walls.from_polylines([[(0.0, 0.0), (100.0, 0.0), (100.0, 100.0 * np.tan(turn))]], material=Material(e, 1.0))
    scene = Scene(walls, Balls([(50.0, 2.0)], [(-20.0, 0.3)], 0.0), gravity=(-1.0, -0.2))
    run = simulate(scene, until=10.0, mode="interpreted")  # which is counted
    assert run.ending == (Ending.AT_REST,)
    assert 0 < len(turns) <= 3 * 2 * (pairs + 2)  # asked once whether it comes out, and twice whether the order shows
