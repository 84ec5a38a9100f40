"""The multi-precision reference against closed forms, and against numbers from another program."""

import itertools
import math
from fractions import Fraction

import numpy as np
import pytest

from wallkit.accuracy import scenes
from wallkit.accuracy.reference import Reference, context, sure_events
from wallkit.accuracy.sure_digits import PrecisionError
from wallkit.scene.scene import Balls, Scene
from wallkit.walls import Material, Walls

VELOCITY = (50 * math.cos(math.radians(30)), 50 * math.sin(math.radians(30)))


def folded(start: Fraction, way: Fraction, low: Fraction, high: Fraction) -> Fraction:
    """Where a point is that ran ``way`` from ``start`` between two mirrors."""
    width = high - low
    place = (start + way - low) % (2 * width)
    return low + min(place, 2 * width - place)


@pytest.mark.parametrize("radius", [0.0, 5.0])
def test_the_box_unfolds(radius):
    scene = Scene(scenes.box(), Balls([(123.0, 87.0)], [VELOCITY], radius))
    events = Reference(scene, 60).run(400)
    r = Fraction(radius)
    for event in events:
        time = Fraction(str(event.time))  # 60 digits of it
        x = folded(Fraction(123), Fraction(VELOCITY[0]) * time, r, 400 - r)
        y = folded(Fraction(87), Fraction(VELOCITY[1]) * time, r, 300 - r)
        # times up to 3,000 carry 1e-56, positions 50 times that
        assert abs(Fraction(str(event.position[0])) - x) < Fraction(1, 10**50)
        assert abs(Fraction(str(event.position[1])) - y) < Fraction(1, 10**50)


# Bounce 1,000 of the ten-cornered star from (3, -7) at 30 degrees, walls counter-clockwise: time, x, y, vx, vy and
# the edge, by another program (1,024 bits for the point, 16,384 for the disc).
STAR_AT_1000 = {
    0.0: (
        "2438.630066385254484603455878973020836437",
        "70.12046409458959433694387439709117498563",
        "-173.1918548401559680886326195918529933599",
        "17.63868399174622078328842544541370923735",
        "46.78543391953649437237640685214903992123",
        7,
    ),
    5.0: (
        "2242.722215928151657165673750745590698774",
        "153.758459658735873490167417828909719445",
        "1.272217803945758378585116191395991133794",
        "-20.96006806730564404605375602360938555201",
        "45.39466429674212911081449606286406467231",
        9,
    ),
}


@pytest.mark.parametrize("radius", [0.0, 5.0])
def test_the_star_agrees_with_another_program(radius):
    turns = [0.1 + k * math.pi / 5 for k in range(10)]
    corners = [
        ((200 if k % 2 == 0 else 90) * math.cos(t), (200 if k % 2 == 0 else 90) * math.sin(t))
        for k, t in enumerate(turns)
    ]
    scene = Scene(Walls.from_polylines([corners]), Balls([(3.0, -7.0)], [VELOCITY], radius))
    last = Reference(scene, 60 if radius == 0 else 320).run(1000)[-1]
    *numbers, edge = STAR_AT_1000[radius]
    mp = context(40)
    for got, expected in zip((last.time, *last.position, *last.velocity), numbers, strict=True):
        assert abs(mp.mpf(got) - mp.mpf(expected)) < mp.mpf(10) ** -34  # they gave 40 digits of up to 5,000
    assert last.edge == edge


@pytest.mark.parametrize(("degrees", "count"), [(2.0, 90), (7.0, 25), (0.5, 359)])
def test_a_wedge_is_left_after_the_bounces_that_unfolding_counts(degrees, count):
    angle = math.radians(degrees)
    walls = Walls.from_polylines(
        [[(0, 0), (1e4, 0)], [(0, 0), (1e4 * math.cos(angle), 1e4 * math.sin(angle))]], closed=False
    )
    scene = Scene(walls, Balls([(100.0, 0.01)], [(-1.0, 0.0)]))  # parallel to a side; 0.5 and 2 divide 180: one less
    assert len(Reference(scene, 60).run(1000)) in (count, math.ceil(math.pi / angle) - 1)


@pytest.mark.parametrize("radius", [0.0, 3.0])
def test_chords_of_a_circle_are_all_alike(radius):
    scene = Scene(scenes.circle(100.0), Balls([(10.0, 20.0)], [(3.0, 4.0)], radius))
    events = Reference(scene, 60).run(200)
    steps = [b.time - a.time for a, b in itertools.pairwise(events)]
    # The four bulges tan(pi / 8) are doubles, so the arcs' centres differ by their rounding, not by 1e-60.
    assert max(steps) - min(steps) < 1e-12
    for event in events:
        x, y = event.position
        assert abs(math.hypot(x, y) - (100 - radius)) < 1e-12


def test_a_ball_larger_than_the_arc_meets_its_ends():
    half_circle = Walls.from_polylines([[(-1.0, 0.0), (1.0, 0.0)]], closed=False, bulges=[[1.0, 0.0]])  # bows down
    scene = Scene(half_circle, Balls([(0.0, 10.0)], [(0.0, -1.0)], 2.0))
    first = Reference(scene, 40).run(1)[0]
    assert (first.edge, first.vertex) in [(-1, 0), (-1, 1)]
    assert abs(float(first.position[1]) - math.sqrt(3)) < 1e-15  # r = 2 over corners 1 apart from the middle


def test_a_dropped_ball_bounces_in_the_closed_form_times():
    floor = Walls.from_polylines([[(-5.0, 0.0), (5.0, 0.0)]], closed=False, material=Material(restitution=0.5))
    scene = Scene(floor, Balls([(0.0, 1.25)], [(0.0, 0.0)], 0.25), gravity=(0.0, -9.75))
    events = Reference(scene, 60).run(20)
    mp = context(60)
    fall = mp.sqrt(2 / mp.mpf(9.75))
    for k, event in enumerate(events):
        assert abs(event.time - fall * (1 + 2 * sum(mp.mpf(0.5) ** j for j in range(1, k + 1)))) < mp.mpf(10) ** -55


def test_a_parabola_meets_an_arc_and_a_corner_where_they_are():
    walls = Walls.from_polylines(
        [[(-3.0, 0.0), (3.0, 0.0)], [(0.0, 5.0), (0.0, 6.0)]], closed=False, bulges=[[0.5, 0.0], None]
    )
    scene = Scene(walls, Balls([(0.3, 3.0)], [(-0.2, 7.0)], 0.4), gravity=(0.1, -9.81))
    events = Reference(scene, 50).run(8)
    assert any(event.edge < 0 for event in events)
    mp = context(50)
    x, y, vx, vy, now = mp.mpf(0.3), mp.mpf(3), mp.mpf(-0.2), mp.mpf(7), mp.mpf(0)
    for event in events:
        t = event.time - now
        x, y = x + vx * t + mp.mpf(0.1) * t * t / 2, y + vy * t - mp.mpf(9.81) * t * t / 2
        assert abs(event.position[0] - x) + abs(event.position[1] - y) < mp.mpf(10) ** -45
        if event.edge == 0 and event.wall == 0:  # the arc: half chord 3, bulge 0.5: radius 3.75, centre (0, 2.25)
            assert abs(mp.sqrt(x * x + (y - mp.mpf(2.25)) ** 2) - (mp.mpf(3.75) - mp.mpf(0.4))) < mp.mpf(10) ** -45
        elif event.wall == 1:
            corner = mp.mpf(5 + event.vertex)
            assert abs(mp.sqrt(x * x + (y - corner) ** 2) - mp.mpf(0.4)) < mp.mpf(10) ** -45
        vx, vy, now = *event.velocity, event.time


def test_a_one_sided_wall_lets_through_from_behind():
    gate = Walls.from_polylines([[(0.0, -1.0), (0.0, 1.0)]], closed=False, sides="outward")  # outward is +x
    through = Scene(gate, Balls([(-5.0, 0.0)], [(1.0, 0.0)]))
    back = Scene(gate, Balls([(5.0, 0.0)], [(-1.0, 0.0)]))
    assert Reference(through).run(5) == []
    assert [event.row() for event in Reference(back).run(5)] == [(5.0, 0.0, 0.0, 1.0, 0.0)]


def test_sure_events_add_digits_until_nothing_changes():
    scene = scenes.built_in()[1].scene()
    sure = sure_events(scene, 200, digits=16)
    more = Reference(scene, 200).run(200)
    assert np.allclose([e.row() for e in sure], [e.row() for e in more], rtol=1e-15, atol=1e-13)


def test_too_few_digits_are_refused():
    with pytest.raises(PrecisionError, match="fewer than a double"):
        Reference(scenes.built_in()[0].scene(), 10)
