"""`wallkit check --audit`: walls against the drawn curves as svgpathtools has them."""

import json

import numpy as np
import pytest
import svgpathtools

import wallkit
from wallkit import ImportOptions
from wallkit.geometry.bulge_arcs import arc_points, edge_points
from wallkit.walls.checking.audit import audit, nearest_distances, random_places

CURVY = (
    '<svg xmlns="http://www.w3.org/2000/svg"><path d="M 10 10 C 90 -40 140 120 60 90 Q 0 70 10 10 Z"/>'
    '<ellipse cx="160" cy="60" rx="30" ry="12" transform="rotate(25 160 60)"/><path d="M 200 0 H 260 V 70 Z"/></svg>'
)
CIRCLE = '<svg xmlns="http://www.w3.org/2000/svg"><circle cx="50" cy="40" r="30"/></svg>'


@pytest.mark.parametrize(
    "options",
    [
        ImportOptions(),
        ImportOptions(curves="arcs"),
        ImportOptions(curves="arcs", tolerance=1e-4),
        ImportOptions(tolerance=3.0),
        ImportOptions(scale=0.5, flip_y=True),
        ImportOptions(grid=0.25),
    ],
    ids=lambda options: ",".join(f"{key}={value}" for key, value in options.said(ImportOptions()).items()) or "usual",
)
def test_every_point_of_the_walls_is_as_near_to_the_curves_as_was_measured(options):
    drawing = wallkit.read_drawing_text(CURVY)
    walls = wallkit.import_walls(drawing, options)
    found = audit(walls, drawing, 300, options)
    assert len(found.places) == 300
    assert len(found.beyond) == 0
    assert 0.2 * walls.measured_error < found.largest <= walls.measured_error * 1.001


@pytest.mark.parametrize("off", [0.2, 30.0])
def test_a_wall_that_is_elsewhere_is_told_with_its_place(off):
    drawing, options = wallkit.read_drawing_text(CIRCLE), ImportOptions(curves="arcs")
    walls = wallkit.import_walls(drawing, options)
    walls.vertices = walls.vertices + np.array([off, 0.0])
    found = audit(walls, drawing, 200, options)
    radius = np.hypot(*(found.places - [50, 40]).T)  # of the true circle: 30
    assert found.beyond.tolist() == np.flatnonzero(abs(radius - 30) > found.allowed).tolist()
    (first, *_) = found.problems()
    assert (first.code, first.x, first.y) == ("off-the-curve", *found.places[found.beyond[0]])


def test_distances_are_those_of_a_circle_and_a_line():
    arc = svgpathtools.Arc(5 + 0j, 5 + 5j, 0, False, True, -5 + 0j)
    line = svgpathtools.Line(-5 - 9j, 5 - 9j)
    places = np.array([[0.0, 4.0], [3.0, 4.0], [1.0, -8.5], [0.0, -4.0]])
    assert nearest_distances([arc, line], places, 2.0) == pytest.approx([1.0, 0.0, 0.5, np.inf], abs=1e-12)


def test_places_on_edges_are_those_of_the_arc_by_its_centre():
    rng = np.random.default_rng(3)
    bulges = np.array([0.0, 1e-9, 0.2, -0.7, 1.0, -2.5])
    a, b = rng.uniform(-9, 9, (2, len(bulges), 2))
    for start, end, bulge in zip(a, b, bulges, strict=True):
        exact = arc_points(start, end, bulge, step=abs(4 * np.arctan(bulge)) / 8 or 1.0)
        parts = np.arange(len(exact)) / len(exact)
        row = np.ones(len(parts))
        got = edge_points(row[:, None] * start, row[:, None] * end, row * bulge, parts)
        assert got == pytest.approx(exact, abs=1e-6 if abs(bulge) == 1e-9 else 1e-12)  # a centre 1e10 away


def test_points_are_spread_by_length_arcs_included():
    """Half circle over a side of 10: pi / 2 of the length of a side."""
    walls = wallkit.Walls.from_polylines([[[0, 0], [10, 0], [10, 10], [0, 10]]], bulges=[[1.0, 0, 0, 0]])
    places, owners = random_places(walls, 4000)
    on_arc = np.count_nonzero(np.abs(np.hypot(*(places - [5, 0]).T) - 5) < 1e-9)
    share = (np.pi / 2) / (np.pi / 2 + 3)
    assert on_arc == pytest.approx(4000 * share, abs=4 * np.sqrt(4000 * share * (1 - share)))
    assert not owners.any()


def test_the_command_says_it_in_a_line_and_in_json(said, tmp_path):
    file = tmp_path / "curvy.svg"
    file.write_text(CURVY)
    _, out, _ = said("check", file, "--audit", 50)
    assert "audit: 50 points of the walls are within " in out
    _, out, _ = said("check", file, "--audit", 50, "--json")
    told = json.loads(out)["audit"]
    assert (told["points"], told["beyond"]) == (50, 0)
    assert told["largest"] <= told["measured_error"] * 1.001


def test_walls_without_a_drawing_and_outlines_of_strokes_are_no_matter_for_an_audit(said, tmp_path):
    file, walls = tmp_path / "curvy.svg", tmp_path / "walls.json"
    file.write_text(CURVY)
    wallkit.import_walls(file).save(walls)
    for words in ((walls,), (file, "--outline-strokes")):
        code, _, err = said("check", *words, "--audit", 5)
        assert code == 2
        assert "--audit" in err
