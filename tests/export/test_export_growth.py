"""Large levels: no format takes more than linear time and memory. Held by a budget, not by a clock.

A ring of 50,000 edges and 1,000 rings are exported in every format by a process that may use 60 s of processor time,
some six times what it needs. A step that grows with the square of the edges (such as appending the points of
a DXF polyline one by one, 14 s for 20,000) cannot keep to it, and the process is stopped.
"""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

pytest.importorskip("resource")

PROGRAM = """
import resource, sys
import numpy as np
import wallkit
from wallkit.export import ExportOptions, export_text, formats

resource.setrlimit(resource.RLIMIT_CPU, (60, 60))
EDGES = 50_000


def circle(count, radius, x=0.0, y=0.0):
    angle = np.linspace(0, 2 * np.pi, count, endpoint=False)
    wave = radius * (1 + 0.3 * np.sin(7 * angle))
    return np.column_stack([x + wave * np.cos(angle), y + wave * np.sin(angle)])


one = wallkit.Walls.from_polylines([circle(EDGES, 5000.0)])
many = wallkit.Walls.from_polylines([circle(10, 10.0, 30 * (k % 32), 30 * (k // 32)) for k in range(1000)])
for walls in (one, many):
    walls.y_axis = "down"
    for each in formats().values():
        if each.name == "dxf" and sys.argv[1] == "without-dxf":
            continue
        text, _ = export_text(walls, each, ExportOptions(scale=1.0, origin="box", max_vertices=8))
        assert len(text) > 10 * len(walls.vertices), each.name
print("done")
"""


def test_large_levels_go_to_every_format_within_a_budget():
    try:
        import ezdxf  # noqa: F401

        word = "all"
    except ImportError:
        word = "without-dxf"
    command = [sys.executable, "-c", PROGRAM, word]
    result = subprocess.run(command, capture_output=True, text=True, timeout=500, env=os.environ)
    assert result.returncode == 0, f"stopped by its budget ({result.returncode}): {result.stderr}"
    assert result.stdout == "done\n"
