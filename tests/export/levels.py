"""Walls for the tests of exports: the samples as the table of acceptance has them, and small ones made by hand."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import wallkit
from wallkit.export import ExportOptions, export_text, formats

SAMPLES = Path(__file__).parents[2] / "samples"
ROOMS = ("sinai.svg", "mushroom.svg", "stadium.svg")  # imported as arenas
# walls, open walls, edges as lines, and the area of the material, or of the room, by the shoelace formula
TABLE = {
    "room.svg": (16, 1, 330, 160692.53337222902),
    "sinai.svg": (2, 0, 92, 289374.20863276),
    "lagoon.ai": (9, 1, 390, 209596.3292436076),
    "mushroom.svg": (1, 0, 67, 176511.18106000853),
    "pinball.svg": (18, 2, 343, 92766.46161488384),
    "stadium.svg": (1, 0, 102, 285581.03905862686),
}
_WALLS = {}


def sample(name, curves="lines"):
    if (name, curves) not in _WALLS:
        _WALLS[name, curves] = wallkit.import_walls(SAMPLES / name, arena=name in ROOMS, curves=curves)
    return _WALLS[name, curves]


def text_of(walls, name, **options):
    return export_text(walls, formats()[name], ExportOptions(**options))[0]


def problems_of(walls, name, **options):
    return export_text(walls, formats()[name], ExportOptions(**options))[1]


def rings_area(polygons):
    """Even-odd area of rings that are nested and do not cross: the sum with the sign of their depth."""
    import shapely

    rings = [shapely.Polygon(points) for points in polygons]
    inside = [sum(other.contains(ring) for other in rings if other is not ring) for ring in rings]
    return sum((-1) ** depth * ring.area for ring, depth in zip(rings, inside, strict=True))


def three_walls(**kinds):
    """A square, a triangle inside it and an open corner."""
    square = [(0.0, 0.0), (8.0, 0.0), (8.0, 6.0), (0.0, 6.0)]
    triangle = [(2.0, 2.0), (2.0, 4.0), (4.0, 2.0)]
    corner = [(5.0, 1.0), (7.0, 1.0), (7.0, 3.0)]
    walls = wallkit.Walls.from_polylines([square, triangle, corner], [True, True, False], **kinds)
    walls.depth[:] = 0, 1, 1
    return walls


def run(command, **kwargs):
    """Run another program; its words are shown when it fails."""
    result = subprocess.run(command, capture_output=True, text=True, timeout=120, **kwargs)
    assert result.returncode == 0, result.stdout + result.stderr
    return result.stdout


def program(*names):
    """The first of these programs that is installed, else the test is skipped."""
    for name in names:
        if shutil.which(name):
            return shutil.which(name)
    pytest.skip(f"{' or '.join(names)} is not installed")
    return None


def node(script, argument, needs):
    """Run a program of tests/export/engines that prints JSON; skipped without node or the package that it needs."""
    command = program("node")
    found = subprocess.run([command, "-e", f"require.resolve({needs!r})"], capture_output=True, timeout=60)
    if found.returncode:
        pytest.skip(f"node does not find the package {needs} (npm install it; NODE_PATH names the folder)")
    file = Path(__file__).parent / "engines" / script
    return json.loads(run([command, str(file), json.dumps(argument)], env=os.environ))


def wallkit_command(*arguments, **kwargs):
    return subprocess.run(
        [sys.executable, "-m", "wallkit", *map(str, arguments)],
        capture_output=True,
        text=True,
        timeout=120,
        env=os.environ | {"NO_COLOR": "1"},
        **kwargs,
    )


def same_points(read, wall):
    """What was read is the wall's vertices, to the bit."""
    return np.array_equal(np.asarray(read, dtype=float), wall.vertices)


class Start:
    """A place for a ball inside a level, six directions, and the question whether a ball has got out.

    The place is the roomiest spot of the same walls as placed; a ball is lost when its centre is not in the face of
    free space that it started in. The ball has a twentieth of the room, so that it comes through every passage.
    """

    def __init__(self, walls, y_axis, metres, **options):
        from wallkit.export import build_level
        from wallkit.scene.starting_places import roomiest

        level = build_level(walls, ExportOptions(**options), y_axis=y_axis, metres=metres)
        placed = wallkit.Walls.from_polylines([w.vertices for w in level], [w.closed for w in level])
        placed.depth = walls.depth
        spot = roomiest(placed)
        self.x, self.y, self.radius, self.face = spot.x, spot.y, spot.room / 20, spot.face
        self.angles = [0.3 + k * np.pi / 3 for k in range(6)]

    def velocities(self, speed):
        return [(speed * float(np.cos(angle)), speed * float(np.sin(angle))) for angle in self.angles]

    def lost(self, places):
        import shapely

        assert len(places) == len(self.angles)
        assert np.isfinite(places).all()
        return int((~shapely.contains_xy(self.face, *np.asarray(places, dtype=float).T)).sum())
