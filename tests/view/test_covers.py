"""Covers and pixels, judged by areas and distances of shapely, by whole numbers, and by Pillow's reader of PNG."""

import io

import numpy as np
import pytest
import shapely
from PIL import Image

from wallkit.view import pixels as picture
from wallkit.view.areas import fill, ring
from wallkit.view.pixels import Pixels
from wallkit.view.strokes import strokes

SIZE = (300, 200)


def star(points, x=150.0, y=100.0):
    angle = np.arange(points) * 4 * np.pi / points + 0.1
    return np.stack([x + 90 * np.cos(angle), y + 90 * np.sin(angle)], axis=1)


def stroke(lines, width, size, round_ends=True):
    """What one group of lines covers; None for nothing."""
    spots = strokes([lines], width, size, round_ends=round_ends)[0]
    return spots if len(spots.place) else None


def whole(cover):
    """What is covered, as parts of a pixel: white on black."""
    paper = Pixels(*SIZE, "#000000")
    paper.paint(cover, "#ffffff")
    return (paper.values & 255) / 255


def distances(shape):
    x, y = np.meshgrid(np.arange(SIZE[0]) + 0.5, np.arange(SIZE[1]) + 0.5)
    return shapely.distance(shape, shapely.points(x, y))


def shares(shape):
    """What each pixel shares with an area, by shapely."""
    x, y = np.meshgrid(np.arange(SIZE[0]), np.arange(SIZE[1]))
    result = shapely.contains_xy(shape, x + 0.5, y + 0.5).astype(float)
    rim = shape.boundary
    shapely.prepare(rim)
    near = shapely.dwithin(rim, shapely.points(x + 0.5, y + 0.5), 0.75)  # a pixel reaches 0.71 from its middle
    x, y = x[near], y[near]
    result[y, x] = shapely.area(shapely.intersection(shapely.box(x, y, x + 1, y + 1), shape))
    return result


@pytest.mark.parametrize("width", [0.6, 1.0, 2.0, 2.6, 3.0, 4.0, 5.0, 16.0])
@pytest.mark.parametrize("angle", [0, 3, 17, 45, 60, 89, 90, 133, 200, 271])
@pytest.mark.parametrize("round_ends", [True, False])
def test_a_stroke_is_as_wide_as_its_pen_in_every_direction(width, angle, round_ends):
    way = 80 * np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle))])
    line = np.array([150.3, 100.2]) + np.stack([-way, way])
    cover = whole(stroke([line], width, SIZE, round_ends=round_ends))
    shape = shapely.LineString(line)
    pen = shape.buffer(width / 2, cap_style="round" if round_ends else "flat", quad_segs=64)
    # What the square of a pixel shares with the pen is known to shapely. Along a slanted rim that is a curve where ours
    # is a straight ramp: 1/8 apart; across a thin pen's two rims and at corners twice as much; and in sixteenths.
    exact, deep = shares(pen), distances(pen.boundary) > 1.4  # farther from the rim than a pixel and its ramp reach
    assert np.abs(cover - exact).max() < 0.3
    assert (cover[deep] == exact[deep]).all()
    # Along the line the ramps add up; what is left are two ends, and the sixteenths, which a line that is as steep
    # as a whole number of pixels repeats: 1/32 at most on each rim.
    assert cover.sum() == pytest.approx(pen.area, abs=2 / 32 * shape.length + 0.5)


def test_a_stroke_through_a_thousand_points_has_no_holes_and_no_hairs():
    angle = np.linspace(0, 2 * np.pi, 1001)
    line = np.stack([150.2 + 70 * np.cos(angle), 100.4 + 70 * np.sin(angle)], axis=1)
    away = distances(shapely.LineString(line))
    cover = whole(stroke([line], 4.0, SIZE))
    assert (cover[away < 0.7] == 1).all()
    assert (cover[away > 3.3] == 0).all()


def test_corners_stay_however_short_their_sides():
    steps = np.cumsum([(100.0, 100.0), (3, 0), (0, 3), (3, 0), (0, 3), (40, 0)], axis=0)
    away = distances(shapely.LineString(steps))
    cover = whole(stroke([steps], 2.0, SIZE))
    assert (cover[away > 2.0] == 0).all()
    assert (cover[distances(shapely.MultiPoint(steps)) < 0.3] > 0).all()


@pytest.mark.parametrize("times", [(1, 2, 1), (1, 3, 2), (2, 2, 2)])
def test_corners_stay_whose_point_is_there_several_times(times):
    # So a path is given of a ball that meets two walls of a corner at one time.
    corner = np.array([(20.0, 30.0), (220.5, 30.0), (220.5, 180.0)])
    line = np.repeat(corner, times, axis=0)
    cover = whole(stroke([line, line[::-1]], 2.6, SIZE))  # the second line begins where the first one ends
    assert np.abs(cover - shares(shapely.LineString(corner).buffer(1.3, quad_segs=64))).max() < 0.3


def test_a_stroke_far_beyond_the_picture_is_clipped():
    cover = whole(stroke([np.array([(150.0, 100.0), (1e7, 100.0)])], 2.0, SIZE))
    assert (cover[99:101, 152:] == 1).all()
    assert stroke([np.array([(900.0, 100.0), (950.0, 100.0)])], 2.0, SIZE) is None


def test_groups_of_strokes_are_what_each_is_alone():
    rng = np.random.default_rng(5)
    groups = [[rng.uniform(-20, 320, (n, 2)) for n in (2, 5, 1)[: 1 + k % 3]] for k, n in enumerate((2, 3, 9, 40, 2))]
    for round_ends in (True, False):
        together = strokes(groups, 2.6, SIZE, round_ends=round_ends)
        alone = [stroke(lines, 2.6, SIZE, round_ends=round_ends) for lines in groups]
        for one, other in zip(together, alone, strict=True):
            assert (whole(one) == whole(other)).all()


def test_a_long_stroke_is_what_its_parts_are():
    # So long that its pixels are looked at in many portions; each segment alone is in one or two.
    line = np.random.default_rng(3).uniform((0, 0), SIZE, (400, 2))
    parts = [whole(stroke([line[k : k + 2]], 2.6, SIZE)) for k in range(len(line) - 1)]
    assert (whole(stroke([line], 2.6, SIZE)) == np.max(parts, axis=0)).all()


def test_a_curve_is_drawn_where_it_is_however_many_points_it_has():
    angle = np.linspace(0, 2 * np.pi, 20_001)
    line = np.stack([150.2 + 70 * np.cos(angle), 100.4 + 70 * np.sin(angle)], axis=1)
    hoop = shapely.Point(150.2, 100.4).buffer(71.5, 720).difference(shapely.Point(150.2, 100.4).buffer(68.5, 720))
    # Points may be left out as far as that moves the line by a tenth of a pixel; the rest as above, at one rim.
    assert np.abs(whole(stroke([line], 3.0, SIZE)) - shares(hoop)).max() < 0.1 + 0.15


def test_what_has_no_place_is_not_drawn():
    nan, inf = float("nan"), float("inf")
    seen = np.array([(20.0, 20.0), (60.0, 40.0)])
    lines = [
        np.array([(10.0, 10.0), (nan, 50.0), (50.0, 10.0)]),
        seen,
        np.array([(0.0, 0.0), (inf, 3.0), (-inf, inf), (1e300, -1e300), (5.0, -1e300)]),
    ]
    assert (whole(stroke(lines, 2.0, SIZE)) == whole(stroke([seen], 2.0, SIZE))).all()
    assert stroke([lines[0]], 2.0, SIZE) is None


def test_a_point_alone_is_a_dot():
    dot = whole(stroke([np.array([(30.4, 40.7)])], 5.0, SIZE))
    assert dot == pytest.approx(whole(ring(30.4, 40.7, 2.5, 0.0, SIZE)), abs=1 / 32 + 1 / 255)


def test_a_fill_covers_the_area_of_its_polygon():
    outer, hole = np.array([(5.2, 5), (295, 15), (280.7, 190), (10, 170)]), np.array([(30, 30.5), (60, 25), (50, 60)])
    polygon = shapely.Polygon(outer, [hole])
    cover = whole(fill([outer, hole], SIZE))
    # Of a pixel at the rim the four rows of samples see all but a quarter of its height, in the mean nothing.
    assert cover.sum() == pytest.approx(polygon.area, abs=0.01 * polygon.length)
    inside = shapely.contains_xy(polygon, *np.meshgrid(np.arange(300) + 0.5, np.arange(200) + 0.5))
    clear = distances(polygon.boundary) > 0.8
    assert (cover[clear] == inside[clear]).all()


def test_a_fill_is_even_odd_where_it_crosses_itself():
    assert whole(fill([star(5)], SIZE))[100, 150] == 0  # the middle of a pentagram, wound twice
    assert whole(fill([star(5)], SIZE))[100, 150 + 60] == 1


def test_a_fill_that_reaches_beyond_the_picture_covers_what_is_seen():
    far = np.array([(-1e6, -1e6), (1e6, -1e6), (1e6, 1e6), (-1e6, 1e6)])
    assert (whole(fill([far], SIZE)) == 1).all()
    assert fill([far + 3e6], SIZE) is None
    assert fill([], SIZE) is None


@pytest.mark.parametrize("radius", [0.4, 2.2, 9.7, 60.0])
def test_a_disc_and_a_ring_cover_their_areas(radius):
    # A ramp of a pixel on both sides of the radius has the integral pi (r^2 + 1/12), and a little less under r = 1/2.
    disc, hoop = ring(150.3, 99.8, radius, 0.0, SIZE), ring(150.3, 99.8, radius + 1, radius - 1, SIZE)
    assert whole(disc).sum() == pytest.approx(np.pi * radius**2, abs=0.3 + 0.005 * radius**2)
    assert whole(hoop).sum() == pytest.approx(np.pi * ((radius + 1) ** 2 - max(radius - 1, 0) ** 2), rel=0.05)
    assert ring(-500.0, 0.0, radius, 0.0, SIZE) is None


@pytest.mark.parametrize("hue", ["#000000", "#ffffff", "#3b528b"])
def test_colours_are_mixed_to_the_nearest_whole_number(hue):
    under, strength = np.meshgrid(np.arange(256), np.arange(256))
    below = (under | (255 - under) << 8 | under << 16).astype(np.uint32)
    mixed = picture._mixed(below, picture.number_of(hue), strength.astype(np.uint32))
    for channel, there in enumerate((under, 255 - under, under)):
        over = int(hue[1 + 2 * channel : 3 + 2 * channel], 16)
        exact = there * (255 - strength) + over * strength  # in 255ths; never halfway, for 255 is odd
        assert (mixed >> 8 * channel & 255 == (2 * exact + 255) // 510).all()


@pytest.mark.parametrize("opacity", [1.0, 0.6])
def test_few_pixels_and_many_are_painted_alike(monkeypatch, opacity):
    covers = [fill([star(7)], SIZE), stroke([star(5)], 3.0, SIZE), ring(20, 30, 12, 8, SIZE)]
    results = []
    for small in (0, 10**9):
        monkeypatch.setattr(picture, "_SMALL", small)
        paper = Pixels(*SIZE, "#fcfbf8")
        for cover in covers:
            paper.paint(cover, "#1f66ad", opacity)
        results.append(paper.values)
    assert (results[0] == results[1]).all()


def test_a_png_holds_the_pixels():
    paper = Pixels(*SIZE, "#fcfbf8")
    paper.paint(fill([star(5)], SIZE), "#1f66ad", 0.5)
    image = Image.open(io.BytesIO(paper.png()))
    image.load()
    assert image.mode == "RGB"
    assert (np.asarray(image) == paper.rgb()).all()
    assert image.getpixel((0, 0)) == (0xFC, 0xFB, 0xF8)
    assert (np.asarray(paper.image()) == paper.rgb()).all()
