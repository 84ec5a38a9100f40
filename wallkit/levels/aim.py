"""``aim``: all shots that reach a target."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from wallkit import arguments
from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.levels.obstacles import obstacles_of
from wallkit.levels.search import APART, FINEST, Searched, Shooter, search
from wallkit.levels.targets import FARTHEST, Disc, target_of
from wallkit.levels.unfolding import Unfolded, unfold, unfolding_at_hand, warm_unfolding
from wallkit.levels.windows import NONE, Windows, merged
from wallkit.scene.scene import Balls, Scene, SceneError
from wallkit.scene.start_overlaps import check_starts
from wallkit.simulation.meeting_rules import refuse_meeting
from wallkit.walls import Walls

Place = tuple[float, float]
MOST_BEAMS = 10_000_000
"""Beams that are followed, and shots that are flown, at most, unless somebody says otherwise."""
SPEED = 50.0
"""Units per second of a ball where speed matters, nobody says it, and the scene has none that moves."""
MOST_BOUNCES = 10_000
"""Beams of a small room grow with their square: long before there are too many of them."""


def aim(
    scene: Scene,
    start: Sequence[float],
    target: Sequence[float] | str,
    bounces: int,
    radius: float = 0.0,
    *,
    speed: float | None = None,
    resolution: float = FINEST,
    most_beams: int = MOST_BEAMS,
    progress: Callable[[int], None] | None = None,
) -> Windows:
    """Find all directions in which a ball reaches a target after at most so many bounces.

    A ball reaches the target where its centre enters the disc; there the shot ends. Sensors and the scene's own balls
    play no part. Between straight walls without gravity or friction the directions are found by unfolding: at each wall
    the room is mirrored, so that a shot is a straight line, and a beam of shots is split at the corners it meets. So
    all windows wider than 1e-12 radians are found. A disc flies among walls that are moved out by its radius; the arcs
    around their corners, and curved walls, cannot be unfolded: directions that come to them are searched with single
    shots, of the kernel that ``simulate`` flies with. Gravity, friction, drag, and walls with a restitution of 0 are
    for the search alone.

    Args:
        scene: walls, and what acts.
        start: (x, y) of the ball's centre.
        target: (x, y, radius), or the name of a target, a spawn or a sensor of the scene.
        bounces: K, 0 or more.
        radius: of the ball; 0 is a point.
        speed: units per second; None for that of the scene's first ball that moves, or 50. It matters under gravity,
            friction and drag alone.
        resolution: of the search, radians between shots that differ: narrower windows may be missed there. It does not
            matter for what is unfolded.
        most_beams: a limit on the beams, and on the shots of the search.
        progress: called now and then with the beams, or shots, so far.

    Raises:
        SceneError: an argument is none of what may be, there is no such target, or the ball starts on or in a wall.
        LimitError: there are more beams or shots.
    """
    arguments.of_type(scene, "scene", Scene, "a Scene", error=SceneError, code="bad-scene")
    refuse_meeting(scene, "an aim")
    place = _pair(start, "start")
    most = arguments.whole_number(bounces, "bounces", "a whole number, 0 or more", error=SceneError, code="bad-limit",
                                  least=0, most=MOST_BOUNCES)  # fmt: skip
    size = arguments.number(radius, "radius", "a number, 0 or more", error=SceneError, code="bad-balls", least=0.0)
    limit = arguments.whole_number(most_beams, "most_beams", error=SceneError, code="bad-limit", least=1)
    finest = arguments.number(resolution, "resolution", "radians, from 1e-12 to 0.1", error=SceneError, code="bad-aim",
                              least=1e-12, most=0.1)  # fmt: skip
    _check_progress(progress)
    disc, pace = target_of(scene, target), _speed(scene, speed)
    alone = replace(scene, balls=Balls([place], [(pace, 0.0)], size), sensors=None)
    check_starts(alone)
    unfolded, intervals = None, np.array([[-math.pi, math.pi]])
    if _unfolds(alone):
        unfolded = _unfolded(alone.walls, size, place, disc, most, limit, progress)
        intervals = _to_search(unfolded)
    searched = None
    if len(intervals):
        searched = search(Shooter.of(alone, place, disc, most, size, pace), intervals, limit, finest, progress)
    return _windows(alone, place, disc, most, unfolded, intervals, searched, finest)


def _check_progress(progress: Callable[[int], None] | None) -> None:
    if progress is not None and not callable(progress):
        raise arguments.refused("progress", progress, "a function of one number, or None", SceneError, "bad-argument")


def machine_code_at_hand(scene: Scene, start: Place, target: Disc, radius: float) -> bool:
    """Tell whether an ``aim`` would begin at once; where not, what it needs is being compiled aside from now on."""
    alone = replace(scene, balls=Balls([start], [(SPEED, 0.0)], radius), sensors=None)
    unfolds = _unfolds(alone)
    ready = not unfolds or unfolding_at_hand()
    if not unfolds or not obstacles_of(alone.walls, radius).twice.all():
        ready = Shooter.of(alone, start, target, 1, radius, SPEED).machine_code_at_hand() and ready
    return ready


def warm_aim(scene: Scene) -> None:
    """Compile the kernels that ``aim`` uses in scenes like this one; those on the disk are loaded.

    Args:
        scene: one with a ball at least, which is what is aimed with; nothing is done without.
    """
    if not len(scene.balls):
        return
    (x, y), radius = scene.balls.position[0].tolist(), float(scene.balls.radius[0])
    alone = replace(scene, balls=Balls([(x, y)], [(SPEED, 0.0)], radius), sensors=None)
    if _unfolds(alone):
        warm_unfolding()
    Shooter.of(alone, (x, y), (x, y, 1.0), 1, radius, SPEED).warm()


def _pair(value: Sequence[float], name: str) -> tuple[float, float]:
    may_be = f"two numbers up to {FARTHEST:g}, (x, y)"
    pair = arguments.floats(value, name, may_be, error=SceneError, code="bad-aim")
    if pair.shape != (2,) or not (np.abs(pair) <= FARTHEST).all():
        raise arguments.refused(name, value, may_be, SceneError, "bad-aim")
    return float(pair[0]), float(pair[1])


def _speed(scene: Scene, speed: float | None) -> float:
    if speed is not None:
        return arguments.number(speed, "speed", "a number above 0", error=SceneError, code="bad-aim",
                                least=arguments.ABOVE_0)  # fmt: skip
    speeds = np.hypot(*scene.balls.velocity.T)
    moving = speeds[speeds > 0.0]
    return float(moving[0]) if len(moving) else SPEED


def _unfolds(scene: Scene) -> bool:
    """Tell whether paths are straight and walls mirror them."""
    acts = (scene.rolling_friction, scene.drag, *(scene.gravity or ()))
    dead = any(min(m.restitution, m.tangential_restitution) == 0.0 for m in scene.walls.materials)
    return not any(acts) and not dead


def _unfolded(
    walls: Walls,
    radius: float,
    place: Place,
    disc: Disc,
    bounces: int,
    most_beams: int,
    progress: Callable[[int], None] | None,
) -> Unfolded:
    """Unfold the walls, moved out by the radius; words name edges of the walls."""
    obstacles = obstacles_of(walls, radius)
    unfolded = unfold(obstacles, place, disc, bounces, most_beams, progress)
    words, edge = unfolded.words, obstacles.edge
    named = np.where(words >= 0, edge[np.maximum(words, 0)] if len(edge) else words, NONE)
    return unfolded._replace(words=named)


def _to_search(unfolded: Unfolded) -> FloatArray:
    """Give (n, 2) the intervals of directions that come to what is not to be unfolded."""
    low, high = unfolded.low[unfolded.search], unfolded.high[unfolded.search]
    low, high, _ = merged(low, high, np.zeros(len(low), dtype=np.int64), np.empty((len(low), 0), dtype=np.int64))
    return np.column_stack([low, high])


def _windows(
    scene: Scene,
    start: tuple[float, float],
    target: tuple[float, float, float],
    most: int,
    unfolded: Unfolded | None,
    intervals: FloatArray,
    searched: Searched | None,
    finest: float,
) -> Windows:
    """Put what was unfolded and what was searched together."""
    parts = []
    if unfolded is not None:
        w = ~unfolded.search
        parts.append((unfolded.low[w], unfolded.high[w], unfolded.bounces[w], unfolded.words[w]))
    if searched is not None:
        known = np.arange(most)[None, :] < searched.bounces[:, None]
        letters = np.where(searched.words < -1, searched.words + 1, searched.words)
        parts.append((searched.low, searched.high, searched.bounces, np.where(known, letters, NONE)))
    low, high, bounces, edges = (np.concatenate(part) for part in zip(*parts, strict=True))
    by_search = np.arange(len(low)) >= len(low) - (0 if searched is None else len(searched.low))
    words = _walls_of(scene.walls, edges)
    width = high - low
    low, high, rows = merged(low, high, bounces, words)
    widest = np.array([one[np.argmax(width[one])] for one in rows], dtype=np.int64)
    x0, y0, x1, y1 = scene.walls.box()
    return Windows(
        start=start,
        target=target,
        radius=float(scene.balls.radius[0]),
        most_bounces=most,
        low=low,
        high=high,
        bounces=bounces[widest],
        searched=np.array([bool(by_search[one].any()) for one in rows], dtype=np.bool_),
        words=words[widest],
        edges=edges[widest],
        walls=scene.walls,
        searched_share=min(1.0, float((intervals[:, 1] - intervals[:, 0]).sum()) / math.tau),
        resolution=(finest, APART * max(x1 - x0, y1 - y0)) if len(intervals) else (0.0, 0.0),
        lost=0.0 if unfolded is None else unfolded.lost,
        beams=np.zeros(most + 1, dtype=np.int64) if unfolded is None else unfolded.beams,
        shots=0 if searched is None else searched.shots,
    )


def _walls_of(walls: Walls, edges: IntArray) -> IntArray:
    """Give the walls of edges and vertices, NONE where there is none."""
    by_edge = np.searchsorted(walls.edge_offsets, edges, side="right") - 1
    by_vertex = np.searchsorted(walls.offsets, np.maximum(-1 - edges, 0), side="right") - 1
    return np.where(edges == NONE, NONE, np.where(edges < 0, by_vertex, by_edge))
