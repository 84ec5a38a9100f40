import re
import xml.etree.ElementTree as ET

import numpy as np
import pytest

from importers.drawing import Drawing, DrawnPath, Subpath
from importers.problems import Problem
from wallkit import Material, Walls
from wallkit.geometry.bulge_arcs import arc_points
from wallkit.view.frame import fit, walls_box
from wallkit.view.outline import solid_areas, tick_places
from wallkit.view.picture import drawing_svg, walls_svg

SVG = "{http://www.w3.org/2000/svg}"


def ring(x0, y0, x1, y1):
    return [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]


@pytest.fixture
def nested():
    return Walls.from_polylines([ring(0, 0, 100, 80), ring(10, 10, 50, 50), ring(20, 20, 40, 40)])


def texts(svg):
    return [element.text for element in ET.fromstring(svg).iter(f"{SVG}text")]


def test_hostile_names_are_text_and_the_document_parses(nested):
    nested.layers = ("<script>alert(1)</script>", "a\x00b\ud800", "]]>&amp;")
    root = ET.fromstring(walls_svg(nested, title='<img onerror="x">'))
    titles = [element.text for element in root.iter(f"{SVG}title")]
    assert "<script>alert(1)</script>" in titles
    assert not list(root.iter(f"{SVG}script"))


@pytest.mark.parametrize(("y_axis", "higher_is"), [("up", -1), ("down", 1)])
def test_the_picture_stands_the_right_way_up(y_axis, higher_is):
    walls = Walls.from_polylines([[(0, 0), (0, 10)]], closed=False)
    walls.y_axis = y_axis
    path = next(p for p in ET.fromstring(walls_svg(walls)).iter(f"{SVG}path") if p.get("class") == "wk-open")
    (_, y0), (_, y1) = [tuple(map(float, pair.split())) for pair in path.get("d").replace("M", "").split("L")]
    assert np.sign(y1 - y0) == higher_is


@pytest.mark.parametrize("y_axis", ["up", "down"])
@pytest.mark.parametrize("bulge", [1.0, -0.4, 0.4, -3.0])
def test_an_arc_is_drawn_through_the_points_of_its_bulge(y_axis, bulge):
    """Against svgpathtools, which knows arcs by SVG's own rules (appendix F.6.5)."""
    svgpathtools = pytest.importorskip("svgpathtools")
    walls = Walls.from_polylines([[(0, 0), (10, 4)]], closed=False, bulges=[[bulge, 0]])
    walls.y_axis = y_axis
    path = next(p for p in ET.fromstring(walls_svg(walls)).iter(f"{SVG}path") if p.get("class") == "wk-open")
    drawn = svgpathtools.parse_path(path.get("d"))[0]
    frame = fit(walls_box(walls), y_axis == "up", width=960, max_height=1100, margin=28)
    # The arc's middle is bulge * chord / 2 to the right of the chord's middle (definition of the sagitta).
    middle = np.array([[5 + bulge * 4 / 2, 2 - bulge * 10 / 2]])
    x, y = frame.points(middle)[0]
    assert abs(drawn.point(0.5) - complex(x, y)) < 0.05  # path data is rounded to 0.01 px, centre ill-placed by that


def test_arc_points_lie_on_one_circle_and_start_at_the_start():
    a, b, bulge = np.array([1.0, 2.0]), np.array([5.0, -1.0]), 0.7
    points = np.vstack([arc_points(a, b, bulge), b])
    chord = np.hypot(*(b - a))
    centre = (a + b) / 2 + (1 - bulge**2) / (4 * bulge) * np.array([-(b - a)[1], (b - a)[0]])
    assert np.allclose(np.hypot(*(points - centre).T), chord * (1 + bulge**2) / (4 * bulge))
    assert np.allclose(points[0], a)


@pytest.mark.parametrize("y_axis", ["up", "down"])
@pytest.mark.parametrize("bulge", [1.0, 0.3, -0.5, -2.0])
def test_ticks_stand_upright_on_an_arc_to_its_outward_side(y_axis, bulge):
    walls = Walls.from_polylines([[(2, 1), (10, 4)]], closed=False, bulges=[[bulge, 0]], sides="outward")
    walls.y_axis = y_axis
    frame = fit(walls_box(walls), y_axis == "up", width=960, max_height=1100, margin=28)
    a, b = walls.vertices
    centre = (a + b) / 2 + (1 - bulge**2) / (4 * bulge) * np.array([-(b - a)[1], (b - a)[0]])
    radius = np.hypot(*(a - centre)) * frame.scale
    ticks = tick_places(walls, frame)
    assert len(ticks) > 3
    for x, y, nx, ny, _ in ticks:
        arm = np.array([x, y]) - frame.points(centre[None, :])[0]
        assert np.hypot(*arm) == pytest.approx(radius)
        # Outward is away from the centre where the arc turns left, and towards it where it turns right.
        assert arm @ (nx, ny) == pytest.approx(np.sign(bulge) * radius)


def test_material_is_where_the_number_of_walls_around_is_odd_unless_a_ball_is_there(nested):
    nowhere = np.empty((0, 2))
    ((_, members, framed),) = solid_areas(nested, nowhere)
    assert (members, framed) == ([0, 1, 2], False)
    ((_, _, framed),) = solid_areas(nested, np.array([[5.0, 5.0]]))
    assert framed
    ((_, _, framed),) = solid_areas(nested, np.array([[15.0, 15.0]]))
    assert not framed


def test_each_material_fills_its_own_walls_and_cuts_its_holes(nested):
    nested.materials = (Material(), Material(0.5, 1), Material(0.25, 1))
    areas = {m.restitution: (members, framed) for m, members, framed in solid_areas(nested, np.empty((0, 2)))}
    assert areas == {1.0: ([0, 1], False), 0.25: ([2], False)}
    assert "restitution 0.25, tangential 1" in texts(walls_svg(nested))


def test_problems_are_numbered_marks_with_a_legend_and_the_rest_is_counted(nested):
    problems = [Problem("gap", "warning", f"Gap {i}", "Join the ends", x=i, y=0) for i in range(75)]
    shown = texts(walls_svg(nested, problems))
    assert shown.count("1") == 2
    assert "Gap 0; Join the ends" in shown
    assert "and 15 more problems, not listed here" in shown


@pytest.mark.parametrize(
    "walls",
    [
        Walls.from_polylines([]),
        Walls.from_polylines([[(3, 3), (3, 3)]]),
        Walls.from_polylines([[(1e9, 1e9), (1e9, 1e9 + 1e-3)]], closed=False),
        Walls.from_polylines([[(0, 0), (1e-300, 0)]], closed=False),
    ],
    ids=["none", "a point", "far and small", "tiny"],
)
def test_degenerate_walls_still_make_a_picture(walls):
    root = ET.fromstring(walls_svg(walls))
    numbers = [float(word) for p in root.iter(f"{SVG}path") for word in re.findall(r"[^MLZ ]+", p.get("d"))]
    assert np.isfinite([*numbers, float(root.get("width")), float(root.get("height"))]).all()


def test_a_drawing_shows_curves_as_they_are_and_hidden_paths_dashed():
    curve = Subpath([("M", 0, 0), ("C", 0, 10, 10, 10, 10, 0), ("A", 5, 2, 30, 0, 1, 0, 0)], closed=True)
    drawing = Drawing("pt", "up", paths=[DrawnPath([curve], fill="#ff0000"), DrawnPath([curve], visible=False)])
    paths = list(ET.fromstring(drawing_svg(drawing)).iter(f"{SVG}path"))
    assert [p.get("class") for p in paths] == ["wk-material0", "wk-outline", "wk-hidden", "wk-scale"]
    assert "C" in paths[0].get("d")
    assert " -30 0 0 " in paths[0].get("d")  # turned over, the rotation and the sweep change sign


def test_vertices_closer_than_the_eye_sees_are_drawn_as_one_and_the_shape_stays():
    turn = np.linspace(0, 2 * np.pi, 100_001)[:-1]
    svg = walls_svg(Walls.from_polylines([np.stack([np.cos(turn), np.sin(turn)], axis=1)]), normals=False)
    path = next(p for p in ET.fromstring(svg).iter(f"{SVG}path") if p.get("class") == "wk-outline")
    points = np.array([pair.split() for pair in path.get("d").strip("MZ").split("L")], dtype=float)
    assert len(points) < 10_000
    radius = np.hypot(*(points - points.mean(axis=0)).T)
    assert np.ptp(radius) < 1.0  # the mean of points that are not evenly spread is off by a part of a pixel
    assert np.hypot(*(points - np.roll(points, -1, axis=0)).T).max() < 2.0
