"""Sensors, one-way platforms and pictures see a ball where it is while it keeps to a wall."""

import json
import math
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

import wallkit.view.page
from wallkit import Balls, Material, Scene, Walls, World, simulate, survey
from wallkit.simulation.run import ContactKind
from wallkit.view.page.payload import run_table
from wallkit.view.tracks import tracks

G = 9.81
DOWN = (0.0, -G)


def half_pipe():
    return Walls.from_polylines(
        [[[-3, 3], [-3, 0], [3, 0], [3, 3]]], bulges=[[0, 1, 0, 0]], closed=False, material=Material(0.5, 1.0)
    )


def swinging(sensors=None, radius=0.1, angle=1.0):
    rho = 3.0 - radius
    balls = Balls([rho * math.sin(angle), -rho * math.cos(angle)], [0.0, 0.0], radius)
    return Scene(half_pipe(), balls, gravity=DOWN, sensors=sensors)


GATE = Walls.from_polylines([[[0.0, -5.0], [0.0, 0.0]]], closed=False)
RING = Walls.from_polylines([[[-1.0, -2.8], [1.0, -2.8]]], bulges=[[1.0, 1.0]])  # a circle of radius 1 about (0, -2.8)


def crossings(run):
    return run.contacts[run.contacts["kind"] >= ContactKind.ENTER]


def test_a_gate_at_the_bottom_counts_every_swing():
    run = simulate(swinging(GATE), until=20.0)
    times = crossings(run)["time"]
    quarter = times[0]
    np.testing.assert_allclose(np.diff(times), 2 * quarter, rtol=1e-7)  # it was let go within rounding of the wall
    assert len(times) == int((20.0 / quarter + 1) / 2)
    sides = crossings(run)["kind"].tolist()
    assert sides == [
        ContactKind.EXIT if k % 2 == (sides[0] != ContactKind.EXIT) else ContactKind.ENTER for k in range(len(sides))
    ]


def test_a_ball_that_glides_through_a_round_sensor_enters_and_leaves_it_on_its_circle():
    seen = crossings(simulate(swinging(RING), until=20.0))
    assert len(seen) > 10
    assert seen["kind"].tolist() == [ContactKind.ENTER, ContactKind.EXIT] * (len(seen) // 2) + [ContactKind.ENTER] * (
        len(seen) % 2
    )
    np.testing.assert_allclose(np.hypot(seen["x"], seen["y"] + 2.8), 1.0, atol=1e-12)
    np.testing.assert_allclose(np.hypot(seen["x"], seen["y"]), 2.9, atol=1e-12)


def test_a_world_and_a_survey_see_the_same_crossings_of_a_gliding_ball():
    run, world = simulate(swinging(RING), until=10.0), World(swinging(RING))
    times = [float(row["time"]) for _frame in range(100) for row in world.step(0.1) if row["kind"] >= ContactKind.ENTER]
    np.testing.assert_allclose(times, crossings(run)["time"], rtol=1e-12)
    totals = survey(swinging(RING), until=10.0)
    assert totals.crossings.tolist() == [
        [int((crossings(run)["kind"] == kind).sum()) for kind in (ContactKind.ENTER, ContactKind.EXIT)]
    ]


@pytest.mark.parametrize("gravity", [DOWN, None])
@pytest.mark.parametrize("height", np.linspace(-4.5, 4.5, 7))
def test_a_disc_on_its_way_up_through_a_one_way_platform_is_not_caught_by_it_half_way(gravity, height):
    # a side wall touches it while the platform, solid from above, is across it
    level = Walls.from_polylines(
        [[[100, 0], [-100, 0]], [[30, -200], [30, 200]], [[200, -150], [-200, -150]]],
        closed=False,
        sides=["outward", "both", "both"],
        material=Material(0.5, 1.0),
    )
    start, push = np.array([25.0 - 20.0 * 0.5, height]), 2.0 if gravity is None else 5.0 + 0.5 * G * 0.5
    start[1] -= 0.5 * push - (0.125 * G if gravity is not None else 0.0)
    run = simulate(
        Scene(level, Balls(start, [20.0, push], 5.0), gravity=gravity), until=4.0 if gravity is None else 20.0
    )
    assert run.contacts["wall"][0] == 1
    assert not np.any(run.contacts["wall"][:2] == 0)
    apex = height + (push - 0.5 * G) ** 2 / (2 * G)
    if gravity is not None and apex < 5.0:  # it never left the platform, so it falls through
        assert 0 not in run.contacts["wall"]
        assert run.final["y"][0] < -100.0


def test_tracks_of_a_gliding_ball_follow_its_circle():
    run = simulate(swinging(), until=5.0)
    flight = tracks(run)
    middle = 0.5 * (flight.until - flight.time)
    place = flight.position + flight.velocity * middle[:, None] + flight.pull * (0.5 * middle**2)[:, None]
    exact = np.array([run.position(time)[0] for time in flight.time + middle])
    np.testing.assert_allclose(place, exact, atol=3e-4)
    np.testing.assert_allclose(flight.target[:-1], flight.position[1:], atol=1e-12)


@pytest.mark.skipif(shutil.which("node") is None, reason="node runs the page's script here")
def test_the_page_draws_a_gliding_ball_where_it_is(tmp_path):
    level = Walls.from_polylines(
        [[[-3, 3], [-3, 0], [3, 0], [3, 3]], [[-1, 3.5], [1, 3.5]]],
        bulges=[[0, 1, 0, 0], [0, 0]],
        closed=False,
        material=Material(0.5, 1.0),
    )
    balls = Balls([[2.9 * math.sin(1), -2.9 * math.cos(1)], [0, 3.6]], [[0, 0], [0.3, 0]], 0.1)
    run = simulate(Scene(level, balls, gravity=DOWN), until=30.0)
    assert {int(edge) for edge in run.contacts["edge"][run.contacts["kind"] == ContactKind.SLIDE]} >= {-1, 0, 1}
    (tmp_path / "run.json").write_text(json.dumps(run_table(run, horizon=False)), encoding="utf-8")
    folder = Path(wallkit.view.page.__file__).parent / "static"
    script = "".join((folder / name).read_text(encoding="utf-8") for name in ("pendulum.js", "slowed.js", "motion.js"))
    script += """
    const run = JSON.parse(require("fs").readFileSync(process.argv[1], "utf8"));
    const motion = new Wallkit.Motion(run);
    const at = (ball, time) => { const s = motion.state(ball, time); return [s.x, s.y, s.vx, s.vy]; };
    console.log(JSON.stringify([...Array(301).keys()].map((k) => [at(0, k / 10), at(1, k / 10)])));
    """
    command = [str(shutil.which("node")), "-e", script, str(tmp_path / "run.json")]
    drawn = json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)
    exact = [np.hstack([run.position(k / 10), run.velocity(k / 10)]) for k in range(301)]
    np.testing.assert_allclose(drawn, exact, atol=1e-11)
