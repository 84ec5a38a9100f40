"""Room at the start, for many balls among few lines: a quick look that finds in nearly all scenes that all is well."""

from __future__ import annotations

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
            off = ex * nx + ey * ny
            along = ey * nx - ex * ny
            before = -along if along < 0.0 else 0.0
            beyond = along - length if along > length else before
            reach = radii[i] + MARGIN * (radii[i] + extent)
            near += 0 if off * off + beyond * beyond > reach * reach else 1
        if near > 0:
            return False
    return True
