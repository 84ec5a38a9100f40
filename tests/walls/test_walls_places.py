"""Places: the units, the origin, the page and the grid of what is imported, the same through every door."""

from __future__ import annotations

import json
import sys

import numpy as np
import pytest
from drawn import circle, codes, drawing, line, path, square

import wallkit
from importers.drawing import Artboard
from wallkit.cli import main
from wallkit.walls.import_options import ImportOptions
from wallkit.walls.importing.pipeline import import_walls
from wallkit.walls.walls import WallsError

MM = """<svg xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"
 xmlns:sodipodi="http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd" width="120mm" height="80mm" viewBox="0 0 120 80">
 <sodipodi:namedview>{pages}</sodipodi:namedview>{art}</svg>"""
ROOM = '<rect id="room" x="10" y="10" width="100" height="60" fill="none" stroke="#000"/>'
PAGES = (
    '<inkscape:page x="0" y="0" width="120" height="80" id="p1"/>'
    '<inkscape:page x="130" y="5" width="60" height="70" inkscape:label="Cave"/>'
)
TWO = '<rect id="one" x="20" y="20" width="50" height="50"/><rect id="two" x="140" y="15" width="30" height="30"/>'


def said(monkeypatch, *words):
    """Run the command line in this process; it ends well."""
    monkeypatch.setattr(sys, "argv", ["wallkit", *map(str, words)])
    with pytest.raises(SystemExit) as ended:
        main()
    assert not ended.value.code


def read(art=ROOM, pages=""):
    return wallkit.read_drawing_text(MM.format(art=art, pages=pages))


def corners(walls):
    return sorted(map(tuple, np.round(walls.vertices, 9).tolist()))


@pytest.mark.parametrize(
    ("units", "inch"), [("px", 96), ("pt", 72), ("mm", 25.4), ("cm", 2.54), ("m", 0.0254), ("in", 1)]
)
def test_a_drawing_in_millimetres_has_its_physical_size_in_every_unit(units, inch):
    walls = import_walls(read(), units=units)
    assert walls.units == units
    wanted = np.array([(10, 10), (10, 70), (110, 10), (110, 70)]) / 25.4 * inch
    got = walls.vertices[np.lexsort(walls.vertices.T[::-1])]
    # mm to px by the viewBox, and on to the unit: two products and two quotients, half an ulp each
    np.testing.assert_allclose(got, wanted, rtol=4 * 2.0**-52)


def test_a_point_is_a_seventy_second_of_an_inch():
    walls = import_walls(drawing(path(square(0, 0, 72)), units="pt"), units="in")
    assert corners(walls) == [(0, 0), (0, 1), (1, 0), (1, 1)]


@pytest.mark.parametrize(
    ("scale", "name", "px"),
    [("1 m = 100 px", "m", 0.01), ("1m=100px", "m", 0.01), ("5 mm = 1 px", "mm", 5.0), ("2.5 m = 1 in", "m", 2.5 / 96),
     ("1 cm = 1e3 px", "cm", 1e-3)],
)  # fmt: skip
def test_a_scale_as_on_a_map_says_how_long_the_drawing_is_in_reality(scale, name, px):
    art = drawing(path(square(10, 20, 300)), units="px", y_axis="down")
    walls = import_walls(art, units=scale)
    assert walls.units == name
    np.testing.assert_allclose(walls.box(), px * np.array([10, 20, 310, 320]), rtol=4 * 2.0**-52)
    inked = import_walls(drawing(path(square(0, 0, 72)), units="pt"), units="1 m = 96 px")  # 72 pt are 96 px
    np.testing.assert_allclose(inked.box(), [0, 0, 1, 1], rtol=4 * 2.0**-52)


@pytest.mark.parametrize(
    "scale", ["1 m", "1 m =", "1 m = 100", "m = px", "0 m = 1 px", "-1 m = 1 px", "nan m = 1 px", "1 m = inf px",
              "1 m = 1 px = 1 in", "1 yard = 3 px", "1 m = 1 yard"],
)  # fmt: skip
def test_what_is_no_scale_is_refused(scale):
    with pytest.raises(WallsError, match=r"^units is .*1 m = 100 px"):
        ImportOptions(units=scale)


def test_lengths_are_in_the_units_asked_for_and_scale_comes_after():
    walls = import_walls(drawing(path(circle(0, 0, 72)), units="pt"), units="mm", tolerance=0.5)
    assert walls.tolerance == 0.5
    assert 0.25 < walls.measured_error <= 0.5
    large = import_walls(drawing(path(circle(0, 0, 72)), units="pt"), units="mm", tolerance=0.5, scale=10)
    assert (large.tolerance, large.units) == (5, "")
    np.testing.assert_allclose(large.vertices, 10 * walls.vertices, rtol=1e-15)


def test_a_circle_stays_a_circle_in_every_unit():
    walls = import_walls(drawing(path(circle(72, 36, 18)), units="pt"), units="mm", curves="arcs", origin="25.4,12.7")
    np.testing.assert_allclose(np.hypot(*walls.vertices.T), 18 * 25.4 / 72, rtol=1e-14)


SHEET = Artboard("page", 0.0, -100.0, 200.0, 0.0)


@pytest.mark.parametrize(
    ("origin", "flip", "box"),
    [
        ("page", False, (10, 60, 30, 80)),
        ("page", True, (10, 20, 30, 40)),  # mirrored about the top of the page, not about 0
        ("box", False, (0, 0, 20, 20)),
        ("box", True, (0, 0, 20, 20)),
        ("10,-40", False, (0, 0, 20, 20)),
        ("10,-40", True, (0, -20, 20, 0)),
        ("", True, (10, 20, 30, 40)),
    ],
)
def test_the_origin_is_where_it_is_asked_for(origin, flip, box):
    up = drawing(path(square(10, -40, 20)), units="pt", y_axis="up", sheet=SHEET)
    walls = import_walls(up, origin=origin, flip_y=flip)
    assert walls.box() == box


def test_a_drawing_without_a_page_says_so_and_what_to_do():
    with pytest.raises(WallsError, match=r"says no page.*--origin box"):
        import_walls(drawing(path(square(0, 0, 9))), origin="page")
    with pytest.raises(WallsError, match=r"is empty.*--origin X,Y"):
        import_walls(drawing(), origin="box")


@pytest.mark.parametrize(
    ("key", "value"),
    [("units", "ft"), ("origin", "middle"), ("origin", "1,nan"), ("origin", "1"), ("origin", 3), ("page", 0),
     ("page", "2"), ("page", True), ("grid", -1.0), ("grid", "1")],
)  # fmt: skip
def test_a_wrong_place_is_told_by_its_key(key, value):
    with pytest.raises(WallsError, match=f"^{key} is"):
        ImportOptions(**{key: value})


def test_balls_spawns_sensors_and_problems_move_with_the_walls():
    art = ROOM + (
        '<g id="balls"><circle cx="40" cy="40" r="3"/><path d="M40 40h12"/></g>'
        '<circle id="a #spawn" cx="60" cy="40" r="2"/>'
        '<rect id="b #sensor" x="80" y="30" width="5" height="5"/><path id="c" d="M90 40" stroke="#000"/>'
    )
    options = ImportOptions(units="mm", origin="10,10", curves="arcs", scale=2.0, flip_y=True)
    scene = wallkit.open_scene(read(art), wallkit.Wishes(importing=options)).scene
    np.testing.assert_allclose(scene.balls.position, [[60, -60]], rtol=1e-14)
    np.testing.assert_allclose(scene.balls.velocity, [[24, 0]], rtol=1e-14)
    np.testing.assert_allclose(scene.balls.radius, [6], rtol=1e-14)
    np.testing.assert_allclose([scene.walls.markers[0].x, scene.walls.markers[0].y], [100, -60], rtol=1e-14)
    np.testing.assert_allclose(scene.sensors.box(), [140, -50, 150, -40], rtol=1e-14)
    np.testing.assert_allclose(scene.walls.box(), [0, -120, 200, 0], atol=1e-12)
    (point,) = [p for p in scene.walls.problems if p.code == "one-point-path"]
    assert (point.x, point.y) == (pytest.approx(160), pytest.approx(-60))


def test_the_page_of_an_inkscape_drawing_is_one_level():
    both = read(TWO, PAGES)
    assert [board.name for board in both.artboards] == ["page 1", "Cave"]
    whole = import_walls(both, units="mm")
    assert whole.names == ("one", "two")
    assert "2 pages are one level: 1 'page 1', 2 'Cave'" in [p.message for p in whole.problems]
    assert "several-artboards" not in codes(import_walls(both, page="all"))
    for page, name, box in ((1, "one", (20, 20, 70, 70)), (2, "two", (10, 10, 40, 40))):
        walls = import_walls(both, units="mm", page=page, origin="page")
        assert walls.names == (name,)
        assert walls.box() == pytest.approx(box)
        assert "other-artboards" in codes(walls)
    assert len(both.paths) == 2  # the drawing itself stays as it was
    with pytest.raises(wallkit.DrawingError, match="there is no page 3: the drawing has 2"):
        import_walls(both, page=3)


def test_one_page_is_no_choice():
    one = read(ROOM, '<inkscape:page x="0" y="0" width="120" height="80"/>')
    assert one.artboards == []
    assert import_walls(one, page=1).names == ("room",)


def test_vertices_are_on_the_grid_in_decimal_numbers():
    drawn = drawing(
        path(square(0.04, 0.16, 0.31), fill="#000000"), path(line((0.02, 0.9), (0.29, 0.91)), stroke="#000000")
    )
    walls = import_walls(drawn, grid=0.1)
    assert corners(walls.take([0])) == [(0, 0.2), (0, 0.5), (0.4, 0.2), (0.4, 0.5)]
    assert set(walls.vertices.ravel().tolist()) == {0.0, 0.2, 0.3, 0.4, 0.5, 0.9}
    assert walls.measured_error == pytest.approx(np.hypot(0.05, 0.04), abs=0.02)


def test_a_grid_that_swallows_an_edge_leaves_no_edge_without_length():
    walls = import_walls(drawing(path(square(0, 0, 40), square(100, 100, 4))), grid=10)
    assert len(walls) == 1
    assert walls.box() == (0, 0, 40, 40)
    assert "one-point-path" in codes(walls)


def test_arcs_move_by_at_most_what_is_said():
    drawn = drawing(path(circle(0.3, 0.4, 30)))
    walls = import_walls(drawn, curves="arcs", grid=1.0)
    away = np.abs(np.hypot(*(walls.straightened(1e-4).vertices - [0.3, 0.4]).T) - 30)
    assert away.max() <= walls.measured_error <= 1.0 + 1e-9


def test_places_are_the_same_from_the_command_line_a_scene_file_and_the_library(tmp_path, monkeypatch):
    (tmp_path / "two.svg").write_text(MM.format(art=TWO, pages=PAGES))
    asked = {"units": "mm", "origin": "page", "page": 2, "grid": 0.5}
    mine = import_walls(tmp_path / "two.svg", **asked)
    words = [word for key, value in asked.items() for word in (f"--{key}", str(value))]
    said(monkeypatch, "import", tmp_path / "two.svg", "-o", tmp_path / "a.json", *words)
    assert wallkit.Walls.load(tmp_path / "a.json").vertices.tobytes() == mine.vertices.tobytes()
    table = "\n".join(f"{key} = {json.dumps(value)}" for key, value in asked.items())
    (tmp_path / "a.toml").write_text(f'drawing = "two.svg"\n[import]\n{table}\n')
    scene = wallkit.open_scene(tmp_path / "a.toml").scene
    assert corners(scene.walls) == corners(mine)  # turned inside out, for there is no other room for a ball
    assert scene.walls.units == "mm"


def test_import_writes_one_level_a_page(tmp_path, monkeypatch):
    (tmp_path / "two.svg").write_text(MM.format(art=TWO, pages=PAGES))
    said(monkeypatch, "import", tmp_path / "two.svg", "--page", "all", "-o", tmp_path / "level.json")
    assert sorted(file.name for file in tmp_path.glob("*.json")) == ["level-1.json", "level-2.json"]
    assert wallkit.Walls.load(tmp_path / "level-2.json").names == ("two",)


def test_inspect_tells_the_physical_size_and_the_pages(tmp_path, monkeypatch, capsys):
    (tmp_path / "two.svg").write_text(MM.format(art=TWO, pages=PAGES))
    said(monkeypatch, "inspect", tmp_path / "two.svg")
    told = capsys.readouterr().out
    assert "page     453.543 by 302.362 px, 120 by 80 mm" in told
    assert '2 "Cave": 226.772 by 264.567 px, 60 by 70 mm' in told
