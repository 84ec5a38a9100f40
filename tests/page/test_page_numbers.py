"""Numbers where one looks: the parts of a bounce, graphs over time, strobe ghosts; all as in the library's own run."""

import json

import numpy as np
import pytest
from test_page_browser import FLYING

from wallkit import Balls, ContactKind, Material, Scene, Walls, simulate
from wallkit.scene.scene_files import scene_to_json
from wallkit.simulation.energy import lowest
from wallkit.simulation.gliding import guides

pytestmark = pytest.mark.browser

ROOM = [(0, 0), (0, 300), (400, 300), (400, 0)]
MINUS = "\N{MINUS SIGN}"
GRAPHS = ("height", "speed", "energy", "spin")
LABELS = {"spin": "Graph of angular momentum"}
GRAPH = "Wallkit.page.instruments.graphs"
DRAWN = (  # what is wanted, at the size that the graphs have by now
    f"{GRAPH}.drawn?.key === {GRAPH}.wanted() && !{GRAPH}.job"
    f" && {GRAPH}.size.height === {GRAPH}.host.getBoundingClientRect().height"
)


def room(balls, **acts):
    walls = Walls.from_polylines([ROOM], names=["room"], material=acts.pop("material", Material()))
    return Scene(walls, balls, **acts)


def bowl():
    """A disc slides on a shelf, pivots about its end, falls, and glides in a bowl: nothing bounces back there."""
    dead = Material(0.0, 1.0)
    walls = Walls.from_polylines([[(0, 0), (0, 140), (120, 140), (120, 150), (0, 150), (0, 300), (400, 300), (400, 0)]],
                                 bulges=[[0.0] * 7 + [-0.3]], names=["bowl"], material=dead)  # fmt: skip
    return Scene(walls, Balls([60.0, 157.0], [20.0, 0.0], 7.0), (0.0, -150.0))


def many(balls):
    angle = np.linspace(0.2, 2.8, balls)
    velocity = 90.0 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return room(Balls(np.tile((200.0, 150.0), (balls, 1)), velocity, 6.0), gravity=(0.0, -80.0))


@pytest.fixture
def flown(opened, server, drop, until):
    """Open a scene, shoot, stop the clock; give the page and the library's own run to the same end."""

    def fly(scene, **options):
        page = opened(server.url, **options)
        drop(page, "scene.json", json.dumps(scene_to_json(scene)))
        page.evaluate("Wallkit.page.wantsMore = () => false")  # what has come is enough
        page.keyboard.press("s")
        until(page, FLYING)
        page.keyboard.press("k")
        return page, simulate(scene, until=page.evaluate("Wallkit.page.player.motion.duration"))

    return fly


def show(page, until, names=GRAPHS):
    for name in names:
        page.get_by_label(LABELS.get(name, f"Graph of {name}"), exact=True).check()
    until(page, DRAWN)


def cells(page, *names):
    return [page.locator(f"#bounce [data-value={name}]").inner_text() for name in names]


def test_50_at_30_degrees_is_25_across_and_43_3_along_the_wall(flown, until):
    way = np.radians(-30.0)
    page, run = flown(room(Balls([80.0, 180.0], [50 * np.cos(way), 50 * np.sin(way)], 6.0)))
    page.keyboard.press("r")
    page.keyboard.press(".")
    until(page, "document.querySelector('#bounce [data-value=across-before]').textContent.endsWith('25.000')")
    assert cells(page, "across-before", "across-after") == [f"{MINUS}25.000", "25.000"]
    assert cells(page, "along-before", "along-after") == ["43.301", "43.301"]
    assert cells(page, "angle-before", "angle-after") == ["60.00°", "60.00°"]
    assert cells(page, "slope-before", "slope-after") == ["30.00°", "30.00°"]
    assert cells(page, "normal") == ["0.000, 1.000"]
    time = float(run.contacts["time"][0])
    assert cells(page, "when") == [f"{time:.4g} s"] or cells(page, "when")[0].startswith(f"{time:.3f}")
    whole, part = divmod(time * 60, 1)
    assert cells(page, "frame") == [f"{whole:.0f} + {part:.3f}"]


def test_parts_of_every_bounce_are_those_of_the_library(flown):
    scene = room(Balls([90.0, 120.0], [170.0, 110.0], 6.0), gravity=(30.0, -80.0), material=Material(0.8, 0.9))
    page, run = flown(scene)
    told = page.evaluate(
        """(() => { const {motion} = Wallkit.page.player;
        return Array.from({length: 20}, (_, i) => W(motion, i)); function W(m, i) {
        const {before, after, normal} = Wallkit.bounceParts(m, i); return {before, after, normal}; } })()"""
    )
    for contact, parts in zip(run.contacts[:20], told, strict=True):
        n = np.array([contact["nx"], contact["ny"]])
        w = np.array([-n[1], n[0]])
        early = np.nextafter(contact["time"], 0.0)  # an ulp of time earlier: off by that times the pull
        for which, v in (("before", run.velocity(early)[0]), ("after", np.array([contact["vx"], contact["vy"]]))):
            assert parts[which]["across"] == pytest.approx(v @ n, abs=1e-9)
            assert abs(parts[which]["along"]) == pytest.approx(abs(v @ w), abs=1e-9)
            assert parts[which]["speed"] == pytest.approx(np.hypot(*v), abs=1e-9)
        assert parts["after"]["across"] == pytest.approx(-0.8 * parts["before"]["across"], abs=1e-9)
        assert parts["after"]["along"] == pytest.approx(0.9 * parts["before"]["along"], abs=1e-9)


def expected(run, time, about):
    """What each graph shows of every ball at a time, by its definition."""
    (x, y), (vx, vy) = run.position(time).T, run.velocity(time).T
    gx, gy = run.scene.gravity
    height = (lowest(run) - gx * x - gy * y) / np.hypot(gx, gy)
    turn = (x - about[0]) * vy - (y - about[1]) * vx
    return {
        "height": height,
        "speed": np.hypot(vx, vy),
        "energy": (vx**2 + vy**2) / 2 + height * np.hypot(gx, gy),
        "spin": turn if run.scene.walls.y_axis == "up" else -turn,
    }


def test_graphs_of_parabolas_slides_glides_and_pivots_are_the_librarys_numbers(flown, until):
    page, run = flown(bowl())
    bends = guides(run.scene.walls, run.contacts)
    assert ContactKind.SLIDE in run.contacts["kind"]
    assert (np.abs(np.abs(bends) - 7.0) < 1e-9).any(), "no pivot about a corner"
    assert (np.abs(bends) > 8.0).any(), "no glide along an arc"
    show(page, until)
    about = page.evaluate("[Wallkit.page.player.about.x, Wallkit.page.player.about.y]")
    x0, y0, x1, y1 = page.evaluate("Wallkit.page.document.box")
    assert about == [(x0 + x1) / 2, (y0 + y1) / 2]
    end = page.evaluate("Wallkit.page.player.motion.duration")
    for time in [*np.linspace(0.0, end, 40).tolist(), *run.contacts["time"][::3].tolist()]:
        told = page.evaluate(
            "([names, t]) => names.map((name) => Wallkit.page.instruments.graphs.value(name, 0, t))", [GRAPHS, time]
        )
        mine = expected(run, time, about)
        scale = {"height": 1e3, "speed": 1e2, "energy": 1e5, "spin": 1e5}
        for name, value in zip(GRAPHS, told, strict=True):
            assert value == pytest.approx(mine[name][0], abs=1e-9 * scale[name]), (name, time)


def test_curves_are_drawn_where_the_numbers_are(flown, until):
    page, run = flown(bowl())
    show(page, until)
    about = page.evaluate("[Wallkit.page.player.about.x, Wallkit.page.player.about.y]")
    drawn = page.evaluate("Wallkit.page.instruments.graphs.drawn")
    for time in np.linspace(0.03, 0.97, 25) * drawn["span"]:
        for name, row in drawn["rows"].items():
            value = expected(run, float(time), about)[name][0]
            x = drawn["left"] + time / drawn["span"] * (drawn["right"] - drawn["left"])
            y = row["top"] + (row["high"] - value) / (row["high"] - row["low"]) * row["height"]
            ink = page.evaluate(
                """([x, y]) => { const {instruments: {graphs}, stage: {ratio}} = Wallkit.page;
                const [left, top] = [x - 1, y - 1].map((place) => Math.floor(place * ratio));
                const {data} = graphs.canvas.getContext("2d").getImageData(left, top, 3 * ratio, 3 * ratio);
                return Math.max(...data.filter((_, i) => i % 4 === 3)); }""",
                [float(x), float(y)],
            )
            assert ink > 150, (name, time)


def test_one_scrubs_in_the_graphs_with_pointer_and_keys(flown, until):
    page, run = flown(room(Balls([90.0, 120.0], [170.0, 110.0], 6.0), gravity=(0.0, -80.0)))
    show(page, until, ["height", "speed"])
    drawn = page.evaluate("Wallkit.page.instruments.graphs.drawn")
    box = page.locator("#graphs").bounding_box()
    clock = lambda: page.evaluate("Wallkit.page.player.time")  # noqa: E731
    left, right, start, span = (drawn[name] for name in ("left", "right", "from", "span"))
    page.mouse.move(box["x"] + left + 100, box["y"] + 30)
    page.mouse.down()
    for x in (150, 400, 300):
        page.mouse.move(box["x"] + left + x, box["y"] + 40)
    page.mouse.up()
    assert clock() == pytest.approx(start + span * 300 / (right - left), abs=span / (right - left))
    page.mouse.move(box["x"] + left + 350, box["y"] + 40)  # without the button nothing moves
    here = clock()
    page.get_by_role("slider", name="Time in the graphs").focus()
    page.keyboard.press("ArrowRight")
    assert clock() == pytest.approx(here + span / 200)
    page.keyboard.press("Shift+ArrowLeft")
    assert clock() == pytest.approx(here + span / 200 - span / 20)
    page.keyboard.press("Home")
    page.keyboard.press("PageUp")
    assert clock() == run.contacts["time"][0]
    until(page, "Number(document.querySelector('.times').ariaValueNow) === Wallkit.page.player.time")
    words = page.get_by_role("slider", name="Time in the graphs").get_attribute("aria-valuetext")
    assert "Height" in words
    assert "Speed" in words
    page.keyboard.press("+")
    until(page, DRAWN + f" && Wallkit.page.instruments.graphs.drawn.span < {0.81 * span}")
    page.keyboard.press("End")  # the graph turns to the page with that time
    until(page, DRAWN + " && Wallkit.page.instruments.graphs.drawn.from > 0")


def test_fifty_balls_fly_while_their_curves_stay(flown, until):
    page, _ = flown(many(50))
    show(page, until)
    states, pages = page.evaluate("(({states, pages}) => [states, pages])(Wallkit.page.instruments.graphs)")
    contacts, columns = page.evaluate("[Wallkit.page.player.motion.count, Wallkit.page.instruments.graphs.drawn.right]")
    assert states <= 50 * columns / 2 + 3 * (contacts + 50)
    after = page.evaluate(
        """(() => { const {player, instruments: {graphs}} = Wallkit.page; const hands = new Set();
        const {span} = graphs.drawn;
        for (let i = 1; i < 60; i++) { player.time = span * i / 60; player.draw(); Wallkit.page.eachFrame();
          hands.add(graphs.hand.style.transform); }
        return [graphs.states, graphs.pages, graphs.job, hands.size]; })()"""
    )
    assert after == [states, pages, None, 59]


def test_a_long_run_costs_no_more_than_its_pixels(flown, until):
    """A curve has at most four numbers a pixel, and what was least and greatest stays in it."""
    page, run = flown(room(Balls([90.0, 120.0], [170.0, 110.0], 6.0), gravity=(0.0, -80.0)))
    show(page, until, ["height"])
    told = page.evaluate(
        """(() => { const {graphs} = Wallkit.page.instruments; const {from, span} = graphs.drawn;
        const curve = graphs.curves(0, {left: 0, right: 5, from, span});
        return [curve.count, Math.min(...curve.values.height), Math.max(...curve.values.height)]; })()"""
    )
    lows = (lowest(run) - run.contacts["y"] * -80.0) / 80.0
    assert told[0] <= 24
    assert told[1] == pytest.approx(lows[run.contacts["time"] <= run.final["time"][0]].min(), abs=1e-9)


def test_strobe_ghosts_stand_at_equal_times(flown, until):
    page, run = flown(room(Balls([90.0, 120.0], [70.0, 110.0], 6.0), gravity=(0.0, -80.0)))
    page.get_by_label("Strobe interval").fill("0.5")

    def ink(on):
        page.get_by_label("Strobe", exact=True).set_checked(on)
        return page.evaluate(
            """(places) => { const {stage, player} = Wallkit.page; player.ghosts = player.trails = false;
            player.seek(3.7); player.draw(); const ctx = stage.front.getContext("2d");
            return places.map((place) => [stage.screenX(place[0]), stage.screenY(place[1])])
              .map((pixel) => pixel.map((part) => Math.round(part * stage.ratio)))
              .map(([x, y]) => ctx.getImageData(x, y, 1, 1).data[3]); }""",
            [run.position(0.5 * k)[0].tolist() for k in range(1, 7)],
        )

    assert max(ink(False)) == 0
    assert min(ink(True)) > 20
    assert sorted(ink(True)) == ink(True), "the older, the fainter"
