"""The promised horizon against runs that really depart: the same steps in 53 bits, and with as many as needed."""

import math

import numpy as np
import pytest

from wallkit import simulate
from wallkit.accuracy import scenes
from wallkit.accuracy.contact_scenes import contact_scene, hard_scene, rolling_scene
from wallkit.accuracy.reference import Reference, sure_events
from wallkit.accuracy.reference_contact import ContactReference
from wallkit.kernels.flight.error_growth import JOINS, stretch
from wallkit.scene.scene import Balls, Scene
from wallkit.simulation import horizon
from wallkit.simulation.near_misses import NEAR_CORNER, NEAR_GRAZE, near_misses
from wallkit.simulation.run import CONTACT, Ending
from wallkit.walls import Material, Walls

BOUNCES = 160
CASES = [(scene, radius) for scene in scenes.built_in() for radius in (0.0, scene.radius)]


def as_contacts(scene, events):
    rows = np.zeros(len(events), CONTACT)
    for row, event in zip(rows, events, strict=True):
        row["time"], row["x"], row["y"], row["vx"], row["vy"] = event.row()
        row["nx"], row["ny"] = map(float, event.normal)
        row["wall"], row["edge"], row["kind"] = event.wall, event.edge, event.edge < 0
    return rows


def in_doubles(scene, bounces):
    """The reference's own steps, rounded to 53 bits each: a double-precision simulator that shares no code."""
    runner = Reference(scene, 17)
    runner.mp.prec = 53
    return runner.run(bounces)


def places(events):
    return np.array([[float(v) for v in event.position] for event in events])


@pytest.mark.parametrize(("built_in", "radius"), CASES, ids=[f"{s.name}-{r:g}" for s, r in CASES])
def test_the_promise_holds_and_is_not_shy(built_in, radius):
    scene = built_in.scene(radius=radius)
    rounded = in_doubles(scene, BOUNCES)
    error = np.hypot(*(places(rounded) - places(sure_events(scene, BOUNCES))).T)
    real = next((k for k, e in enumerate(error) if e > 1e-6), BOUNCES)
    promised = horizon.trusted_until(scene, as_contacts(scene, rounded)).bounces
    assert promised <= real <= promised + 1  # twice the error is promised, and it grows by two and more at a bounce


@pytest.mark.parametrize("seed", [seed for seed in range(3000, 3040) if seed != 3013])  # which starts in a wall
def test_what_a_run_is_off_is_known_from_its_contacts(seed):
    # The judge's places are rounded, and so are the derivatives, which a near graze or a near parallel multiplies.
    _kind, scene, until = hard_scene(seed)
    run = simulate(scene, until=until)
    true = [change for change in ContactReference(scene).run(until) if change.kind == "bounce"]
    own = run.contacts[run.contacts["kind"] <= 1]
    count = min(len(own), len(true))
    same = [(a["wall"], a["edge"]) == (b.wall, b.edge) for a, b in zip(own, true, strict=False)]
    count = same.index(False) if False in same else count
    off = np.hypot(*(np.stack([own["x"], own["y"]], axis=1)[:count] - places(true[:count])).T)
    if scene.walls.materials[0].restitution == 1.0:  # nothing is held by a wall
        expected, _worst = horizon.predicted_errors(scene, own)
        judged = (off > 2e-14) & (off < 1e-7)
        np.testing.assert_allclose(expected[:count][judged], off[judged], rtol=0.2)


def test_a_long_run_that_chaos_ends_is_asked_for_its_beginning_alone(monkeypatch):
    walls = Walls.from_polylines([[(-4, -3), (-4, 3), (4, 3), (4, -3)]], bulges=[[-1.0, 0.0, -1.0, 0.0]])
    scene = Scene(walls, Balls([(0.3, 0.2)], [(2.0, 1.0)]))
    own = simulate(scene, bounces=2500).contacts
    whole = horizon.predicted_errors(scene, own)
    assert not np.isfinite(whole[0][-1])
    monkeypatch.setattr(horizon, "FIRST", 1200)
    np.testing.assert_array_equal(horizon.predicted_errors(scene, own), whole)


def test_a_long_run_s_horizon_is_compiled_to_the_same_bits(monkeypatch):
    scene = Scene(scenes.star(), Balls([(3.0, -7.0)], [(40.0, 25.0)], 5.0), gravity=(0.0, -1.0))
    own = simulate(scene, bounces=40).contacts
    interpreted = horizon.predicted_errors(scene, own)
    monkeypatch.setattr(horizon, "COMPILED_FROM", 0)
    np.testing.assert_array_equal(horizon.predicted_errors(scene, own), interpreted)


def test_a_small_error_grows_as_two_runs_part():
    # The derivative against a difference: runs 1e-30 apart at 80 digits, gravity, restitution, arcs and corners.
    walls = Walls.from_polylines(
        [[(-6, -4), (6, -4), (6, 8), (-6, 8)], [(-2.0, 0.0), (2.0, 0.5)]],
        closed=[True, False],
        bulges=[[0.3, 0.0, -0.1, 0.2], [0.4, 0.0]],
        material=[Material(0.98, 0.97), Material(0.95, 1.0)],
    )
    start, aim, tiny = (0.3, 4.0), (2.0, 1.0), 1e-30
    scene = Scene(walls, Balls([start], [aim], 0.5), gravity=(0.2, -3.0))
    runner = Reference(scene, 80)
    near = Reference(scene, 80)
    near._vector = lambda pair: tuple(  # its start moved by tiny times the first error that `growth` carries
        near.mp.mpf(float(v)) + tiny * d
        for v, d in zip(pair, {start: (0.6, 0.3), aim: (0.2, 0.7)}.get(tuple(map(float, pair)), (0, 0)), strict=True)
    )
    events, neighbours = runner.run(12), near.run(12)
    logs = horizon.growth(scene, as_contacts(scene, events))
    # The neighbour's state at the run's own time of contact: it has bounced at another time, so it is flown there.
    for k, (event, other) in enumerate(zip(events, neighbours, strict=True)):
        position, velocity = near._fly(other.position, other.velocity, event.time - other.time)
        apart = [p - q for p, q in zip((*position, *velocity), (*event.position, *event.velocity), strict=True)]
        size = float(runner.mp.sqrt(sum(d * d for d in apart)) / tiny)
        # each bounce of the prediction is in doubles: 1e-13 of it after a dozen of growth
        assert math.log(size) == pytest.approx(logs[: k + 1].sum(), abs=1e-9)


def test_a_hit_beside_a_corner_ends_trust():
    # A point aimed 1e-12 beside the reflex corner of an L: a rounding decides after a few bounces of a box.
    walls = scenes.room([(0, 0), (0, 2), (1, 2), (1, 1), (2, 1), (2, 0)])
    scene = Scene(walls, Balls([(0.25, 0.5 + 1e-16)], [(3.0, 2.0)]))
    events = Reference(scene, 60).run(60)
    said = horizon.trusted_until(scene, as_contacts(scene, events), tolerance=1e-3)
    assert said.reason == "corner"
    assert not said.whole


def test_sentences_are_for_people():
    assert horizon.Horizon(1e-6, 152, 3.5, False, reason="growth").sentence() == (
        "good to 1e-6 up to bounce 152; chaos after that"
    )
    assert horizon.Horizon(1e-6, 1000, 9.0, True).sentence() == "good to 1e-6 throughout (1000 bounces)"


def test_a_run_says_it_itself():
    scene = Scene(scenes.star(), Balls([(3.0, -7.0), (3.0, -7.0)], [(40.0, 25.0), (40.0, 26.0)], 5.0))
    run = simulate(scene, bounces=300)
    mine = horizon.trusted_until(scene, run.contacts, 1, 1e-3)
    assert [said.bounces for said in run.trusted_until(1e-3)][1] == mine.bounces
    assert run.trusted_until(1e-9)[0].bounces < run.trusted_until(1e-3)[0].bounces < 300
    short = simulate(scene, until=5.0).trusted_until()[0]
    assert (short.whole, short.time) == (True, 5.0)


def test_flattened_walls_are_trusted_less_far():
    built = next(scene for scene in scenes.built_in() if scene.name == "stadium")
    walls = built.lines(0.001)
    walls.measured_error = 0.001
    scene = Scene(walls, Balls([built.position], [built.velocity]))
    contacts = as_contacts(scene, sure_events(scene, 40))
    rounding = horizon.trusted_until(scene, contacts, tolerance=0.1)
    drawing = horizon.trusted_until(scene, contacts, tolerance=0.1, source="drawing")
    exact = Reference(built.scene(radius=0.0), 60).run(40)
    parted = np.hypot(*(places(exact) - places(sure_events(scene, 40))).T)
    real = next(k for k, e in enumerate(parted) if e > 0.1)
    assert drawing.bounces <= real
    assert drawing.bounces < rounding.bounces


def test_a_wall_that_is_off_moves_the_place_at_which_it_is_met():
    # the first wall moved out by d along its normal is met at d / sin(a) farther on, a the angle to the wall
    walls = scenes.room([(0, 0), (0, 4), (10, 4), (10, 0)])
    walls.measured_error, angle = 0.01, math.radians(30)
    scene = Scene(walls, Balls([(2.0, 1.0)], [(math.cos(angle), math.sin(angle))]))
    rms, _worst = horizon.predicted_errors(scene, simulate(scene, bounces=1).contacts, source="drawing")
    assert rms[0] == pytest.approx(0.01 / math.sin(angle), rel=1e-12)


def test_a_hollow_met_along_its_tangent_is_met_where_it_begins():
    # a point falls along the upright side of a half pipe on to the arc that goes on from it: they part as y^2 / 2 R, so
    # that a rounding of 1e-16 in the gap alone would decide over 1e-8
    _kind, scene, until = contact_scene(11349)
    run, true = simulate(scene, until=until), ContactReference(scene).run(until)
    row = next(k for k, change in enumerate(true) if change.kind == "leave") + 1
    met, own = true[row], run.contacts[run.contacts["time"] > float(true[row - 1].time) + 0.1][0]
    assert math.hypot(own["x"] - float(met.position[0]), own["y"] - float(met.position[1])) < 1e-13


def test_a_run_is_good_throughout_if_its_end_is():
    # off a pillar of radius 1e-3 an error of place turns the flight by 2,000 times as much, for 1e6 s
    pillar = Walls.from_polylines([[(1e-3, 0.0), (-1e-3, 0.0)]], bulges=[[1.0, 1.0]])
    scene = Scene(pillar, Balls([(-5.0, 0.3e-3)], [(1.1, 0.0)], 0.0))
    event = Reference(scene).run(1)[0]
    for until, good in ((10.0, True), (1e6, False)):
        run = simulate(scene, until=until)
        flown = [float(p + v * (until - event.time)) for p, v in zip(event.position, event.velocity, strict=True)]
        off = math.hypot(run.final["x"][0] - flown[0], run.final["y"][0] - flown[1])
        said = run.trusted_until(1e-9)[0]
        assert (off <= 1e-9) == good == said.whole
        assert said.bounces == 1


@pytest.mark.parametrize("seed", [179, 45, 62, 129])
def test_the_end_of_a_slowed_slide_is_off_by_no_more_than_predicted_and_not_by_far_less(seed):
    # 179: endless bounces that stop a disc end later, and so farther along; the others turn round in a bowl or a pipe,
    # where what slows a ball down is turned round with it
    _kind, scene, until = rolling_scene(seed)
    run, true = simulate(scene, until=until), ContactReference(scene).run(until)[-1]
    off = math.hypot(run.final["x"][0] - float(true.position[0]), run.final["y"][0] - float(true.position[1]))
    own = horizon._and_end(run.contacts[run.contacts["kind"] < horizon.ENTER], run.final[0])
    promised = horizon.predicted_errors(scene, own)[1][-1]
    assert off <= promised <= 1e-8


@pytest.mark.parametrize("seed", [15437, 18275, 18887, 19613])
def test_a_hit_in_a_corner_by_a_ball_that_still_hops_on_the_other_wall_is_not_called_good(seed):
    # It has joined a wall, and meets the next one before its endless bounces, lower than 2^-41 of the walls, are over.
    _kind, scene, until = contact_scene(seed)
    run = simulate(scene, until=until)
    true = iter(change for change in ContactReference(scene).run(until) if change.kind == "bounce")
    promised = horizon.predicted_errors(scene, run.contacts)[1]
    for row, most in zip(run.contacts, promised, strict=True):
        if row["kind"] <= horizon.VERTEX:
            place = next(true).position
            assert math.hypot(row["x"] - float(place[0]), row["y"] - float(place[1])) <= most


def test_a_hollow_that_is_met_along_its_tangent_ends_no_trust():
    # Down an upright side of a half pipe into its arc: what a neighbour, off by d, loses there is of the size of d.
    _kind, scene, until = contact_scene(11349)
    run, true = simulate(scene, until=until), ContactReference(scene).run(until)[-1]
    assert run.trusted_until(1e-6)[0].whole
    off = math.hypot(run.final["x"][0] - float(true.position[0]), run.final["y"][0] - float(true.position[1]))
    own = horizon._and_end(run.contacts[run.contacts["kind"] < horizon.ENTER], run.final[0])
    assert off <= horizon.predicted_errors(scene, own)[1][-1] <= 1e-8


@pytest.mark.parametrize("aside", [1e-6, 1e-7, 1e-9])
def test_a_point_that_comes_down_beside_a_hollow_s_tangent_parts_by_no_more_than_is_carried(aside):
    # Beside the upright side by `aside` it strikes the arc below at a small angle and hops on it.
    _kind, scene, _until = contact_scene(11349)
    (x, y), runs = scene.walls.vertices[0], []
    for off in (0.0, aside):
        ball = Balls([(x + off, y + 0.3)], [(0.0, 1.0)], 0.0)
        runs.append(simulate(Scene(scene.walls, ball, gravity=scene.gravity), until=1.5))
    own = horizon._and_end(runs[0].contacts, runs[0].final[0])
    course = horizon._course(runs[0].scene, own, 0)
    assert course[1][0, 5] == JOINS
    # that one error alone: the logarithms of its growth, which begins with a length of 1
    logs = np.zeros(len(own))
    stretch(*course, np.array([1.0, 0.0, 0.0, 0.0]), logs)
    apart = math.dist(*((run.final["x"][0], run.final["y"][0]) for run in runs))
    assert 0.0 < apart <= 1.5 * aside * math.exp(logs.sum())


def test_a_ball_that_comes_to_rest_is_good_throughout():
    # What restitution takes from the speed it takes from the error too; where it lies down is where it lies.
    floor = Walls.from_polylines([[(-5.0, 0.0), (5.0, 0.0)]], closed=False, material=Material(0.5, 1.0))
    scene = Scene(floor, Balls([(0.0, 1.0)], [(0.1, 0.0)], 0.1), gravity=(0.0, -9.81))
    run = simulate(scene, until=20.0)
    (said,) = run.trusted_until(1e-9)
    assert said.whole


@pytest.mark.parametrize("seed", [18483, 18525])
def test_the_end_of_a_slide_after_endless_bounces_on_an_arc_is_off_by_what_is_known(seed):
    # Bounces that take speed along the arc change what presses the ball on it, and its normal turns on their way.
    _kind, scene, until = contact_scene(seed)
    run, true = simulate(scene, until=until), ContactReference(scene).run(until)
    row, slide = np.flatnonzero(run.contacts["kind"] == 2)[0], next(c for c in true if c.kind == "slide")
    own = run.contacts[row]
    off = math.hypot(own["x"] - float(slide.position[0]), own["y"] - float(slide.position[1]))
    assert off == pytest.approx(horizon.predicted_errors(scene, run.contacts)[0][row], rel=0.05)
    assert own["time"] == pytest.approx(float(slide.time), abs=1e-13)


def test_a_run_that_ends_at_rest_in_a_tip_says_how_far_off_that_may_be():
    # it stops where it hits the tip within the tolerance, 2^-41 of the walls' size, while it is to come to rest in it
    _kind, scene, until = contact_scene(15389)
    run = simulate(scene, until=until)
    tip = scene.walls.vertices - np.array([run.final["x"][0], run.final["y"][0]])
    off = np.hypot(*tip.T).min()
    assert run.ending[0] == Ending.AT_REST
    assert 1e-11 < off < 1e-10
    assert not run.trusted_until(off / 2)[0].whole
    assert run.trusted_until(10 * off)[0].whole


@pytest.mark.parametrize("gravity", [None, (0.0, -9.81)])
@pytest.mark.parametrize("by", [1e-9, 1e-3])
def test_a_corner_passed_by_a_hair_is_noticed(gravity, by):
    # The disc of radius 1 flies over the end of a stick, as near as `by`; under gravity at the top of its throw.
    down = 0.0 if gravity is None else 9.81 * 3.0  # the top after 3 s
    height = 1.0 + by - (0.0 if gravity is None else 0.5 * 9.81 * 9.0)
    walls = Walls.from_polylines([[(0.0, 0.0), (0.0, -200.0)], [(25.0, -300.0), (25.0, 300.0)]], closed=False)
    scene = Scene(walls, Balls([(-15.0, height)], [(5.0, down)], 1.0), gravity=gravity)
    contacts = simulate(scene, bounces=1).contacts
    assert contacts["wall"].tolist() == [1]
    near = list(near_misses(scene, horizon._flights(scene, contacts, 0), 1.0, 1e-6))
    found = [clear for flights, clear, what in near if what == NEAR_CORNER and len(flights)]
    assert len(found) == (by < 1e-6)
    if found:
        assert found[0][0] == pytest.approx(by, abs=1e-13)


def test_a_parabola_that_turns_round_just_below_a_ceiling_is_noticed():
    walls = scenes.room([(0, 0), (0, 8), (20, 8), (20, 0)])
    up = math.sqrt(2 * 9.81 * (7.0 - 1e-8 - 2.0))  # from 2 to 1e-8 below where a disc of radius 1 touches
    scene = Scene(walls, Balls([(3.0, 2.0)], [(2.0, up)], 1.0), gravity=(0.0, -9.81))
    contacts = simulate(scene, bounces=1).contacts
    near = list(near_misses(scene, horizon._flights(scene, contacts, 0), 1.0, 1e-6))
    clear = [found for flights, found, what in near if what == NEAR_GRAZE and len(flights)]
    assert clear[0][0] == pytest.approx(1e-8, abs=1e-13)


@pytest.mark.parametrize("gravity", [None, (0.0, -9.81)])
@pytest.mark.parametrize("radius", [0.0, 1.0])
def test_what_a_tree_finds_near_a_path_is_what_all_pairs_give(gravity, radius, monkeypatch):
    rng = np.random.default_rng(3)
    sticks = [np.add(rng.uniform(4, 56, 2), [(0, 0), rng.uniform(-3, 3, 2)]) for _ in range(40)]
    walls = Walls.from_polylines(
        [[(0, 0), (0, 60), (60, 60), (60, 0)], *sticks],
        closed=[True] + [False] * 40,
        bulges=[[0.0, 0.3, 0.0, 0.0]] + [[0.5, 0.0]] * 20 + [[0.0, 0.0]] * 20,
    )
    scene = Scene(walls, Balls([(2.0, 2.0)], [(7.0, 9.0)], radius), gravity=gravity)
    flights = horizon._flights(scene, simulate(scene, bounces=30).contacts, 0)
    by_pairs = list(near_misses(scene, flights, radius, 0.5))
    assert sum(len(found) for found, _, _ in by_pairs)
    monkeypatch.setattr("wallkit.simulation.near_misses._ALL_PAIRS", 0)
    for (found, clear, what), other in zip(by_pairs, near_misses(scene, flights, radius, 0.5), strict=True):
        assert sorted(zip(found, clear, strict=True)) == sorted(zip(other[0], other[1], strict=True))
        assert what == other[2]


@pytest.mark.parametrize("acts", [{"rolling_friction": 0.04}, {"drag": 1e-3}], ids=str)
def test_what_slows_a_ball_down_leaves_its_errors_as_they_are(acts):
    walls = Walls.from_polylines([scenes.star().vertices], material=Material(0.99, 0.98))
    walls.measured_error = 1e-9  # of roundings those of a flight that nothing slows down are known, the others not
    balls = Balls([(3.0, -7.0)], [(40.0, 25.0)], 5.0)
    plain = simulate(Scene(walls, balls), bounces=40)
    run = simulate(Scene(walls, balls, **acts), bounces=40)
    assert len(run.contacts) == 40
    assert np.hypot(run.final["vx"], run.final["vy"]) < 0.95 * np.hypot(plain.final["vx"], plain.final["vy"])
    expected, _worst = horizon.predicted_errors(plain.scene, plain.contacts, source="drawing")
    found, _worst = horizon.predicted_errors(run.scene, run.contacts, source="drawing")
    np.testing.assert_allclose(found, expected, rtol=1e-3)
    said = [each.trusted_until(1e-6, source="drawing")[0].bounces for each in (run, plain)]
    assert said[0] == said[1] < 40


def test_a_small_error_grows_as_two_runs_with_drag_under_gravity_part():
    walls = Walls.from_polylines(
        [[(-6, -4), (6, -4), (6, 8), (-6, 8)], [(-2.0, 0.0), (2.0, 0.5)]],
        closed=[True, False],
        bulges=[[0.3, 0.0, -0.1, 0.2], [0.4, 0.0]],
        material=[Material(0.98, 0.97), Material(0.95, 1.0)],
    )
    acts, tiny, error = {"gravity": (0.2, -3.0), "drag": 0.15}, 1e-8, np.array([0.6, 0.3, 0.2, 0.7])
    begin = np.array([0.3, 4.0, 2.0, 1.0])
    runs = [
        simulate(Scene(walls, Balls([state[0:2]], [state[2:4]], 0.5), **acts), bounces=9)
        for state in (begin, begin + tiny * error)
    ]
    grown = np.cumsum(horizon.growth(runs[0].scene, runs[0].contacts))
    for contact, expected in zip(runs[0].contacts[:8], grown, strict=False):
        time = float(contact["time"]) + 1e-5  # when both have had it
        states = [np.concatenate([run.position(time)[0], run.velocity(time)[0]]) for run in runs]
        assert np.hypot.reduce(states[1] - states[0]) == pytest.approx(tiny * math.exp(expected), rel=1e-3)


@pytest.mark.parametrize("drag", [0.01, 0.4])
def test_a_way_with_drag_that_turns_round_just_below_a_ceiling_is_noticed(drag):
    # up from 2 it comes by v / k - g log(1 + k v / g) / k^2, to 1e-8 below where a disc of radius 1 touches
    gravity, way = 9.81, 5.0 - 1e-8
    low, high = 1.0, 40.0
    for _ in range(200):
        up = 0.5 * (low + high)
        low, high = (up, high) if up / drag - gravity * math.log1p(drag * up / gravity) / drag**2 < way else (low, up)
    walls = scenes.room([(0, 0), (0, 8), (20, 8), (20, 0)])
    scene = Scene(walls, Balls([(3.0, 2.0)], [(2.0, up)], 1.0), gravity=(0.0, -gravity), drag=drag)
    contacts = simulate(scene, bounces=1).contacts
    near = list(near_misses(scene, horizon._flights(scene, contacts, 0), 1.0, 1e-6))
    clear = [found for flights, found, what in near if what == NEAR_GRAZE and len(flights)]
    assert clear[0][0] == pytest.approx(1e-8, abs=1e-11)


@pytest.mark.parametrize("seed", range(3))
def test_no_contact_under_gravity_is_farther_off_than_promised(seed):
    # a room with some round sides and things in it; what is promised is three times the root mean square of errors that
    # are carried along to first order, and none of a dozen contacts may be beyond
    rng = np.random.default_rng(seed)
    size = rng.uniform(60, 200, 2)
    outlines, bulges = [[(0, 0), (0, size[1]), size, (size[0], 0)]], [rng.uniform(-0.3, 0.3, 4) * (rng.random(4) < 0.5)]
    for _ in range(2):
        angle, far = np.sort(rng.uniform(0, 2 * np.pi, 3)), rng.uniform(3, 15)
        middle = rng.uniform(0.3 * size, 0.7 * size)
        outlines.append(middle + far * np.stack([np.cos(angle), np.sin(angle)], axis=1))
        bulges.append(rng.uniform(-1, 1, 3) * (rng.random(3) < 0.5))
    walls = Walls.from_polylines(outlines, bulges=bulges)
    aim = rng.uniform(-80, 80, 2)
    scene = Scene(walls, Balls([0.15 * size], [aim], float(rng.choice([0.0, 1.0, 4.0]))), gravity=(0.0, -90.0))
    run = simulate(scene, bounces=12)
    true = Reference(scene, 36).run(12)
    assert [event.wall for event in true] == run.contacts["wall"].tolist()
    off = np.hypot(*(places(true) - np.stack([run.contacts["x"], run.contacts["y"]], axis=1)).T)
    _rms, worst = horizon.predicted_errors(scene, run.contacts)
    assert (off <= worst).all()
