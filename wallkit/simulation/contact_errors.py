"""What each contact adds to the error of a run: the rounding of the arithmetic, or what walls are off as drawn."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray
from wallkit.kernels.flight.ball_state import FALLING_TOLERANCE
from wallkit.kernels.flight.error_growth import BOUNCES, ENDS, SLIDES, SLOWS, STOPS
from wallkit.scene.scene import Scene
from wallkit.simulation.gliding import edges_of

Course = tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray, float, FloatArray]
"""What the kernels of the horizon need of one ball's run, see ``wallkit.kernels.flight.error_growth.carry``."""
RMS_ROUNDING = 0.6 * 2.0**-53
SURE = 3.0  # promised is this many times the root mean square


def roundings(scene: Scene, own: Any, course: Course, ball: int) -> tuple[FloatArray, NDArray[np.bool_]]:
    """(n, 4) what the arithmetic of each contact may add: see :func:`wallkit.kernels.flight.error_growth.carry`.

    And (n,) where that is more than roundings, in the tip of a corner.

    A rounding is at most EPS = 2^-53 of the number, and some 0.6 of that as a root mean square. Places are as
    large as the distance from the local origin; the normal about a corner or on an arc is taken from the place,
    so it turns by that rounding times the curvature. A wall along an axis turns one sign and rounds nothing.
    """
    from wallkit.simulation.modelled import local_origin

    _, path, bend, keep, _, _, _ = course
    begin = np.atleast_2d(np.asarray(scene.balls.position, dtype=np.float64))[ball]
    origin = local_origin(scene.walls.vertices, scene.walls.box())
    places = np.concatenate([begin[None], np.stack([own["x"], own["y"]], axis=1)]) - origin
    place = RMS_ROUNDING * np.hypot(*places[1:].T)
    plain = (bend == 0) & ((path[:, 3] == 0) | (path[:, 4] == 0)) & (keep == 1).all(axis=1)
    speed = np.where(plain, 0.0, RMS_ROUNDING)
    if scene.gravity is not None:
        place, speed = _falling_roundings(course, places)
    turn = np.where(plain, 0.0, RMS_ROUNDING + place * np.abs(bend))
    # An edge is where its first vertex is: what is left of the way from there is rounded as that is long.
    d = scene.walls.vertices[scene.walls.edge_starts[edges_of(scene.walls, own)]] - np.stack(
        [own["x"], own["y"]], axis=1
    )
    wall = np.hypot(place, np.where(own["edge"] < 0, 0.0, RMS_ROUNDING * np.hypot(*d.T)))
    in_corner = np.zeros(len(own), dtype=np.bool_)
    if scene.gravity is not None:
        near = FALLING_TOLERANCE * float(np.abs(scene.walls.vertices - origin).max(initial=0.0))
        there, quick = _doubts_in_corners(course, np.asarray(scene.gravity, dtype=np.float64), near)
        place, speed = np.hypot(place, there / SURE), np.hypot(speed, quick / SURE)
        in_corner = (there > 0.0) | (quick > 0.0)
    return np.stack([wall, turn, place, speed], axis=1), in_corner


def _falling_roundings(course: Course, places: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Rounding of places, and of velocities relative to the speed, under gravity; of (n + 1, 2) places.

    p + v t + g t^2 / 2 is summed up of larger parts, each of which is rounded, as are v + g t and the squared speed,
    v^2 - 2 g.p at the start plus 2 g.p here: half of its error, over v^2, is that of the speed.
    """
    start, path, _, _, pull, _, glides = course
    time, force = np.diff(path[:, 0], prepend=0.0), np.hypot(*pull[:-1].T)
    before = np.hypot(*np.concatenate([start[None], path[:-1, 1:3]]).T)
    after = np.hypot(path[:, 1], path[:, 2])
    after = np.where(after > 1e-70, after, 1.0)  # below all speeds that are modelled it rests, and nothing follows
    far = np.hypot(*places.T)
    force = np.where(np.isnan(glides[:, 0]), force, 0.0)  # along a circle it comes back, and no part is that large
    place = np.sqrt(far[1:] ** 2 + far[:-1] ** 2 + (np.maximum(before, after) * time) ** 2 + (force * time**2 / 2) ** 2)
    height = (pull[:-1] * places[1:]).sum(axis=1)
    speed = np.hypot(np.hypot(1.0, force * time / after), height / after / after)
    return RMS_ROUNDING * place, RMS_ROUNDING * speed


def _doubts_in_corners(course: Course, gravity: FloatArray, near: float) -> tuple[FloatArray, FloatArray]:
    """By how much place and velocity (relative to the speed) may be off where a ball bounces in a corner's tip.

    Nearer to it than the tolerance it bounces off both walls in no time. One that has joined a wall by endless bounces,
    lower than that, and meets the next wall before the time 2 w / p (1 - e) in which they would be over, is in one of
    them yet: it has up to w off the first wall, and meets the other, at the angle a with it, up to h / sin a elsewhere.
    """
    _, path, bend, keep, _, _, _ = course
    there, quick = np.zeros(len(path)), np.zeros(len(path))
    there[(np.diff(path[:, 0], prepend=-1.0) == 0.0) & (path[:, 5] == BOUNCES)] = near
    if len(path) < 3:
        return there, quick
    last, joins, meets = path[:-2], path[1:-1], path[2:]
    across = (last[:, 1:3] * last[:, 3:5]).sum(axis=1)
    pressed = -(last[:, 3:5] @ gravity) - bend[:-2] * (joins[:, 1:3] ** 2).sum(axis=1)
    slower = (1.0 - keep[:-2, 1]) * pressed
    over = np.divide(2.0 * across, slower, out=np.zeros(len(last)), where=slower > 0.0)
    held = np.isin(joins[:, 5], (SLIDES, STOPS, SLOWS))
    early = (last[:, 5] == BOUNCES) & held & (meets[:, 5] == BOUNCES) & (meets[:, 0] - last[:, 0] < over)
    sine = np.abs(joins[:, 3] * meets[:, 4] - joins[:, 4] * meets[:, 3])
    speed = np.hypot(meets[:, 1], meets[:, 2])
    found = np.flatnonzero(early & (sine > 0.0) & (speed > 0.0))
    there[found + 2] = near / sine[found]
    quick[found + 2] = across[found] / speed[found]
    there[-1] = max(there[-1], _at_rest_in_corner(path, near))
    return there, quick


def _at_rest_in_corner(path: FloatArray, near: float) -> float:
    """By how much a ball may be off that ends at rest just after a bounce: in a tip, or wedged between two walls.

    It is no farther than the tolerance from either, at the angle a with one another, and so by up to twice that over
    sin a from where it would come to rest; over sqrt 2, for it counts for each component of its place.
    """
    first, second, end = path[-3:]
    bounced = second[5] == BOUNCES and second[1:3].any()
    if not bounced or end[5] != ENDS or end[1:3].any() or end[0] != second[0]:
        return 0.0
    sine = abs(float(first[3] * second[4] - first[4] * second[3]))
    return math.sqrt(2.0) * near / sine if sine > 0.0 else math.inf


def drawing_errors(scene: Scene, own: Any) -> FloatArray:
    """(n, 4) what walls that are off by their ``measured_error`` add at each contact."""
    walls = scene.walls
    fresh = np.zeros((len(own), 4))
    fresh[:, 0] = walls.measured_error
    if walls.measured_normal_error is not None:
        fresh[:, 1] = walls.measured_normal_error
    else:  # a chord of length c with the sagitta s is turned by at most 4 s / c from its arc
        d = walls.vertices[walls.edge_ends] - walls.vertices[walls.edge_starts]
        chord = np.maximum(np.hypot(d[:, 0], d[:, 1]), walls.measured_error or 1.0)
        fresh[:, 1] = 4 * walls.measured_error / chord[edges_of(walls, own)]
    return fresh
