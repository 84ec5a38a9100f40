"""``count``: any number of balls on threads, processes or a cluster, down to whole numbers."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, CancelledError, Future, wait
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from importers.errors import WallkitError
from wallkit.arguments import of_type, refused, whole_number
from wallkit.scene.scene import Scene, SceneError
from wallkit.simulation import checkpoints
from wallkit.simulation.checkpoints import Done
from wallkit.simulation.counts import Counts
from wallkit.simulation.meeting_rules import refuse_meeting
from wallkit.simulation.pools import Pool, check_executor, open_pool
from wallkit.simulation.simulate import limits
from wallkit.simulation.work import Draw, Result, SurveyWork, Work, check_draw

PILOT = 256
"""Balls that are flown first, here, to see how many bounces one makes."""
CHUNK_BOUNCES = 10_000_000
"""Bounces of a chunk: a second or more, beside which the milliseconds that a task costs do not count."""
MOST_BALLS = 50_000
"""Of a chunk: some 10 MB a worker."""
OPEN_A_WORKER = 2
"""Chunks that are given out, a worker: the next is there when one is done, and no queue grows."""
ATTEMPTS = 4
"""How often a chunk is flown whose workers die: once, and three times again."""
SAVE_EVERY = 2.0
"""Seconds between checkpoints."""
Progress = Callable[[float], None]


def count(
    scene: Scene,
    draw: Draw,
    balls: int,
    until: float | None = None,
    bounces: int | None = None,
    *,
    executor: object = "threads",
    workers: int | None = None,
    chunk: int | None = None,
    checkpoint: str | Path | None = None,
    progress: Progress | None = None,
) -> Counts:
    """Survey any number of balls, in chunks that threads, processes or a cluster fly, and keep whole numbers alone.

    Ball i is ``draw(i, 1)`` wherever it flies, and whole numbers add up to the same in any order: the result has the
    same bits for any executor, any number of workers, any chunks, after lost workers, and after a stop.
    Memory does not grow with the number of balls.

    Args:
        scene: walls and what acts; its balls do not count.
        draw: gives the balls from a number on: :class:`RandomBalls`, :class:`RoomBalls`, or a function of a first
            number and a count. For processes and clusters it must be picklable.
        balls: how many.
        until: as for ``survey``.
        bounces: as for ``survey``.
        executor: ``"threads"``, ``"processes"``, ``"dask://HOST:PORT"``; any ``concurrent.futures.Executor`` that runs
            functions of modules; or a function that makes one, which is called again where a pool breaks. Processes
            start afresh (spawn), so a script must begin under ``if __name__ == "__main__":``.
        workers: threads or processes; None for one a core.
        chunk: balls at a time; None for some ten million bounces.
        checkpoint: a file in which is kept what has flown. If it is there, only the rest flies.
        progress: called now and then with the part done, 0 to 1.

    Raises:
        SceneError: an argument is none of what may be, or the scene cannot be simulated.
        WallkitError: a chunk failed again and again (it is named), or the checkpoint is of another survey.
    """
    of_type(scene, "scene", Scene, "a Scene", error=SceneError, code="bad-scene")
    refuse_meeting(scene, "a count in chunks")
    limits(until, bounces)
    check_draw(draw)
    work = SurveyWork(scene, draw, until, bounces)
    return fly_all_chunks(
        work, balls, executor=executor, workers=workers, chunk=chunk, checkpoint=checkpoint, progress=progress
    )


def fly_all_chunks(
    work: Work[Result],
    balls: int,
    *,
    executor: object,
    workers: int | None,
    chunk: int | None,
    checkpoint: str | Path | None,
    progress: Progress | None,
) -> Result:
    """Do a work for balls 0 to ``balls``; see :func:`count` for the arguments."""
    may_be = "a whole number, 1 or more"
    balls = whole_number(balls, "balls", may_be, error=SceneError, code="bad-argument", least=1)
    for name, value in (("workers", workers), ("chunk", chunk)):
        if value is not None:
            whole_number(value, name, f"{may_be}, or None", error=SceneError, code="bad-argument", least=1)
    check_executor(executor)
    if checkpoint is not None:
        of_type(checkpoint, "checkpoint", (str, Path), "a path, or None", error=SceneError, code="bad-path")
    if progress is not None and not callable(progress):
        raise refused("progress", progress, "a function of one number, or None", SceneError, "bad-argument")
    flight = _Flight(work, work.digest(), balls, checkpoint, progress)
    result: Result = flight.fly(executor, workers, chunk)
    return result


@dataclass
class _Flight:
    """One run over all chunks: what has flown, what it came to, and who is told."""

    work: Work[Any]
    digest: str
    balls: int
    checkpoint: str | Path | None
    progress: Progress | None
    done: Done = field(default_factory=Done)
    part: Any = None
    saved: float = 0.0

    def fly(self, executor: object, workers: int | None, chunk: int | None) -> Any:
        found = None
        if self.checkpoint is not None:
            found = checkpoints.load(self.checkpoint, self.digest, self.work, self.balls)
        if found is not None:
            self.done, self.part = found
        if not len(self.done):
            pilot = min(self.balls, PILOT if chunk is None else chunk)
            self.add(0, pilot, self.work.fly(0, pilot))
        if len(self.done) < self.balls:
            size = chunk or chunk_of(self.part)
            pool = open_pool(executor, self.work, self.digest, workers)
            try:
                _fly_chunks(pool, self.done.left(self.balls, size), self.add)
            finally:
                self.save()
                pool.close()
        self.save()
        return self.part

    def add(self, first: int, count: int, part: Any) -> None:
        """Take in what a chunk came to."""
        self.part = part if self.part is None else self.part + part
        self.done.add(first, count)
        if time.monotonic() - self.saved > SAVE_EVERY:
            self.save()
        if self.progress is not None:
            self.progress(len(self.done) / self.balls)

    def save(self) -> None:
        if self.checkpoint is not None and self.part is not None:
            checkpoints.save(self.checkpoint, self.digest, self.done, self.part)
            self.saved = time.monotonic()


def chunk_of(part: Any) -> int:
    """Say how many balls a chunk has, by the bounces that those before made."""
    bounces = max(part.bounces / part.balls, 1.0)
    return max(1, min(MOST_BALLS, int(CHUNK_BOUNCES / bounces)))


@dataclass(eq=False)
class _Chunk:
    first: int
    count: int
    deaths: int = 0
    """How often its workers died while it was given out."""


def _fly_chunks(pool: Pool, left: Iterator[tuple[int, int]], add: Callable[[int, int, Any], None]) -> None:
    """Give out chunks, a few a worker, until none is left; those of a broken pool again.

    Whose chunk it was that broke a pool nobody says. What was given out twice when one broke flies alone from then on,
    so that the chunk that dies once more is the one to be named.
    """
    again: deque[_Chunk] = deque()
    alone: deque[_Chunk] = deque()
    given: dict[Future[Any], _Chunk] = {}
    try:
        while True:
            _give_out(pool, left, again, alone, given)
            if not given:
                return
            ready, _ = wait(given, return_when=FIRST_COMPLETED)
            lost = [future for future in ready if not _taken(future, given[future], add)]
            for future in ready.difference(lost):
                del given[future]
            if lost:
                _take_back(pool, lost[0], given, again, alone)
    finally:
        for future in given:
            future.cancel()


def _give_out(
    pool: Pool,
    left: Iterator[tuple[int, int]],
    again: deque[_Chunk],
    alone: deque[_Chunk],
    given: dict[Future[Any], _Chunk],
) -> None:
    while len(given) < OPEN_A_WORKER * pool.workers and not any(chunk.deaths > 1 for chunk in given.values()):
        if alone:
            if given:
                return
            chunk = alone.popleft()
        elif again:
            chunk = again.popleft()
        else:
            upcoming = next(left, None)
            if upcoming is None:
                return
            chunk = _Chunk(*upcoming)
        try:
            given[pool.submit(chunk.first, chunk.count)] = chunk
        except BrokenExecutor as error:  # it broke between two looks: as if the chunk had been in it
            future: Future[Any] = Future()
            future.set_exception(error)
            given[future] = chunk
            return


def _taken(future: Future[Any], chunk: _Chunk, add: Callable[[int, int, Any], None]) -> bool:
    """Take in what a chunk came to: False where its worker died.

    Raises:
        WallkitError: the chunk itself failed.
    """
    try:
        part = future.result()
    except (BrokenExecutor, CancelledError):
        return False
    except WallkitError:
        raise
    except Exception as error:
        raise _failed(chunk, f"failed: {type(error).__name__}: {error}", error) from error
    add(chunk.first, chunk.count, part)
    return True


def _take_back(
    pool: Pool,
    lost: Future[Any],
    given: dict[Future[Any], _Chunk],
    again: deque[_Chunk],
    alone: deque[_Chunk],
) -> None:
    """Make the broken pool anew, and line up again what it was given.

    Raises:
        WallkitError: a chunk has had its attempts, or the pool is somebody else's.
    """
    error = lost.exception() if not lost.cancelled() else None
    for chunk in given.values():
        chunk.deaths += 1
        if chunk.deaths >= ATTEMPTS:
            raise _failed(chunk, f"was given out {ATTEMPTS} times, and each time its worker died", error)
        (alone if chunk.deaths > 1 else again).append(chunk)
    if not pool.renew():
        raise _failed(given[lost], "was lost as the executor broke, which is not made here", error)
    given.clear()


def _failed(chunk: _Chunk, what: str, error: BaseException | None) -> WallkitError:
    numbers = f"{chunk.first:,} to {chunk.first + chunk.count - 1:,}"
    fix = "see what its worker says; in a script, begin under: if __name__ == '__main__':"
    failed = WallkitError(f"the chunk of balls {numbers} {what}", code="chunk-failed", fix=fix)
    failed.__cause__ = error
    return failed
