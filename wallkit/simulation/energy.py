"""The energy of a run's balls, kinetic and potential, per mass."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from wallkit.geometry.arrays import FloatArray
from wallkit.geometry.bulge_arcs import circles

if TYPE_CHECKING:
    from wallkit.simulation.run import Run
    from wallkit.walls import Walls


def energies(run: Run) -> tuple[FloatArray, FloatArray]:
    """Give the energy of each ball at the start, and by how much it changed until its end.

    It is v^2 / 2 - g.(x - x0), with x0 the lowest place that the ball's centre can reach: its radius above the lowest
    point of the walls, or where it starts or ends if that is lower still (a ball that falls out). So a ball at rest at
    the lowest place has none left, and none has less.

    Returns:
        (n,) before and (n,) change, in units^2 / s^2. The change is taken part by part, so that what cancels does so
        before it is rounded.
    """
    start, gravity = np.asarray(run.start, dtype=np.float64), np.array(run.scene.gravity or (0.0, 0.0))
    at = np.stack([run.final["x"], run.final["y"]], axis=1)
    kinetic = (start[:, 2:4] ** 2).sum(axis=1) / 2
    kinetic_end = (run.final["vx"] ** 2 + run.final["vy"] ** 2) / 2
    before = kinetic + lowest(run) - start[:, 0:2] @ gravity
    return before, kinetic_end - kinetic - (at - start[:, 0:2]) @ gravity


def mass_parts(run: Run) -> FloatArray:
    """(n,) mass of each ball over the mean of all where balls meet and share their energy; else 1."""
    mass = run.scene.balls.mass
    whole = float(mass.sum())
    return mass * (len(mass) / whole) if run.scene.meeting and whole > 0.0 else np.ones(len(mass))


def lowest(run: Run) -> FloatArray:
    """(n,) g.x at the lowest place x that each ball's centre can reach; 0 without gravity."""
    if run.scene.gravity is None:
        return np.zeros(len(run.final))
    gravity = np.array(run.scene.gravity)
    ends = np.stack([run.final["x"], run.final["y"]], axis=1) @ gravity
    reached: FloatArray = np.maximum(np.asarray(run.start)[:, 0:2] @ gravity, ends)
    if not len(run.scene.walls):
        return reached
    floor = farthest(run.scene.walls, gravity) - run.scene.balls.radius * float(np.hypot(*gravity))
    return np.maximum(reached, floor, out=reached)


def farthest(walls: Walls, direction: FloatArray) -> float:
    """Give the largest d.p over the points p of the walls, for a direction d of any length.

    On an arc with centre c and radius R it is at c + R d / |d| where that point belongs to the arc: where it is on the
    side of the chord to which the arc bows, the right for a positive bulge. Else it is at an end.
    """
    best = float((walls.vertices @ direction).max())
    starts = walls.edge_starts
    is_arc = walls.bulges[starts] != 0.0
    arcs = starts[is_arc]
    length = float(np.hypot(*direction))
    if not len(arcs) or length == 0.0:
        return best
    a, b, bulge = walls.vertices[arcs], walls.vertices[walls.edge_ends[is_arc]], walls.bulges[arcs]
    centre, radius = circles(a, b, bulge)
    point = centre + radius[:, None] * (direction / length)
    chord, along = b - a, point - a
    on_the_right = along[:, 0] * chord[:, 1] - along[:, 1] * chord[:, 0]
    bowed = (point @ direction)[on_the_right * bulge >= 0.0]
    return max(best, float(bowed.max(initial=best)))
