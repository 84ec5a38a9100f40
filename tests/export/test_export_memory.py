"""Exports take little memory: the text of a level never stands there whole, and what is made on the way is small.

Counted where Python and numpy get their memory, so that the figure is the same on every machine. What
GEOS takes is not seen by it; `benchmarks/export_speed.py` measures the whole process.
"""

import io
import tracemalloc

import numpy as np
import pytest

import wallkit
from wallkit.export import ExportOptions, formats, write_to
from wallkit.export.pieces import Pieces

EDGES = 20_000


class Counted(io.TextIOBase):
    """Forgets what is written and keeps how much, and the longest part."""

    def __init__(self):
        self.size = self.longest = 0

    def write(self, text):
        self.size += len(text)
        self.longest = max(self.longest, len(text))
        return len(text)


def ring(edges):
    angle = np.linspace(0, 2 * np.pi, edges, endpoint=False)
    wave = 5000 * (1 + 0.3 * np.sin(7 * angle))
    walls = wallkit.Walls.from_polylines([np.column_stack([wave * np.cos(angle), wave * np.sin(angle)])])
    walls.y_axis = "down"  # so that formats with y up mirror it
    return walls


@pytest.mark.parametrize("name", [name for name, each in formats().items() if each.entry_point is None])
def test_an_export_takes_less_than_twice_the_walls_and_the_text(name):
    if name == "dxf":
        pytest.importorskip("ezdxf")
    chosen, options, stream = formats()[name], ExportOptions(origin="box", scale=1.0), Counted()
    write_to(Counted(), ring(100), chosen, options)  # imports what it needs
    walls = ring(EDGES)
    arrays = sum(array.nbytes for array in (walls.vertices, walls.bulges, walls.offsets, walls.depth, walls.closed))
    tracemalloc.start()
    try:
        write_to(stream, walls, chosen, options)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert stream.size > 10 * EDGES
    assert stream.longest < stream.size / 3
    # blocks of 2,048 rows and batches of 5,000 corners do not grow with the level, and weigh in such a small one
    assert peak < 2 * (arrays + stream.size) + 5e6


def test_pieces_are_polygons_in_two_arrays():
    pieces = Pieces(np.array([[0, 0], [1, 0], [0, 1], [5, 5], [6, 5], [6, 6], [5, 6.0]]), np.array([0, 3, 7]))
    assert [piece.tolist() for piece in pieces.turned()] == [piece[::-1].tolist() for piece in pieces]
    assert [len(block) for block in Pieces.joined([pieces, pieces]).blocks(3)] == [3, 1]
    assert [piece.tolist() for piece in Pieces.joined([pieces, pieces]).cut(1, 3)] == [
        pieces.vertices[3:].tolist(),
        pieces.vertices[:3].tolist(),
    ]
    assert len(Pieces.joined([])) == 0
