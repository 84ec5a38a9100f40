"""What acts on a ball: gravity and rest, friction, drag, absorbing walls, sensors, sides, and overlaps at the start."""

import math

import numpy as np
import pytest

import wallkit
from wallkit.simulation.run import ContactKind, Ending

FLOOR = np.array([[-100.0, 0.0], [100.0, 0.0]])
BOX = np.array([[0.0, 0.0], [40.0, 0.0], [40.0, 30.0], [0.0, 30.0]])


def walls(*lines, closed=False, **how):
    return wallkit.Walls.from_polylines(lines, closed=closed, **how)


def test_a_thrown_ball_lands_where_the_parabola_does():
    scene = wallkit.Scene(walls(FLOOR), wallkit.Balls([0.0, 1.0], [3.0, 4.0], 0.5), gravity=(0.0, -9.81))
    contact = wallkit.simulate(scene, bounces=1).contacts[0]
    time = (4.0 + math.sqrt(16.0 + 2 * 9.81 * 0.5)) / 9.81
    assert contact["time"] == pytest.approx(time, rel=1e-15)
    assert contact["x"] == pytest.approx(3.0 * time, rel=1e-15)
    assert contact["vy"] == pytest.approx(math.sqrt(16.0 + 9.81), rel=1e-14)


@pytest.mark.parametrize("radius", [0.0, 1.0])
def test_gravity_keeps_energy_and_the_room_its_balls(radius):
    rng = np.random.default_rng(1)
    angle = 2 * np.pi * np.arange(9) / 9
    ring = 20 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    for bulges in (np.zeros(9), np.full(9, 0.08)):
        position, velocity = rng.uniform(-8, 8, (10, 2)), rng.normal(0, 12, (10, 2))
        scene = wallkit.Scene(
            wallkit.Walls.from_polylines([ring], bulges=[bulges]),
            wallkit.Balls(position, velocity, radius),
            gravity=(2.0, -9.81),
        )
        one = wallkit.simulate(scene, bounces=150, mode="interpreted")
        other = wallkit.simulate(scene, bounces=150, mode="compiled")
        assert one.contacts.tobytes() == other.contacts.tobytes()
        c = one.contacts
        energy = 0.5 * (c["vx"] ** 2 + c["vy"] ** 2) - 2.0 * c["x"] + 9.81 * c["y"]
        first = 0.5 * (velocity**2).sum(axis=1) - position @ [2.0, -9.81]
        np.testing.assert_allclose(energy, first[c["ball"]], atol=1e-11)
        assert np.hypot(c["x"], c["y"]).max() < 25.0
        assert set(one.ending) == {Ending.BOUNCE_LIMIT}


def test_a_ball_slides_down_a_slope_and_flies_off_its_end():
    slope = np.array([[0.0, 10.0], [10.0, 0.0]])
    steel = wallkit.Material(0.5, 1.0)
    scene = wallkit.Scene(walls(slope, material=steel), wallkit.Balls([2.0, 8.5], [0.0, 0.0]), gravity=(0.0, -10.0))
    run = wallkit.simulate(scene, until=10.0)
    kinds = run.contacts["kind"]
    assert ContactKind.SLIDE in kinds
    assert kinds[-1] == ContactKind.LEAVE
    leave = run.contacts[-1]
    # no friction: tangential bounces lose nothing, normal ones lose what the drop along the normal had given
    assert (leave["x"], leave["y"]) == (pytest.approx(10.0, abs=1e-9), pytest.approx(0.0, abs=1e-9))
    assert leave["vx"] == pytest.approx(-leave["vy"], rel=1e-12)
    along = math.hypot(leave["vx"], leave["vy"])
    way = math.hypot(10.0 - 2.0, 8.5) * math.cos(math.atan2(8.5, 8.0) - math.pi / 4)
    assert along == pytest.approx(math.sqrt(2 * 10.0 * math.sin(math.pi / 4) * way), rel=1e-9)
    half = 0.5 * (run.contacts["time"][-2] + leave["time"])
    x, y = run.position(half)[0]
    assert x + y == pytest.approx(10.0, abs=1e-9)
    assert run.ending == (Ending.LEFT_SCENE,)


def test_tangential_loss_brings_a_ball_to_rest():
    scene = wallkit.Scene(
        walls(FLOOR, material=wallkit.Material(0.6, 0.8)),
        wallkit.Balls([0.0, 2.0], [1.0, 0.0], 0.5),
        gravity=(0, -9.81),
    )
    run = wallkit.simulate(scene, until=100.0)
    assert run.ending == (Ending.AT_REST,)
    assert run.final["time"][0] == pytest.approx(math.sqrt(2 * 1.5 / 9.81) * 1.6 / 0.4, rel=1e-12)
    assert run.velocity(50.0).tolist() == [[0.0, 0.0]]


def test_rolling_friction_stops_after_its_way():
    scene = wallkit.Scene(walls(BOX, closed=True), wallkit.Balls([20.0, 15.0], [30.0, 40.0], 1.0), rolling_friction=5.0)
    run = wallkit.simulate(scene, until=100.0)
    assert run.ending == (Ending.AT_REST,)
    assert run.final["time"][0] == pytest.approx(10.0, rel=1e-13)
    size = np.array([38.0, 28.0])
    straight = np.array([19.0, 14.0]) + np.array([0.6, 0.8]) * 250.0
    folded = np.abs((straight + size) % (2 * size) - size) + 1.0
    np.testing.assert_allclose(run.position(11.0)[0], folded, atol=1e-10)
    np.testing.assert_allclose(np.hypot(*run.velocity(4.0)[0]), 30.0, rtol=1e-12)


def test_drag_changes_the_clock_and_not_the_path():
    balls = wallkit.Balls([20.0, 15.0], [30.0, 40.0], 1.0)
    plain = wallkit.simulate(wallkit.Scene(walls(BOX, closed=True), balls), until=1.5).contacts
    run = wallkit.simulate(wallkit.Scene(walls(BOX, closed=True), balls, drag=0.5), until=2.0)
    count = len(run.contacts)
    assert count > 2
    np.testing.assert_array_equal(run.contacts["x"], plain["x"][:count])
    np.testing.assert_allclose(run.contacts["time"], -np.log1p(-0.5 * plain["time"][:count]) / 0.5, rtol=1e-13)
    assert np.hypot(*run.velocity(2.0)[0]) == pytest.approx(50 * math.exp(-1.0), rel=1e-12)


def test_an_absorbing_wall_keeps_the_ball():
    scene = wallkit.Scene(walls(BOX, closed=True, material=wallkit.Material(0.0, 0.0)), wallkit.Balls([20, 15], [3, 4]))
    run = wallkit.simulate(scene, until=100.0)
    assert run.ending == (Ending.ABSORBED,)
    assert len(run.contacts) == 1


def test_sensors_report_and_do_not_bounce():
    line = wallkit.Walls.from_polylines(
        [[[10.0, -1.0], [10.0, 31.0]], [[20.0, 10.0], [30.0, 10.0], [30.0, 20.0], [20.0, 20.0]]], closed=[False, True]
    )
    balls = wallkit.Balls([5.0, 15.0], [5.0, 0.0])
    plain = wallkit.simulate(wallkit.Scene(walls(BOX, closed=True), balls), until=14.0)
    run = wallkit.simulate(wallkit.Scene(walls(BOX, closed=True), balls, sensors=line), until=14.0)
    seen = run.contacts[run.contacts["kind"] >= ContactKind.ENTER]
    assert seen["time"].tolist() == [1.0, 3.0, 5.0, 9.0, 11.0, 13.0]
    assert seen["wall"].tolist() == [0, 1, 1, 1, 1, 0]
    assert [ContactKind(k) for k in seen["kind"]] == [
        ContactKind.EXIT,
        ContactKind.ENTER,
        ContactKind.EXIT,
        ContactKind.ENTER,
        ContactKind.EXIT,
        ContactKind.ENTER,
    ]
    assert run.bounces.tolist() == [1] == plain.bounces.tolist()
    np.testing.assert_array_equal(run.position(13.5), plain.position(13.5))


@pytest.mark.parametrize("radius", [0.0, 1.0])
def test_one_sided_walls_let_through_from_behind(radius):
    both = wallkit.Walls.from_polylines(
        [BOX, [[20.0, 0.0], [20.0, 30.0]]], closed=[True, False], sides=["both", "outward"]
    )
    from_left = wallkit.simulate(wallkit.Scene(both, wallkit.Balls([10.0, 15.0], [1.0, 0.0], radius)), until=30.5)
    from_right = wallkit.simulate(wallkit.Scene(both, wallkit.Balls([30.0, 15.0], [-1.0, 0.0], radius)), until=25.0)
    assert from_left.contacts["wall"].tolist() == [0]
    assert from_right.contacts["wall"].tolist()[:1] == [1]


def test_an_overlap_at_the_start_is_an_error_with_place_and_depth():
    scene = wallkit.Scene(walls(BOX, closed=True), wallkit.Balls([[20.0, 15.0], [39.0, 15.0]], [[1, 0], [1, 0]], 2.0))
    with pytest.raises(wallkit.SceneError, match=r"ball 1 at \(39, 15\) overlaps wall 0 by 1"):
        wallkit.simulate(scene, until=1.0)
    run = wallkit.simulate(scene, until=0.0, settle=True)
    assert run.position(0.0)[1] == pytest.approx([38.0, 15.0], abs=1e-9)
    touching = wallkit.Scene(walls(BOX, closed=True), wallkit.Balls([38.0, 15.0], [1.0, 0.0], 2.0))
    assert wallkit.simulate(touching, bounces=1).contacts["time"].tolist() == [0.0]
