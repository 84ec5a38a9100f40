"""Checks of levels: closed forms, proofs by geometry, and bounds that other programs give."""

import math
from dataclasses import replace

import mpmath
import numpy as np
import pytest

import wallkit
from wallkit.levels import check_work
from wallkit.levels.check_counts import Fate
from wallkit.levels.check_work import CheckWork, Squares
from wallkit.levels.goals import goal_of
from wallkit.levels.reachable import reachable
from wallkit.levels.statistics import bin_edges, bins_of, never_bound, quantile_ranks, share_bounds

BOX = wallkit.Walls.from_polylines([[(0.0, 0.0), (0.0, 70.0), (100.0, 70.0), (100.0, 0.0)]], names=["box"])
SCENE = wallkit.Scene(BOX)
FOOT = "mushroom:2"
TRAPPED = 0.53206036069
"""(2 / pi) (acos(r / R) - (r / R) sqrt(1 - r^2 / R^2)) cap / (cap + stem) with R = 300, r = 80, stem 160 x 220."""


def check(scene, draw, balls, bounces, target=None, **how):
    return wallkit.check_level(scene, draw, balls, bounces=bounces, target=target, **how)


def in_the_box(**more):
    return wallkit.RoomBalls.of(BOX, speed=10.0, seed=1, **more)


@pytest.fixture(scope="module")
def mushroom():
    """The sample, all balls points; and for 3,000 of them what is exact: those trapped circle at 80 or more."""
    scene = wallkit.open_scene("samples/mushroom.svg").scene
    draw = wallkit.RoomBalls.of(scene.walls, speed=1.0, seed=3)
    balls = draw(0, 3000)
    (x, y), (vx, vy) = (balls.position - (320.0, 320.0)).T, balls.velocity.T
    return scene, draw, (y < 0.0) & (np.abs(x * vy - y * vx) > 80.0)


def test_the_island_of_a_mushroom_is_told_ball_by_ball(mushroom):
    scene, draw, trapped = mushroom
    found = check(scene, draw, 3000, 1500, FOOT, chunk=1000)
    share = found.share(Fate.REGULAR)
    assert share.low < TRAPPED < share.high
    assert share.count == np.count_nonzero(trapped)
    listed = found.counts.traps["ball"]
    np.testing.assert_array_equal(listed, np.flatnonzero(trapped)[: len(listed)])
    assert found.reached.count + share.count + found.share(Fate.SLOW).count == 3000
    assert [problem.code for problem in found.problems()] == ["trap"]


def test_a_trapped_ball_can_be_shown_and_never_leaves_its_island(mushroom):
    scene, draw, _ = mushroom
    found = check(scene, draw, 30, 500, FOOT)
    trap = found.traps()[0]
    assert (trap.fate, trap.norm < 20.0) == (Fate.REGULAR, True)
    run = found.example(trap.ball, bounces=100)
    assert len(run.contacts) == 100
    assert (np.hypot(run.contacts["x"] - 320.0, run.contacts["y"] - 320.0) > 80.0).all()


def test_the_outside_of_a_room_is_out_of_reach_for_certain_and_no_other_wall_is():
    walls = wallkit.open_scene("samples/room.svg").scene.walls
    found = reachable(walls, 6.0, wallkit.RoomBalls.of(walls, radius=6.0), Squares.over(walls))
    offsets = walls.edge_offsets
    assert [wall for wall in range(len(walls)) if not found.edges[offsets[wall] : offsets[wall + 1]].any()] == [0]


def with_pocket(width):
    x = 50.0 + width
    pocket = [(50.0, 70.0), (50.0, 80.0), (x, 80.0), (x, 70.0)]
    return wallkit.Walls.from_polylines([[(0.0, 0.0), (0.0, 70.0), *pocket, (100.0, 70.0), (100.0, 0.0)]])


def test_a_pocket_that_no_ball_enters_is_not_called_never():
    walls = with_pocket(0.5)
    draw = wallkit.RandomBalls((5.0, 5.0, 10.0, 10.0), speed=10.0, seed=1)
    found = check(wallkit.Scene(walls), draw, 40, 3)
    assert 3 in found.never.tolist()
    assert not found.certain.any()
    assert f"{found.chance:.4g}" in found.problems()[0].message


def test_a_disc_has_no_business_in_a_pocket_that_is_too_narrow():
    walls = with_pocket(2.0)
    found = check(wallkit.Scene(walls), wallkit.RoomBalls.of(walls, speed=10.0, radius=3.0, seed=1), 40, 3)
    assert [int(edge) for edge in found.never[found.certain]] == [3]


def test_a_box_with_a_target_is_left_by_all_and_traps_none():
    found = check(SCENE, in_the_box(), 200, 90, (50.0, 35.0, 30.0))
    assert found.share(Fate.REACHED).count >= 198
    assert not found.traps()
    inside = np.hypot(*(in_the_box()(0, 200).position - (50.0, 35.0)).T) <= 30.0
    assert found.counts.times[1][0] == inside.sum()  # there from the start, at time 0


def test_the_first_time_at_a_target_is_that_of_a_run():
    draw = in_the_box(radius=2.0)
    sensor = wallkit.Walls.from_polylines([[(80.0, 10.0), (80.0, 60.0)]], closed=False, names=["gate"])
    scene = wallkit.Scene(BOX, sensors=sensor)
    found = check(scene, draw, 60, 40, "gate")
    run = wallkit.simulate(replace(scene, balls=draw(0, 60)), bounces=40)
    crossed = run.contacts[run.contacts["kind"] >= wallkit.ContactKind.ENTER]
    first = [crossed["time"][crossed["ball"] == ball].min(initial=math.inf) for ball in range(60)]
    reached = np.array(first)[np.isfinite(first)]
    assert found.reached.count == len(reached)
    np.testing.assert_array_equal(found.counts.times[0], bins_of(reached)[0])
    np.testing.assert_array_equal(found.counts.times[1], bins_of(reached)[1])


def test_an_edge_is_a_target_and_bounces_after_it_do_not_count():
    draw = in_the_box()
    found = check(SCENE, draw, 60, 40, "box:2")
    run = wallkit.simulate(wallkit.Scene(BOX, draw(0, 60)), bounces=40)
    bounces, hits = 0, np.zeros(4, dtype=np.int64)
    for ball in range(60):
        own = run.contacts_of(ball)
        there = np.flatnonzero(own["edge"] == 2)
        until = there[0] + 1 if len(there) else len(own)
        bounces += until
        hits += np.bincount(own["edge"][:until], minlength=4)
    assert found.counts.bounces == bounces
    np.testing.assert_array_equal(found.counts.counts.edge_hits, hits)
    assert hits[2] == found.reached.count


def test_two_walls_that_throw_a_ball_to_and_fro_are_a_trap_that_repeats():
    found = check(SCENE, Straight(), 8, 100, (90.0, 60.0, 3.0))
    assert found.share(Fate.REPEATS).count == 8
    assert {trap.period for trap in found.traps()} == {2}


class Straight:
    """Balls that fly straight up, apart from one another."""

    def __call__(self, first, count):
        x = 10.0 + 5.0 * np.arange(first, first + count)
        return wallkit.Balls(np.stack([x, np.full(count, 30.0)], axis=1), np.tile([0.0, 10.0], (count, 1)))


def test_resting_places_under_gravity_are_told_with_their_balls():
    valley = wallkit.Walls.from_polylines(
        [[(0.0, 0.0), (0.0, 70.0), (100.0, 70.0), (100.0, 0.0), (70.0, 15.0), (30.0, 0.5)]],
        material=wallkit.Material(restitution=0.3),
    )
    scene = wallkit.Scene(valley, gravity=(0.0, -50.0))
    found = check(scene, wallkit.RandomBalls((20.0, 40.0, 30.0, 50.0), seed=1), 20, 200, (95.0, 65.0, 2.0))
    assert found.share(Fate.AT_REST).count == 20
    assert sum(balls for _x, _y, balls in found.resting()) == 20
    assert [problem.code for problem in found.problems()][:2] == ["target-missed", "trap"]


@pytest.mark.parametrize("chunk", [1, 13, 40])
def test_chunks_change_no_bit_of_a_check(chunk):
    draw, target = in_the_box(radius=1.0), (80.0, 50.0, 5.0)
    whole = CheckWork(SCENE, draw, None, 30, goal_of(SCENE, target)).fly(0, 40)
    assert check(SCENE, draw, 40, 30, target, chunk=chunk).counts.digest() == whole.digest()


def test_what_only_the_first_balls_are_watched_for_is_surveyed_for_the_rest(monkeypatch):
    watched = check(SCENE, in_the_box(), 256, 20).counts
    monkeypatch.setattr(check_work, "COVERING", 56)
    part = check(SCENE, in_the_box(), 256, 20).counts
    assert part.counts.digest() == watched.counts.digest()
    np.testing.assert_array_equal(part.fates, watched.fates)
    assert part.visits.max() <= 56 < watched.visits.max()


def test_counts_of_a_check_go_through_a_checkpoint(tmp_path):
    file = tmp_path / "check.json"
    half = check(SCENE, in_the_box(), 20, 30, (50.0, 35.0, 9.0), checkpoint=file)
    whole = check(SCENE, in_the_box(), 40, 30, (50.0, 35.0, 9.0), checkpoint=file)
    assert half.balls == 20
    assert whole.counts.digest() == check(SCENE, in_the_box(), 40, 30, (50.0, 35.0, 9.0)).counts.digest()
    with pytest.raises(wallkit.WallkitError, match="another survey"):
        check(SCENE, in_the_box(), 40, 30, (50.0, 35.0, 8.0), checkpoint=file)


def test_quantiles_of_the_time_are_censored_where_the_first_slow_ball_was_given_up():
    found = check(SCENE, in_the_box(), 200, 4, (50.0, 35.0, 9.0))
    assert 20 < found.share(Fate.SLOW).count < 180
    low, half, high = found.times(bounces=True)
    assert low.low == 0.0
    assert low.high < 4.0
    assert high.high == math.inf
    assert high.low == 4.0
    assert half.low <= half.high


def tail(hits, balls, share):
    """P(X >= hits) of a binomial to 30 digits: its terms one after the other, from the largest down."""
    share = mpmath.mpf(share)
    term = mpmath.binomial(balls, hits) * share**hits * (1 - share) ** (balls - hits)
    total = term
    for k in range(hits, balls):
        term *= (balls - k) * share / ((k + 1) * (1 - share))
        total += term
        if term < total * mpmath.mpf("1e-25"):
            break
    return total


@pytest.mark.parametrize(("hits", "balls"), [(0, 30), (1, 30), (17, 40), (999, 1000), (1000, 1000), (2150, 4000)])
def test_bounds_of_a_share_are_those_of_the_binomial_tails_to_many_digits(hits, balls):
    low, high = share_bounds(hits, balls)
    with mpmath.workdps(30):
        assert hits == 0 or abs(tail(hits, balls, low) - mpmath.mpf("0.025")) < 1e-10
        assert hits == balls or abs(tail(balls - hits, balls, 1 - mpmath.mpf(high)) - mpmath.mpf("0.025")) < 1e-10
    assert (low == 0.0) == (hits == 0)
    assert (high == 1.0) == (hits == balls)


def test_what_no_ball_of_20000_did_is_below_a_known_chance():
    assert never_bound(20000) == pytest.approx(1.4978e-4, abs=5e-9)
    assert never_bound(10000) == pytest.approx(3.0e-4, abs=1e-6)


@pytest.mark.parametrize(("balls", "part"), [(20, 0.5), (59, 0.05), (100, 0.95), (1000, 0.5)])
def test_ranks_that_bound_a_quantile_hold_back_what_the_binomial_says(balls, part):
    low, high = quantile_ranks(balls, part)
    chance = [math.comb(balls, k) * part**k * (1 - part) ** (balls - k) for k in range(balls + 1)]
    assert sum(chance[:low]) <= 0.025 < sum(chance[: low + 1])
    assert sum(chance[high:]) <= 0.025
    assert high > balls or sum(chance[high - 1 :]) > 0.025


def test_a_bin_holds_its_values_to_a_sixty_fourth():
    for value in (0.0, 1.0, 3.7, 100.25, 1e-9):
        ((code,), (number,)) = bins_of(np.array([value]))
        low, high = bin_edges(int(code))
        assert low <= value < high
        assert number == 1
        assert high - low <= max(low, 1e-300) / 64
