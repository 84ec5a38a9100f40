"""How far places in triangles are from the nearest wall, see ``walls.checking.wall_distance``: the bits of NumPy."""

from __future__ import annotations

import math

from wallkit.kernels.jit import kernel


@kernel
def nearest_walls(points, corners, neighbours, edge, wall, triangle, place, entered, queue, result):
    """Find the distance of each place from the nearest wall, from triangle to triangle, the first entered first.

    Args:
        points: (P, 2).
        corners: (T, 3) points of each triangle, counter-clockwise.
        neighbours: (T, 3) the triangle opposite each corner, or -1.
        edge: (T, 3) the edge opposite each corner.
        wall: (N,) which edges are walls.
        triangle: (n,) the triangle that each place is in.
        place: (n, 2).
        entered: (T,) the last place for which each triangle was entered; -1 at first.
        queue: (T,) to work with.
        result: (n,) written.
    """
    for n in range(len(triangle)):
        home, x, y = triangle[n], place[n, 0], place[n, 1]
        best = math.inf
        for k in range(3):
            best = min(best, _square(points, corners[home, k], x, y))
        entered[home], queue[0] = n, home
        first, stop = 0, 1
        while first < stop:
            at = queue[first]
            first += 1
            for side in range(3):
                p, q, over = corners[at, (side + 1) % 3], corners[at, (side + 2) % 3], edge[at, side]
                dx, dy = points[q, 0] - points[p, 0], points[q, 1] - points[p, 1]
                off_x, off_y = x - points[p, 0], y - points[p, 1]
                part = (off_x * dx + off_y * dy) / max(dx * dx + dy * dy, 1e-300)
                part = min(max(part, 0.0), 1.0)
                away_x, away_y = off_x - dx * part, off_y - dy * part
                square = away_x * away_x + away_y * away_y
                if wall[over]:
                    best = min(best, square)
                    continue
                beyond = neighbours[at, side]
                if (square >= best) | (beyond < 0):
                    continue
                # Of other triangles than its own a place is in front of the edges that lead back.
                if (at != home) & (dx * off_y - dy * off_x <= 0):
                    continue
                if entered[beyond] != n:
                    entered[beyond], queue[stop] = n, beyond
                    stop += 1
                    tip = 0 if edge[beyond, 0] == over else 1 if edge[beyond, 1] == over else 2
                    best = min(best, _square(points, corners[beyond, tip], x, y))
        result[n] = math.sqrt(best)


@kernel
def _square(points, point, x, y):
    """The square of the distance between a point and a place."""
    away_x, away_y = points[point, 0] - x, points[point, 1] - y
    return away_x * away_x + away_y * away_y
