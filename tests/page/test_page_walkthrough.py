"""docs/walkthroughs.md, to planck in a page: the example runs in a browser, and its balls stay in the level."""

from __future__ import annotations

import functools
import http.server
import shutil
import subprocess
import threading
from pathlib import Path

import pytest

import wallkit

ROOT = Path(__file__).parents[2]
pytestmark = pytest.mark.browser


@pytest.fixture
def served(tmp_path):
    node = shutil.which("node")
    if not node:
        pytest.skip("node is not installed")
    asked = [node, "-p", "require.resolve('planck')"]
    found = subprocess.run(asked, capture_output=True, text=True, timeout=60)
    if found.returncode:
        pytest.skip("node does not find the package planck (npm install planck; NODE_PATH names the folder)")
    shutil.copy(Path(found.stdout.strip()).parent / "planck.min.js", tmp_path)
    shutil.copy(ROOT / "examples" / "planck_page.html", tmp_path)
    handler = functools.partial(http.server.SimpleHTTPRequestHandler, directory=str(tmp_path))
    handler.log_message = lambda *_: None
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler)
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    yield tmp_path, f"http://127.0.0.1:{server.server_port}/planck_page.html"
    server.shutdown()
    thread.join()
    server.server_close()


def test_the_page_plays_the_level_and_keeps_its_balls(served, browser):
    from wallkit.export import ExportOptions, build_level
    from wallkit.scene.starting_places import roomiest

    folder, url = served
    walls = wallkit.import_walls(ROOT / "samples" / "lagoon.ai")
    walls.export(folder / "level.planck.json")
    level = build_level(walls, ExportOptions(), y_axis="up", metres=True)
    placed = wallkit.Walls.from_polylines([wall.vertices for wall in level], [wall.closed for wall in level])
    placed.depth = walls.depth
    spot = roomiest(placed)
    page = browser.new_page()
    wrong = []
    page.on("pageerror", lambda error: wrong.append(str(error)))
    page.goto(f"{url}?ball={spot.x!r},{spot.y!r}")
    page.wait_for_function("window.game && window.game.frames >= 120")
    places = page.evaluate("game.balls.map((ball) => [ball.getPosition().x, ball.getPosition().y])")
    page.close()
    import shapely

    assert not wrong
    assert len({tuple(place) for place in places}) == 12
    assert all(shapely.contains_xy(spot.face, x, y) for x, y in places)
