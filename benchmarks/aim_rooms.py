"""Is `aim` complete? 50 rooms by chance beside a plain tracer of a million rays each, and `simulate`.

    python benchmarks/aim_rooms.py [rooms] [rays]

Each room has five obstacles, 26 to 40 edges, and three to six bounces are allowed. A ray is missed if it reaches the
target and no window with its bounces holds it; a window is wrong for a ray that it holds and that does not reach the
target so. The middle of every window is flown by `simulate`, too. It ends with 1 if anything is missed or wrong.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path

import numba
import numpy as np

import wallkit

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "aim"))
from tracing import by_windows, room


@numba.njit(cache=True)
def trace(a, b, sx, sy, tx, ty, radius, bounces, angles):
    """Bounces before each ray enters the disc, or -1: each flight looks at every edge."""
    reached = np.full(len(angles), -1)
    for i in range(len(angles)):
        x, y, dx, dy, last = sx, sy, math.cos(angles[i]), math.sin(angles[i]), -1
        for k in range(bounces + 1):
            best, edge = np.inf, -1
            for e in range(len(a)):
                ax, ay, ex, ey = a[e, 0] - x, a[e, 1] - y, b[e, 0] - a[e, 0], b[e, 1] - a[e, 1]
                cross = dx * ey - dy * ex
                if e == last or cross == 0.0:
                    continue
                t, part = (ax * ey - ay * ex) / cross, (ax * dy - ay * dx) / cross
                if 0.0 < t < best and 0.0 <= part <= 1.0:
                    best, edge = t, e
            wx, wy = tx - x, ty - y
            along, off = wx * dx + wy * dy, wx * dy - wy * dx
            if along > 0.0 and abs(off) < radius and along - math.sqrt(radius * radius - off * off) < best:
                reached[i] = k
                break
            if edge < 0:
                break
            x, y, last = x + best * dx, y + best * dy, edge
            ex, ey = b[edge, 0] - a[edge, 0], b[edge, 1] - a[edge, 1]
            length = math.sqrt(ex * ex + ey * ey)
            nx, ny = ey / length, -ex / length
            normal = dx * nx + dy * ny
            dx, dy = dx - 2.0 * normal * nx, dy - 2.0 * normal * ny
    return reached


def confirmed(level: wallkit.Scene, windows: wallkit.Windows) -> int:
    """How many middles `simulate` flies to the target after as many bounces."""
    angle = np.array([window.middle for window in windows])
    velocity = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    balls = wallkit.Balls(np.tile(windows.start, (len(angle), 1)), velocity)
    run = wallkit.simulate(wallkit.Scene(level.walls, balls), bounces=windows.most_bounces + 1)
    count = 0
    for ball, window in enumerate(windows):
        own = run.contacts_of(ball)
        places = np.array([windows.start, *zip(own["x"], own["y"], strict=True)])
        p, d = places[:-1], np.diff(places, axis=0)
        part = np.clip(((np.array(windows.target[:2]) - p) * d).sum(axis=1) / (d * d).sum(axis=1), 0, 1)
        enters = np.hypot(*(p + part[:, None] * d - windows.target[:2]).T) < windows.target[2]
        count += bool(enters.any()) and int(np.argmax(enters)) == window.bounces
    return count


def main() -> None:
    rooms, rays = (int(word) for word in (sys.argv[1:] + ["50", "1000000"][len(sys.argv) - 1 :]))
    angle = -math.pi + 2.0 * math.pi * (np.arange(rays) + 0.5) / rays
    sums = np.zeros(5, dtype=np.int64)
    for seed in range(rooms):
        rings, start, target = room(seed)
        bounces = 3 + seed % 4
        a = np.concatenate(rings)
        b = np.concatenate([np.roll(ring, -1, axis=0) for ring in rings])
        level = wallkit.Scene(wallkit.Walls.from_polylines(rings))
        windows = wallkit.aim(level, start, target, bounces)
        reached, said = trace(a, b, *start, *target, bounces, angle), by_windows(windows, angle)
        missed, wrong = int(((reached >= 0) & (said != reached)).sum()), int(((said >= 0) & (said != reached)).sum())
        good = confirmed(level, windows)
        sums += (len(windows), int((reached >= 0).sum()), missed, wrong, len(windows) - good)
        print(f"room {seed:>2}: {len(a)} edges, K {bounces}, {len(windows):>3} windows, {(reached >= 0).sum()} hits, "
              f"missed {missed}, wrong {wrong}, confirmed {good}", flush=True)  # fmt: skip
    print("{} windows, {} hits: {} rays missed, {} windows' rays wrong, {} middles not confirmed".format(*sums))
    sys.exit(int(sums[2:].any()))


if __name__ == "__main__":
    main()
