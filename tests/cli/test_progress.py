"""What a command shows of its progress, and what a shell completes."""

import io
import os
import subprocess
import sys

import pytest

from wallkit.cli.progress import progress_bar, progress_words

WIPED = "\x1b[1A\x1b[2K"  # one line up, and that line erased


class Terminal(io.StringIO):
    def isatty(self):
        return True


def on_a_terminal(monkeypatch):
    """Let standard error be a terminal; in the test itself, for pytest takes it back after fixtures."""
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", "80")
    monkeypatch.setattr(sys, "stderr", stream := Terminal())
    return stream


def test_a_bar_is_drawn_on_a_terminal_and_wiped_at_the_end(monkeypatch):
    stream = on_a_terminal(monkeypatch)
    with progress_bar("simulating") as report:
        report(0.5)
    assert "simulating" in stream.getvalue()
    assert "50%" in stream.getvalue()
    assert stream.getvalue().endswith(WIPED)


def test_words_are_shown_as_they_are_and_wiped_at_the_end(monkeypatch):
    stream = on_a_terminal(monkeypatch)
    with progress_words() as told:
        told("scene [1] of 3")
    assert "scene [1] of 3" in stream.getvalue()
    assert stream.getvalue().endswith(WIPED)


@pytest.mark.parametrize("progress", [lambda: progress_bar("simulating"), progress_words])
def test_no_terminal_sees_nothing(progress, monkeypatch):
    monkeypatch.setattr(sys, "stderr", stream := io.StringIO())
    with progress() as told:
        assert told is None
    assert stream.getvalue() == ""


@pytest.mark.parametrize(
    ("typed", "offered"),
    [("wallkit exp", ["export"]), ("wallkit export --format p", ["planck", "pymunk", "phaser"])],
)
def test_the_shell_completes_commands_and_formats(typed, offered):
    words = {"_WALLKIT_COMPLETE": "complete_bash", "COMP_WORDS": typed, "COMP_CWORD": str(len(typed.split()) - 1)}
    code = "import sys; sys.argv = ['wallkit']; from wallkit.cli import main; main()"
    done = subprocess.run(
        [sys.executable, "-c", code], env={**os.environ, **words}, capture_output=True, text=True, timeout=60
    )
    assert done.stdout.split() == offered
