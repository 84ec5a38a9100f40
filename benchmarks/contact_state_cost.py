"""What a slide, a glide and a pivot cost beside a bounce of the same walls, on one thread, in one run.

    python benchmarks/contact_state_cost.py [slide glide pivot ramp]

Tracks in which balls run to and fro for ever, without friction and with restitution 0, so that nearly every contact is
the begin of a contact state, and a ramp of a few lines, which many balls slide down; and the same tracks, closed to a
room and with restitution 1, in which balls bounce: among the ramp's lines in lockstep, beside arcs one by one. A
state is counted where a ball comes to keep to a piece of wall: where it turns round on it is not. Compiling is not
counted. Both do some 400,000 of what they are asked for, so that what a call costs does not count.
"""

from __future__ import annotations

import math
import sys
import time

import numpy as np

import wallkit

BALLS, SECONDS, BOUNCES, TURNS, PULL, RADIUS = 200, 400.0, 400_000, 5, 100.0, 2.0
TOUCHING = RADIUS + 1e-6
"""From the wall: a disc that is let go there comes to keep to it at once."""


def slide():
    """A half pipe whose straight sides are eight pieces each."""
    radius, length, s = 20.0, 80.0, math.sqrt(0.5)
    left, right = np.array([-radius * s, radius * (1 - s)]), np.array([radius * s, radius * (1 - s)])
    ways = np.arange(1, 9)[:, None] * length / 8 * s
    points = np.vstack([left + ways[::-1] * (-1, 1), left, right, right + ways])
    bulges = np.zeros(len(points))
    bulges[8] = math.tan(math.pi / 8)
    return points, bulges, left + np.linspace(30.0, 75.0, BALLS)[:, None] * (-s, s) + TOUCHING * s


def glide():
    """A hollow of sixteen arcs of one circle."""
    angle, far = np.linspace(-1.2, 1.2, 17), 60.0
    points = far * np.stack([np.sin(angle), 1.0 - np.cos(angle)], axis=1)
    bulges = np.full(len(points), math.tan(2.4 / 16 / 4))
    angle = np.linspace(-1.1, -0.6, BALLS)
    return points, bulges, (0.0, far) + (far - TOUCHING) * np.stack([np.sin(angle), -np.cos(angle)], axis=1)


def pivot():
    """A flat hill of sixteen lines between two hollow arcs: a slow disc pivots about each of its vertices."""
    half, count = 0.08, 16
    angle = np.linspace(-half, half, count + 1)
    hill = 100.0 * np.stack([np.sin(angle), np.cos(angle) - 1.0], axis=1)
    # The last line leans by half a piece less than the hill's end; an arc goes on from it, round to 60 degrees.
    lean, rho = half - half / count, 15.0
    middle = hill[-1] + rho * np.array([math.sin(lean), math.cos(lean)])
    out = middle + rho * np.array([math.sin(math.pi / 3), -math.cos(math.pi / 3)])
    points = np.vstack([out * (-1, 1), hill, out])
    bulges = np.zeros(len(points))
    bulges[0] = bulges[-2] = math.tan((lean + math.pi / 3) / 4)
    # As high above the hill that no disc is quick enough to fly off it: v^2 = 2 g h < g r cos.
    high = np.linspace(0.05, 0.5, BALLS)
    angle = np.arccos((middle[1] - RADIUS - high) / (rho - TOUCHING))
    return points, bulges, middle + (rho - TOUCHING) * np.stack([np.sin(angle), -np.cos(angle)], axis=1)


def ramp():
    """A slope of twelve pieces, no arc anywhere."""
    points = np.linspace((0.0, 60.0), (240.0, 0.0), 13)
    down = np.array([240.0, -60.0]) / math.hypot(240.0, 60.0)
    way = np.linspace(6.0, 18.0, 20_000)[:, None]
    return points, np.zeros(13), points[0] + way * down + TOUCHING * np.array([-down[1], down[0]])


def scene_of(track, restitution):
    """Balls that are let go at a track, or thrown from there, which a lid closes to a room."""
    points, bulges, places = track
    low, high = points.min(axis=0), points.max(axis=0)
    lid = np.array([[high[0], high[1] + 60.0], [low[0], high[1] + 60.0]])
    walls = wallkit.Walls.from_polylines(
        [np.vstack([points, lid])],
        closed=True,
        bulges=[np.concatenate([bulges, np.zeros(2)])],
        material=wallkit.Material(restitution, 1.0),
    )
    turn = np.linspace(0.3, 2.8, len(places))[:, None]
    velocity = 50.0 * np.hstack([np.cos(turn), np.sin(turn)]) if restitution else np.zeros_like(places)
    return wallkit.Scene(walls, wallkit.Balls(places, velocity, RADIUS), gravity=(0.0, -PULL))


def seconds(run):
    began = time.process_time()
    run()
    return time.process_time() - began


def measure(name):
    track = {"slide": slide, "glide": glide, "pivot": pivot, "ramp": ramp}[name]()
    held, bouncing = scene_of(track, 0.0), scene_of(track, 1.0)
    each = BOUNCES // len(track[2])
    run = wallkit.simulate(held, until=SECONDS, mode="compiled")
    kinds = np.bincount(run.contacts["kind"], minlength=4)
    pivots = np.count_nonzero((run.contacts["kind"] == 2) & (run.contacts["edge"] < 0))
    print(f"{name}: {kinds[2]} states, {pivots} of them pivots, {kinds[0] + kinds[1]} bounces, {kinds[3]} flights")
    ready, other = wallkit.prepare(held), wallkit.prepare(bouncing)
    for how, both in (
        (
            "survey",
            (
                lambda: wallkit.survey(ready, until=SECONDS, threads=1),
                lambda: wallkit.survey(other, bounces=each, threads=1),
            ),
        ),
        (
            "simulate",
            (
                lambda: wallkit.simulate(held, until=SECONDS, mode="compiled"),
                lambda: wallkit.simulate(bouncing, bounces=each, mode="compiled"),
            ),
        ),
    ):
        for part in both:  # compiled here
            part()
        turns = np.array([[seconds(part) for part in both] for _ in range(TURNS)]) / (kinds[2], BOUNCES) * 1e9
        (state, bounce), ratio = np.median(turns, axis=0), np.median(turns[:, 0] / turns[:, 1])
        print(f"  {how:8s} a state {state:6.0f} ns, a bounce {bounce:6.0f} ns, ratio {ratio:.1f}", flush=True)


def main() -> None:
    for name in sys.argv[1:] or ["slide", "glide", "pivot", "ramp"]:
        measure(name)


if __name__ == "__main__":
    main()
