"""What measures on the page and in the replay, for everybody: axe-core, small windows, the replay."""

import math

import pytest
from test_page_browser import FLYING, ROOM

from wallkit import Balls, Scene, Walls, simulate
from wallkit.view.replay import replay_html

pytestmark = pytest.mark.browser

WINDOWS = {"desktop": {"width": 1366, "height": 768}, "phone": {"width": 390, "height": 844}}
GRAPHS = ("height", "speed", "energy", "angular momentum")


def sheet(page):
    """Open the sheet of a small window, or shut it."""
    if page.locator("#sheet-button").is_visible():
        page.locator("#sheet-button").click()


def all_on(page, until, where):
    for name in GRAPHS:
        page.get_by_label(f"Graph of {name}", exact=True).check()
    page.get_by_label("Strobe", exact=True).check()
    sheet(page)
    for tool in ("Ruler", "Protractor"):
        page.get_by_role("button", name=tool, exact=True).click()
    page.keyboard.press(".")
    until(page, f"{where}.instruments.graphs.drawn && !{where}.instruments.graphs.job && !{where}.player.asked")


@pytest.mark.parametrize("window", list(WINDOWS))
def test_everybody_can_use_the_page_with_all_that_measures(opened, server, drop, until, accessible, window):
    page = opened(server.url, viewport=WINDOWS[window])
    drop(page, "room.svg", ROOM)
    sheet(page)
    page.get_by_role("button", name="Add a ball").click()
    page.get_by_label("1 m is so many").fill("100")
    page.get_by_label("Gravity in units").fill("9.81")
    page.locator("#shoot").click()
    until(page, FLYING)
    page.keyboard.press("k")
    all_on(page, until, "Wallkit.page")
    assert page.evaluate("document.documentElement.scrollWidth") <= WINDOWS[window]["width"]
    stage, graphs = (page.locator(part).bounding_box() for part in ("#stage", "#graphs"))
    assert stage["height"] > 180
    assert graphs["y"] == pytest.approx(stage["y"] + stage["height"], abs=1)
    accessible(page)


@pytest.mark.parametrize("window", list(WINDOWS))
def test_the_replay_measures_too(opened, until, accessible, tmp_path, window):
    walls = Walls.from_polylines([[(0, 0), (0, 300), (400, 300), (400, 0)]], names=["room"])
    way = math.radians(-30.0)
    balls = Balls([80.0, 180.0], [50 * math.cos(way), 50 * math.sin(way)], 6.0)
    (tmp_path / "replay.html").write_text(replay_html(simulate(Scene(walls, balls), until=30.0)), encoding="utf-8")
    page = opened((tmp_path / "replay.html").as_uri(), viewport=WINDOWS[window])
    sheet(page)
    all_on(page, until, "Wallkit.replay")
    until(page, "document.querySelector('#bounce [data-value=along-after]').textContent === '43.301'")
    assert page.evaluate("document.documentElement.scrollWidth") <= WINDOWS[window]["width"]
    assert page.locator("#stage").bounding_box()["height"] > 180
    accessible(page)
