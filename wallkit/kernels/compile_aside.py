"""Compile aside: a process of its own compiles kernels, while whoever wants them goes on interpreted.

The disk cache carries the machine code over. The process outlives the one that began it (a run that was over sooner,
an ended worker of the page), so no compiling is thrown away; a lock lets one of them compile at a time, and the next
finds on the disk what the one before it has made.
"""

from __future__ import annotations

import contextlib
import os
import pickle
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from wallkit.kernels.jit import NotCompiledError, cache_folder, never_compiling
from wallkit.kernels.machine_code import alone

Task = Callable[..., None]
_processes: dict[tuple[Any, ...], subprocess.Popen[bytes] | None] = {}
NICE = 5
"""Politeness of the process: who waits for an interpreted answer goes first."""


def at_hand(task: Task, *arguments: Any) -> bool:
    """Tell whether kernels can be had without waiting for a compiler; begin to compile them aside where not.

    Args:
        task: a function of a module that calls or compiles these kernels, quick once they are compiled.
        arguments: its own, hashable and small.

    Returns:
        True once they are compiled, in this process or on the disk. True, too, where no other process can be of help
        (it failed, or the cache's folder cannot be written): then whoever calls them compiles.
    """
    wanted = task, *arguments
    if wanted not in _processes:
        try:
            with never_compiling():
                task(*arguments)
        except NotCompiledError:
            _processes[wanted] = _begun(*wanted)
        else:
            _processes[wanted] = None
    process = _processes[wanted]
    return process is None or process.poll() is not None


def _begun(*wanted: Any) -> subprocess.Popen[bytes] | None:
    """Start the process; None where there can be none."""
    if not sys.executable or not _writable(cache_folder()):
        return None
    command = [sys.executable, "-c", f"from {__name__} import main; main()"]
    path = os.pathsep.join(part for part in sys.path if part)
    null = subprocess.DEVNULL
    try:
        process = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=null,
            stderr=null,
            env={**os.environ, "PYTHONPATH": path},
            start_new_session=True,  # deaf to the terminal's Ctrl+C
        )
    except OSError:
        return None
    assert process.stdin is not None
    with contextlib.suppress(OSError), process.stdin as pipe:  # it ended at once: its exit status says so
        pickle.dump(wanted, pipe)
    return process


def _writable(folder: Path) -> bool:
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:
        return False
    return os.access(folder, os.W_OK)


def main() -> None:
    """Be that process."""
    _be_modest()
    task, *arguments = pickle.load(sys.stdin.buffer)  # of at_hand: nobody else holds the pipe
    with alone(cache_folder() / "compiling"):
        task(*arguments)


def _be_modest() -> None:
    """Give way to others; but take the memory that compiling needs, whatever bound the beginner was held to."""
    if sys.platform == "win32":
        return
    import resource

    os.nice(NICE)
    _, hard = resource.getrlimit(resource.RLIMIT_AS)
    resource.setrlimit(resource.RLIMIT_AS, (hard, hard))
