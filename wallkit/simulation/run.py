"""Run: every contact, the exact state in between, and how each ball ended."""

from __future__ import annotations

import enum
import math
from collections import Counter
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from importers.errors import WallkitError
from importers.pictured import Pictured
from wallkit import arguments
from wallkit.simulation.gliding import guides
from wallkit.simulation.motion import Motion

if TYPE_CHECKING:
    from wallkit.scene.scene import Scene
    from wallkit.simulation.horizon import ErrorSource, Horizon

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
the ball); wall; edge within that wall, -1 for a corner; kind, see :class:`ContactKind`. 88 bytes or fewer."""

MEETING_CONTACT = np.dtype(
    [
        *((name, CONTACT[name]) for name in CONTACT.names or ()),
        ("other", np.int32),
        ("other_x", np.float64),
        ("other_y", np.float64),
        ("other_vx", np.float64),
        ("other_vy", np.float64),
    ]
)
"""One contact of a scene whose balls meet: as ``CONTACT``, then the other ball, its centre, and its velocity after;
-1 and zeros at a wall. Two balls that meet make one row of the kind ``BALL``: ball is the lower of their numbers,
the normal points to it, and wall and edge are -1."""

FINAL = np.dtype(
    [("time", np.float64), ("x", np.float64), ("y", np.float64), ("vx", np.float64), ("vy", np.float64)],
)
"""Where a ball's run ended: time, centre, velocity."""


class ContactKind(enum.IntEnum):
    """What was touched."""

    EDGE = 0
    VERTEX = 1
    SLIDE = 2
    """From here on the ball keeps to the wall: it slides on a line, glides along an arc, or pivots about a vertex
    (where the edge is -1); or it rests. Slowed by friction or drag it has such a contact where it turns, too."""
    LEAVE = 3
    """The ball leaves the wall to which it kept."""
    ENTER = 4
    """The centre crosses a sensor against its outward normal; wall and edge are the sensor's."""
    EXIT = 5
    """The centre crosses a sensor along its outward normal."""
    BALL = 6
    """Two balls meet."""

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


@dataclass(eq=False, repr=False)
class Run(Pictured):
    """What a simulation found.

    Attributes:
        scene: what was simulated.
        contacts: (m,) of ``CONTACT``, by time over all balls; at equal times by ball, then in order. Of
            ``MEETING_CONTACT`` where balls meet, at equal times in order.
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

    def __repr__(self) -> str:
        counts = Counter(ending.label for ending in self.ending).most_common()
        last = float(self.final["time"].max(initial=0.0))
        parts = [
            f"{len(self.final):,} ball{'' if len(self.final) == 1 else 's'}",
            f"{int(self.bounces.sum()):,} bounces in {last:.6g} s",
            *(f"{word} {count:,}" for word, count in counts),
        ]
        return f"<Run: {', '.join(parts)}>"

    @property
    def bounces(self) -> NDArray[np.int64]:
        """(n,) bounces of each ball: its contacts with edges, corners and other balls."""
        bounced = self._rows["ball"][bounces_in(self._rows)]
        return np.bincount(bounced, minlength=len(self.final)).astype(np.int64)

    def contacts_of(self, ball: int) -> NDArray[Any]:
        """Contacts of one ball, in order; where it meets another one, seen from it: it is ``ball`` in each row.

        Raises:
            WallkitError: there is no such ball.
        """
        may_be = f"a whole number from 0 to {len(self.final) - 1}"
        arguments.whole_number(
            ball, "ball", may_be, error=WallkitError, code="bad-ball", least=0, most=len(self.final) - 1
        )
        order, offsets = self._by_ball
        return self._rows[order[offsets[ball] : offsets[ball + 1]]]

    def position(self, time: ArrayLike) -> NDArray[np.float64]:
        """Exact centres at a time from 0, or at many at once; after a ball's end, where it ended.

        Args:
            time: one number, or an array of any shape S, in any order; infinity is after every end.

        Returns:
            S + (n, 2): for one number (n, 2), for k times (k, n, 2).

        Raises:
            WallkitError: a time is negative or no number.
        """
        return self._states(time)[..., 0:2]

    def velocity(self, time: ArrayLike) -> NDArray[np.float64]:
        """Velocities at one time or many, after the contact at that time; after a ball's end, its last.

        Arguments, shapes and errors are those of :meth:`position`.
        """
        return self._states(time)[..., 2:4]

    def take(self, balls: ArrayLike | slice) -> Run:
        """Choose balls: what these did. It is the run that they alone would have made, unless they met others.

        Where one of them met a ball that is not among them, its contact stays, with -1 for the other.

        Args:
            balls: their numbers, each once, in the order wanted; a mask of n truth values; or a slice.

        Raises:
            WallkitError: there is no such ball, one is named twice, or the mask has another length.
        """
        kept = arguments.chosen(balls, len(self.final), "balls", error=WallkitError, code="bad-ball")
        number = np.full(len(self.final), -1, dtype=np.int32)
        number[kept] = np.arange(len(kept), dtype=np.int32)
        if np.count_nonzero(number >= 0) < len(kept):
            raise arguments.refused("balls", balls, "each number once", WallkitError, "bad-ball")
        contacts = _of_balls(self.contacts, number)
        scene = replace(self.scene, balls=self.scene.balls.take(kept))
        ending = tuple(self.ending[ball] for ball in kept.tolist())
        return Run(scene, contacts, self.final[kept], ending, np.asarray(self.start)[kept])

    def save(self, path: str | Path) -> None:
        """Write the run as JSON, scene included; see :func:`wallkit.simulation.run_files.save`."""
        from wallkit.simulation.run_files import save

        arguments.of_type(path, "path", (str, Path), "a path", error=WallkitError, code="bad-path")
        save(self, path)

    @staticmethod
    def load(source: str | Path | IO[bytes] | IO[str]) -> Run:
        """Read a run that :meth:`save` wrote, the same bits; see :func:`wallkit.simulation.run_files.load`."""
        from wallkit.simulation.run_files import load

        if not isinstance(source, str | Path) and not hasattr(source, "read"):
            raise arguments.refused("source", source, "a path or an open file", WallkitError, "bad-path")
        return load(source)

    def trusted_until(self, tolerance: float = 1e-6, source: ErrorSource = "rounding") -> list[Horizon]:
        """Say for each ball up to which bounce, and time, its contacts are good to ``tolerance``.

        The growth of a small error is carried along the contacts; see ``horizon`` for the equations. It is good
        throughout (``whole``) if place and velocity at its end are good, too.

        Args:
            tolerance: of the place of a contact, in the drawing's units; of the velocity at the end in these a second.
            source: what is wrong to begin with: ``"rounding"`` of the arithmetic, or the ``"drawing"``, whose
                walls are off by their ``measured_error``.

        Raises:
            WallkitError: the tolerance is not above 0, or the source is none of the two.
        """
        from wallkit.simulation.horizon import trusted_until

        arguments.number(
            tolerance,
            "tolerance",
            "a finite number above 0",
            error=WallkitError,
            code="bad-tolerance",
            least=arguments.ABOVE_0,
        )
        arguments.word(source, "source", ("rounding", "drawing"), error=WallkitError, code="bad-source")
        if self.scene.meeting and np.count_nonzero(self.scene.balls.radius) > 1:
            from wallkit.simulation.meeting_horizon import trusted_together

            return trusted_together(self, tolerance, source)
        return [
            trusted_until(self.scene, self.contacts_of(ball), ball, tolerance, source, final)
            for ball, final in enumerate(self.final)
        ]

    @cached_property
    def _rows(self) -> NDArray[Any]:
        """Contacts, with a row for each of two balls that meet."""
        return one_a_ball(self.contacts)

    @cached_property
    def _by_ball(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        ball = self._rows["ball"]
        order = np.argsort(ball, kind="stable")
        offsets = np.zeros(len(self.final) + 1, dtype=np.int64)
        np.cumsum(np.bincount(ball, minlength=len(self.final)), out=offsets[1:])
        return order, offsets

    def _states(self, time: ArrayLike) -> NDArray[np.float64]:
        """S + (n, 4) states x, y, vx, vy at times of the shape S."""
        may_be = "seconds, 0 or more, or an array of them"
        times = arguments.floats(time, "time", may_be, error=WallkitError, code="bad-time")
        if not (times >= 0.0).all():
            raise arguments.refused("time", time, may_be, WallkitError, "bad-time")
        states = np.empty((times.size, len(self.final), 4))
        for ball in range(len(self.final)):
            states[:, ball] = self._states_of(ball, times.ravel())
        return states.reshape(*times.shape, len(self.final), 4)

    def _states_of(self, ball: int, times: NDArray[np.float64]) -> NDArray[np.float64]:
        """(k, 4) states of one ball: of each time the flight that it falls into, carried on."""
        own, end = self._turns[ball], float(self.final[ball]["time"])
        passed, which = np.unique(np.searchsorted(own["time"], times, side="right"), return_inverse=True)
        begun = passed[passed > 0] - 1
        rows = np.searchsorted(begun, passed - 1, side="right")[which]  # 0 is the start
        motion = Motion.after(self.scene, self.start[ball], own[begun], self._bends[ball][begun])
        since = np.concatenate([[0.0], own["time"][begun]])[rows]
        span, ended = np.maximum(np.minimum(times, end) - since, 0.0), times >= end
        if motion.damping is not None:
            span = np.where(ended & (self.ending[ball] == Ending.AT_REST), math.inf, span)
        last = ended & motion.held[rows]  # a ball that walls hold to its end is where its run says
        flown = motion.at(rows, np.where(last, 0.0, span))
        flown[last] = [self.final[ball][name] for name in ("x", "y", "vx", "vy")]
        return flown

    @cached_property
    def _bends(self) -> list[NDArray[np.float64]]:
        """By ball what :func:`wallkit.simulation.gliding.guides` says of the contacts in ``_turns``."""
        return [guides(self.scene.walls, own) for own in self._turns]

    @cached_property
    def _turns(self) -> list[NDArray[Any]]:
        """By ball the contacts that change its flight; sensors do not."""
        return [own[turns_in(own)] for own in map(self.contacts_of, range(len(self.final)))]


def one_a_ball(contacts: NDArray[Any]) -> NDArray[Any]:
    """Give contacts with a row for each ball of two that meet, each seen from its ball, one after the other."""
    if "other" not in (contacts.dtype.names or ()):
        return contacts
    met = np.flatnonzero(contacts["other"] >= 0)
    seen = contacts[met]
    for own, other in (("ball", "other"), *((name, f"other_{name}") for name in ("x", "y", "vx", "vy"))):
        seen[own], seen[other] = contacts[other][met], contacts[own][met]
    seen["nx"], seen["ny"] = -seen["nx"], -seen["ny"]
    order = np.argsort(np.concatenate([np.arange(len(contacts)), met]), kind="stable")
    whole: NDArray[Any] = np.concatenate([contacts, seen])[order]
    return whole


def in_order(contacts: NDArray[Any]) -> NDArray[Any]:
    """Sort contacts by time; at equal times by ball, or, where balls meet, as they come."""
    if "other" in (contacts.dtype.names or ()):
        return contacts[np.argsort(contacts["time"], kind="stable")]
    return contacts[np.lexsort((contacts["ball"], contacts["time"]))]


def bounces_in(contacts: NDArray[Any]) -> NDArray[np.bool_]:
    """Tell which contacts are bounces: with edges, corners or balls."""
    found: NDArray[np.bool_] = (contacts["kind"] <= ContactKind.VERTEX) | (contacts["kind"] == ContactKind.BALL)
    return found


def turns_in(contacts: NDArray[Any]) -> NDArray[np.bool_]:
    """Tell which contacts change a flight: all but crossings of sensors."""
    found: NDArray[np.bool_] = (contacts["kind"] != ContactKind.ENTER) & (contacts["kind"] != ContactKind.EXIT)
    return found


def _of_balls(contacts: NDArray[Any], number: NDArray[np.int32]) -> NDArray[Any]:
    """Contacts of the balls whose new number is not -1, under these numbers."""
    kept: NDArray[Any] = contacts[number[contacts["ball"]] >= 0]
    if "other" in (contacts.dtype.names or ()):
        rows = one_a_ball(contacts)
        kept = rows[number[rows["ball"]] >= 0]
        other = np.where(kept["other"] >= 0, number[kept["other"]], -1)
        again = (other >= 0) & (other < number[kept["ball"]])  # the same contact, seen from the other one
        kept, other = kept[~again], other[~again]
        kept["other"] = other
    kept["ball"] = number[kept["ball"]]
    return in_order(kept)
