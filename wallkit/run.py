"""Run: every contact, the exact state in between, and how each ball ended."""

from __future__ import annotations

import enum
import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from importers.pictured import Pictured
from wallkit.damping import carried_on, damping_of
from wallkit.gliding import glide, guides

if TYPE_CHECKING:
    from wallkit.horizon import Horizon, Source
    from wallkit.scene import Scene

CONTACT = np.dtype(
    [
        ("time", np.float64),
        ("ball", np.int32),
        ("x", np.float64),
        ("y", np.float64),
        ("vx", np.float64),
        ("vy", np.float64),
        ("px", np.float64),
        ("py", np.float64),
        ("nx", np.float64),
        ("ny", np.float64),
        ("wall", np.int32),
        ("edge", np.int32),
        ("kind", np.uint8),
    ]
)
"""One contact: time; ball; centre x, y; velocity vx, vy after; contact point px, py; unit normal nx, ny (towards
the ball); wall; edge within that wall, -1 for a corner; kind, see :class:`Kind`. 88 bytes or fewer."""

FINAL = np.dtype(
    [("time", np.float64), ("x", np.float64), ("y", np.float64), ("vx", np.float64), ("vy", np.float64)],
)
"""Where a ball's run ended: time, centre, velocity."""


class Kind(enum.IntEnum):
    """What was touched."""

    EDGE = 0
    VERTEX = 1
    SLIDE = 2
    """From here on the ball keeps to the wall, without friction: it slides on a line, glides along an arc, or pivots
    about a vertex (where the edge is -1); or it rests."""
    LEAVE = 3
    """The ball leaves the wall to which it kept."""
    ENTER = 4
    """The centre crosses a sensor against its outward normal; wall and edge are the sensor's."""
    EXIT = 5
    """The centre crosses a sensor along its outward normal."""

    @property
    def label(self) -> str:
        """The word in the CSV."""
        return self.name.lower()


class Ending(enum.IntEnum):
    """How a ball's run ended."""

    TIME_REACHED = 0
    BOUNCE_LIMIT = 1
    LEFT_SCENE = 2
    AT_REST = 3
    COLLAPSE = 4
    AMBIGUOUS_CORNER = 5
    ABSORBED = 6
    SWINGING = 7
    """It keeps to the walls and meets nothing ever again: a run without an end in time stops there."""

    @property
    def label(self) -> str:
        """The words for people and files: "time reached", "left the scene"."""
        words = {Ending.LEFT_SCENE: "left the scene", Ending.SWINGING: "swings for ever"}
        return words.get(self, self.name.lower().replace("_", " "))


@dataclass(eq=False)
class Run(Pictured):
    """What a simulation found.

    Attributes:
        scene: what was simulated.
        contacts: (m,) of ``CONTACT``, by time over all balls; at equal times by ball, then in order.
        final: (n,) of ``FINAL``, one a ball. A ball that left the scene has its last contact here, unless the
            run was given an end time.
        ending: n endings, one a ball.
        start: (n, 4) positions and velocities at time 0.
    """

    scene: Scene
    contacts: NDArray[Any]
    final: NDArray[Any]
    ending: tuple[Ending, ...]
    start: NDArray[np.float64] = field(repr=False, default_factory=lambda: np.empty((0, 4)))

    @property
    def bounces(self) -> NDArray[np.int64]:
        """(n,) bounces of each ball: its contacts with edges and corners."""
        bounced = self.contacts["ball"][self.contacts["kind"] <= Kind.VERTEX]
        return np.bincount(bounced, minlength=len(self.final)).astype(np.int64)

    def contacts_of(self, ball: int) -> NDArray[Any]:
        """Contacts of one ball, in order."""
        order, offsets = self._by_ball
        return self.contacts[order[offsets[ball] : offsets[ball + 1]]]

    def position(self, time: float) -> NDArray[np.float64]:
        """Exact centres (n, 2) at a time from 0; after a ball's end, where it ended."""
        return self._state(time)[:, 0:2]

    def velocity(self, time: float) -> NDArray[np.float64]:
        """Velocities (n, 2) at a time from 0, after the contact at that time; after a ball's end, its last."""
        return self._state(time)[:, 2:4]

    def trusted_until(self, tolerance: float = 1e-6, source: Source = "rounding") -> list[Horizon]:
        """Say for each ball up to which bounce, and time, its contacts are good to ``tolerance``.

        The growth of a small error is carried along the contacts; see :mod:`wallkit.horizon` for the equations.

        Args:
            tolerance: of the place of a contact, in the drawing's units.
            source: what is wrong to begin with: ``"rounding"`` of the arithmetic, or the ``"drawing"``, whose
                walls are off by their ``measured_error``.
        """
        from wallkit.horizon import trusted_until

        ends = self.final["time"].tolist()
        return [
            trusted_until(self.scene, own[own["kind"] <= Kind.VERTEX], ball, tolerance, source, end)
            for ball, end in enumerate(ends)
            for own in [self.contacts_of(ball)]
        ]

    @cached_property
    def _by_ball(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        order = np.argsort(self.contacts["ball"], kind="stable")
        offsets = np.zeros(len(self.final) + 1, dtype=np.int64)
        np.cumsum(np.bincount(self.contacts["ball"], minlength=len(self.final)), out=offsets[1:])
        return order, offsets

    def _state(self, time: float) -> NDArray[np.float64]:
        state = np.array(self.start, dtype=np.float64)
        for ball in range(len(self.final)):
            own = self._turns[ball]
            passed = int(np.searchsorted(own["time"], time, side="right"))
            contact = own[passed - 1] if passed else None
            since = 0.0
            if contact is not None:
                since = float(contact["time"])
                state[ball] = contact["x"], contact["y"], contact["vx"], contact["vy"]
            end = float(self.final[ball]["time"])
            if self._damping is not None:
                rests = time >= end and self.ending[ball] == Ending.AT_REST
                span = math.inf if rests else max(min(time, end) - since, 0.0)
                state[ball] = carried_on(self._damping, state[ball], span)
            elif (span := min(time, end) - since) > 0.0:
                pull = self.pull_after(contact)
                if contact is not None and contact["kind"] == Kind.SLIDE:
                    normal = np.array([contact["nx"], contact["ny"]])
                    state[ball] = glide(self._gravity, state[ball], normal, self._bends[ball][passed - 1], span)
                    continue
                x, v = state[ball, 0:2], state[ball, 2:4]
                state[ball] = np.concatenate([x + span * (v + 0.5 * span * pull), v + span * pull])
        return state

    @cached_property
    def _gravity(self) -> NDArray[np.float64]:
        return np.asarray(self.scene.gravity if self.scene.gravity is not None else (0.0, 0.0), dtype=np.float64)

    @cached_property
    def _bends(self) -> list[NDArray[np.float64]]:
        """By ball what :func:`wallkit.gliding.guides` says of the contacts in ``_turns``."""
        return [guides(self.scene.walls, own) for own in self._turns]

    @cached_property
    def _damping(self) -> NDArray[np.float64] | None:
        return damping_of(self.scene)

    @cached_property
    def _turns(self) -> list[NDArray[Any]]:
        """By ball the contacts that change its flight; sensors do not."""
        return [own[own["kind"] < Kind.ENTER] for own in map(self.contacts_of, range(len(self.final)))]

    def pull_after(self, contact: Any) -> NDArray[np.float64]:
        """Acceleration after a contact (None: at the start): gravity, or the part of it along a wall that holds."""
        return pull_of(self.scene, contact)


def pull_of(scene: Scene, contact: Any) -> NDArray[np.float64]:
    """Acceleration after a contact (None: at the start): gravity, or its part along a straight wall that holds."""
    pull = np.asarray(scene.gravity if scene.gravity is not None else (0.0, 0.0), dtype=np.float64)
    if contact is None or contact["kind"] != Kind.SLIDE:
        return pull
    along = np.array([-contact["ny"], contact["nx"]])
    return along * float(along @ pull)
