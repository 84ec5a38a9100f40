"""Where chunks are flown: threads, processes, a Dask cluster, or any executor; broken pools are made anew."""

from __future__ import annotations

import multiprocessing
import pickle
from collections.abc import Callable
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from typing import Any

from wallkit.arguments import refused
from wallkit.scene.scene import SceneError
from wallkit.simulation.threads import cores
from wallkit.simulation.work import Work, fly_chunk, keep

MAY_BE = (
    "'threads', 'processes', 'dask://HOST:PORT', a concurrent.futures.Executor that runs functions of modules, "
    "or a function that makes one"
)


class Pool:
    """Workers that fly chunks of one work.

    Attributes:
        workers: how many chunks run at once; a guess for executors that do not say.
    """

    def __init__(self, work: Work[Any], digest: str, make: Callable[[], Executor], workers: int, owned: bool) -> None:
        """Take what makes an executor; one that is ``owned`` is shut down at the end, and made anew when it breaks."""
        self._work, self._digest, self._make, self._owned = work, digest, make, owned
        self.workers = workers
        self.sent: Any = None
        self._executor = make()

    def submit(self, first: int, count: int) -> Future[Any]:
        """Let some balls be flown."""
        return self._executor.submit(fly_chunk, self._digest, self.sent, first, count)

    def renew(self) -> bool:
        """Make a new executor in place of a broken one: False where it is somebody else's."""
        if not self._owned:
            return False
        self._executor.shutdown(wait=False, cancel_futures=True)
        self._executor = self._make()
        return True

    def close(self) -> None:
        """Wait for what runs, drop what does not, and end the workers that are ours."""
        if self._owned:
            self._executor.shutdown(wait=True, cancel_futures=True)


class _Dask(Pool):
    """Workers of a Dask cluster: the scene travels to each once, and Dask itself flies again what a lost one had."""

    def __init__(self, work: Work[Any], digest: str, address: str) -> None:
        try:
            from distributed import Client
        except ImportError as error:
            fix = "install it: pip install 'wallkit[dask]'"
            raise SceneError("dask:// needs the package distributed", code="no-dask", fix=fix) from error
        try:
            connect: Any = Client
            self._client = connect(address, timeout="10s", set_as_default=False)
        except (OSError, TimeoutError, ValueError) as error:
            fix = "start one: dask scheduler; then on each machine: dask worker HOST:PORT"
            raise SceneError(f"no Dask scheduler answers at {address}", code="no-dask", fix=fix) from error
        super().__init__(work, digest, lambda: self._client.get_executor(pure=False, retries=3), 1, owned=False)
        self.renew()

    def renew(self) -> bool:
        """Send the scene again: what was lost went with all workers that had it."""
        self.sent = self._client.scatter(pickled(self._work), broadcast=True, hash=False)
        self.workers = max(1, sum(self._client.nthreads().values()))
        return True

    def close(self) -> None:
        self._client.close()


def check_executor(executor: object) -> None:
    """Refuse what no chunk can be given to.

    Raises:
        SceneError: it is none of ``MAY_BE``.
    """
    if isinstance(executor, str):
        good = executor in ("threads", "processes") or (executor.startswith("dask://") and len(executor) > 7)
    else:
        good = (
            executor is None
            or isinstance(executor, Executor)
            or (callable(executor) and not isinstance(executor, type))
        )
    if not good:
        raise refused("executor", executor, MAY_BE, SceneError, "bad-executor")


def open_pool(executor: object, work: Work[Any], digest: str, workers: int | None) -> Pool:
    """Open an executor that was checked.

    Raises:
        SceneError: no cluster answers, or the work cannot be sent.
    """
    many = cores() if workers is None else workers
    if executor is None or executor == "threads":
        keep(digest, work)
        return Pool(work, digest, lambda: ThreadPoolExecutor(many, thread_name_prefix="wallkit-chunk"), many, True)
    if executor == "processes":
        return Pool(work, digest, _processes(many, digest, pickled(work)), many, True)
    if isinstance(executor, str):
        return _Dask(work, digest, "tcp://" + executor[7:])
    if isinstance(executor, Executor):
        pool = Pool(work, digest, lambda: executor, _size(executor, many), owned=False)
    else:
        make: Callable[[], Executor] = executor  # type: ignore[assignment]
        pool = Pool(work, digest, make, many, owned=True)
        pool.workers = _size(pool._executor, many)
    pool.sent = pickled(work)
    return pool


def _size(executor: Executor, usual: int) -> int:
    size = getattr(executor, "_max_workers", None)
    return size if isinstance(size, int) and size > 0 else usual


def _processes(workers: int, digest: str, blob: bytes) -> Callable[[], Executor]:
    """Processes that are given the work once, at their start: fresh ones, for a fork would copy locked locks."""
    context = multiprocessing.get_context("spawn")
    return lambda: ProcessPoolExecutor(workers, context, initializer=keep, initargs=(digest, blob))


def pickled(work: Work[Any]) -> bytes:
    """Make bytes of a work that another process reads.

    Raises:
        SceneError: how its balls are drawn cannot be sent, such as a lambda.
    """
    try:
        return pickle.dumps(work, pickle.HIGHEST_PROTOCOL)
    except (pickle.PicklingError, AttributeError, TypeError) as error:
        fix = "draw with RandomBalls, or with a function of a module; or take executor='threads'"
        raise SceneError(f"draw cannot be sent to another process: {error}", code="bad-executor", fix=fix) from error
