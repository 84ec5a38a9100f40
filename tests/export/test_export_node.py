"""Levels in engines of the web, run by node: planck, matter.js, Phaser's matter and Rapier."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
from levels import TABLE, Start, node, sample, text_of, three_walls

import wallkit
from wallkit.export import formats, loader_of
from wallkit.walls import Material

SECONDS = 30


def games(names, kind, tmp_path, y_axis, metres, speed):
    """Write the levels and give what the programs of engines take."""
    starts, asked = [], []
    for name in names:
        file = tmp_path / f"{name}.json"
        file.write_text(text_of(sample(name), kind), encoding="utf-8")
        start = Start(sample(name), y_axis, metres)
        starts.append(start)
        place = {"file": str(file), "x": start.x, "y": start.y, "radius": start.radius}
        asked.append(place | {"velocities": start.velocities(speed), "seconds": SECONDS})
    return starts, asked


def loader(kind, tmp_path):
    file = tmp_path / formats()[kind].loader
    file.write_text(loader_of(formats()[kind]), encoding="utf-8")
    return str(file)


def test_planck_reads_every_vertex_and_keeps_all_balls_inside(tmp_path):
    starts, asked = games(TABLE, "planck", tmp_path, "up", True, 6.0)
    results = node("planck.js", asked, "planck")
    for name, start, result in zip(TABLE, starts, results, strict=True):
        assert start.lost(result["places"]) == 0, name
        whole = json.loads((tmp_path / f"{name}.json").read_text())
        shapes = {json.dumps(part["vertices"]) for part in whole if part.get("type") == "chain"}
        for chain in result["chains"]:
            points = chain["points"][:-1] if chain["loop"] else chain["points"]
            assert json.dumps([{"x": x, "y": y} for x, y in np.array(points, dtype=float).tolist()]) in shapes
    by_name = dict(zip(TABLE, results, strict=True))
    assert sorted(chain["count"] for chain in by_name["sinai.svg"]["chains"]) == [
        5,
        89,
    ]  # 4 and 88, and the first again
    named = {chain["userData"]["name"] for chain in by_name["room.svg"]["chains"]}
    assert named == set(sample("room.svg").names)


def test_planck_keeps_names_and_materials(tmp_path):
    names = ["a/b", "", "Wände \N{TENNIS RACQUET AND BALL}"]
    walls = three_walls(names=names, material=Material(0.8, 1.0))
    file = tmp_path / "level.json"
    file.write_text(text_of(walls, "planck"), encoding="utf-8")
    (result,) = node("planck.js", [{"file": str(file), "velocities": [], "seconds": 0}], "planck")
    assert [chain["userData"]["name"] for chain in result["chains"]] == names
    assert {chain["restitution"] for chain in result["chains"]} == {0.8}
    assert [chain["loop"] for chain in result["chains"]] == [True, True, False]


@pytest.mark.parametrize("kind", ["matter", "phaser"])
def test_matter_keeps_all_balls_inside_the_level_where_it_was_drawn(kind, tmp_path):
    package = {"matter": "matter-js", "phaser": "phaser"}[kind]
    starts, asked = games(TABLE, kind, tmp_path, "down", False, 5.0)  # px a step: above 2, or nothing bounces
    results = node("matter.js", {"engine": kind, "loader": loader(kind, tmp_path), "games": asked}, package)
    for name, start, result in zip(TABLE, starts, results, strict=True):
        assert start.lost(result["places"]) == 0, name
        assert result["static"]
        if name in ("room.svg", "pinball.svg"):  # no frame around them
            area = sum(poly.area for poly in sample(name).to_shapely().geoms[0].geoms)
            # open walls are thickened; they overlap nothing, so the material is all the rest
            assert result["area"] > area
            x, y, _, _ = sample(name).box()
            assert result["low"] == pytest.approx([x, y], abs=1e-6)


@pytest.mark.parametrize("kind", ["matter", "phaser"])
def test_the_loader_sets_the_restitution_that_matter_forgets(kind, tmp_path):
    package = {"matter": "matter-js", "phaser": "phaser"}[kind]
    walls = replace(three_walls(material=Material(0.8, 1.0)), y_axis="down")
    file = tmp_path / "level.json"
    file.write_text(text_of(walls, kind, thickness=0.1), encoding="utf-8")
    game = {"file": str(file), "velocities": [], "seconds": 0}
    (result,) = node("matter.js", {"engine": kind, "loader": loader(kind, tmp_path), "games": [game]}, package)
    assert result["restitution"] == [0.8]
    assert result["friction"] == [0]
    # the square less the triangle, and the corner of length 4, 0.1 wide: 0.4 with its mitre
    assert result["area"] == pytest.approx(48 - 2 + 0.4, rel=1e-9)
    assert result["low"] == pytest.approx([0, 0], abs=1e-9)


def test_rapier_keeps_all_balls_inside_and_takes_the_walls_restitution_alone(tmp_path):
    starts, asked = games(TABLE, "rapier", tmp_path, "up", True, 6.0)
    square = [(0.0, 0.0), (9.0, 0.0), (9.0, 9.0), (0.0, 9.0)]
    walls = wallkit.Walls.from_polylines([square], material=Material(0.8, 1.0))
    (tmp_path / "square.json").write_text(text_of(walls, "rapier", scale=1.0), encoding="utf-8")
    place = {"file": str(tmp_path / "square.json"), "x": 4.5, "y": 4.5, "radius": 0.5}
    once = place | {"velocities": [[4.0, 0.0]], "seconds": 1.5}
    games_of_all = {"loader": loader("rapier", tmp_path), "games": [*asked, once]}
    results = node("rapier.js", games_of_all, "@dimforge/rapier2d-compat")
    for name, start, result in zip(TABLE, starts, results, strict=False):
        assert start.lost(result["places"]) == 0, name
        assert sum(result["segments"]) == TABLE[name][2], name
    assert results[-1]["speeds"] == pytest.approx([3.2], rel=1e-3)  # one bounce, in 32-bit numbers
