"""Energy is counted from the lowest place that a ball can reach, and bounces are counted alike everywhere."""

import math

import numpy as np
import pytest

from wallkit import Balls, Material, Scene, Walls, simulate
from wallkit.cli.summary import energy_words
from wallkit.simulation.energy import energies, farthest
from wallkit.simulation.horizon import trusted_until
from wallkit.simulation.run import ContactKind


def half_pipe(restitution=1.0):
    """Upright walls 6 apart that end in a half circle of radius 3 below their feet at y = 0."""
    return Walls.from_polylines(
        [[(-3.0, 3.0), (-3.0, 0.0), (3.0, 0.0), (3.0, 3.0)]],
        False,
        bulges=[[0.0, 1.0, 0.0, 0.0]],
        material=Material(restitution),
    )


@pytest.mark.parametrize("turned", [0.0, 0.5, math.pi / 2, 2.0, math.pi, 5.0])
def test_walls_reach_as_far_as_their_arcs_bow(turned):
    # Three quarters of a unit circle as two arcs, turned; it reaches 1 where a direction lies in it, else to its ends.
    angle = np.array([turned, turned + 3 * math.pi / 4, turned + 3 * math.pi / 2])
    bulge = math.tan(3 * math.pi / 16)
    walls = Walls.from_polylines([np.stack([np.cos(angle), np.sin(angle)], axis=1)], False, bulges=[[bulge, bulge, 0]])
    for way in np.linspace(0.0, 2 * math.pi, 60):
        within = (way - turned) % (2 * math.pi) <= 3 * math.pi / 2
        expected = 1.0 if within else np.cos(way - angle[[0, 2]]).max()
        reached = farthest(walls, 2.0 * np.array([math.cos(way), math.sin(way)]))
        assert reached == pytest.approx(2.0 * expected, abs=1e-14)  # a few roundings of numbers up to 2


def test_a_ball_deep_in_a_half_pipe_has_energy_left():
    # From 2.5 it falls 5.4 to its lowest place, -2.9. Its wall takes speed, but what is left is never below nothing.
    scene = Scene(half_pipe(0.5), Balls([(0.0, 2.5)], [(0.0, 0.0)], 0.1), gravity=(0.0, -10.0))
    run = simulate(scene, until=1.3)
    before, change = energies(run)
    assert before[0] == pytest.approx(54.0, rel=1e-15)
    kinetic = 0.5 * float(run.final["vy"][0]) ** 2
    left = kinetic + 10.0 * (float(run.final["y"][0]) + 2.9)
    assert (before + change)[0] == pytest.approx(left, abs=1e-12)
    assert 0.0 < left < 54.0
    assert energy_words(run) == f"{left / 54.0:.2%} left (kinetic and potential)"


def test_a_ball_that_lies_at_the_lowest_place_has_none_left_and_one_that_falls_out_keeps_it():
    floor = Walls.from_polylines([[(-5.0, 0.0), (5.0, 0.0)]], False, material=Material(0.5, 0.5))
    resting = simulate(Scene(floor, Balls([(0.0, 4.0)], [(0.0, 0.0)], 1.0), gravity=(0.0, -10.0)), until=50.0)
    assert energy_words(resting) == "0.00% left (kinetic and potential)"
    falling = simulate(Scene(floor, Balls([(9.0, 4.0)], [(0.0, 0.0)], 1.0), gravity=(0.0, -10.0)), until=5.0)
    assert energy_words(falling).startswith("kept (kinetic and potential)")


def slide_through_a_sensor():
    """A disc that bounces down a slope, slides, and leaves it; two sensors on its way."""
    slope = Walls.from_polylines(
        [[(0.0, 10.0), (40.0, 0.0)], [(40.0, -5.0), (40.0, 30.0)]], False, material=Material(0.5)
    )
    sensors = Walls.from_polylines([[(1.0, -50.0), (1.0, 50.0)], [(20.0, -50.0), (20.0, 50.0)]], False)
    return Scene(slope, Balls([(5.0, 20.0)], [(3.0, 0.0)], 1.0), gravity=(0.0, -10.0), sensors=sensors)


def test_a_slide_and_a_sensor_are_no_bounces_for_the_run_the_horizon_and_the_replay():
    from wallkit.view.page.payload import horizon_table, run_table

    run = simulate(slide_through_a_sensor(), until=8.0)
    kinds = run.contacts["kind"]
    assert {ContactKind.SLIDE, ContactKind.EXIT} <= set(kinds.tolist())
    bounces = int(np.count_nonzero(kinds <= ContactKind.VERTEX))
    assert run.bounces.tolist() == [bounces]
    (said,) = run.trusted_until()
    assert said.whole
    assert said.bounces == bounces
    assert (
        trusted_until(run.scene, run.contacts, final=run.final[0]) == said
    )  # whoever gives all contacts gets the same answer
    assert f"({bounces} bounces)" in horizon_table(run)["sentence"]
    assert run_table(run)["balls"] == 1
    assert repr(run).startswith(f"<Run: 1 ball, {bounces} bounces in 8 s")


def test_states_at_many_times_are_those_at_each():
    scene = slide_through_a_sensor()
    two = Scene(scene.walls, Balls([(5.0, 20.0), (8.0, 25.0)], [(3.0, 0.0), (-1.0, 2.0)], 1.0), scene.gravity)
    for case in (two, Scene(half_pipe(), Balls([(0.0, 1.0), (1.0, 0.5)], [(1.0, 2.0), (2.0, 1.0)]), drag=0.5)):
        run = simulate(case, until=6.0)
        times = np.concatenate([np.linspace(0.0, 7.0, 57)[::-1], run.contacts["time"][:3], [math.inf]])
        position, velocity = run.position(times), run.velocity(times.tolist())
        assert position.shape == velocity.shape == (len(times), 2, 2)
        for index, time in enumerate(times.tolist()):
            assert position[index].tobytes() == run.position(time).tobytes()
            assert velocity[index].tobytes() == run.velocity(time).tobytes()
        assert run.position(times[:, None]).shape == (len(times), 1, 2, 2)
        assert run.position([]).shape == (0, 2, 2)
        contact = run.contacts[0]
        assert run.position(contact["time"])[contact["ball"]].tolist() == [contact["x"], contact["y"]]
        assert run.position(math.inf)[0].tolist() == [run.final["x"][0], run.final["y"][0]]
