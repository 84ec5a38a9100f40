"""Memory of the page's server over many requests: ``python benchmarks/page_memory.py [REQUESTS] [walls]`` (10,000).

The server runs in a process of its own and is asked on this machine alone, by four askers: pages, samples, files that
are opened, and runs; with ``walls``, each of them opens one drawing and has it imported again and again, each time
with another tolerance and flown. Its memory, and that of its workers, is read after each tenth; the first tenth is
warming.
"""

from __future__ import annotations

import http.client
import json
import random
import subprocess
import sys
import threading
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SERVER = """
import sys, threading
from wallkit.cli.play import reader
from wallkit.view.page.server import PageServer
from wallkit.view.page.workers import Workers
with PageServer(Workers(reader())) as server:
    threading.Thread(target=server.serve_forever, daemon=True).start()
    print(server.server_address[1], server.token, flush=True)
    sys.stdin.read()
    server.shutdown()
"""


class Asker:
    """Asks one server."""

    def __init__(self, port: int, token: str) -> None:
        self._port, self._token = port, token

    def ask(self, method: str, path: str, body: bytes | None = None) -> bytes:
        """Send one request on a connection of its own."""
        connection = http.client.HTTPConnection("127.0.0.1", self._port, timeout=300)
        headers = {"X-Wallkit-Token": self._token}
        connection.request(method, path, body, headers | ({"Content-Length": str(len(body))} if body else {}))
        answer = connection.getresponse()
        content = answer.read()
        connection.close()
        if answer.status != 200:
            raise SystemExit(f"{method} {path}: {answer.status} {content[:200]!r}")
        return content

    def any(self, chance: random.Random) -> None:
        """Ask for one of what a page asks for."""
        kind = chance.random()
        if kind < 0.3:
            self.ask("GET", f"/?token={self._token}")
        elif kind < 0.5:
            self.ask("GET", "/samples/sinai.svg")
        else:
            drawing = (
                f'<svg xmlns="http://www.w3.org/2000/svg"><path d="M0 0H{chance.randrange(100, 300)}V99H0Z"/></svg>'
            )
            opened = json.loads(self.ask("POST", "/api/open?name=room.svg", drawing.encode()))
            ball = {"x": 50.0, "y": 50.0, "vx": 40.0, "vy": 30.0 * chance.random(), "radius": 1.0}
            question = {"document": opened["id"], "balls": [ball], "until": 10.0}
            self.ask("POST", "/api/simulate", json.dumps(question).encode())

    def again(self, chance: random.Random, document: str) -> None:
        """Have a document imported with a tolerance that nobody asked for yet, and flown."""
        curves = chance.choice(("lines", "arcs"))
        wish = {"document": document, "curves": curves, "tolerance": 10 ** chance.uniform(-3, 0)}
        opened = json.loads(self.ask("POST", "/api/walls", json.dumps(wish).encode()))
        question = {"document": opened["id"], "balls": opened["balls"], "until": 5.0}
        self.ask("POST", "/api/simulate", json.dumps(question).encode())


def megabytes(pid: int) -> tuple[float, float]:
    """Resident memory of a process, and of all its children."""
    children = Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
    own, *others = [int(Path(f"/proc/{one}/statm").read_text().split()[1]) * 4096 / 2**20 for one in (pid, *children)]
    return own, sum(others)


def main(requests: int, walls: bool) -> None:
    """Print the memory after each tenth."""
    started = subprocess.Popen([sys.executable, "-c", SERVER], stdin=-1, stdout=-1, text=True, cwd=ROOT)
    try:
        port, token = started.stdout.readline().split()
        asker = Asker(int(port), token)
        warm = 0.0
        for tenth in range(10):
            shares = [
                threading.Thread(target=ask, args=(asker, 4 * tenth + k, requests // 40, walls)) for k in range(4)
            ]
            for share in shares:
                share.start()
            for share in shares:
                share.join()
            own, others = megabytes(started.pid)
            warm = warm or own
            done = (tenth + 1) * requests // 10
            print(f"{done:8,} requests: {own:6.1f} MB ({own / warm:.3f}), workers {others:6.1f} MB", flush=True)
    finally:
        started.stdin.close()
        started.wait(60)


def ask(asker: Asker, seed: int, count: int, walls: bool) -> None:
    """Ask about so many requests; an opened file, or another import, counts two with its run."""
    chance = random.Random(seed)
    if walls:
        drawing = (ROOT / "samples" / "pinball.svg").read_bytes()
        document = json.loads(asker.ask("POST", "/api/open?name=again.svg", drawing))["id"]
        for _ in range(count // 2):
            asker.again(chance, document)
        return
    for _ in range(round(count / 1.5)):
        asker.any(chance)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 10_000, "walls" in sys.argv[2:])
