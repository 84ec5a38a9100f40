"""What the page finds doubtful: leaks as `wallkit check` lists them, and a ball that overlaps a wall."""

import json

import numpy as np
import pytest
from typer.testing import CliRunner

from wallkit import Balls, Scene, open_scene, simulate
from wallkit.cli.app import _register_commands, app

pytestmark = pytest.mark.browser

LEAKY = """<svg xmlns="http://www.w3.org/2000/svg" width="400" height="300">
<path id="wall" fill="none" stroke="black" d="M190 0H0V300H400V0H214"/>
<g id="balls" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" inkscape:groupmode="layer"
 inkscape:label="balls"><circle cx="80" cy="120" r="6"/><path d="M80 120L130 150"/></g></svg>"""
BOX = """<svg xmlns="http://www.w3.org/2000/svg" width="400" height="300"><path id="box" d="M0 0H400V300H0Z"/>
<g id="balls" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" inkscape:groupmode="layer"
 inkscape:label="balls"><circle cx="80" cy="120" r="6"/><path d="M80 120L130 150"/></g></svg>"""
CHECKED = "Wallkit.page.document && !Wallkit.page.checks.looking.busy"
FLYING = "Wallkit.page.player.motion && !Wallkit.page.flying.busy"


def test_the_page_lists_what_check_lists(page, drop, until, tmp_path):
    drop(page, "leaky.svg", LEAKY)
    until(page, CHECKED)
    file = tmp_path / "leaky.svg"
    file.write_text(LEAKY)
    _register_commands()
    result = CliRunner().invoke(app, ["check", str(file), "--json"])
    assert result.exit_code == 1
    said = json.loads(result.stdout)["problems"]
    assert "leak" in [problem["code"] for problem in said]
    listed = page.evaluate("Wallkit.page.document.problems")
    assert [{key: one[key] for key in problem} for one, problem in zip(listed, said, strict=True)] == said
    assert page.locator("#problems button").count() == len(said) == int(page.locator("#problem-count").inner_text())


def test_a_leak_is_gone_to_by_keyboard_alone(page, drop, until):
    drop(page, "leaky.svg", LEAKY)
    until(page, CHECKED)
    page.locator("#problems button", has_text="out through a gap 24 wide").focus()
    page.keyboard.press("Enter")
    until(page, "Wallkit.page.stage.dirty === false")
    assert page.evaluate("[Wallkit.page.stage.x, Wallkit.page.stage.y]") == pytest.approx([202, 0])


@pytest.mark.parametrize("window", [{"width": 1366, "height": 768}, {"width": 390, "height": 844}])
@pytest.mark.parametrize("shoots", [False, True])
def test_a_ball_in_a_wall_is_settled_when_asked(opened, server, drop, until, accessible, window, shoots):
    page = opened(server.url, expected=["422"], viewport=window)
    drop(page, "box.svg", BOX)
    page.evaluate("(() => { const {aim} = Wallkit.page; aim.ball.x = 3; Wallkit.page.aimed(); })()")
    until(page, "!document.getElementById('settle').hidden")
    if shoots:
        page.keyboard.press("s")
        until(page, "!Wallkit.page.flying.busy && !document.getElementById('settle').hidden")
    assert "overlaps" in page.locator("#toast").inner_text()
    accessible(page)
    page.get_by_role("button", name="nearest free spot").focus()
    page.keyboard.press("Enter")
    until(
        page, "document.getElementById('settle').hidden && Wallkit.page.aim.foretold && !Wallkit.page.foretelling.busy"
    )
    scene = open_scene(BOX.encode(), name="box.svg").scene
    mine = simulate(Scene(scene.walls, Balls([(3, 120)], [(50, 30)], 6)), bounces=1, settle=True)
    ball = page.evaluate("Wallkit.page.aim.ball")
    assert np.array_equal([ball["x"], ball["y"]], mine.scene.balls.position[0])
    assert page.locator("#toast").is_hidden()
    page.keyboard.press("s")
    until(page, FLYING)


def test_nothing_is_offered_where_settling_would_not_help(opened, server, drop, until):
    page = opened(server.url, expected=["422"])
    drop(page, "box.svg", BOX)
    page.evaluate("(() => { Wallkit.page.aim.ball.radius = -1; Wallkit.page.foretell(); })()")
    until(page, "!Wallkit.page.foretelling.busy && !document.getElementById('toast').hidden")
    assert page.locator("#settle").is_hidden()
