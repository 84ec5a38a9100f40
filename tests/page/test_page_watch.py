"""The page follows its file: what is saved is shown anew, from where the person stands."""

from __future__ import annotations

import json
import os
import threading

import pytest

from wallkit import WallkitError
from wallkit.cli.play import reader
from wallkit.view.page.questions import Opening
from wallkit.view.page.server import PageServer
from wallkit.view.page.workers import Workers
from wallkit.walls.import_options import ImportOptions
from wallkit.watch_file import Watch

ROOM = """<svg xmlns="http://www.w3.org/2000/svg" width="400" height="300">
<path id="room" d="M0 0H{width}V300H0Z" fill="none" stroke="#000"/>
<g id="balls"><circle cx="80" cy="120" r="6"/><path d="M80 120L130 150"/></g></svg>"""


def saved(path, text):
    """Save as drawing programs do: a new file renamed over the old one."""
    (path.parent / "new").write_text(text)
    os.replace(path.parent / "new", path)  # noqa: PTH105


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "room.svg"
    path.write_text(ROOM.format(width=400))
    return path


@pytest.fixture(scope="module")
def workers():
    both = Workers(reader())
    yield both
    both.close()


def opened_by(workers, file, importing=None):
    watch, options = Watch(file), importing or ImportOptions(curves="arcs")
    return json.loads(workers.open(Opening(file.read_bytes(), file.name, file.parent, options), watch=watch).content)


def asked(workers, table):
    return json.loads(workers.ask("saved", {"document": table["id"], "version": table["version"]}).content)


def test_a_saved_file_is_given_anew_to_every_page_that_has_an_older_version(workers, file):
    first = opened_by(workers, file, ImportOptions(curves="arcs", scale=2.0))
    assert (first["watched"], first["version"], asked(workers, first)) == (True, 0, {})
    saved(file, ROOM.format(width=500))
    assert asked(workers, first) == {}  # one look: it may still be written
    second = asked(workers, first)
    assert (second["id"], second["version"], second["box"][2]) == (first["id"], 1, 1000)  # imported as before
    assert asked(workers, first)["version"] == 1  # another page with the old version
    assert asked(workers, second) == {}


def test_what_cannot_be_read_is_told_once_and_the_document_stays(workers, file):
    first = opened_by(workers, file)
    saved(file, "<svg")
    assert asked(workers, first) == {}
    with pytest.raises(WallkitError, match=r"room\.svg"):
        asked(workers, first)
    assert asked(workers, first) == {}
    again = json.loads(workers.ask("walls", {"document": first["id"], "curves": "arcs"}).content)
    assert again["walls"]["box"] == [0, 0, 400, 300]
    saved(file, ROOM.format(width=500))
    assert [asked(workers, first), asked(workers, first)["version"]] == [{}, 1]


def test_what_was_dropped_on_the_page_is_no_file_to_be_watched(workers, file):
    table = json.loads(workers.open(Opening(file.read_bytes(), file.name, None, ImportOptions(curves="arcs"))).content)
    assert (table["watched"], asked(workers, table)) == (False, {})


@pytest.mark.browser
def test_the_page_shows_what_is_saved_and_keeps_view_aim_and_settings(opened, until, file):
    workers = Workers(reader())
    document = opened_by(workers, file)
    with PageServer(workers, 0, document) as server:
        threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.01}, daemon=True).start()
        page = opened(server.url)
        until(page, "Wallkit.page.document")
        stage = "[Wallkit.page.stage.screenX(100), Wallkit.page.stage.screenY(100)]"
        page.locator("#speed").fill("77")
        page.locator("#restitution").fill("0.5")
        page.evaluate("Wallkit.page.stage.zoom(2)")
        before = page.evaluate(f"[{stage}, Wallkit.page.aim.ball, Wallkit.page.controls.world()]")
        saved(file, ROOM.format(width=500))
        until(page, "Wallkit.page.document.version === 1")
        assert page.evaluate("Wallkit.page.document.walls.box[2]") == 500
        assert page.evaluate(f"[{stage}, Wallkit.page.aim.ball, Wallkit.page.controls.world()]") == before
        assert before[2]["restitution"] == 0.5
        saved(file, ROOM.format(width=600))
        until(page, "Wallkit.page.document.version === 2")
        page.close()  # and with it what it still asks
        server.shutdown()
