"""A plain tracer of rays among lines, all rays against all edges at once; and rooms by chance. No code of wallkit's."""

import numpy as np


def room(seed):
    """Rings of a room with five obstacles of three to seven corners, each in a cell of its own: none cross."""
    random = np.random.default_rng(seed)
    corners = np.array([(0, 0), (0, 80), (120, 80), (120, 0)]) + random.uniform(-8, 8, (4, 2))
    rings = [corners]
    for cell in random.permutation([(x, y) for x in (25, 60, 95) for y in (22, 58)])[:5]:
        count = random.integers(3, 8)
        angle = np.sort(random.uniform(0, 2 * np.pi, count))
        rings.append(cell + random.uniform(4, 12, (count, 1)) * np.stack([np.cos(angle), np.sin(angle)], axis=1))
    return rings, (12.0, 40.0), (*random.uniform((105, 35), (110, 45)), 2.0)


def trace(rings, start, target, bounces, angle):
    """Bounces before each ray enters the target disc, or -1."""
    a = np.concatenate(rings)
    b = np.concatenate([np.roll(ring, -1, axis=0) for ring in rings])
    e = b - a
    normal = np.stack([e[:, 1], -e[:, 0]], axis=1) / np.hypot(*e.T)[:, None]
    p, d = np.tile(np.array(start, dtype=float), (len(angle), 1)), np.stack([np.cos(angle), np.sin(angle)], axis=1)
    last, reached, rays = np.full(len(angle), -1), np.full(len(angle), -1), np.arange(len(angle))
    centre, radius = np.array(target[:2]), target[2]
    for k in range(bounces + 1):
        w = a[None] - p[:, None]
        cross = d[:, None, 0] * e[None, :, 1] - d[:, None, 1] * e[None, :, 0]
        t = (w[..., 0] * e[None, :, 1] - w[..., 1] * e[None, :, 0]) / cross
        part = (w[..., 0] * d[:, None, 1] - w[..., 1] * d[:, None, 0]) / cross
        meets = (t > 1e-9) & (part >= 0) & (part <= 1) & (np.arange(len(a))[None] != last[:, None])
        t = np.where(meets, t, np.inf)
        edge = t.argmin(axis=1)
        wall = t[np.arange(len(p)), edge]
        to = centre - p
        along, off = (to * d).sum(axis=1), to[:, 0] * d[:, 1] - to[:, 1] * d[:, 0]
        inside = radius**2 - off**2
        enters = (inside > 0) & (along > 0) & (along - np.sqrt(np.maximum(inside, 0)) < wall)
        reached[rays[enters]] = k
        go = ~enters & np.isfinite(wall)
        p, d, last, rays = (p + wall[:, None] * d)[go], d[go], edge[go], rays[go]
        n = normal[last]
        d = d - 2 * (d * n).sum(axis=1)[:, None] * n
    return reached


def by_windows(windows, angle):
    """What windows say of each ray."""
    said = np.full(len(angle), -1)
    for window in windows:
        turned = (angle - window.low) % (2 * np.pi)
        said[turned <= window.width] = window.bounces
    return said
