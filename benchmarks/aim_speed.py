"""Speed of `aim` by unfolding, in beams a second and thread, and how it grows with walls that are not seen.

    python benchmarks/aim_speed.py

Beams are windows on one wall after k bounces, counted at all depths up to K; making the triangles is not counted, and
compiling is not. Processor time of one thread, the best of some turns. The second table puts a box with many small
obstacles behind a wall beside the room: beams from the room see none of them.
"""

from __future__ import annotations

import time

import numpy as np

import wallkit
from wallkit.kernels.beams.beams import DONE, split_beams
from wallkit.kernels.beams.wedges import Target
from wallkit.kernels.jit import compiled
from wallkit.levels import unfolding
from wallkit.levels.obstacles import obstacles_of

START, TARGET = (720.0, 345.0), (297.0, 523.0, 10.0)
TURNS, ROWS = 7, 1 << 18
FLOOR = 3e6
"""Beams a second and thread in room.svg that are promised."""


def beams_per_second(walls: wallkit.Walls, bounces: int) -> tuple[int, float]:
    """Beams of one aim, and how many a second."""
    found = obstacles_of(walls, 0.0)
    mesh, noded = unfolding._mesh(found, START, TARGET)
    room = unfolding._room(mesh, noded, found, START)
    target = Target(TARGET[0] - START[0], TARGET[1] - START[1], TARGET[2])
    best = np.inf
    for _ in range(TURNS):
        work = unfolding._found(room, unfolding._first_wedges(mesh, room, START), bounces)
        work = work._replace(borders=np.zeros((ROWS, 4)), words=np.zeros((ROWS, bounces + 2), dtype=np.int64))
        begun = time.process_time()
        assert compiled(split_beams)(room, target, bounces, work, 10**12) == DONE
        best = min(best, time.process_time() - begun)
        count = int(work.counts[2:].sum())
    return count, count / best


def with_hidden(walls: wallkit.Walls, side: int) -> wallkit.Walls:
    """The room, and side x side squares in a box beyond its walls."""
    x, y = (grid.ravel() for grid in np.meshgrid(np.arange(side), np.arange(side)))
    corner = np.stack([x, y], axis=1) * 1000.0 / side + (2000.0, 0.0)
    square = np.array([(0, 0), (1, 0), (1, 1), (0, 1)]) * 500.0 / side
    hidden = [c + square for c in corner]
    box = np.array([(1990, -10), (1990, 1010), (3010, 1010), (3010, -10)], dtype=float)
    rings = [walls.vertices[a:b] for a, b in zip(walls.offsets[:-1], walls.offsets[1:], strict=True)]
    return wallkit.Walls.from_polylines(
        [*rings, box, *hidden], closed=[*walls.closed.tolist(), *[True] * (1 + side**2)]
    )


def main() -> None:
    walls = wallkit.import_walls("samples/room.svg")
    print(f"room.svg, {len(walls.edge_starts)} edges\n  K     beams   million a second")
    for bounces in (5, 10, 20, 30):
        count, speed = beams_per_second(walls, bounces)
        print(f"{bounces:>3} {count:>9,}   {speed / 1e6:.2f}" + ("" if speed >= FLOOR else "   below the floor of 3"))
    print("with squares that are not seen, K = 20\n  edges   million beams a second   making the triangles, s")
    for side in (0, 10, 30, 100):
        more = with_hidden(walls, side) if side else walls
        begun = time.process_time()
        unfolding._mesh(obstacles_of(more, 0.0), START, TARGET)
        made = time.process_time() - begun
        _, speed = beams_per_second(more, 20)
        print(f"{len(more.edge_starts):>7,}   {speed / 1e6:.2f}   {made:.2f}")


if __name__ == "__main__":
    main()
