"""Lessons on the page: in the gallery, beside the drawing, in what is saved, and on a phone."""

import json
import re

import pytest

from wallkit import open_scene, replay_html, simulate
from wallkit.scene.samples import lessons
from wallkit.view.theme import colour

pytestmark = pytest.mark.browser

LESSONS = lessons()
PHONE = {"viewport": {"width": 390, "height": 844}, "has_touch": True, "is_mobile": True}
BUMPERS = """<svg xmlns="http://www.w3.org/2000/svg" width="400" height="300"><path id="room" d="M0 0H400V300H0Z"/>
<circle id="dull" data-restitution="0.5" cx="250" cy="150" r="40"/></svg>"""


def rgb(colour):
    return "rgb({}, {}, {})".format(*bytes.fromhex(colour.removeprefix("#")))


def shown(page, until, title):
    page.locator("#lesson-list button").filter(has=page.locator(".name", has_text=title)).click()
    until(page, f"Wallkit.page.document && Wallkit.page.document.lesson?.title === {json.dumps(title)}")


@pytest.mark.parametrize(
    "window", [{"width": 1366, "height": 768}, {"width": 390, "height": 844}], ids=["desk", "phone"]
)
def test_the_gallery_shows_the_lessons_and_nothing_about_it_is_inaccessible(opened, server, until, accessible, window):
    page = opened(server.url, viewport=window)
    assert page.locator("#lesson-list .name").all_inner_texts() == [lesson.title for lesson in LESSONS]
    drawn = "[...document.querySelectorAll('#lesson-list img')].slice(0, 4)"  # others load when they come into sight
    until(page, f"{drawn}.every((image) => image.complete && image.naturalWidth > 1)")
    accessible(page)
    shown(page, until, LESSONS[1].title)
    accessible(page)
    if window["width"] < 500:
        page.locator("#sheet-button").click()
        accessible(page)


def test_a_lesson_stands_beside_its_drawing_and_goes_with_the_next_file(opened, server, drop, until):
    page = opened(server.url)
    for lesson in LESSONS:
        shown(page, until, lesson.title)
        told = open_scene(lesson.path).lesson
        assert page.locator("#lesson-title").inner_text() == told.title
        assert page.locator("#lesson-text p").count() == len(re.split(r"\n\s*\n", told.text))
        assert page.locator("#lesson summary").all_inner_texts() == [question for question, _ in told.questions]
        assert page.locator("#lesson details p").first.is_hidden()
        page.locator("#lesson summary").first.focus()
        page.keyboard.press("Enter")
        assert page.locator("#lesson details p").first.inner_text() == told.questions[0][1]
        page.get_by_role("button", name="Samples").click()
    drop(page, "bumpers.svg", BUMPERS)
    assert page.locator("#lesson").is_hidden()
    assert page.locator("#legend li").all_inner_texts() == [
        "restitution 1, tangential 1", "restitution 0.5, tangential 1",
    ]  # fmt: skip


def test_a_lesson_is_saved_with_its_scene_and_its_replay(opened, server, until, tmp_path):
    page = opened(server.url)
    shown(page, until, "The mirror law")
    told = open_scene(LESSONS[0].path).lesson
    page.keyboard.press("s")
    until(page, "Wallkit.page.player.motion && !Wallkit.page.flying.busy")
    for what, name in (("Scene", "mirror-law.scene.json"), ("Replay", "mirror-law.html")):
        with page.expect_download() as download:
            page.get_by_role("button", name=what, exact=True).click()
        download.value.save_as(tmp_path / name)
    assert open_scene(tmp_path / "mirror-law.scene.json").lesson == told
    replay = opened((tmp_path / "mirror-law.html").as_uri())
    assert replay.locator("#lesson-text p").first.is_visible()
    assert replay.locator("#legend").is_hidden()  # one plain material says nothing


def test_a_replay_has_the_legend_of_materials_in_both_themes(opened, tmp_path):
    scene = open_scene(LESSONS[1].path).scene
    (tmp_path / "run.html").write_text(replay_html(simulate(scene, until=3.0)), encoding="utf-8")
    replay = opened((tmp_path / "run.html").as_uri())
    assert [words.split(",")[0] for words in replay.locator("#legend li").all_inner_texts()] == [
        f"restitution {material.restitution:g}" for material in scene.walls.materials
    ]
    painted = "[...document.querySelectorAll('.swatch')].map((e) => getComputedStyle(e).backgroundColor)"
    for theme in ("light", "dark"):
        shades = [rgb(colour(f"material{index}", theme)) for index in range(3)]
        assert replay.evaluate(painted) == shades
        replay.get_by_role("button", name="Light or dark").click()


def test_a_phone_is_filled_by_the_drawing_and_the_controls_are_a_sheet(opened, server, until):
    page = opened(server.url, **PHONE)
    shown(page, until, "The mirror law")
    tall = "document.getElementById('stage').getBoundingClientRect()"
    assert page.evaluate(f"{tall}.width") == 390
    assert page.evaluate(f"{tall}.height") > 0.7 * 844
    assert page.evaluate("[document.documentElement.scrollWidth, document.documentElement.scrollHeight]") == [390, 844]
    assert page.locator("#panel").is_hidden()
    page.locator("#shoot").tap()  # at hand without the sheet
    until(page, "Wallkit.page.player.motion && !Wallkit.page.flying.busy")
    page.locator("#sheet-button").tap()
    until(page, f"{tall}.height < 0.5 * 844")
    assert page.evaluate(f"{tall}.height") > 200
    page.locator("#restitution").evaluate("(e) => { e.value = 0.5; e.dispatchEvent(new Event('input')); }")
    until(page, "Wallkit.page.controls.world().restitution === 0.5 && !Wallkit.page.flying.busy")
    page.locator("#speed").focus()
    page.keyboard.press("Escape")
    assert page.locator("#panel").is_hidden()
    page.set_viewport_size({"width": 844, "height": 390})  # the phone lies on its side
    until(page, f"{tall}.width === 844 && {tall}.height > 200")
    page.set_viewport_size({"width": 1366, "height": 768})  # on a large screen all is where it was
    until(page, "document.getElementById('shots').closest('#panel') !== null")
    assert page.locator("#panel").is_visible()
    assert page.locator("#sheet-button").is_hidden()
    assert page.evaluate("document.getElementById('panel').firstElementChild.id") == "shots"
