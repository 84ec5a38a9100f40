"""Motion: where balls are between two contacts. Runs, worlds, sensors and all that is drawn ask this one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.simulation.damping import Slowing, carried_on, damping_of, flown_on, slowing_of
from wallkit.simulation.gliding import SLIDE, glide, pull_along

if TYPE_CHECKING:
    from wallkit.scene.scene import Scene


@dataclass(slots=True, eq=False, repr=False)
class Motion:
    """What m balls do, each from its start or a contact on until the next one.

    In flight x'' = g, with drag x'' = g - k x'; without gravity x'' = -k x', or -a x' / |x'| for rolling friction a. A
    ball that a straight wall holds has only the part of g along it, less friction there. One that an arc or a vertex
    holds goes round on a circle, see :func:`wallkit.simulation.gliding.glide`.

    Attributes:
        state: (m, 4) x, y, vx, vy just after the contact.
        pull: (m, 2) acceleration, drag aside; of one on a circle that where it begins.
        normal: (m, 2) of the contact, unit, towards the ball; zeros for a start.
        held: (m,) a wall holds the ball from the contact on.
        bend: (m,) signed radius of the centre's circle, 0 for none; see :func:`wallkit.simulation.gliding.guides`.
        gravity: (2,) that acts on all.
        damping: friction and drag without gravity, or None.
        slowing: friction and drag under gravity.
    """

    state: FloatArray
    pull: FloatArray
    normal: FloatArray
    held: NDArray[np.bool_]
    bend: FloatArray
    gravity: FloatArray
    damping: FloatArray | None
    slowing: Slowing

    @staticmethod
    def of(scene: Scene, state: FloatArray) -> Motion:
        """Give the free flights of m balls, from (m, 4) states."""
        gravity = np.asarray(scene.gravity if scene.gravity is not None else (0.0, 0.0), dtype=np.float64)
        pull, held = np.tile(gravity, (len(state), 1)), np.zeros(len(state), dtype=np.bool_)
        normal, bend = np.zeros((len(state), 2)), np.zeros(len(state))
        return Motion(state, pull, normal, held, bend, gravity, damping_of(scene), slowing_of(scene))

    @staticmethod
    def after(scene: Scene, start: FloatArray, contacts: NDArray[Any], bend: FloatArray) -> Motion:
        """Give what one ball does from its start, (4,), and after each of k of its contacts: k + 1 rows.

        Args:
            scene: what acts.
            start: x, y, vx, vy.
            contacts: (k,) of ``CONTACT``.
            bend: (k,) what :func:`wallkit.simulation.gliding.guides` says of them.
        """
        state = np.empty((1 + len(contacts), 4))
        state[0] = start
        for column, name in enumerate(("x", "y", "vx", "vy")):
            state[1:, column] = contacts[name]
        motion = Motion.of(scene, state)
        motion.normal[1:, 0], motion.normal[1:, 1] = contacts["nx"], contacts["ny"]
        held = 1 + np.flatnonzero(contacts["kind"] == SLIDE)
        motion.hold(held, motion.normal[held], bend[held - 1])
        return motion

    def hold(self, rows: IntArray, normal: FloatArray, bend: FloatArray) -> None:
        """Let walls hold some balls: (k,) rows, (k, 2) normals towards the balls and (k,) signed radii."""
        self.normal[rows], self.held[rows], self.bend[rows] = normal, True, bend
        for row in rows.tolist():
            self.pull[row] = pull_along(self.gravity, self.slowing, self.state[row, 2:4], self.normal[row])

    def begin(self, row: int, position: FloatArray, velocity: FloatArray) -> None:
        """Let one ball fly from a place on; the normal of what it touched last stays."""
        self.state[row, 0:2], self.state[row, 2:4] = position, velocity
        self.pull[row], self.held[row], self.bend[row] = self.gravity, False, 0.0

    def at(self, rows: IntArray, span: FloatArray) -> FloatArray:
        """Give (k, 4) states of (k,) rows, each (k,) a time after it began; infinite only where friction ends it."""
        state = self.state[rows]
        if self.damping is not None:
            each = zip(state, span.tolist(), strict=True)
            return np.array([carried_on(self.damping, *one) for one in each]).reshape(-1, 4)
        time = span[:, None]
        flown = flown_on(self.slowing.drag, state[:, 0:2], state[:, 2:4], self.pull[rows], time)
        result: FloatArray = np.where(time > 0.0, flown, state)
        for k in np.flatnonzero((self.bend[rows] != 0.0) & (span > 0.0)).tolist():
            row = rows[k]
            bend = float(self.bend[row])
            result[k] = glide(self.gravity, self.slowing, state[k], self.normal[row], bend, float(span[k]))
        return result
