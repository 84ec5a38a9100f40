"""Looks for files that cost much work a byte: it grows them from a grammar, by counters and by processor time.

    python tests/fuzz/fuzz_work.py svg --minutes 60 --seed 1 --keep FOLDER

The first word names the grammar: svg, css, pdf, structure, illustrator, scene, walls, or all of them in turn; the
minutes are of processor time. What lives on and is changed again is what costs most a byte: of processor time, of each
kind of step that the budget of work counts, and of time that no step was charged for. Now and then one of those is said
8, 64 and 512 times as often in a process of its own. What it prints, and writes to FOLDER, are faults:

- foreign: an exception that is no WallkitError, or a number in the result that is none;
- limit: more than 5 seconds of processor time or 512 MB;
- growth: a larger file that costs over 2.5 times as much a byte as a smaller one of its kind, and over a second.

One seed gives one run only as far as the machine's times repeat, so a fault is kept as a file. None of the files that
are measured is longer than growing.LONGEST; the larger ones are at most MOST letters.
"""

from __future__ import annotations

import argparse
import contextlib
import heapq
import multiprocessing
import os
import resource
import sys
import time
from pathlib import Path
from typing import Any

sys.path[:0] = [str(Path(__file__).parents[2]), str(Path(__file__).parent)]

from grammars import READERS, Reading, Target  # noqa: E402
from growing import Grower, Many, TooLongError, scaled, written  # noqa: E402

from importers.errors import WallkitError  # noqa: E402

SECONDS, MEGABYTES = 5.0, 512
MOST = 1_500_000  # letters of a text that is said more often
MOST_BYTES = 16 << 20  # of the file that is made of it: a form of a PDF is a letter there
ALIVE = 12  # texts that live on, of each way to be costly
EVERY = 150  # texts between two that are said more often


def measured(target: Target, data: bytes) -> tuple[float, Reading]:
    """Give seconds of processor time and what was counted; what is no WallkitError comes through."""
    start = time.process_time()
    reading = Reading()
    try:
        target.read(data, reading)
    except WallkitError as error:
        reading.ended = error.code
    return time.process_time() - start, reading


class Herd:
    """The costliest texts met so far, by each way to be costly."""

    def __init__(self) -> None:
        self.kinds: dict[str, list[tuple[float, int, Many]]] = {}
        self.count = 0

    def add(self, tree: Many, size: int, seconds: float, steps: dict[str, int]) -> None:
        """Keep a text where it is among the costliest of a kind."""
        self.count += 1
        ways = {"seconds": seconds / (300 + size)}
        ways["uncharged"] = seconds / (2_000 + size + sum(steps.values()))
        ways.update({kind: number / (300 + size) for kind, number in steps.items()})
        for kind, cost in ways.items():
            best = self.kinds.setdefault(kind, [])
            heapq.heappush(best, (cost, self.count, tree))
            if len(best) > ALIVE:
                heapq.heappop(best)

    def some(self, grower: Grower) -> Many:
        """Give one of them, each kind as often as another."""
        kind = grower.random.choice(list(self.kinds))
        return grower.random.choice(self.kinds[kind])[2]


def _alone(target: Target, data: bytes, answer: Any) -> None:
    """Measure a file in a process that is ended by the limits."""
    resource.setrlimit(resource.RLIMIT_CPU, (int(4 * SECONDS), int(4 * SECONDS)))
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    try:
        seconds, reading = measured(target, data)
        ended = reading.ended
    except MemoryError:
        seconds, ended = SECONDS, "MemoryError"
    except Exception as error:
        seconds, ended = 0.0, f"foreign {type(error).__name__}: {error}"
    answer.send((seconds, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before, ended))


def alone(target: Target, data: bytes) -> tuple[float, float, str]:
    """Give seconds, megabytes more than at the start, and how reading a file ended, in a process of its own."""
    fork = multiprocessing.get_context("fork")
    ours, theirs = fork.Pipe()
    process = fork.Process(target=_alone, args=(target, data, theirs))
    process.start()
    theirs.close()
    try:
        seconds, kilobytes, ended = ours.recv()
    except EOFError:
        seconds, kilobytes, ended = 4 * SECONDS, 0, "killed"
    process.join()
    return seconds, kilobytes / 1024, ended


class Hunt:
    """One target's texts, and what was found wrong with them."""

    def __init__(self, target: Target, seed: int, keep: Path | None) -> None:
        self.target, self.keep = target, keep
        self.grower, self.herd = Grower(target.grammar, seed), Herd()
        self.faults: dict[str, int] = {}
        self.texts = self.larger = 0
        with contextlib.suppress(WallkitError, TooLongError):  # what is imported late counts for no text
            target.read(target.written(written(self.grower.new("file"))), Reading())

    def step(self) -> None:
        """Measure one more text."""
        new = not self.herd.kinds or self.grower.random.random() < 0.25
        tree = self.grower.new("file") if new else self.grower.changed(self.herd.some(self.grower))
        try:
            text = written(tree)
        except TooLongError:
            return
        self.texts += 1
        try:
            seconds, reading = measured(self.target, self.target.written(text))
        except Exception as error:
            self.fault(f"foreign {type(error).__name__} {str(error)[:60]}", text, f"{error!r}")
            return
        if seconds > SECONDS:
            self.fault("limit, though small", text, f"{seconds:.1f} s for {len(text):,} letters, {reading.ended}")
        if reading.ended != "limit":
            self.herd.add(tree, len(text), seconds, reading.steps)
        if self.texts % EVERY == 0:
            self.grow(self.herd.some(self.grower))

    def grow(self, tree: Many) -> None:
        """Say a text more often, and see that it costs no more than it may."""
        base, last = len(written(tree)), (0, 0.0)
        for factor in (8, 64, 512):
            try:
                text = written(scaled(tree, factor), MOST)
            except TooLongError:
                return
            data = self.target.written(text)
            if len(text) < 2 * max(last[0], base) or len(data) > MOST_BYTES:
                return
            seconds, megabytes, ended = alone(self.target, data)
            self.larger += 1
            said = f"{len(text):,} letters: {seconds:.1f} s, {megabytes:.0f} MB, {ended or 'read'}"
            if ended.startswith("foreign"):
                self.fault(ended[:60], text, said)
            elif seconds > SECONDS or megabytes > MEGABYTES or ended == "MemoryError":
                self.fault(f"limit of {self.target.name}", text, said)
                return
            elif last[1] > 0.02 and seconds > 1.0 and seconds / last[1] > 2.5 * len(text) / last[0]:
                self.fault("growth", text, f"{said}; before it {last[0]:,} letters: {last[1]:.2f} s")
            last = len(text), seconds

    def fault(self, kind: str, text: str, said: str) -> None:
        """Print a fault, and keep its text; of one kind the first few."""
        self.faults[kind] = count = self.faults.get(kind, 0) + 1
        if count > 5:
            return
        print(f"[{self.target.name}] {kind}: {said}\n    {text[:160]!r}", flush=True)
        if self.keep:
            name = f"{self.target.name}-{len(self.faults)}-{count}"
            (self.keep / name).write_bytes(self.target.written(text))

    def report(self) -> None:
        """Print how much was looked at, and the costliest text of each kind."""
        print(f"[{self.target.name}] {self.texts:,} texts, {self.larger:,} larger ones, faults: {self.faults}")
        for kind, best in sorted(self.herd.kinds.items()):
            cost, _, tree = max(best)
            what = "us" if kind in ("seconds", "uncharged") else "steps"
            scale = 1e6 if what == "us" else 1
            print(f"    {kind}: {cost * scale:.1f} {what} a letter: {written(tree)[:200]!r}")


def spent() -> float:
    """Give the seconds of processor time spent so far, here and in processes that ended."""
    return sum(os.times()[:4])


def main() -> int:
    """Hunt for so many minutes."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("grammar", choices=[*READERS, "all"])
    options.add_argument("--minutes", type=float, default=1.0)
    options.add_argument("--seed", type=int, default=0)
    options.add_argument("--keep", type=Path)
    given = options.parse_args()
    if given.keep:
        given.keep.mkdir(parents=True, exist_ok=True)
    names = list(READERS) if given.grammar == "all" else [given.grammar]
    hunts = [Hunt(READERS[name], given.seed, given.keep) for name in names]
    for hunt in hunts:
        end = spent() + 60 * given.minutes / len(hunts)
        while spent() < end:
            hunt.step()
        hunt.report()
    return int(any(hunt.faults for hunt in hunts))


if __name__ == "__main__":
    sys.exit(main())
