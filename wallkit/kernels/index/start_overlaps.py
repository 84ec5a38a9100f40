"""Room at the start, for balls among lines: a quick look that finds in nearly all scenes that all is well."""

from __future__ import annotations

import math

from wallkit.kernels.jit import kernel

MARGIN = 2.0**-30
"""Part of the scene's size, and of the radius, that counts as touching here: far beyond all rounding."""


@kernel
def all_clear(lines, extent, origin, position, radii):
    """Tell whether every ball surely keeps off every edge.

    Args:
        lines: all edges; one without length is as good as touched.
        extent: of the scene, see ``Model``.
        origin: (x0, y0) of the local coordinates.
        position: (2 n,), x and y in turn, in the scene's coordinates.
        radii: (n,).
    """
    x0, y0 = origin
    for k in range(len(lines)):
        line = lines[k]
        ax, ay, nx, ny, length = line.ax, line.ay, line.nx, line.ny, line.length
        near = 0
        for i in range(len(radii)):
            ex, ey = (position[2 * i] - x0) - ax, (position[2 * i + 1] - y0) - ay
            # From the segment: across it e.n, along it by how much e.tau is below 0 or beyond the length.
            off = ex * nx + ey * ny
            along = ey * nx - ex * ny
            before = -along if along < 0.0 else 0.0
            beyond = along - length if along > length else before
            reach = radii[i] + MARGIN * (radii[i] + extent)
            # Counted, not returned at once: without a branch the loop is vectorised.
            near += 0 if off * off + beyond * beyond > reach * reach else 1
        if near > 0:
            return False
    return True


@kernel
def all_clear_in_cells(lines, extent, origin, position, radii, box, ends, sorted_balls):
    """Tell the same where there are many edges: each asks only the balls in the cells about it.

    Args:
        lines: all edges; one without length is as good as touched.
        extent: of the scene, see ``Model``.
        origin: (x0, y0) of the local coordinates.
        position: (2 n,), x and y in turn, in the scene's coordinates.
        radii: (n,).
        box: (x, y, width, height) of the positions, local.
        ends: (2 n + 3,) whole numbers, 0, to work with: cells are no more than 2 n + 1.
        sorted_balls: (3 n,) floats to work with.
    """
    left, low, width, height = box
    largest = 0.0
    for i in range(len(radii)):
        largest = max(largest, radii[i])
    reach = largest + MARGIN * (largest + extent)
    # side^2 >= w h / n and side >= (w + h) / n, so (w / side + 1)(h / side + 1) <= 2 n + 1 cells, about a ball each.
    side = max(max(math.sqrt(width * height / len(radii)), (width + height) / len(radii)), reach)
    per_side = 1.0 / side
    columns, rows = int(width * per_side) + 1, int(height * per_side) + 1
    _sort(position, origin, radii, left, low, per_side, columns, columns * rows, ends, sorted_balls)
    # What grows with x also grows with x in cells, as rounded: no ball falls out of the range that is looked through.
    for k in range(len(lines)):
        line = lines[k]
        first, last = min(line.ax, line.bx) - reach - left, max(line.ax, line.bx) + reach - left
        bottom, top = min(line.ay, line.by) - reach - low, max(line.ay, line.by) + reach - low
        first, last, bottom, top = first * per_side, last * per_side, bottom * per_side, top * per_side
        if last < 0.0 or first >= columns or top < 0.0 or bottom >= rows:
            continue
        first_column, last_column = int(max(first, 0.0)), int(min(last, columns - 0.5))
        for row in range(int(max(bottom, 0.0)), int(min(top, rows - 0.5)) + 1):
            cell = row * columns
            if _any_near(line, extent, sorted_balls, ends[cell + first_column], ends[cell + last_column + 1]):
                return False
    return True


@kernel
def _sort(position, origin, radii, left, low, per_side, columns, cells, ends, sorted_balls):
    """Sort balls by cell, counting first: those of cell c come from ends[c] to ends[c + 1]."""
    # Counting sort. Counts stand two places on; summed up they are where each cell begins, one place on; and filling a
    # cell moves that to where the next one begins.
    x0, y0 = origin
    for i in range(len(radii)):
        ends[_cell(position[2 * i] - x0, position[2 * i + 1] - y0, left, low, per_side, columns) + 2] += 1
    for cell in range(cells):
        ends[cell + 2] += ends[cell + 1]
    for i in range(len(radii)):
        x, y = position[2 * i] - x0, position[2 * i + 1] - y0
        cell = _cell(x, y, left, low, per_side, columns)
        at = 3 * ends[cell + 1]
        sorted_balls[at], sorted_balls[at + 1], sorted_balls[at + 2] = x, y, radii[i]
        ends[cell + 1] += 1


@kernel
def _cell(x, y, left, low, per_side, columns):
    return int((y - low) * per_side) * columns + int((x - left) * per_side)


@kernel
def _any_near(line, extent, balls, start, stop):
    """Tell whether an edge may touch one of the balls from start to stop."""
    for i in range(start, stop):
        ex, ey = balls[3 * i] - line.ax, balls[3 * i + 1] - line.ay
        off, along = ex * line.nx + ey * line.ny, ey * line.nx - ex * line.ny
        beyond = max(max(-along, along - line.length), 0.0)
        reach = balls[3 * i + 2] + MARGIN * (balls[3 * i + 2] + extent)
        if not off * off + beyond * beyond > reach * reach:
            return True
    return False
