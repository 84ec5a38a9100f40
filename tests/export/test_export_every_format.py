"""What holds for every format: odd walls are written, and whatever a format cannot say is told with its count."""

from __future__ import annotations

import numpy as np
import pytest
from levels import problems_of, text_of, three_walls

import wallkit
from wallkit.export import formats, loader_of
from wallkit.walls import Material

OWN = [name for name, each in formats().items() if each.entry_point is None]

# What is told of three one-way walls with names alike, arcs and friction, in numbers that 32 bits cannot hold
TOLD = {
    "tmj": {"arcs-as-lines", "friction", "one-way"},
    "tmx": {"arcs-as-lines", "friction", "one-way"},
    "tscn": {"arcs-as-lines", "friction", "renamed", "rounded"},
    "tscn3": {"arcs-as-lines", "friction", "renamed", "rounded"},
    "planck": {"arcs-as-lines", "friction", "one-way", "user-data", "scale"},
    "rube": {"arcs-as-lines", "friction", "rounded", "scale"},
    "box2d-v3": {"arcs-as-lines", "friction", "one-way", "rounded", "scale"},  # one-way: the open wall
    "box2d-v24": {"arcs-as-lines", "friction", "one-way", "rounded", "scale"},
    "pymunk": {"arcs-as-lines", "friction"},
    "matter": {"arcs-as-lines", "friction", "one-way", "thickened"},
    "phaser": {"arcs-as-lines", "friction", "one-way", "thickened"},
    "rapier": {"arcs-as-lines", "friction", "one-way", "rounded", "scale"},
    "unity": {"arcs-as-lines", "friction", "one-way", "rounded"},
    "dxf": set(),
    "geojson": {"arcs-as-lines", "planar"},
    "wkt": {"arcs-as-lines", "names"},
    "svg": set(),
    "svg-layers": set(),
}


def odd_walls():
    line = [(0.0, 0.0), (3.0, 0.0)]
    yield wallkit.Walls.from_polylines([])
    yield wallkit.Walls.from_polylines([line], True)
    yield wallkit.Walls.from_polylines([[(0.0, 0.0), (0.0, 0.0)]], False)
    yield wallkit.Walls.from_polylines([[(0.0, 0.0), (0.0, 0.0), (0.0, 0.0)]], True)
    yield wallkit.Walls.from_polylines([line], True, bulges=[[1.0, 1.0]])
    yield wallkit.Walls.from_polylines([[*line, (1.0, 1.0)]], names=["half a pair \ud800"], layers=["\0"])


@pytest.mark.parametrize("name", OWN)
def test_odd_walls_are_written(name):
    if name == "dxf":
        pytest.importorskip("ezdxf")
    for walls in odd_walls():
        assert text_of(walls, name).encode()


@pytest.mark.parametrize("name", OWN)
def test_whatever_a_format_cannot_say_is_told(name):
    if name == "dxf":
        pytest.importorskip("ezdxf")
    bulges = [[0.1, 0, 0, 0], None, None]
    kinds = {"names": ["a", "a", ""], "sides": "outward", "material": Material(0.8, 0.9), "bulges": bulges}
    walls = three_walls(**kinds)
    walls.vertices /= 3
    problems = problems_of(walls, name, origin="0,3")
    assert {problem.code.removeprefix("export-") for problem in problems} - {"outside"} == TOLD[name]
    assert all(problem.severity == "info" for problem in problems)
    for problem in problems:
        if problem.code == "export-friction":
            assert problem.message.startswith('3 of 3 walls ("a", "a", ...): ')
            assert (problem.name, problem.x, problem.y) == ("a", 0, 0)
        if problem.code == "export-arcs-as-lines":
            assert problem.message.startswith('1 of 3 walls ("a"): ')


@pytest.mark.parametrize("name", ["rube", "box2d-v3", "box2d-v24"])
def test_one_sided_chains_are_told_for_two_sided_rings(name):
    (problem,) = [problem for problem in problems_of(three_walls(), name) if problem.code == "export-two-sided"]
    assert problem.message.startswith("2 of 3 walls")


def test_every_format_stands_in_the_table_of_tests_and_in_the_docs():
    from pathlib import Path

    docs = (Path(__file__).parents[2] / "docs" / "exports.md").read_text()
    assert set(OWN) == set(TOLD)
    for name in OWN:
        assert f"`{name}`" in docs
    codes = {f"export-{word}" for words in TOLD.values() for word in words}
    problems = (Path(__file__).parents[2] / "docs" / "problems.md").read_text()
    for code in codes | {"export-merged", "export-left-out", "export-outside", "export-material", "export-two-sided"}:
        assert f"`{code}`" in problems


def test_loaders_are_written_beside_the_level(tmp_path):
    for name, each in formats().items():
        if each.loader:
            three_walls().export(tmp_path / f"level{each.endings[0]}")
            assert (tmp_path / each.loader).read_text() == loader_of(each), name
    names = {file.name for file in tmp_path.iterdir()}
    assert {"wallkit-matter.mjs", "wallkit-phaser.mjs", "wallkit-rapier.mjs", "WallkitLevel.cs"} < names


def test_numbers_keep_all_their_digits_in_every_text():
    place = float(np.nextafter(0.1, 1))  # 0.10000000000000002
    walls = wallkit.Walls.from_polylines([[(place, 1 / 3), (5.0, 1.0), (2.0, 4.0)]])
    walls.y_axis = "down"
    for name in OWN:
        if name not in ("tmj", "tmx") and not formats()[name].metres and formats()[name].y_axis == "down":
            assert repr(place) in text_of(walls, name), name
            assert repr(1 / 3) in text_of(walls, name), name
