"""Scenes made ready for surveys: checked, in local coordinates, indexed, their balls in an order."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wallkit.arguments import flag, of_type
from wallkit.geometry.arrays import FloatArray
from wallkit.kernels.index.start_overlaps import all_clear, all_clear_in_cells
from wallkit.kernels.jit import compiled
from wallkit.kernels.records import Model
from wallkit.scene.scene import Balls, Scene, SceneError
from wallkit.scene.start_overlaps import check_apart, check_starts
from wallkit.simulation.edge_records import columns
from wallkit.simulation.meeting_rules import check_modelled
from wallkit.simulation.modelled import Modelled
from wallkit.simulation.sensors import modelled_sensors

CLOSE_CELLS = 1 << 15
"""So many are always at hand: balls are then best taken as they come, one after the other in memory."""
WORTH_A_QUICK_LOOK = 100
"""Balls from which on a compiled look for overlaps pays among few lines."""


@dataclass(frozen=True, eq=False, repr=False)
class PreparedScene:
    """A scene made ready by :func:`prepare`: checked, in local coordinates, indexed.

    Attributes:
        scene: what it was made of; what is changed in its walls later is not seen. The arrays of its balls are read by
            each survey as they are then: other balls need another call.
        modelled: what the kernels see of it.
        order: (n,) in which the balls are flown, None for as they come.
        sensors: what the kernels see of the sensors, None where there are none.
    """

    scene: Scene
    modelled: Modelled
    order: NDArray[np.int64] | None
    sensors: Model | None = None

    def __repr__(self) -> str:
        index = (
            "no index" if self.modelled.model.grid is None else f"an index of {len(self.modelled.model.cells):,} cells"
        )
        return f"<PreparedScene: {self.scene!r}, {index}>"


def prepare(scene: Scene, *, check: bool = True) -> PreparedScene:
    """Do once what every ``survey`` of a scene would do first: check it, and index its walls.

    Args:
        scene: walls, balls, and what acts.
        check: look whether a disc overlaps a wall at the start; False where that is known, to save the time.

    Raises:
        SceneError: the scene cannot be simulated, or an argument is none of what may be.
    """
    of_type(scene, "scene", Scene, "a Scene", error=SceneError, code="bad-scene")
    return _prepared(scene, Modelled(scene, machine_code=True, limits=None), check=check)


def prepare_once(scene: Scene, until: float, bounces: int, *, check: bool = True) -> PreparedScene:
    """Prepare a scene for one survey: its index is as fine as pays for the flights that are to come.

    Args:
        scene: as for :func:`prepare`.
        until: seconds, or inf.
        bounces: most of a ball.
        check: as for :func:`prepare`.
    """
    return _prepared(scene, Modelled(scene, machine_code=True, limits=(until, bounces)), check=check)


def prepare_again(ready: PreparedScene, balls: Balls, *, check: bool = True) -> PreparedScene:
    """Prepare a scene with other balls: what was made of its walls is kept where it serves these, too."""
    scene = replace(ready.scene, balls=balls)
    modelled = ready.modelled.with_balls(balls) or Modelled(scene, machine_code=True, limits=None)
    return _prepared(scene, modelled, check=check)


def _prepared(scene: Scene, modelled: Modelled, *, check: bool) -> PreparedScene:
    if flag(check, "check", error=SceneError, code="bad-argument") and not _surely_clear(scene, modelled):
        check_starts(scene)
    if scene.meeting:
        check_modelled(scene)
        if check:
            check_apart(scene)
    order = _neighbours_together(scene.balls.position) if _is_wide(modelled.model) else None
    sensors = None
    if scene.sensors is not None and len(scene.sensors):
        sensors = modelled_sensors(scene, scene.sensors, modelled.origin).model
    return PreparedScene(scene, modelled, order, sensors)


def _is_wide(model: Model) -> bool:
    """Tell whether balls far apart would drive one another's cells out of the cache."""
    return model.grid is not None and len(model.cells) > CLOSE_CELLS


def _surely_clear(scene: Scene, modelled: Modelled) -> bool:
    """Tell whether a quick look shows that no ball overlaps a wall; it does not pay for few balls among few lines."""
    model, radii = modelled.model, modelled.radii
    if model.arcs is not None or (len(radii) < WORTH_A_QUICK_LOOK and model.grid is None):
        return False
    if not radii.any():
        return True
    origin = tuple(modelled.origin.tolist())
    if model.grid is None:
        return bool(compiled(all_clear)(model.lines, model.extent, origin, np.ravel(scene.balls.position), radii))
    return bool(
        compiled(all_clear_in_cells)(model.lines, model.extent, *ball_cells(scene.balls.position, origin, radii))
    )


def ball_cells(position: FloatArray, origin: tuple[float, float], radii: FloatArray) -> tuple[Any, ...]:
    """Give ``all_clear_in_cells`` what it needs of balls at (n, 2) positions, and room to work in."""
    x, y = position.T
    low_x, low_y = float(x.min()) - origin[0], float(y.min()) - origin[1]
    box = low_x, low_y, float(x.max()) - origin[0] - low_x, float(y.max()) - origin[1] - low_y
    return origin, np.ravel(position), radii, box, np.zeros(2 * len(x) + 3, dtype=np.int64), np.empty(3 * len(x))


def _neighbours_together(position: FloatArray) -> NDArray[np.int64]:
    """Order places along Morton's curve: a ball then finds the cells it needs where the one before left them."""
    if not len(position):
        return np.empty(0, dtype=np.int64)
    places = columns(position)
    places = places - places.min(axis=1, keepdims=True)
    x, y = spaced((places * (255.0 / (float(places.max()) or 1.0))).astype(np.int64))
    # Keys of 16 bits are sorted by counting, and balls in one of 256 by 256 squares are near enough.
    return np.argsort((x | y << 1).astype(np.uint16), kind="stable")


def spaced(number: NDArray[np.int64]) -> NDArray[np.int64]:
    """Put a zero before each of ten bits."""
    for shift, mask in ((8, 0x300FF), (4, 0x30F0F), (2, 0x33333), (1, 0x55555)):
        number = (number | number << shift) & mask
    return number
