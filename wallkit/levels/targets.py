"""What a target is: a disc, given by its numbers or by a name of the level."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from wallkit import arguments
from wallkit.scene.scene import Scene, SceneError
from wallkit.simulation.modelled import LENGTHS

Disc = tuple[float, float, float]
FARTHEST = LENGTHS[1]
"""A place is no farther away than the walls may be, so that products of two are numbers."""


def target_of(scene: Scene, target: Sequence[float] | str) -> Disc:
    """Give centre and radius of a target.

    A name is that of a target or a spawn of the drawing, or of a sensor. What is drawn as a circle is that circle; of
    anything else the target is the largest disc around the middle of its box that no corner of the box is inside of:
    half its shorter side is the radius.

    Raises:
        SceneError: it is no disc with a radius above 0, or nothing, or more than one thing, has that name.
    """
    return _named(scene, target) if isinstance(target, str) else disc_of(target)


def disc_of(target: Sequence[float]) -> Disc:
    """Give a target that is said in numbers.

    Raises:
        SceneError: they are not three numbers of at most 1e60, the last above 0.
    """
    may_be = f"three numbers up to {FARTHEST:g}, (x, y, radius above 0), or a name"
    disc = arguments.floats(target, "target", may_be, error=SceneError, code="bad-target")
    if disc.shape != (3,) or not (np.abs(disc) <= FARTHEST).all() or disc[2] <= 0.0:
        raise arguments.refused("target", target, may_be, SceneError, "bad-target")
    x, y, r = disc.tolist()
    return x, y, r


def given_target(text: str) -> tuple[float, ...] | str:
    """Read a target as it is typed: numbers between commas, or else a name."""
    try:
        numbers = tuple(float(part) for part in text.split(","))
    except ValueError:
        return text
    return numbers if len(numbers) > 1 else text


def named_targets(scene: Scene) -> dict[str, list[Disc]]:
    """List what has a name and a size: discs by name, the same disc once."""
    found: dict[str, list[Disc]] = {}
    for name, disc in (*_sensors(scene), *_markers(scene)):
        discs = found.setdefault(name, [])
        if disc[2] > 0.0 and not any(math.dist(disc, other) <= 1e-3 * disc[2] for other in discs):
            discs.append(disc)
    return {name: discs for name, discs in found.items() if name and discs}


def _named(scene: Scene, name: str) -> Disc:
    known = named_targets(scene)
    discs = known.get(name, [])
    if len(discs) == 1:
        return discs[0]
    if discs:
        places = "; ".join(f"{x:.6g},{y:.6g},{r:.6g}" for x, y, r in discs[:4])
        raise SceneError(
            f"{len(discs)} things are named {name!r}", code="bad-target", fix=f"give one of them: {places}"
        )
    names = ", ".join(map(repr, sorted(known)[:8]))
    fix = f"there are {names}" if names else "the scene names none: give X,Y,R, or name a sensor (docs/tags.md)"
    raise SceneError(f"no target or sensor with a size is named {name!r}", code="no-target", fix=fix)


def _markers(scene: Scene) -> Iterator[tuple[str, Disc]]:
    for marker in scene.walls.markers:
        yield marker.name, (marker.x, marker.y, marker.radius)


def _sensors(scene: Scene) -> Iterator[tuple[str, Disc]]:
    """Give the discs of closed sensors: the circle, or the disc in the middle of the box."""
    if scene.sensors is None:
        return
    for index, sensor in enumerate(scene.sensors):
        if sensor.closed:
            one = scene.sensors.take([index])
            size = float(np.ptp(sensor.vertices, axis=0).max())
            points = one.straightened(1e-9 * size).vertices if one.has_arcs else sensor.vertices
            (x0, y0), (x1, y1) = points.min(axis=0).tolist(), points.max(axis=0).tolist()
            yield sensor.name, ((x0 + x1) / 2, (y0 + y1) / 2, min(x1 - x0, y1 - y0) / 2)
