"""GeoJSON, well-known text, SVG and convex pieces, read by shapely, geojson and wallkit's own reader of SVG."""

from __future__ import annotations

import io
import json
from importlib.resources import files

import jsonschema
import numpy as np
import pytest
import shapely
from levels import TABLE, problems_of, sample, text_of, three_walls

import wallkit
from wallkit.export import ExportOptions, build_level
from wallkit.export.convex import convex_pieces, solids_of
from wallkit.walls import Material


@pytest.mark.parametrize("name", TABLE)
def test_shapely_reads_well_known_text_to_the_bit(name):
    walls = sample(name)
    material, lines = shapely.from_wkt(text_of(walls, "wkt")).geoms
    assert material.is_valid
    assert material.area == pytest.approx(TABLE[name][3], rel=1e-9)
    assert len(lines.geoms) == TABLE[name][1]
    level = build_level(walls, ExportOptions(), y_axis="up")
    ours = {tuple(point) for wall in level for point in wall.vertices.tolist()}
    assert {tuple(point) for point in shapely.get_coordinates([material, lines]).tolist()} == ours


@pytest.mark.parametrize("name", TABLE)
def test_geojson_holds_the_material_and_every_wall(name):
    text = text_of(sample(name), "geojson")
    geojson = pytest.importorskip("geojson")
    whole = geojson.loads(text)
    assert whole.errors() == []
    kinds = [feature["properties"]["kind"] for feature in whole["features"]]
    count, still_open, _, area = TABLE[name]
    assert (kinds.count("ring"), kinds.count("line")) == (count - still_open, still_open)
    areas = [
        feature for feature in json.loads(text)["features"] if feature["properties"]["kind"] in ("material", "room")
    ]
    shapes = [shapely.from_geojson(json.dumps(feature["geometry"])) for feature in areas]
    assert sum(shape.area for shape in shapes) == pytest.approx(area, rel=1e-9)
    assert all(shape.exterior.is_ccw and not any(hole.is_ccw for hole in shape.interiors) for shape in shapes)


def test_rings_that_cross_are_taken_even_odd():
    walls = wallkit.Walls.from_polylines([[(0, 0), (4, 0), (4, 4), (0, 4)], [(2, 2), (6, 2), (6, 6), (2, 6)]])
    material, _ = shapely.from_wkt(text_of(walls, "wkt")).geoms
    assert material.is_valid
    assert material.area == 16 + 16 - 2 * 4


@pytest.mark.parametrize("format", ["svg", "svg-layers"])
@pytest.mark.parametrize("curves", ["lines", "arcs"])
@pytest.mark.parametrize("name", TABLE)
def test_svg_reads_back_to_the_same_walls(name, curves, format):
    walls = sample(name, curves)
    again = wallkit.import_walls(
        io.BytesIO(text_of(walls, format).encode()),
        tolerance=walls.tolerance,
        curves=curves,
        arena=bool(walls.depth[0]),
    )
    level = build_level(walls, ExportOptions(), y_axis="down", arcs=True)
    order = sorted(level, key=lambda wall: walls.layers.index(wall.layer)) if format == "svg-layers" else level.walls
    assert len(again) == len(walls)
    for one, wall in zip(again, order, strict=True):
        assert np.array_equal(one.vertices, wall.vertices)
        # a bulge goes through the radius r = c (1 + b^2) / (4 |b|), which is flat about the half circle b = 1: there
        # an error e of r becomes one of sqrt(2 e) of b
        assert np.abs(one.bulges - wall.bulges).max() <= (1e-14 if np.abs(wall.bulges).max() < 0.9 else 1e-7)
        assert one.depth == wall.depth


def test_svg_keeps_names_layers_and_materials():
    from lxml import etree

    names, layers = ["a/b", 'Wände <"&>', "\x07bell"], ["one", "two & 2", "one"]
    walls = three_walls(names=names, layers=layers, material=Material(0.8, 1.0), sides=["outward", "both", "both"])
    root = etree.fromstring(text_of(walls, "svg-layers").encode())
    label = "{http://www.inkscape.org/namespaces/inkscape}label"
    assert [group.get(label) for group in root] == ["one", "two & 2"]
    paths = [path for group in root for path in group]
    assert [path.get("data-name") for path in paths] == ["a/b", "_bell", 'Wände <"&>']
    assert [path.get("data-sides") for path in paths] == ["outward", None, None]
    assert {path.get("data-restitution") for path in paths} == {"0.8"}
    (problem,) = problems_of(walls, "svg-layers")
    assert (problem.code, problem.name) == ("export-renamed", "\x07bell")


def check_pieces(pieces, most):
    for piece in pieces:
        assert 3 <= len(piece) <= most
        a, b = np.roll(piece, -1, axis=0) - piece, np.roll(piece, -2, axis=0) - np.roll(piece, -1, axis=0)
        assert (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0] > 0).all()  # strictly convex, counter-clockwise


@pytest.mark.parametrize("most", [3, 5, 8])
@pytest.mark.parametrize("name", TABLE)
def test_convex_pieces_cover_the_material_and_nothing_twice(name, most):
    level = build_level(sample(name), ExportOptions(max_vertices=most), y_axis="down")
    pieces = [piece for solid in solids_of(level) if solid.wall.closed for piece in solid.pieces]
    check_pieces(pieces, most)
    shapes = shapely.polygons([shapely.linearrings(piece) for piece in pieces])
    area = float(shapely.area(shapes).sum())
    if level.is_room:
        x_min, y_min, x_max, y_max = level.box
        around = 0.2 * level.side
        area = (x_max - x_min + around) * (y_max - y_min + around) - area
    assert area == pytest.approx(TABLE[name][3], rel=1e-9)
    assert float(shapely.area(shapely.union_all(shapes))) == pytest.approx(float(shapely.area(shapes).sum()), rel=1e-9)


def test_many_vertices_in_one_polygon_are_cut_in_halves_first():
    angle = np.linspace(0, 2 * np.pi, 5000, endpoint=False)
    radius = 100 * (1 + 0.3 * np.sin(7 * angle))
    star = shapely.Polygon(np.column_stack([radius * np.cos(angle), radius * np.sin(angle)]))
    (pieces,) = convex_pieces([star], 8)
    check_pieces(pieces, 8)
    assert sum(shapely.Polygon(piece).area for piece in pieces) == pytest.approx(star.area, rel=1e-12)


def test_a_square_with_a_hole_loses_no_area_to_its_hole():
    # matter's own fromVertices gives such a keyhole 7200 instead of 9600
    square, hole = [(0, 0), (100, 0), (100, 100), (0, 100)], [(40, 40), (40, 60), (60, 60), (60, 40)]
    walls = wallkit.Walls.from_polylines([square, hole])
    walls.depth[:] = 0, 1
    (solid,) = solids_of(build_level(walls, ExportOptions()))
    assert sum(shapely.Polygon(piece).area for piece in solid.pieces) == 9600
    assert len(solid.pieces) == 4  # the fewest that are possible


def test_holes_of_another_material_are_told():
    walls = three_walls(material=[Material(0.5, 1.0), Material(0.8, 1.0), Material(0.5, 1.0)])
    codes = [problem.code for problem in problems_of(walls, "matter")]
    assert codes == ["export-material", "export-thickened"]


@pytest.mark.parametrize("kind", ["matter", "rapier", "unity"])
def test_the_plain_json_fits_its_schema(kind):
    schema = json.loads((files("wallkit.schemas") / "level.schema.json").read_text())
    for name, curves in (("room.svg", "lines"), ("sinai.svg", "arcs")):
        jsonschema.validate(json.loads(text_of(sample(name, curves), kind)), schema)


@pytest.mark.parametrize("name", ["room.svg", "sinai.svg"])
def test_unity_gets_every_vertex(name):
    walls = sample(name)
    level = build_level(walls, ExportOptions(), y_axis="up")
    for entry, wall in zip(json.loads(text_of(walls, "unity"))["walls"], level, strict=True):
        assert np.array_equal([(point["x"], point["y"]) for point in entry["points"]], wall.vertices)
