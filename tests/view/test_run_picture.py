import dataclasses
import io
import re
import xml.etree.ElementTree as ET

import numpy as np
import pytest
from PIL import Image

import wallkit
from wallkit.geometry.path_segments import polylines
from wallkit.view.canvas import Canvas, Disc, Shape
from wallkit.view.frame import fit
from wallkit.view.heat import spent
from wallkit.view.raster import Raster, png
from wallkit.view.run_picture import run_box, run_canvas, run_svg, scene_box, scene_svg
from wallkit.view.theme import RAMP_STEPS, colour, ramp
from wallkit.view.tracks import tracks

SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module")
def run():
    walls = wallkit.Walls.from_polylines(
        [[(0, 0), (10, 0), (10, 7), (0, 7)], [(4, 3), (5, 3), (5, 5)]], names=["<room>", "toy"]
    )
    balls = wallkit.Balls([[3, 3], [5, 2]], [[1.1, 0.7], [-2.3, 1.9]], [0.5, 0])
    return wallkit.simulate(wallkit.Scene(walls, balls), bounces=25)


def by_class(svg, name):
    return [
        element for element in ET.fromstring(svg).iter() if (element.get("class") or "").split()[:1] == [f"wk-{name}"]
    ]


def test_a_ghost_stands_at_each_contact_and_the_newest_is_the_plainest(run):
    ghosts = by_class(run_svg(run), "ghost")
    frame = next(iter([fit(scene_box(run.scene), True, width=960, max_height=1100, margin=28)]))
    assert len(ghosts) == len(run.contacts)
    for ghost, contact in zip(ghosts, run.contacts, strict=True):
        x, y = frame.point(contact["x"], contact["y"])
        assert float(ghost.get("cx")) == pytest.approx(x, abs=0.006)  # written to a hundredth of a pixel
        assert float(ghost.get("cy")) == pytest.approx(y, abs=0.006)
    faintness = [float(ghost.get("opacity")) for ghost in ghosts]
    assert faintness == sorted(faintness)


def test_the_path_goes_through_every_contact_of_every_ball(run):
    canvas = run_canvas(run)
    drawn = [np.array(line) for item in canvas.items if isinstance(item, Shape) and item.style == "path"
             for line in polylines(item.commands)]  # fmt: skip
    points = np.concatenate(drawn)
    frame = fit(scene_box(run.scene), True, width=960, max_height=1100, margin=28)
    for place in frame.points(np.stack([run.contacts["x"], run.contacts["y"]], axis=1)):
        assert np.hypot(*(points - place).T).min() < 1e-9
    assert sum(len(line) - 1 for line in drawn) == len(run.contacts) + 2


def test_names_are_escaped_and_materials_and_the_ramp_have_words(run):
    svg = run_svg(run, title="a <b>", colour="speed")
    titles = [element.text for element in ET.fromstring(svg).iter(f"{SVG}title")]
    assert "<room>" in titles
    assert any(
        text.startswith("speed ") for text in (element.text for element in ET.fromstring(svg).iter(f"{SVG}text"))
    )


def test_a_million_contacts_are_thinned_and_the_picture_says_so(run, monkeypatch):
    monkeypatch.setattr("wallkit.view.run_picture.MAX_STRETCHES", 20)
    assert "20 of 52 stretches are shown: each ball&#x27;s first 10" in run_svg(run)


def test_a_ball_that_leaves_is_drawn_to_the_rim():
    walls = wallkit.Walls.from_polylines([[(0, 0), (10, 0), (10, 5)]], closed=False)
    run = wallkit.simulate(wallkit.Scene(walls, wallkit.Balls([[5, 2]], [[-1, -1.0]], 0.1)), bounces=10)
    numbers = [float(n) for path in by_class(run_svg(run), "path") for n in re.findall(r"[-.\d]+", path.get("d"))]
    assert max(numbers) < 1000
    assert min(numbers) > -1


def test_a_scene_shows_its_balls_with_an_arrow_each(run):
    svg = scene_svg(run.scene)
    assert len(by_class(svg, "ball")) == len(by_class(svg, "arrow")) == 2


def test_heat_sums_to_all_ball_seconds(run):
    flight = tracks(run)
    frame = fit(scene_box(run.scene), True, width=960, max_height=1100, margin=28)
    cells = spent(flight, frame, 10.0, (int(frame.height / 10) + 1, int(frame.width / 10) + 1))
    assert cells.sum() == pytest.approx((flight.until - flight.time).sum(), rel=1e-12)


def test_png_has_twice_the_size_and_the_colours_of_the_picture(run):
    canvas = run_canvas(run)
    image = Image.open(io.BytesIO(png(canvas, "dark")))
    assert image.size == (1920, int(np.ceil(canvas.height * 2)))
    assert image.getpixel((2, 2)) == tuple(bytes.fromhex(colour("paper", "dark")[1:]))


def test_the_even_odd_fill_of_pixels_agrees_with_shapely():
    shapely = pytest.importorskip("shapely")
    outer = [(5, 5), (95, 15), (80, 90), (10, 70)]
    hole = [(30, 30), (60, 25), (50, 60)]
    commands = [(("M" if i == 0 else "L"), *p) for ring in (outer, hole) for i, p in enumerate(ring)]
    pixels = np.asarray(Raster(100, 100, "light", 2.0).drawn([Shape("error", commands)]).pixels.image())
    red = (pixels == tuple(bytes.fromhex(colour("error", "light")[1:]))).all(axis=2)
    centres = (np.arange(200) + 0.5) / 2
    x, y = np.meshgrid(centres, centres)
    polygon = shapely.Polygon(outer, [hole])
    inside = shapely.contains_xy(polygon, x, y)
    # A shape of the style "error" has a stroke, too: only what is well away from it is compared.
    clear = shapely.distance(shapely.boundary(polygon), shapely.points(x, y)) > 1.5
    assert (red == inside)[clear].all()


def test_the_ramp_grows_lighter_all_the_way_so_that_it_reads_in_grey():
    for theme in ("light", "dark"):
        rgb = [tuple(bytes.fromhex(ramp(step, theme)[1:])) for step in range(RAMP_STEPS)]
        grey = [0.2126 * r + 0.7152 * g + 0.0722 * b for r, g, b in rgb]
        assert grey == sorted(grey)


def test_a_faint_disc_partly_outside_is_no_error():
    Raster(10, 10, "light", 1.0).drawn(
        [Disc("ghost", -3, 5, 8, 3, opacity=0.5), Disc("ghost", 50, 50, 8, 3, opacity=0.5)]
    )
    assert Canvas(10, 10).to_svg().startswith("<svg")


def test_more_balls_than_are_drawn_still_make_a_picture():
    walls = wallkit.Walls.from_polylines([[(0, 0), (10, 0), (10, 7), (0, 7)]])
    count = 450
    balls = wallkit.Balls(np.full((count, 2), 3.0), np.ones((count, 2)), np.linspace(0.1, 0.5, count))
    run = wallkit.simulate(wallkit.Scene(walls, balls), bounces=1)
    assert len(by_class(run_svg(run), "ball")) == 400


def test_flight_under_gravity_is_drawn_as_the_exact_parabola():
    walls = wallkit.Walls.from_polylines([[(0, 0), (10, 0), (10, 9), (0, 9)]])
    run = wallkit.simulate(
        wallkit.Scene(walls, wallkit.Balls([[2, 8]], [[1.0, 0]], 0.5), gravity=(0, -9.81)), bounces=3
    )
    frame = fit(scene_box(run.scene), True, width=960, max_height=1100, margin=28)
    drawn = [
        polylines(item.commands) for item in run_canvas(run).items if isinstance(item, Shape) and item.style == "path"
    ]
    points = np.concatenate([line for lines in drawn for line in lines])
    fall = np.sqrt(2 * 7.5 / 9.81)  # seconds from y = 8 to the contact at y = 0.5
    for t in np.linspace(0, fall, 25):
        # The curve is sampled at even parts of the time of its stretch: 24 chords, so every 25th of the fall is there.
        exact = frame.point(2 + t, 8 - 9.81 / 2 * t * t)
        assert np.hypot(*(points - exact).T).min() < 1e-6


def test_strobe_shows_the_balls_at_equal_times_beside_the_ghosts_at_contacts(run):
    frame = fit(scene_box(run.scene), True, width=960, max_height=1100, margin=28)
    with_it = [item for item in run_canvas(run, strobe=0.7).items if isinstance(item, Disc) and item.style == "ghost"]
    discs = [disc for disc in with_it if disc.filled and disc.title.startswith("ball ")]
    last = float(run.final["time"].max())
    times = [0.7 * k for k in range(int(last / 0.7) + 1)]
    expected = [(time, ball) for time in times for ball in (0, 1) if time <= run.final["time"][ball]]
    assert len(discs) == len(expected) > 20
    for disc, (time, ball) in zip(discs, expected, strict=True):
        assert (disc.x, disc.y) == pytest.approx(frame.point(*run.position(time)[ball]), abs=1e-9)
    assert len(with_it) - len(discs) == len(run.contacts)


def test_several_balls_have_their_colours_in_stills_as_in_films_one_shows_the_time(run):
    def steps(of, style):
        return {item.step for item in run_canvas(of).items if getattr(item, "style", "") == style}

    assert steps(run, "path") == {0, RAMP_STEPS - 1}  # as film has them: ball k of n at k / (n - 1) of the ramp
    assert steps(run, "ball") == {0, RAMP_STEPS - 1}
    assert "ball 0" in run_svg(run)
    alone = run.take([0])
    assert len(steps(alone, "path")) > 2
    assert steps(alone, "ball") == {None}


@pytest.mark.parametrize(("speed", "above"), [(20.0, 20.0), (40.0, 40.0)])  # v^2 / 2 g, at most the size of the floor
def test_a_picture_has_room_for_a_ball_that_is_thrown_above_its_walls(speed, above):
    floor = wallkit.Walls.from_polylines([[(0.0, 0.0), (40.0, 0.0)]], closed=False)
    scene = wallkit.Scene(floor, wallkit.Balls([20.0, 0.0], [1.0, speed]), gravity=(0.0, -10.0))
    x0, y0, x1, y1 = run_box(wallkit.simulate(scene, until=3.0 * speed / 20.0))
    assert (x0, y0, x1) == (0.0, 0.0, 40.0)
    assert y1 == pytest.approx(min(speed * speed / 20.0, above))
    still = dataclasses.replace(scene, gravity=None)
    assert run_box(wallkit.simulate(still, until=1.0)) == (0.0, 0.0, 40.0, 0.0)
