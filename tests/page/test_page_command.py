"""`wallkit play` as a command: what it prints, how it ends, and the samples that it opens on."""

import os
import re
import signal
import socket
import subprocess
import sys
import urllib.request
from pathlib import Path

import pytest

from wallkit.scene.samples import samples

ROOT = Path(__file__).parents[2]


def play(*arguments, **options):
    environment = os.environ | {"NO_COLOR": "1", "PYTHONPATH": str(ROOT), "PYTHONUNBUFFERED": "1"}
    return subprocess.Popen(
        [sys.executable, "-m", "wallkit", "play", "--no-browser", *map(str, arguments)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=environment,
        preexec_fn=_heed_interrupts if os.name == "posix" else None,
        **options,
    )


def _heed_interrupts():
    """Undo what a shell does to what it starts in the background, and what is started by that."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def test_it_prints_its_address_serves_the_file_and_ends_on_an_interrupt():
    with play(ROOT / "samples" / "sinai.svg") as running:
        address = re.search(r"http://127\.0\.0\.1:\d+/\?token=\S+", running.stdout.readline())
        assert address
        with urllib.request.urlopen(address[0], timeout=60) as answer:
            page = answer.read().decode()
        running.send_signal(signal.SIGINT)
        _, said = running.communicate(timeout=60)
    assert '"name":"sinai.svg"' in page
    assert running.returncode == 130
    assert "Traceback" not in said


def test_standard_input_is_a_file_too():
    with play("-", stdin=subprocess.PIPE) as running:
        running.stdin.write("24 803 m\n69 828 l\n108 775 l\n31 757 l\n24 803 l\n")
        running.stdin.close()
        address = running.stdout.readline().split()[-1]
        with urllib.request.urlopen(address, timeout=60) as answer:
            assert '"name":"standard input"' in answer.read().decode()
        running.kill()


def test_a_file_that_is_not_there_ends_it_with_words():
    with play("nothing.svg") as running:
        _, said = running.communicate(timeout=60)
    assert running.returncode == 2
    assert "nothing.svg" in said
    assert "Traceback" not in said


def test_a_port_in_use_ends_it_with_words():
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        with play("--port", other.getsockname()[1]) as running:
            _, said = running.communicate(timeout=60)
    assert running.returncode == 2
    assert "cannot listen on port" in said


@pytest.mark.parametrize("sample", samples(), ids=lambda sample: sample.name)
def test_every_sample_says_what_it_shows(sample):
    assert sample.title
    assert sample.about.endswith(".")
    assert sample.path.is_file()


def test_the_samples_travel_with_the_wheel():
    settings = (ROOT / "pyproject.toml").read_text()
    assert '"samples" = "wallkit/samples_data"' in settings
    assert len(samples()) >= 5
