"""A person's own walls or scene as a subject of the report: arcs are flattened here where lines are asked for."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from wallkit.accuracy.contest import Subject, along
from wallkit.accuracy.scenes import lines_for_turn
from wallkit.geometry.bulge_arcs import circles
from wallkit.scene.scene import Balls, Scene, SceneError
from wallkit.walls import Walls


def of_scene(name: str, scene: Scene) -> Subject:
    """Take walls and the first ball as they are, alone."""
    scene = replace(scene, balls=first_ball(scene.balls), meeting=False)
    scene = replace(scene, ball_restitution=1.0, ball_tangential_restitution=1.0)
    arcs = (lambda _: scene) if scene.walls.has_arcs else None

    def lines(tolerance: float) -> Scene:
        return replace(scene, walls=flattened(scene.walls, tolerance))

    return Subject(name, "a scene", lines, arcs, False)


def first_ball(balls: Balls) -> Balls:
    """Give the first ball alone: the contest is about one.

    Raises:
        SceneError: there is none.
    """
    if not len(balls):
        raise SceneError("there is no ball to shoot", code="no-ball", fix="give the scene a ball")
    return Balls(np.asarray(balls.position)[:1], np.asarray(balls.velocity)[:1], np.asarray(balls.radius)[:1])


def flattened(walls: Walls, tolerance: float) -> Walls:
    """Turn arcs into chords whose sagitta is at most ``tolerance``; everything else stays."""
    if not walls.has_arcs:
        return walls
    polylines = []
    for wall in walls:
        ends = np.roll(wall.vertices, -1, axis=0)
        edges = len(wall.vertices) if wall.closed else len(wall.vertices) - 1
        points = []
        for a, b, bulge in zip(wall.vertices[:edges], ends[:edges], wall.bulges[:edges], strict=True):
            points.append(along(a, b, float(bulge), _chords(a, b, float(bulge), tolerance)))
        if not wall.closed:
            points.append(wall.vertices[-1:])
        polylines.append(np.concatenate(points))
    return Walls.from_polylines(
        polylines,
        walls.closed.tolist(),
        sides=walls.sides,
        material=walls.materials,
        names=walls.names,
        layers=walls.layers,
        origins=walls.origins,
    )


def _chords(a: np.ndarray, b: np.ndarray, bulge: float, tolerance: float) -> int:
    if bulge == 0.0:
        return 1
    _, radius = circles(a[None], b[None], np.array([bulge]))
    return lines_for_turn(4 * abs(math.atan(bulge)), float(radius[0]), tolerance)
