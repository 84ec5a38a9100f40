"""Tiled maps read by programs that are not ours: pytiled-parser, PyTMX and Tiled itself."""

from __future__ import annotations

import json
import os

import numpy as np
import pytest
from levels import TABLE, program, rings_area, run, sample, text_of, three_walls

from wallkit.walls import Material

# The object stands at the wall's first vertex and the points are relative to it, as Tiled draws them. Adding the two
# rounds once, to half an ulp of a coordinate below 1024: 5.7e-14.
ROUNDING = 5.7e-14


def absolute(one):
    return np.array([(one.coordinates.x + x, one.coordinates.y + y) for x, y in one.points])


def read_by_pytiled(text, ending, tmp_path):
    pytiled_parser = pytest.importorskip("pytiled_parser")
    file = tmp_path / f"level{ending}"
    file.write_text(text, encoding="utf-8")
    parsed = pytiled_parser.parse_map(file)
    return parsed, [one for layer in parsed.layers for one in layer.tiled_objects]


@pytest.mark.parametrize("ending", [".tmj", ".tmx"])
@pytest.mark.parametrize("name", TABLE)
def test_pytiled_parser_reads_all_walls_with_the_area_of_the_drawing(name, ending, tmp_path):
    walls, (count, still_open, edges, area) = sample(name), TABLE[name]
    _, objects = read_by_pytiled(text_of(walls, ending[1:]), ending, tmp_path)
    kinds = [type(one).__name__ for one in objects]
    assert (kinds.count("Polygon"), kinds.count("Polyline")) == (count - still_open, still_open)
    assert sum(len(one.points) for one in objects) - still_open == edges
    rings = [absolute(one) for one in objects if type(one).__name__ == "Polygon"]
    assert rings_area(rings) == pytest.approx(area, rel=1e-9)
    if walls.y_axis == "down":  # nothing is mirrored or moved
        for one, wall in zip(objects, sorted(walls, key=lambda wall: walls.layers.index(wall.layer)), strict=True):
            assert np.abs(absolute(one) - wall.vertices).max() <= ROUNDING


@pytest.mark.parametrize("name", ["room.svg", "mushroom.svg", "pinball.svg", "stadium.svg"])
def test_pytmx_reads_every_bit_of_the_vertices(name, tmp_path):
    pytmx = pytest.importorskip("pytmx")
    walls = sample(name)
    (tmp_path / "level.tmx").write_text(text_of(walls, "tmx"), encoding="utf-8")
    objects = list(pytmx.TiledMap(str(tmp_path / "level.tmx")).objects)
    for one, wall in zip(objects, sorted(walls, key=lambda wall: walls.layers.index(wall.layer)), strict=True):
        assert np.array_equal([(point.x, point.y) for point in one.points], wall.vertices)
        assert one.closed == wall.closed
        assert one.properties["restitution"] == wall.material.restitution


@pytest.mark.parametrize("ending", ["tmj", "tmx"])
@pytest.mark.parametrize("name", ["room.svg", "lagoon.ai"])
def test_tiled_itself_opens_the_map_and_writes_the_same_numbers(name, ending, tmp_path):
    tiled = program("tiled")
    file, out = tmp_path / f"level.{ending}", tmp_path / "out.json"
    file.write_text(text_of(sample(name), ending), encoding="utf-8")
    run([tiled, "--export-map", "json", str(file), str(out)], env=os.environ | {"QT_QPA_PLATFORM": "offscreen"})
    ours = json.loads(text_of(sample(name), "tmj"))
    theirs = json.loads(out.read_text())
    for mine, other in zip(
        (one for layer in ours["layers"] for one in layer["objects"]),
        (one for layer in theirs["layers"] for one in layer["objects"]),
        strict=True,
    ):
        shape = "polygon" if "polygon" in mine else "polyline"
        ours_at, theirs_at = ([(o["x"] + p["x"], o["y"] + p["y"]) for p in o[shape]] for o in (mine, other))
        # Tiled's JSON has 15 digits: half a unit of the last of a number below 1000 is 5e-13, and there are two
        assert np.abs(np.subtract(ours_at, theirs_at)).max() <= 1e-12
        assert (mine["name"], mine["type"]) == (other["name"], other["type"])
        assert {p["name"]: p["value"] for p in mine["properties"]} == {
            p["name"]: p["value"] for p in other["properties"]
        }


@pytest.mark.parametrize("ending", [".tmj", ".tmx"])
def test_names_alike_empty_and_strange_survive_with_material_and_one_way(ending, tmp_path):
    names = ["cabinet", "cabinet", ""]
    strange = ["a/b", 'Wände <"&>', "\N{TENNIS RACQUET AND BALL}"]
    for given in (names, strange):
        walls = three_walls(names=given, material=Material(0.8, 0.9), sides=["outward", "both", "both"])
        _, objects = read_by_pytiled(text_of(walls, ending[1:]), ending, tmp_path)
        assert [one.name for one in objects] == given
        assert [one.properties["one_way"] for one in objects] == [True, False, False]
        assert {one.properties["restitution"] for one in objects} == {0.8}
        assert {one.properties["tangential_restitution"] for one in objects} == {0.9}


def test_arcs_become_lines_and_are_kept_as_a_property(tmp_path):
    walls = sample("sinai.svg", "arcs")
    _, objects = read_by_pytiled(text_of(walls, "tmj"), ".tmj", tmp_path)
    pillar = next(one for one in objects if one.name == "pillar")
    kept = np.array([[float(number) for number in corner.split(",")] for corner in pillar.properties["arcs"].split()])
    wall = next(wall for wall in walls if wall.name == "pillar")
    assert np.array_equal(kept, np.column_stack([wall.vertices, wall.bulges]))
    distance = np.hypot(*(absolute(pillar) - absolute(pillar).mean(axis=0)).T)
    assert distance == pytest.approx(distance[0], abs=1e-9)  # all on the circle
