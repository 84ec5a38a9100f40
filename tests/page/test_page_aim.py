"""Windows on the page: what the library finds is drawn around the ball, for targets of the level and clicked ones."""

import math

import pytest
from test_page_browser import on_screen

import wallkit
from wallkit.scene.opening import open_scene

pytestmark = pytest.mark.browser

LEVEL = """<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 400 300" width="400" height="300">
<path id="room" d="M0 0H400V300H0Z" fill="none" stroke="black"/>
<circle id="goal" data-target="hole" cx="300" cy="200" r="12"/>
<g id="balls" data-role="ball"><circle cx="80" cy="120" r="6"/></g></svg>"""


def test_the_windows_of_a_target_are_those_of_the_library(opened, server, until):
    page = opened(server.url)
    page.evaluate("text => Wallkit.page.open('level.svg', new Blob([text]))", LEVEL)
    until(page, "Wallkit.page.document && Wallkit.page.aim.ball")
    assert page.locator("#target option").all_inner_texts() == ["no target", "hole"]
    found = "Wallkit.page.windows.found && !Wallkit.page.windows.lane.busy"
    page.select_option("#target", label="hole")
    until(page, found)
    scene = open_scene(LEVEL.encode(), name="level.svg").scene
    own = wallkit.aim(scene, (80, 120), "hole", 2, 6.0)
    shown = page.evaluate("Wallkit.page.windows.found")
    assert shown["low"] == own.low.tolist()
    assert shown["high"] == own.high.tolist()
    words = page.locator("#windows-facts").inner_text()
    assert "13 windows" in words
    assert f"{math.degrees(own.widest.width):.3g}" in words
    assert "straight" in words
    page.fill("#target-bounces", "0")
    until(page, f"{found} && Wallkit.page.windows.found.count === 1")
    page.click("#pick-target")
    page.mouse.click(*on_screen(page, 200, 60))
    until(page, f"{found} && Wallkit.page.windows.target.clicked")
    assert page.locator("#target").input_value() == "clicked"
    assert page.evaluate("Wallkit.page.windows.target.x") == pytest.approx(200, abs=1)
    assert page.evaluate("Wallkit.page.aim.ball.x") == 80  # the click was for the target alone
