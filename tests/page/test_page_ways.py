"""Ways to be wrong on the page: the library's own frames over the exact run, one panel or two, by hand or by key."""

import base64
import json

import numpy as np
import pytest

import wallkit
from wallkit.cli.play import reader
from wallkit.scene.wishes import USUAL
from wallkit.view.page.answers import Answers, QuestionError
from wallkit.view.page.questions import Opening
from wallkit.view.page.ways import MOST_FRAMES

ROOM = """<svg xmlns="http://www.w3.org/2000/svg" width="400" height="300">
<path id="room" d="M0 0H400V300H0Z"/>
<g id="balls" data-role="ball"><circle cx="100" cy="100" r="10"/></g></svg>"""
BALL = {"x": 100, "y": 100, "vx": 30, "vy": 40, "radius": 10}
SIZES = [(1366, 768), (390, 844)]
FLOWN = "Wallkit.page.player.motion && !Wallkit.page.flying.busy && !Wallkit.page.player.motion.partial"


@pytest.fixture(scope="module")
def answers():
    return Answers(reader())


@pytest.fixture(scope="module")
def document(answers):
    return answers.open(Opening(ROOM.encode(), "room.svg", None, USUAL))


def column(packed):
    return np.frombuffer(base64.b64decode(packed["data"]), packed["type"])


def scene_of(document, restitution=1.0, gravity=None):
    walls = wallkit.Walls.from_polylines(
        [document.opened.scene.walls.vertices], sides=document.opened.scene.walls.sides,
        material=wallkit.Material(restitution), names=["room"],
    )  # fmt: skip
    return wallkit.Scene(walls, wallkit.Balls([(100, 100)], [(30, 40)], 10.0), gravity=gravity)


@pytest.mark.parametrize("way", ["stop", "full-step", "reflect-in-place", "overlap"])
def test_the_frames_are_those_of_the_library(answers, document, way):
    answer = answers.simulate({"balls": [BALL], "until": 20, "way": way, "dt": 0.7}, document)
    own = wallkit.step_through(scene_of(document), way, 0.7, 20.0)
    told = answer["stepped"]
    assert (told["way"], told["dt"], told["balls"]) == (way, 0.7, 1)
    assert np.array_equal(column(told["time"]), own.time)
    assert np.array_equal(column(told["place"]).reshape(-1, 2), own.state[:, 0, 0:2])
    (parting,) = own.partings(wallkit.simulate(scene_of(document), until=20))
    assert [(each["time"], each["place"], each["exact"]) for each in told["parted"]] == [
        (parting.time, parting.place, parting.exact)
    ]
    assert [(each["time"], each["lost"]) for each in told["through"]] == [
        (through.time, through.lost) for through in own.flown_through()
    ]
    assert told["sentence"].startswith(f"{way} in frames of 0.7 s: parts from the exact path at {parting.time:g} s")


def test_the_exact_way_has_no_frames(answers, document):
    assert "stepped" not in answers.simulate({"balls": [BALL], "until": 5, "way": "exact", "dt": 1}, document)


def test_the_second_panel_has_its_own_world_and_all_else_of_the_first(answers, document):
    other = {"way": "stop", "dt": 0.5, "restitution": 0.5, "gravity": [0, 30.0]}
    body = {"balls": [BALL], "until": 12, "restitution": 1.0, "gravity": None, "way": "overlap", "dt": 2.0}
    answer = answers.simulate({**body, "other": other}, document)
    for part, scene, way, dt in (
        (answer, scene_of(document), "overlap", 2.0),
        (answer["other"], scene_of(document, 0.5, (0.0, 30.0)), "stop", 0.5),
    ):
        run = wallkit.simulate(scene, until=12)
        assert column(part["contacts"]["time"]).tolist() == run.contacts["time"].tolist()
        own = wallkit.step_through(scene, way, dt, 12)
        assert np.array_equal(column(part["stepped"]["place"]).reshape(-1, 2), own.state[:, 0, 0:2])


def test_an_empty_second_panel_is_the_exact_world_of_the_first(answers, document):
    answer = answers.simulate(
        {"balls": [BALL], "until": 12, "restitution": 0.5, "way": "stop", "dt": 1, "other": {}}, document
    )
    assert "stepped" not in answer["other"]
    assert answer["other"]["contacts"] == answer["contacts"]
    # against its own exact run: as the first panel's frames part, at 5 s
    assert answer["apart"] == answer["stepped"]["parted"][0]["time"] == 5.0


@pytest.mark.parametrize(
    ("other", "apart"),
    [
        ({}, None),
        # the lower wall is met after 4.75 s; 1 % of 400 is 4, and speeds along the normal then differ by 20 a second
        ({"restitution": 0.5}, 4.95),
        # g t^2 / 2 = 4
        ({"gravity": [0, 2.0]}, 2.0),
    ],
)
def test_two_exact_panels_part_where_arithmetic_says(answers, document, other, apart):
    answer = answers.simulate({"balls": [BALL], "until": 12, "other": other}, document)
    assert answer["apart"] == (apart if apart is None else pytest.approx(apart, abs=12 / 1000))


def test_of_a_long_run_the_first_frames_are_shown(answers, document):
    answer = answers.simulate({"balls": [BALL], "until": 1000, "way": "stop", "dt": 0.001}, document)
    assert MOST_FRAMES - 2 <= len(column(answer["stepped"]["time"])) <= MOST_FRAMES + 1


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"way": "jump", "dt": 1}, "way is jump"),
        ({"way": ["stop"], "dt": 1}, "way is"),
        ({"way": "stop"}, "dt is"),
        ({"way": "stop", "dt": 0}, "dt is"),
        ({"way": "stop", "dt": "1"}, "dt is"),
        ({"way": "stop", "dt": 1e-9}, "dt is"),
        ({"other": [1]}, "other is"),
        ({"other": {"way": "jump"}}, "way is"),
        ({"other": {"restitution": -1}}, "restitution is"),
    ],
)
def test_what_is_no_way_is_refused(answers, document, wrong, words):
    with pytest.raises(QuestionError, match=words):
        answers.simulate({"balls": [BALL], "until": 5, **wrong}, document)


def tab_to(page, name):
    """Press Tab until a control has the focus, as who has no mouse does."""
    for _ in range(120):
        if page.evaluate("document.activeElement.id") == name:
            return
        page.keyboard.press("Tab")
    raise AssertionError(f"Tab never comes to {name}")


@pytest.fixture
def room(opened, server, drop):
    def made(size, **options):
        page = opened(server.url, viewport={"width": size[0], "height": size[1]}, **options)
        drop(page, "room.svg", ROOM)
        page.evaluate("Object.assign(Wallkit.page.aim.ball, {vx: 30, vy: 40}); Wallkit.page.aimed()")
        if size[0] <= 860:  # on a phone the controls are a sheet
            tab_to(page, "sheet-button")
            page.keyboard.press("Enter")
        return page

    return made


def pixel(page, canvas, x, y):
    """The colour of a place of the drawing on a panel's front canvas: [r, g, b, a]."""
    return page.evaluate(
        """([id, x, y]) => { const stage = id === "stage" ? Wallkit.page.stage : Wallkit.page.panels.mirror.stage;
        const r = stage.ratio; return [...stage.front.getContext("2d").getImageData(
          Math.round(stage.screenX(x) * r), Math.round(stage.screenY(y) * r), 1, 1).data]; }""",
        [canvas, x, y],
    )


def hue(page, name):
    return [*bytes.fromhex(page.evaluate(f"Wallkit.colours()[{json.dumps(name)}]")[1:]), 255]


def drawn(page, until):
    page.evaluate("globalThis.seen = false; requestAnimationFrame(() => requestAnimationFrame(() => (seen = true)))")
    until(page, "globalThis.seen")


@pytest.mark.browser
@pytest.mark.parametrize("size", SIZES)
def test_a_way_chosen_by_keys_alone_is_shown_over_the_exact_run(room, until, size):
    page = room(size)
    tab_to(page, "way")
    page.keyboard.press("ArrowDown")  # stop
    tab_to(page, "dt")
    page.keyboard.press("Control+A")
    page.keyboard.type("1")
    page.keyboard.press("Tab")
    page.keyboard.press("s")
    until(page, FLOWN)
    page.keyboard.press("k")
    page.evaluate("Wallkit.page.player.pause(); Wallkit.page.player.seek(5.5)")
    drawn(page, until)
    words = page.locator("#way-facts").inner_text()
    assert "stop in frames of 1 s: parts from the exact path at 5 s at (242.5, 290), 12.5" in words
    # the frame of 5 s stands at (242.5, 290); the exact ball has gone on to (265, 260)
    assert pixel(page, "stage", 242.5 - 4, 290 - 4) == hue(page, "normal")
    ring = page.evaluate("(Wallkit.page.player.shownRadius(0) + 6) / Wallkit.page.stage.scale")
    *colour, cover = pixel(page, "stage", 242.5 - ring, 290)
    assert cover > 100  # a thin line, smoothed, whose colours are rounded by what it covers
    assert colour == pytest.approx(hue(page, "error")[:3], abs=3)
    tab_to(page, "way")
    page.keyboard.press("ArrowUp")  # exact again
    until(page, FLOWN + " && !Wallkit.page.ways.frames")
    assert page.locator("#dt").is_disabled()


@pytest.mark.browser
@pytest.mark.parametrize("size", SIZES)
def test_two_panels_have_two_worlds_one_clock_and_one_view(room, until, size):
    page = room(size)
    page.click("#shoot")
    until(page, FLOWN)
    page.click("#two-panels")
    page.select_option("#way-b", "overlap")
    page.fill("#dt-b", "2")
    page.fill("#restitution-b", "0.5")
    page.fill("#gravity-b", "30")
    until(page, FLOWN + " && Wallkit.page.panels.frames && Wallkit.page.panels.mirror.motion.gravity")
    assert page.evaluate("Wallkit.page.panels.mirror.motion.gravity") == [0, 30]
    assert page.evaluate("Wallkit.page.player.motion.gravity") is None
    assert page.locator("#caption-a").inner_text() == "exact"
    assert page.locator("#caption-b").inner_text() == "overlap, dt 2 s, restitution 0.5, gravity 30"
    assert "The panels part at" in page.locator("#other-facts").inner_text()
    page.evaluate("Wallkit.page.player.pause(); Wallkit.page.player.seek(2.5)")
    page.evaluate("Wallkit.page.stage.zoom(1.3)")
    drawn(page, until)
    assert page.evaluate("Wallkit.page.panels.mirror.time") == 2.5
    assert page.evaluate("Wallkit.page.panels.mirror.stage.scale === Wallkit.page.stage.scale")
    assert pixel(page, "stage-b", 160, 240) == hue(page, "normal")  # its frame of 2 s: 100 + 40 t + 30 t^2 / 2 down
    a, b = (page.locator(name).bounding_box() for name in ("#stage", "#stage-b"))
    assert (a["width"], a["height"]) == pytest.approx((b["width"], b["height"]), abs=1)
    assert b["x"] >= a["x"] + a["width"] - 1 or b["y"] >= a["y"] + a["height"] - 1
    page.click("#two-panels")
    assert not page.locator("#stage-b").is_visible()
    assert not page.locator("#other").is_visible()


@pytest.mark.browser
@pytest.mark.parametrize("size", SIZES)
def test_nothing_is_closed_to_anybody(room, until, accessible, size):
    page = room(size)
    page.select_option("#way", "overlap")
    page.click("#shoot")
    until(page, FLOWN + " && Wallkit.page.ways.frames")
    page.click("#two-panels")
    until(page, FLOWN + " && Wallkit.page.panels.mirror.motion")
    page.evaluate("Wallkit.page.player.pause()")
    accessible(page)
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")


@pytest.mark.browser
def test_a_way_that_balls_who_meet_do_not_know_is_refused_in_words(opened, server, until):
    page = opened(server.url, expected=["422"])
    page.evaluate("Wallkit.page.asked('api/sample', {name: 'cradle.toml'})")
    until(page, "Wallkit.page.document")
    page.select_option("#way", "stop")
    page.click("#shoot")
    until(page, "!document.getElementById('message').hidden")
    assert "only 'exact' knows other balls" in page.locator("#message").inner_text()
