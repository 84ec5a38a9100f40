"""Several balls on the page, placed, dragged and named; what acts on them; metres; all as the library flies them."""

import json

import numpy as np
import pytest
from test_page_browser import FLYING, ROOM, on_screen, press_and_drag

from wallkit import Balls, Scene, open_scene, simulate

pytestmark = pytest.mark.browser

FORETOLD = "!Wallkit.page.foretelling.busy"


def walls():
    return open_scene(ROOM.encode(), name="room.svg").scene.walls


@pytest.fixture
def room(page, drop):
    drop(page, "room.svg", ROOM)
    page.evaluate("Wallkit.page.wantsMore = () => false")  # what has come is enough
    return page


def balls_of(page):
    return page.evaluate("Wallkit.page.aim.balls")


def same_run(page, scene, until_what):
    """See that the run on the page is the library's own."""
    page.locator("#shoot").click()
    until_what(page, FLYING)
    page.evaluate("Wallkit.page.player.pause()")
    run = simulate(scene, until=page.evaluate("Wallkit.page.player.motion.duration"))
    for time in np.linspace(0.0, float(run.final["time"].max()), 12).tolist():
        told = page.evaluate(
            """(t) => { const {motion} = Wallkit.page.player; return Array.from({length: motion.balls}, (_, b) =>
            { const {x, y} = Wallkit.stateAt(motion, b, t); return [x, y]; }); }""",
            time,
        )
        np.testing.assert_allclose(told, run.position(time), rtol=0, atol=1e-9)
    return run


def test_balls_are_added_named_dragged_and_removed_each_with_its_own_numbers(room, until):
    room.get_by_role("button", name="Add a ball").click()
    room.get_by_role("button", name="Add a ball").click()
    assert room.locator("#ball-count").inner_text() == "3"
    room.get_by_label("Name of ball 2").fill("Anna")
    assert room.evaluate("Wallkit.page.player.nameOf(1)") == "Anna"
    room.get_by_label("Choose Anna").check()
    for label, value in (("Speed", "80"), ("Angle", "200"), ("Radius", "9"), ("Place x", "140"), ("Place y", "60")):
        room.get_by_label(label, exact=label != "Angle").fill(value)
    first, second, third = balls_of(room)
    assert (first["x"], first["y"], first["vx"], first["vy"], first["radius"]) == (80, 120, 50, 30, 6)
    way = np.radians(200)
    assert [second[name] for name in ("x", "y", "vx", "vy", "radius")] == pytest.approx(
        [140, 60, 80 * np.cos(way), 80 * np.sin(way), 9], abs=1e-12
    )
    assert third["radius"] == 6
    room.keyboard.down("Shift")
    press_and_drag(room, (80, 120), (40, 200))
    room.mouse.up()
    room.keyboard.up("Shift")
    first = balls_of(room)[0]
    assert (first["x"], first["y"]) == pytest.approx((40, 200), abs=1.0)
    assert (first["vx"], first["vy"]) == (50, 30)  # the drag was of its place alone
    assert room.get_by_label("Choose ball 1").is_checked()
    room.get_by_label("Choose ball 3").check()
    x, y = third["x"], third["y"]
    press_and_drag(room, (x, y), (x + 40, y + 30))  # without Shift: aimed
    room.mouse.up()
    assert balls_of(room)[2]["vx"] == pytest.approx(40, abs=1.0)
    table = balls_of(room)
    flown = Balls([[b["x"], b["y"]] for b in table], [[b["vx"], b["vy"]] for b in table], [b["radius"] for b in table])
    same_run(room, Scene(walls(), flown), until)
    room.get_by_role("button", name="Remove Anna").click()
    assert [ball["radius"] for ball in balls_of(room)] == [6, 6]
    room.get_by_role("button", name="Remove ball 2").click()
    assert room.get_by_role("button", name="Remove ball 1").is_disabled()


def test_a_ball_is_added_to_a_free_spot_and_the_library_agrees(room, until):
    for _ in range(6):
        room.get_by_role("button", name="Add a ball").click()
    until(room, FORETOLD)
    table = balls_of(room)
    places, radius = np.array([[b["x"], b["y"]] for b in table]), np.array([b["radius"] for b in table])
    apart = np.hypot(*(places[:, None] - places[None]).transpose(2, 0, 1)) + 100 * np.eye(len(table))
    assert (apart > radius[:, None] + radius).all()
    simulate(Scene(walls(), Balls(places, np.ones_like(places), radius)), bounces=1)  # overlaps are refused


def test_balls_by_keys_alone(room):
    room.get_by_role("button", name="Add a ball").focus()
    room.keyboard.press("Enter")
    room.keyboard.press(" ")
    assert len(balls_of(room)) == 3
    room.get_by_label("Choose ball 3").focus()
    room.keyboard.press("ArrowUp")  # the radio group's own
    assert room.evaluate("Wallkit.page.aim.chosen") == 1
    assert room.evaluate("document.activeElement.getAttribute('aria-label')") == "Choose ball 2"
    room.keyboard.press("Tab")
    room.keyboard.type("Bo")
    room.keyboard.press("Tab")
    room.keyboard.press("Enter")
    assert [ball.get("name") for ball in balls_of(room)] == [None, None]


def test_saved_scenes_have_the_balls_of_the_page(room, tmp_path):
    room.get_by_role("button", name="Add a ball").click()
    with room.expect_download() as download:
        room.get_by_role("button", name="Scene", exact=True).click()
    download.value.save_as(tmp_path / "room.json")
    saved = json.loads((tmp_path / "room.json").read_text())["balls"]
    assert [ball["position"] for ball in saved] == [[ball["x"], ball["y"]] for ball in balls_of(room)]


@pytest.mark.parametrize(("label", "acts"), [("Friction", {"rolling_friction": 7.0}), ("Drag", {"drag": 0.25})])
def test_friction_and_drag_act_as_in_the_library(room, until, label, acts):
    room.get_by_label(label).fill(str(*acts.values()))
    same_run(room, Scene(walls(), Balls([80.0, 120.0], [50.0, 30.0], 6.0), **acts), until)


def test_friction_with_gravity_acts_as_in_the_library(opened, server, drop, until):
    page = opened(server.url)
    drop(page, "room.svg", ROOM)
    page.evaluate("Wallkit.page.wantsMore = () => false")
    page.get_by_label("Friction").fill("7")
    page.get_by_label("Gravity in units").fill("40")
    scene = Scene(walls(), Balls([80.0, 120.0], [50.0, 30.0], 6.0), (0.0, 40.0), 7.0)
    same_run(page, scene, until)


def test_metres_change_what_is_told_and_not_what_is(room, until):
    room.keyboard.press("s")
    until(room, FLYING)
    room.keyboard.press("k")
    before = room.evaluate("[...Wallkit.page.player.motion.x]")
    room.get_by_label("1 m is so many").fill("100")
    assert room.get_by_label("Speed", exact=True).input_value() == f"{np.hypot(50, 30) / 100:.6g}"
    assert room.get_by_label("Radius").input_value() == "0.06"
    assert room.evaluate("document.querySelector('label[for=gravity]').dataset.unit") == "m/s²"
    until(room, "document.querySelector('[data-value=speed]').textContent.endsWith(' m/s')")
    assert room.locator("[data-value=speed]").inner_text() == "0.583 m/s"
    assert room.evaluate("[...Wallkit.page.player.motion.x]") == before
    room.get_by_label("Gravity in units").fill("9.81")
    assert room.evaluate("Wallkit.page.controls.world().gravity") == [0, pytest.approx(981)]
    room.get_by_label("1 m is so many").fill("")
    assert room.get_by_label("Gravity in units").input_value() == "981"
    assert room.evaluate("Wallkit.page.controls.world().gravity") == [0, pytest.approx(981)]


def test_numbers_of_the_file_keep_their_bits_until_they_are_changed(page, drop):
    gravity = [1 / 3, -80.123456789]
    scene = {
        "walls": [{"vertices": [[0, 0], [0, 300], [400, 300], [400, 0]]}],
        "gravity": gravity,
        "balls": [{"position": [100 / 3, 50], "velocity": [7 / 3, 1], "radius": 5 / 3}],
    }
    drop(page, "scene.json", json.dumps(scene))
    assert page.evaluate("Wallkit.page.controls.world().gravity") == gravity
    page.get_by_label("Angle").fill("90")
    ball = balls_of(page)[0]
    assert (ball["x"], ball["radius"]) == (100 / 3, 5 / 3)
    assert ball["vy"] == pytest.approx(np.hypot(7 / 3, 1), rel=1e-15)


def test_a_drawing_in_metres_is_told_in_metres(opened, server, drop):
    page = opened(server.url)
    scene = {"walls": [{"vertices": [[0, 0], [0, 3], [4, 3], [4, 0]]}], "balls": [{"position": [1, 1]}]}
    drop(page, "scene.json", json.dumps(scene))
    assert page.get_by_label("1 m is so many").is_visible()
    assert page.evaluate("Wallkit.page.player.units.name") == "units"
    page.evaluate("Wallkit.page.document.walls.units = 'm'; Wallkit.page.show(Wallkit.page.document)")
    assert page.evaluate("Wallkit.page.player.units.name") == "m"
    assert not page.get_by_label("1 m is so many").is_visible()


def test_a_ball_chosen_on_the_drawing_is_the_one_of_the_list_and_of_the_graphs(room, until):
    room.get_by_role("button", name="Add a ball").click()
    room.mouse.click(*on_screen(room, 80, 120))
    assert room.get_by_label("Choose ball 1").is_checked()
    room.keyboard.press("s")
    until(room, FLYING)
    room.keyboard.press("k")
    room.get_by_label("Graph of speed").check()
    until(room, "document.querySelector('#graphs .row span').textContent.startsWith('Speed of ball 1')")
