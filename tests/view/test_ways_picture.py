"""Pictures and films of a way to be wrong show both paths, and mark where they part and what was flown through."""

import io

import numpy as np
import pytest
from lxml import etree
from PIL import Image

import wallkit
from wallkit.view import film as films
from wallkit.view.theme import colour, ramp
from wallkit.view.ways_picture import ways_canvas

SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module")
def run():
    walls = wallkit.Walls.from_polylines([[(0, 0), (100, 0), (100, 70), (0, 70)]], names=["room"])
    return wallkit.simulate(wallkit.Scene(walls, wallkit.Balls([[30, 30]], [[40, 3]], 4)), until=4.0)


def stepped(run, way, dt):
    return wallkit.step_through(run.scene, way, dt, 4.0)


def drawn(canvas):
    return etree.fromstring(canvas.to_svg().encode())


def of_class(document, tag, name):
    return [each for each in document.iter(f"{SVG}{tag}") if name in each.get("class", "").split()]


def test_a_picture_has_a_dot_a_frame_and_the_exact_path_under_them(run):
    way = stepped(run, "stop", 0.5)
    document = drawn(ways_canvas(run, way))
    dots = [each for each in of_class(document, "circle", "wk-ball") if each.get("r") == "1.8"]
    assert len(dots) == len(way.time)
    order = [each.get("class").split()[0] for each in document.iter(f"{SVG}path", f"{SVG}circle")]
    assert order.index("wk-exact") < order.index("wk-path")


def test_the_ring_is_where_the_balls_part_and_the_words_say_when(run):
    way = stepped(run, "stop", 0.5)
    (parting,) = way.partings(run)
    canvas = ways_canvas(run, way)
    (ring,) = of_class(drawn(canvas), "circle", "wk-apart")
    dots = [each for each in of_class(drawn(canvas), "circle", "wk-ball") if each.get("r") == "1.8"]
    dot = dots[way.time.tolist().index(parting.time)]
    assert (ring.get("cx"), ring.get("cy")) == (dot.get("cx"), dot.get("cy"))
    (words,) = of_class(drawn(canvas), "text", "wk-apart-words")
    assert words.text == f"parts at {parting.time:g} s"
    told = " ".join("".join(text.itertext()) for text in of_class(drawn(canvas), "text", "wk-note"))
    assert "stop in frames of 0.5 s: parts from the exact path at 2 s" in told


def test_a_ball_that_flew_through_a_wall_leaves_a_cross_and_ends_at_the_rim(run):
    way = stepped(run, "overlap", 1.0)
    document = drawn(ways_canvas(run, way))
    assert [each.findtext(f"{SVG}title") for each in of_class(document, "path", "wk-apart")][-1] == "through wall 0"
    xs = [float(each.get("cx")) for each in of_class(document, "circle", "wk-ball") if each.get("r") == "1.8"]
    assert len(xs) < len(way.time)
    assert max(xs) < ways_canvas(run, way).width
    told = " ".join("".join(text.itertext()) for text in of_class(document, "text", "wk-note"))
    assert "goes through wall 0 (room) at 2 s, and is lost" in " ".join(told.split())


def test_where_nothing_parts_the_picture_says_so_and_marks_nothing(run):
    document = drawn(ways_canvas(run, stepped(run, "exact", 0.5)))
    assert of_class(document, "circle", "wk-apart") == []
    told = " ".join("".join(text.itertext()) for text in of_class(document, "text", "wk-note"))
    assert "never 1 % of the drawing off the exact path, up to 4 s" in told


def middle_of(pixels, hue, least):
    near = np.abs(pixels - np.array(list(bytes.fromhex(hue[1:])))).max(axis=2) < 12
    rows, columns = np.nonzero(near)
    assert len(rows) > least
    return np.median(columns) + 0.5, np.median(rows) + 0.5


def test_each_frame_of_a_film_shows_the_latest_frame_of_the_way_over_the_exact_ball(run):
    way = stepped(run, "overlap", 1.0)
    look = films.Look(width=640, fps=25, pace=1.0, colour="ball", theme="light")
    frames = films._Frames(run, look, 1.9, None, way)
    image = Image.open(io.BytesIO(films.film(run, "gif", seconds=1.9, pace=1.0, stepped=way)))
    image.seek(45)  # at 1.8 s: the way stands at its frame of 1 s, the exact ball has gone on
    pixels = np.asarray(image.convert("RGB")).astype(int)
    x, y = middle_of(pixels, ramp(16, "light"), 60)
    wanted = frames.frame.points(way.shown(1.8)[:, 0:2])[0]
    assert np.hypot(x - wanted[0], y - wanted[1]) < 2.0
    u, v = frames.frame.points(run.position(1.8))[0]
    ring = pixels[round(v) - 40 : round(v) + 40, round(u) - 40 : round(u) + 40]
    middle_of(ring, colour("muted", "light"), 20)
    assert frames.caption(1.0).startswith("overlap, dt 1 s: 1.00 s")


def test_marks_appear_when_the_film_gets_there(run):
    frames = films._Frames(run, films.Look(640, 25, 1.0, "ball", "light"), 4.0, None, stepped(run, "stop", 0.5))
    assert frames.beside.marks(1.9) == []
    assert frames.beside.marks(2.0) != []


def test_a_film_refuses_what_is_no_way(run):
    with pytest.raises(films.FilmError, match="stepped is"):
        films.film(run, "gif", stepped="stop")
