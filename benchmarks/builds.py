"""Another build of wallkit beside this one: a git worktree of a commit, with an environment of its own."""

from __future__ import annotations

import contextlib
import os
import resource
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


@dataclass(frozen=True)
class Build:
    """Where a build lies, the Python that runs it, and what is set for it."""

    folder: Path
    python: str
    settings: dict[str, str] = field(default_factory=dict)

    def seconds(self, arguments: Sequence[str], **more: str) -> tuple[float, str]:
        """Run Python with these arguments: processor seconds of the process and its children, and what it printed."""
        env = os.environ | self.settings | more | {"PYTHONPATH": str(self.folder)}
        env.pop("PYTHONDONTWRITEBYTECODE", None)  # an installed package has its byte code
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run([self.python, *arguments], cwd=self.folder, env=env, capture_output=True, text=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        if done.returncode:
            sys.exit(f"{self.folder}: {' '.join(arguments)[:200]}\n{done.stderr[-2000:]}")
        return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, done.stdout


@contextlib.contextmanager
def beside(commit: str, *, same_environment: bool = False) -> Iterator[tuple[Build, Build]]:
    """Check a commit out and give (this build, that one), each with an empty folder for its kernels.

    Args:
        commit: as git names it.
        same_environment: run it with the packages of this environment, and not with those that pip chooses for it now;
            builds of before our own compiler need Numba there.
    """
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        tree = folder / "build"
        subprocess.run(["git", "worktree", "add", "-q", "--detach", str(tree), commit], cwd=ROOT, check=True)
        try:
            python = sys.executable if same_environment else environment(folder / "environment", tree)
            yield (
                Build(ROOT, sys.executable, {"WALLKIT_CACHE_DIR": str(folder / "kernels-here")}),
                Build(tree, python, {"WALLKIT_CACHE_DIR": str(folder / "kernels-there")}),
            )
        finally:
            subprocess.run(["git", "worktree", "remove", "--force", str(tree)], cwd=ROOT, check=True)


def environment(folder: Path, tree: Path) -> str:
    """Make a virtual environment with what a tree or a wheel holds; give its Python."""
    subprocess.run([sys.executable, "-m", "venv", str(folder)], check=True)
    python = str(folder / ("Scripts" if sys.platform == "win32" else "bin") / "python")
    subprocess.run([python, "-m", "pip", "install", "-q", str(tree)], check=True)
    return python


def medians(turns: Sequence[Sequence[float]]) -> tuple[float, float, float]:
    """Of turns, a figure here and one there each: both medians, and that of there divided by here."""
    here, there = (statistics.median(column) for column in zip(*turns, strict=True))
    return here, there, statistics.median(turn[1] / turn[0] for turn in turns)
