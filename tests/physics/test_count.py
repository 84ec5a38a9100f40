"""Surveys on threads, processes and clusters: one digest for all, whatever is lost, stopped and gone on with."""

import json
import multiprocessing
import os
import pickle
import sys
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor

import numpy as np
import pytest
from draws import PLAIN, Deadly, Overlapping

import wallkit
from wallkit.simulation.count import ATTEMPTS, OPEN_A_WORKER
from wallkit.simulation.counts import TICKS_PER_SECOND, ticks_of

SQUARE = [(0.0, 0.0), (0.0, 10.0), (10.0, 10.0), (10.0, 0.0)]
POST = [(4.0, 7.0), (5.0, 6.0), (6.0, 7.0), (5.0, 8.0)]
GATE = wallkit.Walls.from_polylines([[(5.0, 0.0), (5.0, 6.0)]], closed=False)
SCENE = wallkit.Scene(wallkit.Walls.from_polylines([SQUARE, POST]))
BALLS, BOUNCES = 2000, 30


def count(balls=BALLS, draw=PLAIN, bounces=BOUNCES, scene=SCENE, **how):
    return wallkit.count(scene, draw, balls, bounces=bounces, **how)


@pytest.fixture(scope="module")
def digest():
    """Of one chunk on one thread, counted by hand from a survey."""
    totals = wallkit.survey(wallkit.Scene(SCENE.walls, PLAIN(0, BALLS)), bounces=BOUNCES, threads=1, by_edge=True)
    return wallkit.Counts.of(totals).digest()


class Counting(Executor):
    """Flies a chunk when somebody waits for it; notes how many were open at most."""

    _max_workers = 3

    def __init__(self):
        self.open, self.most, self.pool = 0, 0, ThreadPoolExecutor(1)

    def submit(self, fn, /, *args):
        self.open += 1
        self.most = max(self.most, self.open)
        future = self.pool.submit(fn, *args)
        future.add_done_callback(lambda _: setattr(self, "open", self.open - 1))
        return future


@pytest.mark.parametrize("how", [{}, {"workers": 2, "chunk": 777}, {"chunk": 1999}], ids=str)
def test_threads_and_odd_chunks_change_no_bit(how, digest):
    assert count(**how).digest() == digest


def test_an_executor_of_ones_own_is_given_few_chunks_at_a_time(digest):
    executor = Counting()
    assert count(executor=executor, chunk=50).digest() == digest
    assert 1 < executor.most <= OPEN_A_WORKER * executor._max_workers


def test_processes_change_no_bit_and_a_killed_one_is_replaced(digest):
    killed = []

    def kill_one(part):
        if part > 0.4 and not killed:
            killed.append(multiprocessing.active_children()[0])
            killed[0].kill()

    assert count(executor="processes", workers=2, chunk=150, progress=kill_one).digest() == digest
    assert len(killed) == 1


def test_a_chunk_that_always_dies_is_named_after_its_attempts():
    pools = []

    def make():
        pools.append(ProcessPoolExecutor(1, multiprocessing.get_context("spawn")))
        return pools[-1]

    with pytest.raises(wallkit.WallkitError, match=r"balls 700 to 799 was given out 4 times") as caught:
        count(1000, Deadly(731, os.getpid()), executor=make, chunk=100)
    assert caught.value.code == "chunk-failed"
    assert len(pools) == ATTEMPTS


def test_a_broken_executor_of_somebody_else_is_said():
    with (
        ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as executor,
        pytest.raises(wallkit.WallkitError, match="which is not made here") as caught,
    ):
        count(300, Deadly(250, os.getpid()), executor=executor, chunk=100)
    assert caught.value.code == "chunk-failed"


def test_an_error_of_the_scene_is_told_as_it_is():
    with pytest.raises(wallkit.SceneError) as caught:
        count(1000, Overlapping(), chunk=250)
    assert caught.value.code == "overlap"
    assert pickle.loads(pickle.dumps(caught.value)).code == caught.value.code


class StopError(Exception):
    pass


def stop_at(share):
    def progress(part):
        if part >= share:
            raise StopError

    return progress


def test_a_survey_that_was_stopped_goes_on_where_it_was(tmp_path, digest):
    file, drawn = tmp_path / "survey.json", []

    def draw(first, number):
        drawn.append(number)
        return PLAIN(first, number)

    with pytest.raises(StopError):
        count(checkpoint=file, chunk=130, progress=stop_at(0.5))
    assert [path.name for path in tmp_path.iterdir()] == ["survey.json"]
    begun = sum(stop - start for start, stop in json.loads(file.read_text())["ranges"])
    assert 0.5 * BALLS <= begun < BALLS
    assert count(draw=draw, checkpoint=file, chunk=333).digest() == digest
    assert sum(drawn[1:]) == BALLS - begun  # the first call tells the draw from others
    assert count(checkpoint=file).digest() == digest


def test_a_survey_that_was_done_can_go_on_to_more_balls(tmp_path, digest):
    file = tmp_path / "survey.json"
    assert count(BALLS // 2, checkpoint=file).balls == BALLS // 2
    assert count(checkpoint=file).digest() == digest
    with pytest.raises(wallkit.WallkitError, match=r"2,000 balls have flown, and 1,000 are asked for"):
        count(BALLS // 2, checkpoint=file)


@pytest.mark.parametrize(
    "other",
    [
        {"draw": wallkit.RandomBalls((2.0, 2.0, 8.0, 4.0), speed=9.0, seed=12)},
        {"bounces": BOUNCES + 1},
        {"scene": wallkit.Scene(wallkit.Walls.from_polylines([SQUARE]))},
        {"scene": wallkit.Scene(SCENE.walls, gravity=(0.0, -1.0))},
        {"scene": wallkit.Scene(SCENE.walls, sensors=GATE)},
    ],
    ids=["draw", "limit", "walls", "gravity", "sensors"],
)
def test_a_checkpoint_of_another_survey_is_refused(other, tmp_path):
    file = tmp_path / "survey.json"
    count(20, checkpoint=file)
    before = file.read_bytes()
    with pytest.raises(wallkit.WallkitError, match="another survey") as caught:
        count(40, checkpoint=file, **other)
    assert caught.value.code == "other-checkpoint"
    assert file.read_bytes() == before


@pytest.mark.parametrize("text", ["", "[]", '{"format": "wallkit-run"}', '{"format": "wallkit-checkpoint"}'])
def test_a_file_that_is_no_checkpoint_is_refused(text, tmp_path):
    file = tmp_path / "survey.json"
    file.write_text(text)
    with pytest.raises(wallkit.WallkitError, match="no checkpoint") as caught:
        count(20, checkpoint=file)
    assert caught.value.code == "bad-checkpoint"


def test_a_draw_that_cannot_be_sent_is_said_and_threads_take_it(digest):
    with pytest.raises(wallkit.SceneError, match="cannot be sent") as caught:
        count(draw=lambda first, number: PLAIN(first, number), executor="processes", chunk=100)
    assert caught.value.code == "bad-executor"
    assert count(draw=lambda first, number: PLAIN(first, number), chunk=900).digest() == digest


def test_without_distributed_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(wallkit.SceneError, match="needs the package distributed") as caught:
        count(executor="dask://127.0.0.1:9", chunk=100)
    assert caught.value.fix == "install it: pip install 'wallkit[dask]'"


@pytest.mark.filterwarnings("ignore")  # of dask's own: what it asks of ports and of its event loop
def test_dask_changes_no_bit_and_may_lose_a_worker(digest):
    distributed = pytest.importorskip("distributed", reason="distributed is not installed (extra dask)")
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, host="127.0.0.1"
    ) as cluster:
        address = cluster.scheduler_address.replace("tcp://", "dask://")
        assert count(executor=address, chunk=400).digest() == digest
        killed = []

        def kill_one(part):
            if part > 0.4 and not killed:
                killed.append(next(iter(cluster.workers.values())).pid)
                os.kill(killed[0], 9)

        assert count(executor=address, chunk=100, progress=kill_one).digest() == digest
        assert len(killed) == 1


def test_counts_add_up_and_read_back_from_their_file(tmp_path):
    balls = wallkit.Scene(SCENE.walls, sensors=GATE)
    whole, part = count(300, scene=balls), count(200, scene=balls)
    rest = wallkit.count(balls, lambda first, number: PLAIN(200 + first, number), 100, bounces=BOUNCES)
    assert (part + rest).digest() == whole.digest()
    assert whole.crossings.sum() > 0
    whole.save(tmp_path / "totals.npz")
    assert wallkit.Counts.load(tmp_path / "totals.npz").digest() == whole.digest()
    with np.load(tmp_path / "totals.npz") as archive:
        np.testing.assert_array_equal(archive["edge_hits"], whole.edge_hits)
    assert whole.edge_hits.sum() + whole.vertex_hits.sum() == whole.bounces == 300 * BOUNCES


def test_times_are_added_up_as_whole_numbers_of_any_size():
    time = np.array([0.5 / TICKS_PER_SECOND, 1.5 / TICKS_PER_SECOND, 3.0])
    assert ticks_of(time) == 0 + 2 + 3 * TICKS_PER_SECOND  # halves go to the even number
    assert ticks_of(np.array([1e300, 1e300])) == 2 * int(1e300) * TICKS_PER_SECOND
    assert ticks_of(np.empty(0)) == 0


def test_a_future_that_never_began_is_cancelled_when_a_survey_is_stopped():
    class Idle(Executor):
        _max_workers = 2

        def __init__(self):
            self.given = []

        def submit(self, fn, /, *args):
            future = Future()
            if not self.given:
                future.set_result(fn(*args))
            self.given.append(future)
            return future

    executor = Idle()
    with pytest.raises(StopError):
        count(executor=executor, chunk=100, progress=stop_at(0.1))
    assert [future.cancelled() for future in executor.given] == [False, True, True, True]
