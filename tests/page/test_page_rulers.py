"""The ruler, the protractor and the point of the angular momentum: dragged, moved by keys, snapping to corners."""

import math

import pytest
from test_page_browser import ROOM, on_screen

pytestmark = pytest.mark.browser

TOOLS = "Wallkit.page.instruments.tools"


@pytest.fixture
def room(page, drop):
    drop(page, "room.svg", ROOM)
    return page


def handle(page, name):
    return page.get_by_role("button", name=name)


def places(page, tool):
    return page.evaluate(f"{TOOLS}.{tool}.places")


def drag(page, name, to, until):
    box = handle(page, name).bounding_box()
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    page.mouse.down()
    page.mouse.move(*on_screen(page, *to), steps=3)
    page.mouse.up()
    until(page, "!Wallkit.page.player.asked")


def test_the_ruler_snaps_to_corners_and_tells_their_distance(room, until):
    room.get_by_role("button", name="Ruler", exact=True).click()
    until(room, "!Wallkit.page.player.asked")
    drag(room, "Ruler, one end", (4, 3), until)
    drag(room, "Ruler, other end", (397, 298), until)
    one, other, _ = places(room, "ruler")
    assert [one["x"], one["y"], other["x"], other["y"]] == [0, 0, 400, 300]
    words = handle(room, "Ruler, one end").get_attribute("aria-label")
    assert "500.00 px" in words
    assert f"{math.degrees(math.atan2(300, 400)):.2f}" in words
    drag(room, "Ruler, the middle", (200, 120), until)
    assert room.evaluate(f"{TOOLS}.ruler.length") == pytest.approx(500, rel=1e-12)
    room.get_by_label("1 m is so many").fill("100")
    until(room, f"document.querySelector('.handle').ariaLabel.includes('5.000 m') || !{TOOLS}.ruler.on")
    room.get_by_role("button", name="Ruler", exact=True).click()
    until(room, "!Wallkit.page.player.asked")
    assert not handle(room, "Ruler, one end").is_visible()


def test_tools_are_used_by_keys_alone(room, until):
    room.get_by_role("button", name="Protractor", exact=True).focus()
    room.keyboard.press("Enter")
    until(room, "!Wallkit.page.player.asked")
    corner = handle(room, "Protractor, the corner")
    corner.focus()
    before = places(room, "protractor")
    room.keyboard.press("ArrowLeft")
    room.keyboard.press("Shift+ArrowUp")
    after = places(room, "protractor")
    pixel = 1 / room.evaluate("Wallkit.page.stage.scale")
    for old, new in zip(before, after, strict=True):  # the arms come along
        assert new["x"] == pytest.approx(old["x"] - pixel)
        assert new["y"] == pytest.approx(old["y"] - 10 * pixel)  # y points down in SVG
    assert room.evaluate(f"{TOOLS}.protractor.angle") == pytest.approx(60)
    room.evaluate(f"{TOOLS}.protractor.places = [{{x: 9, y: 290}}, {{x: 12, y: 20}}, {{x: 380, y: 280}}]")
    for name in ("Protractor, the corner", "Protractor, one arm", "Protractor, other arm"):
        handle(room, name).focus()
        room.keyboard.press("Enter")
    assert [(p["x"], p["y"]) for p in places(room, "protractor")] == [(0, 300), (0, 0), (400, 300)]
    assert room.evaluate(f"{TOOLS}.protractor.angle") == 90
    assert not room.evaluate("Wallkit.page.player.motion")  # Enter was for the handle: nothing was shot


def test_the_point_of_the_angular_momentum_can_be_moved(room, until):
    room.get_by_label("Graph of angular momentum").check()
    until(room, "!Wallkit.page.player.asked")
    name = "Point of the angular momentum"
    assert [(p["x"], p["y"]) for p in places(room, "pivot")] == [(200, 150)]
    drag(room, name, (2, 297), until)
    assert room.evaluate("Wallkit.page.player.about") == {"x": 0, "y": 300}
    room.get_by_label("Graph of angular momentum").uncheck()
    until(room, "!Wallkit.page.player.asked")
    assert not handle(room, name).is_visible()


def test_another_drawing_puts_the_tools_away(room, drop):
    room.get_by_role("button", name="Ruler", exact=True).click()
    drop(room, "again.svg", ROOM)
    assert room.get_by_role("button", name="Ruler", exact=True).get_attribute("aria-pressed") == "false"
    assert room.evaluate(f"{TOOLS}.ruler.on") is False


def test_the_scale_bar_is_as_long_as_it_says(room):
    """In metres and in the drawing's units: 1, 2 or 5 times a power of ten, and at most a sixth of the stage."""
    for metre, name in ((None, "px"), (100, "m")):
        text, pixels, scale, width = room.evaluate(
            """(metre) => { const {player, stage} = Wallkit.page; player.units.metre = metre; const said = [];
            const bar = []; const heard = {fillText: (text) => said.push(text), lineTo: (x) => bar.push(x)};
            heard.moveTo = heard.lineTo;
            const ctx = new Proxy({}, {get: (_, key) => heard[key] ?? (() => {}), set: () => true});
            Wallkit.scaleBar(ctx, stage, player.units, Wallkit.colours());
            return [said[0], Math.max(...bar) - Math.min(...bar), stage.scale, stage.width]; }""",
            metre,
        )
        number, unit = text.split()
        assert unit == name
        assert number.strip("0.")[0] in "125"
        assert pixels == pytest.approx(float(number) * (metre or 1) * scale)
        assert width / 16 < pixels <= width / 6
