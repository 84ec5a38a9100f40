"""Discs that meet, against closed forms; interpreted, and so without a wait for a compiler, but where it says so."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from jsonschema import Draft202012Validator

import wallkit
import wallkit.schemas
from wallkit.simulation import meeting
from wallkit.simulation.meeting_run import simulate_meeting

SCHEMAS = Path(wallkit.schemas.__file__).parent
BOX = [(0.0, 0.0), (0.0, 10.0), (10.0, 10.0), (10.0, 0.0)]

BOX_SCENE = {"format": "wallkit-scene", "walls": [{"vertices": BOX}]}


def room(width: float = 10.0, height: float = 10.0, **material: float) -> wallkit.Walls:
    corners = [(x / 10.0 * width, y / 10.0 * height) for x, y in BOX]
    return wallkit.Walls.from_polylines([corners], material=[wallkit.Material(**material)])


def gas(seed: int = 1, **scene: Any) -> wallkit.Scene:
    """Twenty-five discs of four sizes and as many masses in a box."""
    random = np.random.default_rng(seed)
    places = np.array([(x, y) for x in range(1, 10, 2) for y in range(1, 10, 2)], dtype=float)
    radius, mass = random.choice([0.3, 0.5, 0.7, 0.9], 25), random.uniform(0.5, 3.0, 25)
    balls = wallkit.Balls(places, random.normal(size=(25, 2)), radius, mass)
    return wallkit.Scene(room(), balls, meeting=True, **scene)


def states(run: wallkit.Run) -> np.ndarray[Any, Any]:
    return np.stack([run.final[name] for name in ("x", "y", "vx", "vy")], axis=1)


def test_two_discs_that_meet_off_centre_exchange_their_speeds_along_the_line_of_centres() -> None:
    """Radius 1, the second at rest at (4, 1.2): they touch at dx = 1.6, dy = 1.2, so n = (0.8, 0.6), after 2.4."""
    balls = wallkit.Balls([(2, 4), (6, 5.2)], [(1, 0), (0, 0)], 1.0)
    run = wallkit.simulate(wallkit.Scene(room(), balls, meeting=True), until=3.0)
    (contact,) = run.contacts
    assert contact["time"] == pytest.approx(2.4, rel=1e-15)
    assert (contact["ball"], contact["other"], contact["wall"], contact["edge"]) == (0, 1, -1, -1)
    assert contact["kind"] == wallkit.ContactKind.BALL
    assert (contact["nx"], contact["ny"]) == pytest.approx((-0.8, -0.6), rel=1e-14)
    assert (contact["px"], contact["py"]) == pytest.approx((5.2, 4.6), rel=1e-15)
    assert (contact["vx"], contact["vy"]) == pytest.approx((0.36, -0.48), rel=1e-14)  # what is across the line stays
    assert (contact["other_vx"], contact["other_vy"]) == pytest.approx((0.64, 0.48), rel=1e-14)
    assert run.bounces.tolist() == [1, 1]


@pytest.mark.parametrize(("e", "f"), [(1.0, 1.0), (0.5, 1.0), (0.8, 0.3), (0.0, 0.0)])
def test_masses_and_both_restitutions_give_the_closed_form(e: float, f: float) -> None:
    balls = wallkit.Balls([(2, 4), (6, 5.2)], [(1, 0), (-1, 0.25)], 1.0, mass=[2.0, 6.0])
    scene = wallkit.Scene(room(), balls, meeting=True, ball_restitution=e, ball_tangential_restitution=f)
    contact = wallkit.simulate(scene, until=2.0).contacts[0]
    n = np.array([contact["nx"], contact["ny"]])
    t = np.array([-n[1], n[0]])
    w = np.array([1.0, 0.0]) - np.array([-1.0, 0.25])
    after = -e * (w @ n) * n + f * (w @ t) * t
    mean = (2.0 * np.array([1.0, 0.0]) + 6.0 * np.array([-1.0, 0.25])) / 8.0
    assert [contact["vx"], contact["vy"]] == pytest.approx((mean + 0.75 * after).tolist(), abs=1e-15)
    assert [contact["other_vx"], contact["other_vy"]] == pytest.approx((mean - 0.25 * after).tolist(), abs=1e-15)


def test_three_discs_in_a_row_meet_when_and_where_the_line_says() -> None:
    """Masses 1, 2, 1 at 2, 5, 8 (gaps 2) and speeds 3, 0, -1: 0 meets 1 at 2/3, then 1 (at speed 2) meets 2."""
    balls = wallkit.Balls([(2, 5), (5, 5), (8, 5)], [(3, 0), (0, 0), (-1, 0)], 0.5, mass=[1.0, 2.0, 1.0])
    run = wallkit.simulate(wallkit.Scene(room(), balls, meeting=True), until=1.3)
    met = run.contacts[run.contacts["kind"] == wallkit.ContactKind.BALL]
    assert met[["ball", "other"]].tolist() == [(0, 1), (1, 2)]
    assert met["time"] == pytest.approx([2 / 3, 2 / 3 + (2 - 2 / 3) / 3], rel=1e-14)
    assert run.final["vx"] == pytest.approx([-1.0, 0.0, 3.0], abs=1e-14)


def test_of_a_cradle_as_many_leave_as_come() -> None:
    """Balls in a row that touch: each passes what it gets to the next, in order, at one time."""
    places = [(1.5, 5.0), (2.5, 5.0), (5.0, 5.0), (6.0, 5.0), (7.0, 5.0)]
    balls = wallkit.Balls(places, [(1, 0), (1, 0), (0, 0), (0, 0), (0, 0)], 0.5)
    run = wallkit.simulate(wallkit.Scene(room(), balls, meeting=True), until=2.4)
    assert run.final["vx"].tolist() == [0.0, 0.0, 0.0, 1.0, 1.0]
    assert run.contacts[["ball", "other"]].tolist() == [(1, 2), (0, 1), (2, 3), (1, 2), (3, 4), (2, 3)]
    assert set(run.contacts["time"].tolist()) == {1.5}


@pytest.mark.parametrize(("digits", "bounces"), [(0, 3), (1, 31), (2, 314)])
def test_two_discs_and_a_wall_count_the_digits_of_pi(digits: int, bounces: int) -> None:
    """Galperin (2003, Regular and Chaotic Dynamics 8:375): masses 100^d : 1, contacts with the ball and the wall."""
    balls = wallkit.Balls([(2, 0), (4, 0)], [(0, 0), (-1, 0)], 0.5, mass=[1.0, 100.0**digits])
    wall = wallkit.Walls.from_polylines([[(0, -5), (0, 5)]], closed=False)
    run = wallkit.simulate(wallkit.Scene(wall, balls, meeting=True), bounces=10_000)
    assert len(run.contacts) == bounces
    assert run.ending[1] == wallkit.Ending.LEFT_SCENE  # the light one may stand still where all is exchanged


def test_hard_rods_press_on_a_wall_as_tonks_says() -> None:
    """Equal discs in a row exchange their speeds, as points would pass through one another on what they leave free.

    So after the time T a wall has had 2 m v for each passage of the points: sum of 2 m v floor-like counts, which is
    T sum(m v^2) / (L - n 2 r) up to one passage each (L. Tonks 1936, Phys. Rev. 50:955).
    """
    speeds = np.array([0.7, -1.3, 0.4, 2.1, -0.9, 1.6])
    balls = wallkit.Balls([(1 + 1.5 * i, 5.0) for i in range(6)], np.stack([speeds, 0 * speeds], axis=1), 0.5, mass=2.0)
    run = wallkit.simulate(wallkit.Scene(room(), balls, meeting=True), until=400.0)
    right = run.contacts[run.contacts["nx"] * (run.contacts["other"] < 0) == -1.0]
    pressure = float(2.0 * 2.0 * np.abs(right["vx"]).sum()) / 400.0
    free = 10.0 - 6 * 1.0
    assert pressure == pytest.approx(
        float((2.0 * speeds**2).sum()) / free, abs=2.0 * 2.0 * np.abs(speeds).sum() / 400.0
    )


def test_momentum_and_energy_stay_to_rounding() -> None:
    scene = gas()
    run = wallkit.simulate(scene, until=30.0)
    mass = scene.balls.mass
    energy = [float(mass @ (run.velocity(t) ** 2).sum(axis=1)) for t in (0.0, 10.0, 30.0)]
    assert energy[1:] == pytest.approx([energy[0]] * 2, rel=1e-14)  # some 20 contacts a ball, a few 2^-53 each
    met = run.contacts[run.contacts["kind"] == wallkit.ContactKind.BALL]
    assert len(met) > 100
    for contact in met:
        one, two = (run.contacts_of(int(ball)) for ball in (contact["ball"], contact["other"]))
        before = sum(
            mass[ball] * _velocity_before(run, ball, own, contact["time"])
            for ball, own in ((contact["ball"], one), (contact["other"], two))
        )
        after = mass[contact["ball"]] * np.array([contact["vx"], contact["vy"]])
        after = after + mass[contact["other"]] * np.array([contact["other_vx"], contact["other_vy"]])
        assert after == pytest.approx(before, abs=1e-14)


def _velocity_before(run: wallkit.Run, ball: int, own: Any, time: float) -> np.ndarray[Any, Any]:
    earlier = own[own["time"] < time]
    return np.array([earlier["vx"][-1], earlier["vy"][-1]]) if len(earlier) else run.start[ball, 2:4]


def test_discs_never_overlap_by_more_than_rounding() -> None:
    scene = gas()
    run = wallkit.simulate(scene, until=30.0)
    times = np.unique(np.concatenate([run.contacts["time"], np.linspace(0.0, 30.0, 200)]))
    places = run.position(times)
    gap = np.hypot(*(places[:, :, None] - places[:, None]).transpose(3, 0, 1, 2))
    gap -= scene.balls.radius[:, None] + scene.balls.radius
    gap[:, np.arange(25), np.arange(25)] = 1.0
    assert gap.min() > -1e-13  # a few 2^-53 of the room, and of the way of a flight


def test_time_reversal_brings_every_disc_back() -> None:
    scene = gas()
    there = wallkit.simulate(scene, until=8.0)
    end = states(there)
    turned = wallkit.Balls(end[:, 0:2], -end[:, 2:4], scene.balls.radius, scene.balls.mass)
    back = wallkit.simulate(wallkit.Scene(scene.walls, turned, meeting=True), until=8.0)
    assert states(back)[:, 0:2] == pytest.approx(np.asarray(scene.balls.position), abs=1e-6)
    assert len(back.contacts) == len(there.contacts)


@pytest.mark.parametrize("per_disc", [0.01, 0.3, 4.0, 100.0])
def test_the_number_of_cells_changes_no_bit(per_disc: float) -> None:
    scene = gas(ball_restitution=0.9)
    run, other = wallkit.simulate(scene, until=15.0), simulate_meeting(scene, 15.0, 10**6, per_disc=per_disc)
    assert np.array_equal(run.contacts, other.contacts)
    assert np.array_equal(run.final, other.final)


def test_discs_that_meet_nothing_fly_as_if_they_were_alone() -> None:
    balls = wallkit.Balls([(3, 3)], [(1.1, 0.7)], 0.5)
    alone = wallkit.simulate(wallkit.Scene(room(restitution=0.9), balls), until=60.0)
    run = wallkit.simulate(wallkit.Scene(room(restitution=0.9), balls, meeting=True), until=60.0)
    assert all(np.array_equal(run.contacts[name], alone.contacts[name]) for name in alone.contacts.dtype.names)
    assert np.array_equal(run.final, alone.final)


def test_points_never_meet() -> None:
    balls = wallkit.Balls([(2, 5), (5, 5), (8, 5)], [(1, 0), (0, 0), (-1, 0)], [0.0, 0.5, 0.5])
    run = wallkit.simulate(wallkit.Scene(room(), balls, meeting=True), until=4.0)
    assert run.contacts[["ball", "other"]].tolist() == [(1, 2)]
    assert run.final["x"][0] == 6.0


def test_balls_that_a_dead_wall_absorbs_are_out() -> None:
    """The pocket on the right swallows ball 0; ball 1 then passes where that one was swallowed."""
    pocket = wallkit.Walls.from_polylines(
        [[(9, 0), (9, 10)], [(0, 0), (0, 10)]],
        closed=False,
        material=[wallkit.Material(restitution=0.0, tangential_restitution=0.0), wallkit.Material()],
    )
    balls = wallkit.Balls([(7, 5), (3, 5)], [(1, 0), (1, 0)], 0.5)
    run = wallkit.simulate(wallkit.Scene(pocket, balls, meeting=True), until=20.0)
    assert run.ending == (wallkit.Ending.ABSORBED, wallkit.Ending.ABSORBED)
    assert run.contacts["time"].tolist() == [1.5, 5.5]


def test_the_first_disc_at_its_limit_ends_the_run_of_all() -> None:
    run = wallkit.simulate(gas(), bounces=20)
    assert run.bounces.max() == 20
    assert set(run.ending) == {wallkit.Ending.BOUNCE_LIMIT}
    assert len(set(run.final["time"].tolist())) == 1


def test_a_cluster_that_loses_its_speed_ends_by_no_hang() -> None:
    """Three discs in a row with e = 0.05: contacts come infinitely often, in a finite time (McNamara, Young 1994)."""
    balls = wallkit.Balls([(2, 5), (5, 5), (8, 5)], [(1, 0), (0, 0), (-1, 0)], 0.5)
    run = wallkit.simulate(wallkit.Scene(room(), balls, meeting=True, ball_restitution=0.05), until=10.0)
    assert run.ending == (wallkit.Ending.TIME_REACHED,) * 3
    assert len(run.contacts) > 100
    assert run.final["vx"] == pytest.approx([0.0, 0.0, 0.0], abs=1e-7)
    assert float(np.diff(run.final["x"]).min()) > 1.0 - 1e-13


def test_discs_that_overlap_at_the_start_are_refused_with_their_places() -> None:
    scene = wallkit.Scene(room(), wallkit.Balls([(3, 3), (7, 7), (3.5, 3)], np.zeros((3, 2)), 0.4), meeting=True)
    with pytest.raises(wallkit.SceneError, match=r"ball 0 at \(3, 3\) and ball 2 at \(3.5, 3\) overlap by 0.3") as told:
        wallkit.simulate(scene, until=1.0)
    assert told.value.code == "balls-overlap"
    with pytest.raises(wallkit.SceneError, match="overlap"):
        wallkit.prepare(scene)


def test_what_is_not_modelled_is_named_when_it_is_prepared() -> None:
    with pytest.raises(wallkit.SceneError, match="relative motion is not straight") as told:
        wallkit.prepare(gas(rolling_friction=1.0))
    assert told.value.code == "meeting-not-modelled"
    with pytest.raises(wallkit.SceneError, match="World with drag"):
        wallkit.World(gas(drag=0.1))


def test_drag_leaves_paths_as_they_are_and_slows_all_alike() -> None:
    """dv/dt = -c v: what takes s without drag takes -ln(1 - c s) / c, and 1 - c s of each speed is left."""
    free = wallkit.simulate(gas(), until=3.0)
    slowed = wallkit.simulate(gas(drag=0.2), until=-math.log1p(-0.2 * 3.0) / 0.2)
    for name in ("ball", "other", "wall", "x", "y"):
        assert np.array_equal(slowed.contacts[name], free.contacts[name])
    assert slowed.contacts["time"] == pytest.approx(-np.log1p(-0.2 * free.contacts["time"]) / 0.2, rel=1e-14)
    assert slowed.contacts["other_vx"] == pytest.approx(
        free.contacts["other_vx"] * (1.0 - 0.2 * free.contacts["time"]), rel=1e-13
    )
    assert states(slowed)[:, 0:2] == pytest.approx(states(free)[:, 0:2], abs=1e-12)
    assert slowed.position(2.0) == pytest.approx(free.position((1.0 - math.exp(-0.4)) / 0.2), abs=1e-12)
    assert [said.bounces for said in slowed.trusted_until(1e-10)] == [
        said.bounces for said in free.trusted_until(1e-10)
    ]


def test_drag_brings_discs_that_meet_to_rest_where_it_brings_one_alone() -> None:
    balls = wallkit.Balls([(3, 3)], [(1.1, 0.7)], 0.5)
    alone = wallkit.simulate(wallkit.Scene(room(), balls, drag=0.05), until=2000.0)
    run = wallkit.simulate(wallkit.Scene(room(), balls, drag=0.05, meeting=True), until=2000.0)
    assert run.ending == alone.ending == (wallkit.Ending.AT_REST,)
    assert states(run) == pytest.approx(states(alone), abs=1e-12)
    assert run.contacts["time"] == pytest.approx(alone.contacts["time"], rel=1e-9)


def test_under_gravity_two_falling_discs_meet_where_straight_lines_say() -> None:
    """Relative to one another they go straight: a gap of 3 at 1.5, while both rise and fall by 6 t - 3 t^2 / 2."""
    balls = wallkit.Balls([(2, 15), (6, 15)], [(1.5, 6), (0, 6)], 0.5)
    scene = wallkit.Scene(room(30.0, 30.0), balls, gravity=(0.0, -3.0), meeting=True)
    run = wallkit.simulate(scene, until=2.5)
    (contact,) = run.contacts
    assert contact["time"] == pytest.approx(2.0, rel=1e-14)
    assert (contact["x"], contact["y"]) == pytest.approx((5.0, 15 + 12 - 6), rel=1e-14)
    assert (contact["vy"], contact["other_vy"]) == pytest.approx((0.0, 0.0), abs=1e-13)
    assert run.velocity(2.1)[:, 0] == pytest.approx([0.0, 1.5], abs=1e-14)


def test_interpreted_and_compiled_kernels_give_the_same_bits_and_survey_the_same_totals() -> None:
    scene = gas()
    runs = [wallkit.simulate(scene, until=12.0, mode=mode) for mode in ("interpreted", "compiled")]
    assert np.array_equal(runs[0].contacts, runs[1].contacts)
    assert np.array_equal(runs[0].final, runs[1].final)
    other = gas(2)
    totals = wallkit.survey([scene, other, scene], until=12.0, threads=2)
    for one, run in zip(totals, (runs[0], wallkit.simulate(other, until=12.0), runs[0]), strict=True):
        assert np.array_equal(one.bounces, run.bounces)
        assert np.array_equal(one.position[:, 0], run.final["x"])
        assert np.array_equal(one.velocity[:, 1], run.final["vy"])
        assert one.hits.sum() == np.count_nonzero(run.contacts["kind"] <= wallkit.ContactKind.VERTEX)


def test_speeds_become_those_of_maxwell() -> None:
    """400 discs of one speed: after some 20 contacts each, v^2 is exponential (Kolmogorov's test); compiled."""
    from scipy.stats import kstest

    random = np.random.default_rng(5)
    places = np.array([(x, y) for x in range(20) for y in range(20)], dtype=float) + 0.5
    angle = random.uniform(0.0, 2.0 * math.pi, 400)
    balls = wallkit.Balls(places, np.stack([np.cos(angle), np.sin(angle)], axis=1), 0.3)
    totals = wallkit.survey(wallkit.Scene(room(20.0, 20.0), balls, meeting=True), until=30.0)
    square = (totals.velocity**2).sum(axis=1)
    assert square.mean() == pytest.approx(1.0, rel=1e-13)
    assert kstest(square, "expon").pvalue > 0.01


def test_a_world_steps_through_the_same_contacts_and_takes_kicks() -> None:
    scene = gas()
    run = wallkit.simulate(scene, until=4.0)
    world = wallkit.World(scene)
    seen = np.concatenate([world.step(1 / 16) for _ in range(64)])
    assert np.array_equal(seen, run.contacts)
    assert np.array_equal(np.hstack([world.position, world.velocity]), states(run))
    kinetic = scene.balls.mass @ (world.velocity**2).sum(axis=1)
    world.place(3, velocity=(0.0, 0.0))
    assert world.velocity[3].tolist() == [0.0, 0.0]
    world.step(3.0)
    assert float(scene.balls.mass @ (world.velocity**2).sum(axis=1)) < kinetic
    with pytest.raises(wallkit.SceneError, match="only 'exact' knows other balls"):
        wallkit.World(scene, "stop")


def test_files_hold_the_columns_of_the_other_ball_and_those_without_meeting_have_none(tmp_path: Path) -> None:
    scene = gas(ball_restitution=0.9)
    run = wallkit.simulate(scene, until=2.0)
    run.save(tmp_path / "run.json")
    read = wallkit.Run.load(tmp_path / "run.json")
    assert np.array_equal(read.contacts, run.contacts)
    assert np.array_equal(read.scene.balls.mass, scene.balls.mass)
    assert (read.scene.meeting, read.scene.ball_restitution) == (True, 0.9)
    whole = json.loads((tmp_path / "run.json").read_text())
    assert (whole["version"], whole["scene"]["version"]) == (2, 2)
    Draft202012Validator(json.loads((SCHEMAS / "run.schema.json").read_text())).validate(whole)
    Draft202012Validator(json.loads((SCHEMAS / "scene.schema.json").read_text())).validate(whole["scene"])
    alone = wallkit.simulate(wallkit.Scene(scene.walls, scene.balls.take([0])), until=2.0)
    alone.scene.balls = wallkit.Balls([(1, 1)], [(1, 2)], 0.5)
    alone.save(tmp_path / "alone.json")
    plain = json.loads((tmp_path / "alone.json").read_text())
    assert (plain["version"], plain["scene"]["version"]) == (1, 1)
    assert not {"other", "meeting", "mass"} & {*plain["contacts"], *plain["scene"], *plain["scene"]["balls"][0]}


def test_the_command_line_and_scene_files_say_meeting(tmp_path: Path, said: Any) -> None:
    (tmp_path / "two.toml").write_text(
        "meeting = true\nball_restitution = 0.5\n"
        "walls = [{ vertices = [[0, 0], [0, 10], [10, 10], [10, 0]] }]\n"
        "balls = [{ position = [2, 5], velocity = [1, 0], radius = 0.5, mass = 3 },\n"
        "         { position = [6, 5], radius = 0.5, mass = 1 }]\n[run]\nuntil = 3.5\n"
    )
    code, out, err = said("simulate", tmp_path / "two.toml", "-o", tmp_path / "two.csv")
    assert (code, err) == (0, "")
    assert "balls met 1 time" in out
    header, row = (tmp_path / "two.csv").read_text().splitlines()[:2]
    assert header.split(",")[12:] == ["kind", "other", "other_x", "other_y", "other_vx", "other_vy"]
    assert [float(row.split(",")[k]) for k in (0, 4, 16)] == pytest.approx([3.0, 0.625, 1.125])
    code, out, _ = said("simulate", tmp_path / "two.toml", "--no-meeting", "--format", "csv")
    assert code == 0
    assert "other" not in out


def test_random_balls_that_meet_start_apart() -> None:
    opened = wallkit.open_scene(json.dumps(BOX_SCENE).encode(), wallkit.Wishes(balls=60, radius=0.4, meeting=True))
    wallkit.prepare(opened.scene)
    with pytest.raises(wallkit.SceneError, match="were not placed"):
        wallkit.open_scene(json.dumps(BOX_SCENE).encode(), wallkit.Wishes(balls=200, radius=0.4, meeting=True))


def test_laying_neighbours_together_in_memory_changes_no_bit(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = gas(3)
    plain = wallkit.simulate(scene, until=12.0)
    monkeypatch.setattr(meeting, "MANY", 1)
    monkeypatch.setattr(meeting, "OFTEN", 1)
    monkeypatch.setattr(meeting, "CHUNK", 40)
    ordered = wallkit.simulate(scene, until=12.0, mode="compiled")
    assert np.array_equal(plain.contacts, ordered.contacts)
    assert np.array_equal(plain.final, ordered.final)


def test_under_gravity_energy_stays_among_discs_that_bounce_and_meet() -> None:
    scene = gas(4, gravity=(0.3, -1.0))
    scene.balls = wallkit.Balls(scene.balls.position, scene.balls.velocity, 0.45, scene.balls.mass)
    run = wallkit.simulate(scene, until=10.0)
    assert np.count_nonzero(run.contacts["kind"] == wallkit.ContactKind.BALL) > 50
    mass, pull = scene.balls.mass, np.array([0.3, -1.0])
    energies = [
        float(mass @ ((run.velocity(t) ** 2).sum(axis=1) / 2 - run.position(t) @ pull)) for t in (0.0, 5.0, 10.0)
    ]
    assert energies[1:] == pytest.approx([energies[0]] * 2, abs=1e-11)  # times are roots, good to 2^-41 of the room
    assert np.array_equal(run.contacts, simulate_meeting(scene, 10.0, 10**6, per_disc=0.2).contacts)


HOP = 2.0**-12
"""By this part of the smallest radius discs hop off what they would come to lie on."""


def marbles(count: int, **kept: Any) -> wallkit.Run:
    """Discs let fall into a narrow trough, for four seconds."""
    random = np.random.default_rng(0)
    e, f = kept.pop("e", 1.0), kept.pop("f", 1.0)
    walls = wallkit.Walls.from_polylines(
        [[(0, 0), (0, 40), (10, 40), (10, 0)]],
        bulges=[[0, 0, 0, kept.pop("bulge", 0.0)]],
        material=wallkit.Material(e, f),
    )
    places = [(1.2 + 2.4 * (k % 4) + random.uniform(-0.1, 0.1), 3 + 2.2 * (k // 4)) for k in range(count)]
    balls = wallkit.Balls(places, 0.3 * random.normal(size=(count, 2)), random.uniform(0.8, 1.0, count))
    return wallkit.simulate(
        wallkit.Scene(walls, balls, (0.0, -10.0), meeting=True, **kept), until=4.0, mode="interpreted"
    )


@pytest.mark.parametrize(
    "kept",
    [
        {"e": 0.5, "ball_restitution": 0.5},
        {"e": 0.5, "f": 0.95, "ball_restitution": 0.8, "bulge": -0.4},
        {"e": 0.0, "ball_restitution": 0.0},
        {"ball_restitution": 0.3},
    ],
    ids=str,
)
def test_a_pile_of_marbles_goes_on_hopping_without_overlap(kept: dict[str, float]) -> None:
    run = marbles(12, **kept)
    radius = run.scene.balls.radius
    assert set(run.ending) == {wallkit.Ending.TIME_REACHED}
    assert (
        len(run.contacts) < 12 * 4 * 1000
    )  # a hop takes 2 sqrt(2 h / g) = 9 ms, and in a pile a disc meets some six others
    for time in np.linspace(0.0, 4.0, 9):
        places = run.position(float(time))
        gap = np.hypot(*(places[:, None] - places[None]).transpose(2, 0, 1)) - radius[:, None] - radius
        np.fill_diagonal(gap, 1.0)
        assert gap.min() > -1e-12
        assert (places[:, 0] - radius).min() > -1e-12
    hop = math.sqrt(2.0 * 10.0 * HOP * float(radius.min()))
    assert np.hypot(*run.velocity(4.0).T).max() < 10.0 * hop  # what is left is of the order of hops
    assert run.position(4.0)[:, 1].max() < 4.5  # three rows of at most 2, pushed into one another


def test_discs_stacked_on_a_floor_stay_stacked() -> None:
    floor = wallkit.Walls.from_polylines([[(0, 0), (10, 0)]], closed=False, material=wallkit.Material(0.3))
    balls = wallkit.Balls([(5, 0.5), (5, 1.5), (5, 2.5)], np.zeros((3, 2)), 0.5)
    scene = wallkit.Scene(floor, balls, (0.0, -10.0), meeting=True, ball_restitution=0.3)
    run = wallkit.simulate(scene, until=1.0, mode="interpreted")
    assert run.final["y"] == pytest.approx([0.5, 1.5, 2.5], abs=20 * HOP)
    assert run.final["x"].tolist() == [5.0] * 3


def test_a_disc_slides_down_a_slope_by_hops_as_far_as_without_them() -> None:
    """s = g sin(a) t^2 / 2 along a slope of 3 in 4 (sin a = 0.6), whatever the hops; then it falls off the end."""
    slope = wallkit.Walls.from_polylines([[(0, 30), (40, 0)]], closed=False, material=wallkit.Material(0.2, 1.0))
    far = (2 + 0.6 * 1.0, 28.5 + 0.8 * 1.0)
    balls = wallkit.Balls([far, (500, 500)], np.zeros((2, 2)), 1.0)
    run = wallkit.simulate(wallkit.Scene(slope, balls, (0.0, -10.0), meeting=True), until=6.0, mode="interpreted")
    way = run.position(3.0)[0] - far
    assert math.hypot(*way) == pytest.approx(0.6 * 10.0 * 9.0 / 2.0, abs=1e-3)
    assert run.position(6.0)[0, 1] < 0.0


def test_a_disc_alone_on_a_floor_bounces_as_alone_until_it_hops() -> None:
    balls = wallkit.Balls([(5, 3)], [(0.2, 0)], 0.5)
    box = room(restitution=0.6)
    alone = wallkit.simulate(wallkit.Scene(box, balls, (0.0, -10.0)), bounces=5).contacts
    run = wallkit.simulate(wallkit.Scene(box, balls, (0.0, -10.0), meeting=True), until=5.0, mode="interpreted")
    assert np.array_equal(run.contacts["time"][:5], alone["time"])
    tops = run.position(np.linspace(4.0, 5.0, 200))[:, 0, 1]
    assert tops.max() <= 0.5 + 1.001 * HOP * 0.5
    assert tops.min() >= 0.5 - 1e-12


@pytest.mark.parametrize(("sample", "hops"), [("galton", True), ("gas", False)])
def test_that_discs_hop_is_said_where_they_would_come_to_lie(sample: str, hops: bool) -> None:
    opened = wallkit.open_scene(Path(__file__).parents[2] / "samples" / f"{sample}.toml")
    assert ("meeting-hops" in [problem.code for problem in opened.problems]) is hops
