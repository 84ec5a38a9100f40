"""A survey writes into memory that all workers share: only threads of this process will do."""

import concurrent.futures
from concurrent.futures import Executor, ProcessPoolExecutor, ThreadPoolExecutor

import numpy as np
import pytest

from wallkit import Balls, Scene, Walls, survey
from wallkit.scene.scene import SceneError

SQUARE = [(0.0, 0.0), (0.0, 10.0), (10.0, 10.0), (10.0, 0.0)]


def scene(count=3000):
    angle = np.linspace(0.1, 6.0, count)
    velocity = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return Scene(Walls.from_polylines([SQUARE]), Balls(np.full((count, 2), 5.0), velocity, 0.5))


class ByValue(Executor):
    """Stands for executors that pickle what they are given, closures too (loky, dask): they would fill copies."""

    def submit(self, fn, /, *args, **kwargs):
        raise AssertionError("it was given work")


class OwnThreads(ThreadPoolExecutor):
    pass


@pytest.mark.parametrize("executor", [ByValue(), "threads", ThreadPoolExecutor])
def test_what_is_no_threads_is_refused_before_it_is_given_work(executor):
    with pytest.raises(SceneError, match=r"executor is a .*ThreadPoolExecutor") as caught:
        survey(scene(), bounces=5, executor=executor)
    assert caught.value.code == "bad-executor"


def test_processes_are_refused_by_their_name():
    with ProcessPoolExecutor(1) as executor, pytest.raises(SceneError, match="ProcessPoolExecutor, and a survey"):
        survey(scene(), bounces=5, executor=executor)


@pytest.mark.skipif(
    not hasattr(concurrent.futures, "InterpreterPoolExecutor"), reason="interpreters of their own are of Python 3.14"
)
def test_threads_with_interpreters_of_their_own_are_refused():
    with concurrent.futures.InterpreterPoolExecutor(1) as executor, pytest.raises(SceneError, match="Interpreter"):
        survey(scene(), bounces=5, executor=executor)


def test_loky_is_refused():
    loky = pytest.importorskip("loky", reason="loky is not installed")
    executor = loky.ProcessPoolExecutor(1)
    try:
        with pytest.raises(SceneError, match=r"loky.*ThreadPoolExecutor"):
            survey(scene(), bounces=5, executor=executor)
    finally:
        executor.shutdown(kill_workers=True)


def test_threads_of_a_kind_of_ones_own_are_taken():
    with OwnThreads(2) as executor:
        totals = survey(scene(), bounces=5, executor=executor)
    assert totals.bounces.tolist() == [5] * 3000
    assert totals.hits.tolist() == [15000]
