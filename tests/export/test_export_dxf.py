"""DXF read by ezdxf: every vertex and bulge to the bit, names and materials in the extended data."""

from __future__ import annotations

import builtins
import io
import math
import sys
from dataclasses import replace

import numpy as np
import pytest
from levels import TABLE, problems_of, sample, text_of, three_walls

import wallkit
from wallkit.export import ExportError, ExportOptions, build_level
from wallkit.export.level import signed_areas_of
from wallkit.walls import Material


def read(text):
    ezdxf = pytest.importorskip("ezdxf")
    document = ezdxf.read(io.StringIO(text))
    assert document.audit().errors == []
    return document, list(document.modelspace().query("LWPOLYLINE"))


def notes(line):
    """The words and numbers that we attached, by name."""
    found, key = {}, ""
    for code, value in line.get_xdata("WALLKIT"):
        if code == 1000 and "=" in value and not key:
            name, _, rest = value.partition("=")
            found[name] = rest
        elif code == 1000 and "+" in value:
            name, _, rest = value.partition("+")
            found[name] += rest
        elif code == 1000:
            key = value
        elif code == 1040:
            found[key], key = value, ""
    return found


@pytest.mark.parametrize("curves", ["lines", "arcs"])
@pytest.mark.parametrize("name", TABLE)
def test_ezdxf_reads_every_bit_of_vertices_and_bulges(name, curves):
    walls = sample(name, curves)
    _, lines = read(text_of(walls, "dxf"))
    level = build_level(walls, ExportOptions(), y_axis="up", arcs=True)
    assert len(lines) == len(walls)
    for line, wall in zip(lines, level, strict=True):
        assert line.closed == wall.closed
        corners = np.array([(x, y, bulge) for x, y, _, _, bulge in line.get_points()])
        assert np.abs(corners[:, 2]).max() <= 1
        if np.abs(wall.bulges).max() <= 1:
            assert np.array_equal(corners, np.column_stack([wall.vertices, wall.bulges]))
    if curves == "lines":
        area = sum(signed_areas_of([wall for wall in level if wall.closed]))
        assert abs(area) == pytest.approx(TABLE[name][3], rel=1e-9)


def test_an_arc_of_more_than_half_a_circle_is_cut_in_two_for_gdal():
    # From (0, 0) to (10, 0) with bulge 3: angle 4 atan 3 = 4.996 rad, radius 10 (1 + 9) / 12 = 8.333, length 41.64
    walls = wallkit.Walls.from_polylines([[(0.0, 0.0), (10.0, 0.0)]], False, bulges=[[3.0, 0.0]])
    _, (line,) = read(text_of(walls, "dxf"))
    corners = np.array([(x, y, bulge) for x, y, _, _, bulge in line.get_points()])
    assert len(corners) == 3
    assert corners[:, 2] == pytest.approx([math.tan(math.atan(3) / 2)] * 2 + [0], rel=1e-15)
    chord = np.hypot(*np.diff(corners[:, :2], axis=0).T)
    angle = 4 * np.arctan(corners[:2, 2])
    length = (chord / 2 / np.sin(angle / 2) * angle).sum()
    assert length == pytest.approx(4 * math.atan(3) * 10 * 10 / 12, rel=1e-14)
    assert corners[1, :2] == pytest.approx([5, -15], rel=1e-14)  # 5 + 3 * 5 below: it bows to the right


def test_names_layers_and_materials_are_kept_where_dxf_forbids_them():
    names = ["a/b", "Wände\nzwei", "\N{TENNIS RACQUET AND BALL}" * 100]
    layers = ["a:b", "a*b", "A_B"]
    walls = three_walls(names=names, layers=layers, sides=["outward", "both", "both"], material=Material(0.8, 0.9))
    document, lines = read(text_of(walls, "dxf"))
    assert [notes(line)["name"] for line in lines] == [names[0], "Wände_zwei", names[2]]
    assert [notes(line)["layer"] for line in lines] == layers
    assert [notes(line)["sides"] for line in lines] == ["outward", "both", "both"]
    assert {notes(line)["restitution"] for line in lines} == {0.8}
    assert {notes(line)["tangential_restitution"] for line in lines} == {0.9}
    assert [line.dxf.layer for line in lines] == ["a_b", "a_b 2", "A_B 3"]
    assert all(line.dxf.layer in document.layers for line in lines)
    assert [problem.message[:12] for problem in problems_of(walls, "dxf")] == ["3 of 3 walls"]


def test_millimetres_are_said_to_be_millimetres():
    document, _ = read(text_of(replace(three_walls(), units="mm"), "dxf"))
    assert document.header["$INSUNITS"] == 4
    document, _ = read(text_of(replace(three_walls(), units="mm"), "dxf", scale=2.0))
    assert document.header["$INSUNITS"] == 0


def test_without_ezdxf_the_command_to_install_it_is_named(monkeypatch, tmp_path):
    for name in [name for name in sys.modules if name.partition(".")[0] == "ezdxf"]:
        monkeypatch.delitem(sys.modules, name)
    importing = builtins.__import__

    def without_ezdxf(name, *arguments, **keywords):
        if name.partition(".")[0] == "ezdxf":
            raise ImportError(name)
        return importing(name, *arguments, **keywords)

    monkeypatch.setattr(builtins, "__import__", without_ezdxf)
    with pytest.raises(ExportError, match=r"pip install 'wallkit\[dxf\]'"):
        three_walls().export(tmp_path / "level.dxf")
    assert not (tmp_path / "level.dxf").exists()
