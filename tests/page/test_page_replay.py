import math
import re
from dataclasses import replace

import numpy as np
import pytest

from wallkit import Balls, ContactKind, Material, Scene, Walls, simulate
from wallkit.view.replay import replay_html, thinned

ROOM = [(0, 0), (400, 0), (400, 300), (0, 300)]
HOSTILE = "</script><img src=x onerror=\"document.title='owned'\"><!--"


def scene(balls=1, gravity=None, y_axis="up", names=("room", "pillar"), restitution=1.0):
    angle = np.linspace(0, 2 * math.pi, 12, endpoint=False)
    pillar = np.stack([200 + 40 * np.cos(angle), 150 + 40 * np.sin(angle)], axis=1)
    walls = Walls.from_polylines([ROOM, pillar], names=list(names), material=Material(restitution, 1.0))
    walls.y_axis = y_axis
    way = 0.6 + np.linspace(0, 0.3, balls)
    velocity = 170 * np.stack([np.cos(way), np.sin(way)], axis=1)
    return Scene(walls, Balls(np.tile((60.0, 70.0), (balls, 1)), velocity, 6.0), gravity)


@pytest.fixture
def shown(opened, tmp_path):
    def show(run, **options):
        file = tmp_path / "replay.html"
        file.write_text(replay_html(run, **options), encoding="utf-8")
        return opened(file.as_uri())

    return show


def drawn_at(page, ball, time):
    """Where the page puts a ball at a time, in pixels of its stage."""
    return page.evaluate(
        """([ball, time]) => { const {stage, player} = Wallkit.replay; const s = player.motion.state(ball, time);
        return [stage.screenX(s.x), stage.screenY(s.y)]; }""",
        [ball, time],
    )


def expected_at(page, place):
    """The same from the documented view alone: scale, middle and direction of y."""
    view = page.evaluate(
        "(({x, y, scale, width, height, up}) => ({x, y, scale, width, height, up}))(Wallkit.replay.stage)"
    )
    down = -1 if view["up"] else 1
    return [
        view["width"] / 2 + (place[0] - view["x"]) * view["scale"],
        view["height"] / 2 + down * (place[1] - view["y"]) * view["scale"],
    ]


def test_a_replay_is_one_file_without_any_address():
    html = replay_html(simulate(scene(), until=1.0))
    assert not re.search(r"(src|href)\s*=\s*[\"'](?!data:,)", html)
    assert "http" not in html.replace("http-equiv", "")


@pytest.mark.browser
@pytest.mark.parametrize("y_axis", ["up", "down"])
def test_balls_are_drawn_where_the_library_says(shown, y_axis):
    run = simulate(scene(balls=3, y_axis=y_axis), until=20.0)
    page = shown(run)
    for time in [0.0, 0.3, 7.77, *run.contacts["time"][[0, 5, -1]], 20.0]:
        for ball, place in enumerate(run.position(time)):
            assert drawn_at(page, ball, time) == pytest.approx(expected_at(page, place), abs=1e-6)


@pytest.mark.browser
@pytest.mark.parametrize("gravity", [(0.0, -60.0), (25.0, -50.0)])
def test_falling_sliding_and_resting_balls_are_drawn_where_the_library_says(shown, gravity):
    run = simulate(scene(balls=4, gravity=gravity, restitution=0.5), until=40.0)
    assert ContactKind.SLIDE in run.contacts["kind"]
    page = shown(run)
    for time in [*np.linspace(0.0, 40.0, 60), *run.contacts["time"][::7]]:
        for ball, place in enumerate(run.position(time)):
            assert drawn_at(page, ball, float(time)) == pytest.approx(expected_at(page, place), abs=1e-6)


@pytest.mark.browser
@pytest.mark.parametrize("slows", [{"rolling_friction": 9.0}, {"drag": 0.2}])
def test_slowed_balls_are_drawn_where_the_library_says(shown, slows):
    run = simulate(replace(scene(balls=3), **slows), until=40.0)
    page = shown(run)
    for time in [*np.linspace(0.0, 40.0, 40), *run.contacts["time"][::5]]:
        for ball, place in enumerate(run.position(time)):
            assert drawn_at(page, ball, float(time)) == pytest.approx(expected_at(page, place), abs=1e-6)


@pytest.mark.browser
@pytest.mark.parametrize("slows", [{"rolling_friction": 9.0}, {"drag": 0.2}, {"rolling_friction": 3.0, "drag": 0.1}])
def test_falling_balls_that_are_slowed_are_drawn_where_the_library_says(shown, slows):
    bowl = Walls.from_polylines(
        [[(0, 0), (120, 0), (180, 60)], [(200, 200), (380, 200)]],
        closed=False,
        bulges=[[0.4, 0.3, 0.0], [0.5, 0.0]],
        material=Material(0.5, 1.0),
    )
    balls = Balls([(30, 60), (100, 80), (230, 240)], [(3, 0), (40, 0), (10, 5)], [4.0, 0.0, 8.0])
    run = simulate(Scene(bowl, balls, gravity=(0.0, -60.0), **slows), until=12.0)
    assert ContactKind.SLIDE in run.contacts["kind"]
    page = shown(run)
    for time in [*np.linspace(0.0, 12.0, 30), *run.contacts["time"][::5]]:
        for ball, place in enumerate(run.position(time)):
            assert drawn_at(page, ball, float(time)) == pytest.approx(expected_at(page, place), abs=1e-6)


@pytest.mark.browser
def test_sensors_are_drawn_and_change_no_flight(shown):
    gate = Walls.from_polylines([[(100, 0), (100, 300)]], closed=False, names=["gate"])
    run = simulate(replace(scene(), sensors=gate), until=20.0)
    assert ContactKind.EXIT in run.contacts["kind"]
    page = shown(run)
    assert page.evaluate("Wallkit.replay.player.picture.sensors.count") == 1
    for time in np.linspace(0.0, 20.0, 21):
        assert drawn_at(page, 0, time) == pytest.approx(expected_at(page, run.position(time)[0]), abs=1e-6)


@pytest.mark.browser
def test_the_pixels_of_a_ball_are_at_its_place(shown):
    run = simulate(scene(), until=20.0)
    page = shown(run)
    time = float(run.contacts["time"][4])
    page.evaluate(
        """(t) => { const p = Wallkit.replay.player; p.ghosts = p.trails = false; p.seek(t); p.draw(); }""",
        time + 0.05,
    )
    # The disc is drawn in paper with an outline, its arrow beyond it: the middle of the paper pixels is its centre.
    centre = page.evaluate(
        """() => { const {stage} = Wallkit.replay; const ctx = stage.front.getContext("2d");
        const {width, height} = stage.front; const {data} = ctx.getImageData(0, 0, width, height);
        let [n, x, y] = [0, 0, 0];
        for (let i = 0; i < width * height; i++)
          if (data[4 * i] > 240 && data[4 * i + 3] > 250) {
            n++; x += i % width + 0.5; y += Math.floor(i / width) + 0.5;
          }
        return [x / n / stage.ratio, y / n / stage.ratio]; }"""
    )
    assert centre == pytest.approx(expected_at(page, run.position(time + 0.05)[0]), abs=1.0)


@pytest.mark.browser
def test_every_control_of_the_replay(shown, until):
    run = simulate(scene(), until=20.0)
    times = run.contacts["time"].tolist()
    page = shown(run)
    clock = lambda: page.evaluate("Wallkit.replay.player.time")  # noqa: E731
    page.get_by_role("button", name="Step to the next bounce").click()
    assert clock() == times[0]
    page.keyboard.press(".")
    page.keyboard.press(".")
    assert clock() == times[2]
    page.keyboard.press(",")
    assert clock() == times[1]
    page.get_by_text(f"2 of {len(times)}").wait_for()  # the read-out follows in the next frame
    page.keyboard.press("r")
    assert clock() == 0
    page.get_by_label("Speed of playing").select_option("10")
    page.get_by_role("button", name="Play").click()
    until(page, "Wallkit.replay.player.time > 0.5")
    page.get_by_role("button", name="Pause").click()
    page.get_by_label("Time", exact=True).evaluate("(e) => { e.value = 0.5; e.dispatchEvent(new Event('input')); }")
    assert clock() == pytest.approx(10.0)
    for label, flag in (("Normals", "normals"), ("Ghosts", "ghosts"), ("Paths", "trails")):
        page.get_by_label(label).uncheck()
        assert page.evaluate(f"Wallkit.replay.player.{flag}") is False
    page.get_by_label("Ghosts").focus()
    page.keyboard.press(" ")  # is the box's own there
    assert page.get_by_label("Ghosts").is_checked()
    assert page.evaluate("Wallkit.replay.player.playing") is False
    before = page.evaluate("Wallkit.replay.stage.scale")
    page.get_by_role("button", name="Zoom in").click()
    assert page.evaluate("Wallkit.replay.stage.scale") == pytest.approx(1.5 * before)
    page.locator("canvas[data-layer=front]").focus()
    page.keyboard.press("0")
    assert page.evaluate("Wallkit.replay.stage.scale") == pytest.approx(before)


@pytest.mark.browser
def test_wheel_and_drag_keep_the_place_under_the_pointer(shown, until):
    page = shown(simulate(scene(), until=5.0))
    box = page.locator("#stage").bounding_box()
    x, y = 300 - box["x"] % 1, 200 - box["y"] % 1  # a pointer is at whole pixels of the window
    page.mouse.move(box["x"] + x, box["y"] + y)
    under = f"[Wallkit.replay.stage.drawingX({x}), Wallkit.replay.stage.drawingY({y})]"
    before = page.evaluate(under)
    page.mouse.wheel(0, -400)
    until(page, "!Wallkit.replay.stage.fitted")
    assert page.evaluate(under) == pytest.approx(before, rel=1e-9)
    page.mouse.down()
    page.mouse.move(box["x"] + x + 60, box["y"] + y + 35, steps=3)
    page.mouse.up()
    moved = page.evaluate(f"[Wallkit.replay.stage.drawingX({x + 60}), Wallkit.replay.stage.drawingY({y + 35})]")
    assert moved == pytest.approx(before, rel=1e-9)


@pytest.mark.browser
def test_a_hostile_name_is_inert(shown):
    run = simulate(scene(names=(HOSTILE, HOSTILE)), until=10.0)
    html = replay_html(run, title=HOSTILE)
    assert html.count("</script>") == 2
    page = shown(run, title=HOSTILE)
    page.keyboard.press(".")
    assert page.title() == HOSTILE
    assert page.locator("img").count() == 0
    assert HOSTILE in page.locator("[data-value=last]").inner_text()


def test_thinning_keeps_whole_balls_and_says_so():
    run = simulate(scene(balls=10), until=20.0)
    most = len(run.contacts) // 3
    small, words = thinned(run, most)
    assert 0 < len(small.contacts) <= most
    assert "of 10 balls" in words
    assert f"{len(run.contacts):,}" in words
    stride = math.ceil(10 / len(small.final))
    assert np.array_equal(small.position(9.0), run.position(9.0)[::stride])


def test_thinning_one_ball_ends_its_path_early_and_exactly():
    run = simulate(scene(), until=50.0)
    small, words = thinned(run, 7)
    assert len(small.contacts) == 7
    end = run.contacts["time"][6]
    assert np.allclose(small.position(50.0), run.position(end), rtol=0, atol=1e-12)
    assert "first 7 bounces" in words


@pytest.mark.browser
def test_a_million_contacts_open(shown):
    run = simulate(scene(), until=5.0)
    contacts = np.repeat(run.contacts[:1], 1_000_000)
    contacts["time"] = np.linspace(0.5, 4.9, len(contacts))
    run.contacts = contacts
    page = shown(run)
    assert page.evaluate("Wallkit.replay.player.motion.count") == 1_000_000
    # Places travel as Float32 from the box's middle then: 2^-24 of 400 units.
    expected = expected_at(page, (contacts["x"][0], contacts["y"][0]))
    assert drawn_at(page, 0, 0.5) == pytest.approx(expected, abs=1e-3)
