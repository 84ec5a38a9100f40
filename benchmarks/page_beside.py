"""How long the page takes for a light answer while it works on a heavy one: ``python benchmarks/page_beside.py``.

The heavy question is an import of the sample lagoon as arcs with a tolerance of 1e-9, asked again and again; the light
ones are what aiming asks for, 24 bounces in a room. Printed are the median and the longest of a hundred, alone and
beside it.
"""

from __future__ import annotations

import json
import statistics
import subprocess
import sys
import threading
import time

from page_memory import ROOT, SERVER, Asker

ROOM = b'<svg xmlns="http://www.w3.org/2000/svg"><path d="M0 0H200V99H0Z"/></svg>'
BALL = {"x": 50.0, "y": 50.0, "vx": 40.0, "vy": 30.0, "radius": 1.0}


def opened(asker: Asker, name: str, drawing: bytes) -> str:
    """Give the document's name on the server."""
    return str(json.loads(asker.ask("POST", f"/api/open?name={name}", drawing))["id"])


def light(asker: Asker, room: str) -> tuple[float, float]:
    """Median and longest of a hundred light answers, in milliseconds."""
    question = json.dumps({"document": room, "balls": [BALL], "bounces": 24}).encode()
    taken = []
    for _ in range(100):
        begun = time.perf_counter()
        asker.ask("POST", "/api/simulate", question)
        taken.append(1e3 * (time.perf_counter() - begun))
    return statistics.median(taken), max(taken)


def keep_busy(asker: Asker, lagoon: str, done: threading.Event) -> None:
    """Ask the heavy question until that is over, each time with another tolerance, so that no answer is at hand."""
    tolerance = 1e-9
    while not done.is_set():
        tolerance *= 1.001
        asker.ask(
            "POST", "/api/walls", json.dumps({"document": lagoon, "curves": "arcs", "tolerance": tolerance}).encode()
        )


def main() -> None:
    """Print both."""
    started = subprocess.Popen([sys.executable, "-c", SERVER], stdin=-1, stdout=-1, text=True, cwd=ROOT)
    try:
        port, token = started.stdout.readline().split()
        asker, done = Asker(int(port), token), threading.Event()
        room, lagoon = (
            opened(asker, "room.svg", ROOM),
            opened(asker, "lagoon.ai", (ROOT / "samples/lagoon.ai").read_bytes()),
        )
        light(asker, room)
        print("alone: median {:.0f} ms, at most {:.0f}".format(*light(asker, room)))
        busy = threading.Thread(target=keep_busy, args=(asker, lagoon, done))
        busy.start()
        time.sleep(1.0)
        print("beside: median {:.0f} ms, at most {:.0f}".format(*light(asker, room)))
        done.set()
        busy.join()
    finally:
        started.stdin.close()
        started.wait(60)


if __name__ == "__main__":
    main()
