"""Threads that share a survey: the same bits, each ball once, and nobody waits for a thread that never starts."""

import os
import sys
import threading
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from wallkit import Balls, Scene, Walls, survey
from wallkit.accuracy import scenes
from wallkit.kernels.batches.ball_queue import BLOCK, NO_BALL, Queue, next_ball
from wallkit.simulation.survey_backends import AT_ONCE
from wallkit.simulation.threads import in_threads


def _scene(name):
    random = np.random.default_rng(1)
    balls = Balls(random.uniform(-30, 30, (3000, 2)), random.uniform(-60, 60, (3000, 2)), 2.0)
    turn = np.linspace(0.0, 2 * np.pi, 60, endpoint=False)
    circle = Walls.from_polylines([90.0 * np.stack([np.cos(turn), np.sin(turn)], axis=1)])
    return {
        "in step": Scene(scenes.star(), balls),
        "with an index": Scene(circle, balls),
        "falling": Scene(scenes.star(), balls, gravity=(0.0, -9.0)),
    }[name]


@pytest.mark.parametrize("name", ["in step", "with an index", "falling"])
def test_threads_change_no_bit(name):
    one = survey(_scene(name), until=3.0, threads=1)
    assert one.bounces.sum() > 2000
    with ThreadPoolExecutor(2) as executor:
        ways = [{"threads": 2}, {"threads": 5}, {}, {"executor": executor}, {"executor": executor, "threads": 4}]
        for way in ways:
            many = survey(_scene(name), until=3.0, **way)
            for field in ("bounces", "position", "velocity", "time", "hits", "ending"):
                np.testing.assert_array_equal(getattr(many, field), getattr(one, field))


def test_more_balls_than_are_flown_at_once():
    count = AT_ONCE + 3 * BLOCK // 2
    walls = Walls.from_polylines([[[0.0, 0.0], [9.0, 0.0], [9.0, 9.0], [0.0, 9.0]]])
    position = np.random.default_rng(2).uniform(1.0, 8.0, (count, 2))
    totals = survey(Scene(walls, Balls(position, np.tile([3.0, 4.0], (count, 1)), 0.5)), bounces=1, threads=3)
    assert (totals.bounces == 1).all()
    assert totals.hits.sum() == count
    np.testing.assert_allclose(np.hypot(*totals.velocity.T), 5.0, rtol=1e-14)


def test_each_ball_is_taken_once_whoever_asks():
    counter = np.zeros(1, dtype=np.int64)
    queues = [Queue(counter, np.zeros(2, dtype=np.int64)) for _ in range(3)]
    flown = []
    for stop in (2 * BLOCK + 5, 4 * BLOCK - 1, 7 * BLOCK):  # what one has taken beyond a stop it flies after that
        asking = list(queues)
        while asking:
            asking = [
                queue for queue in asking if (ball := next_ball(queue, stop)) != NO_BALL and flown.append(ball) is None
            ]
        assert sorted(flown) == list(range(stop))


def test_work_is_done_without_threads_that_are_busy_elsewhere(monkeypatch):
    held = threading.Event()
    with ThreadPoolExecutor(1) as busy:
        busy.submit(held.wait)
        monkeypatch.setattr("wallkit.simulation.threads._helpers", lambda: busy)
        assert in_threads(lambda: threading.current_thread().name, 3) == [threading.current_thread().name]
        held.set()


def test_what_goes_wrong_in_a_thread_is_raised():
    meeting = threading.Barrier(2, timeout=20)

    def work():
        meeting.wait()
        if threading.current_thread() is not threading.main_thread():
            raise ValueError("here")

    with pytest.raises(ValueError, match="here"):
        in_threads(work, 2)


@pytest.mark.skipif(not hasattr(os, "fork") or sys.version_info >= (3, 12), reason="later Pythons warn of threads")
def test_a_forked_process_has_threads_of_its_own():
    def meet():
        meeting.wait()

    meeting = threading.Barrier(2, timeout=20)
    in_threads(meet, 2)
    child = os.fork()
    if not child:
        status = 1
        try:
            meeting = threading.Barrier(2, timeout=20)
            in_threads(meet, 2)
            status = 0
        finally:
            os._exit(status)
    assert os.waitpid(child, 0)[1] == 0
