"""A folder of exported pages: opened from a disk and from a static server, offline, under its own strict policy."""

import functools
import http.server
import re
import threading

import numpy as np
import pytest
from typer.testing import CliRunner

from wallkit import open_scene, simulate, step_through
from wallkit.cli.app import _register_commands, app
from wallkit.scene.samples import lessons
from wallkit.view.export_pages import page_names

LESSONS = lessons()
NAMES = [f"{lesson.path.stem}.html" for lesson in LESSONS]
WINDOWS = [{"width": 1366, "height": 768}, {"width": 390, "height": 844}]


def play(*arguments):
    _register_commands()
    return CliRunner().invoke(app, ["play", *map(str, arguments)])


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("class") / "pages"
    result = play("--export-page", folder)
    assert result.exit_code == 0, result.output
    return folder


@pytest.fixture(scope="module")
def static(folder):
    """The folder's address on a server that knows nothing but files."""

    class Quiet(http.server.SimpleHTTPRequestHandler):
        def log_message(self, *args):
            pass

    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=folder)) as server:
        threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.01}, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_address[1]}"
        server.shutdown()


@pytest.fixture(params=["file", "http"])
def address(request, folder, static):
    return folder.as_uri() if request.param == "file" else static


def test_every_page_stands_alone_under_a_policy_of_hashes(folder):
    assert sorted(path.name for path in folder.iterdir()) == sorted(["index.html", *NAMES])
    for path in folder.iterdir():
        html = path.read_text(encoding="utf-8")
        policy = re.search(r'http-equiv="Content-Security-Policy" content="([^"]+)"', html)[1]
        assert policy.startswith("default-src 'none'; ")
        assert "unsafe" not in policy
        assert "http" not in policy
        head = html.split("<style>")[0] + re.sub(r"<style>.*?</style>|<script[^>]*>.*?</script>", "", html, flags=re.S)
        assert not re.search(r"\son\w+=|\sstyle=|javascript:", head)
        leads = set(re.findall(r'(?:src|href)="([^"]+)"', head))
        assert {lead for lead in leads if not lead.startswith("data:")} <= {"index.html", *NAMES}


@pytest.mark.browser
def test_the_folder_is_walked_through_by_keyboard_alone(opened, address, until):
    page = opened(f"{address}/{NAMES[0]}")
    page.get_by_role("link", name="Lessons").focus()
    page.keyboard.press("Enter")
    page.wait_for_url("**/index.html")
    cards = page.get_by_role("link")
    assert cards.count() == len(LESSONS)
    assert page.evaluate("[...document.images].every((image) => image.complete && image.naturalWidth > 100)")
    cards.first.focus()
    page.keyboard.press("Enter")
    for lesson in LESSONS:
        page.wait_for_url(f"**/{lesson.path.stem}.html")
        until(page, "globalThis.Wallkit && Wallkit.replay")
        assert page.title() == lesson.title
        page.get_by_role("button", name="Play").focus()
        page.keyboard.press("Enter")
        until(page, "Wallkit.replay.player.time > 0")
        told = open_scene(lesson.path).lesson
        assert page.locator("#lesson-text p").all_inner_texts() == [
            " ".join(part.split()) for part in re.split(r"\n\s*\n", told.text)
        ]
        page.locator("summary").first.focus()
        page.keyboard.press("Enter")
        assert page.locator("details p").first.inner_text() == told.questions[0][1]
        if lesson is not LESSONS[-1]:
            page.get_by_role("link", name="Next page").focus()
            page.keyboard.press("Enter")


@pytest.mark.browser
def test_balls_and_frames_are_where_the_library_says(opened, folder):
    lesson = next(lesson for lesson in LESSONS if lesson.path.stem == "frames")
    opening = open_scene(lesson.path)
    run = simulate(opening.scene, opening.until)
    stepped = step_through(opening.scene, "overlap", opening.lesson.dt, opening.until)
    page = opened(f"{folder.as_uri()}/frames.html")
    for time in [0.0, 0.1, 0.2025, 0.3, *stepped.time[[3, 14, -1]].tolist()]:
        x, y, ghost_x = page.evaluate(
            """(t) => { const {player, frames} = Wallkit.replay; const s = player.motion.state(0, t);
            return [s.x, s.y, frames.x(frames.at(t), 0)]; }""",
            time,
        )
        assert [x, y] == pytest.approx(run.position(time)[0], abs=1e-9)
        assert ghost_x == stepped.shown(time)[0, 0]
    pixel = page.evaluate(  # its ball is drawn, beyond the wall
        """() => { const {player, stage, frames} = Wallkit.replay; player.ghosts = player.trails = false;
        player.seek(0.3); player.draw(); const k = stage.ratio;
        const x = stage.screenX(frames.x(frames.at(0.3), 0)), y = stage.screenY(60);
        return [...stage.front.getContext("2d").getImageData(Math.round(x * k), Math.round(y * k), 1, 1).data]; }"""
    )
    assert pixel[3] == 255


@pytest.mark.browser
def test_the_policy_lets_no_other_script_run(opened, address):
    page = opened(f"{address}/{NAMES[0]}", expected=["Content Security Policy"])
    page.evaluate(
        """() => { const script = document.createElement("script"); script.textContent = "window.owned = 1";
        document.body.append(script);
        document.body.setAttribute("onclick", "window.owned = 1"); document.body.click(); }"""
    )
    assert page.evaluate("window.owned === undefined")


@pytest.mark.browser
@pytest.mark.parametrize("window", WINDOWS, ids=["desk", "phone"])
def test_exported_pages_are_accessible(opened, folder, accessible, window):
    page = opened(f"{folder.as_uri()}/restitution.html", viewport=window)
    if window["width"] < 500:
        accessible(page)
        page.locator("#sheet-button").click()
    accessible(page)
    page.get_by_role("link", name="Lessons").click()
    page.wait_for_url("**/index.html")
    accessible(page)


@pytest.mark.browser
def test_a_phone_is_filled_by_the_drawing_and_the_text_is_a_sheet(opened, folder, until):
    page = opened(f"{folder.as_uri()}/parabolas.html", viewport=WINDOWS[1], has_touch=True, is_mobile=True)
    tall = "document.getElementById('stage').getBoundingClientRect()"
    assert page.evaluate(f"{tall}.width") == 390
    assert page.evaluate(f"{tall}.height") > 0.7 * 844
    assert page.evaluate("[document.documentElement.scrollWidth, document.documentElement.scrollHeight]") == [390, 844]
    assert page.locator("#panel").is_hidden()
    page.locator("#sheet-button").tap()
    assert page.locator("#lesson-text").is_visible()
    assert page.locator("#sheet-button").get_attribute("aria-expanded") == "true"
    until(page, f"{tall}.height < 0.5 * 844 && Wallkit.replay.stage.fitted")
    assert page.evaluate(f"{tall}.height") > 200  # the drawing stays in sight
    page.locator("summary").first.focus()
    page.keyboard.press("Escape")
    assert page.locator("#panel").is_hidden()
    assert page.evaluate("document.activeElement.id") == "sheet-button"
    small = page.evaluate(
        """[...document.querySelectorAll("button, a, select")].filter((e) => e.offsetParent
        && e.getBoundingClientRect().height < 36).map((e) => e.outerHTML)"""
    )
    assert small == []


def test_levels_without_a_lesson_are_exported_too_and_hostile_names_are_text(tmp_path):
    name = "a <img src=x onerror=alert(1)>.svg"
    room = '<svg xmlns="http://www.w3.org/2000/svg"><path d="M0 0H90V60H0Z" fill="none" stroke="red"/></svg>'
    (tmp_path / name).write_text(room)
    (tmp_path / "a.svg").write_text(room)
    result = play("--export-page", tmp_path / "out", tmp_path / name, tmp_path / "a.svg", "--curves", "lines")
    assert result.exit_code == 0, result.output
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == [
        "a-img-src-x-onerror-alert-1.html", "a.html", "index.html",
    ]  # fmt: skip
    index = (tmp_path / "out" / "index.html").read_text(encoding="utf-8")
    assert "<h1>Levels</h1>" in index
    assert "<img src=x" not in index


def test_names_of_pages_differ():
    names = ["a.svg", "A.toml", "index.svg", "ä.svg", "-", "a-2.svg"]
    assert page_names(names) == ["a.html", "a-2.html", "index-2.html", "page.html", "page-2.html", "a-2-2.html"]


def test_what_cannot_be_exported_is_told_with_its_file(tmp_path):
    bad = tmp_path / "bad.svg"
    bad.write_text("<svg")
    result = play("--export-page", tmp_path / "out", bad)
    assert result.exit_code != 0
    assert str(bad) in str(result.exception.file)
    assert not (tmp_path / "out").exists()
    inside = tmp_path / "inside.toml"
    inside.write_text(
        "[[walls]]\nvertices = [[0, 0], [0, 9], [9, 9], [9, 0]]\n[[balls]]\nposition = [1, 4]\nradius = 2\n"
    )
    assert str(inside) in str(play("--export-page", tmp_path / "out", inside).exception.file)
    taken = tmp_path / "taken"
    taken.write_text("")
    assert play("--export-page", taken).exception.code == "cannot-write"
    assert play(bad, bad).exception.code == "usage"
    assert np.size(list(tmp_path.glob("out/*"))) == 0
