"""``simulate``: fly every ball of a scene and keep every contact."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from functools import cached_property
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from wallkit.arguments import flag, number, of_type, refused, whole_number, word
from wallkit.geometry.arrays import FloatArray
from wallkit.kernels.compile_aside import at_hand
from wallkit.kernels.flight.ball_state import FALLING_TOLERANCE, TOLERANCE
from wallkit.kernels.flight.flight import fly, fly_all
from wallkit.kernels.flight.resting import side_of
from wallkit.kernels.jit import compile_for, compiled
from wallkit.kernels.records import (
    COUNT,
    LOG,
    LOG_STRIDE,
    NO_HIT,
    PASSING,
    RUNNING,
    STARTING,
    STATE,
    STATE_SIZE,
    Counts,
)
from wallkit.kernels.signatures import Told, kinds_of
from wallkit.scene.scene import Scene, SceneError
from wallkit.scene.start_overlaps import check_apart, check_starts, settled
from wallkit.simulation.modelled import Modelled
from wallkit.simulation.run import CONTACT, FINAL, Ending, Run
from wallkit.simulation.sensors import with_crossings

Mode = Literal["auto", "interpreted", "compiled"]
BOUNCE_GUARD = 1_000_000
"""Bounces a ball may make where no limit was given: a run always ends."""
PATIENCE = 60_000
"""Entries looked at by interpreted kernels, a few microseconds each, before a run asks for machine code."""
CHUNK = 8192
_compiled_features: set[tuple[bool, ...]] = set()  # combinations whose kernels this process has compiled or loaded
START = Counts(
    last=NO_HIT,
    bounces=0,
    ending=RUNNING,
    still=0,
    held=NO_HIT,
    hold=STARTING,
    side=1,
    turns=0,
    changes=0,
    before=NO_HIT,
)


def simulate(
    scene: Scene,
    until: float | None = None,
    bounces: int | None = None,
    *,
    mode: Mode = "auto",
    settle: bool = False,
    progress: Callable[[float], None] | None = None,
) -> Run:
    """Fly every ball until a time, a number of bounces, or an ending of its own, and keep every contact.

    Args:
        scene: walls, balls, and what acts.
        until: seconds; None for no end in time.
        bounces: bounces a ball; None for at most ``BOUNCE_GUARD``. At least one of the two must be given.
        mode: ``"interpreted"`` or ``"compiled"`` kernels, which give the same bits. ``"auto"`` interprets; a longer
            run has its kernels compiled by another process meanwhile, and goes on compiled as soon as they are.
        settle: move discs that overlap a wall where they start to the nearest free spot.
        progress: called now and then with the part done, 0 to 1.

    Raises:
        SceneError: neither limit was given, an argument is none of what may be, a disc overlaps a wall at the start,
            or the scene cannot be simulated.
    """
    limit_time, limit_bounces = limits(until, bounces)
    of_type(scene, "scene", Scene, "a Scene", error=SceneError, code="bad-scene")
    word(mode, "mode", get_args(Mode), error=SceneError, code="bad-mode")
    if progress is not None and not callable(progress):
        raise refused("progress", progress, "a function of one number, or None", SceneError, "bad-argument")
    if flag(settle, "settle", error=SceneError, code="bad-argument"):
        scene = settled(scene)
    check_starts(scene)
    if scene.meeting:
        check_apart(scene)
        from wallkit.simulation.meeting_run import simulate_meeting

        return with_crossings(simulate_meeting(scene, limit_time, limit_bounces, mode=mode, progress=progress), mode)
    return flown(Flights(scene, mode=mode), limit_time, limit_bounces, progress)


def flown(flights: Flights, until: float, bounces: int, progress: Callable[[float], None] | None = None) -> Run:
    """Fly every ball of checked flights to a time or a number of bounces, one ball after the other."""
    logs: list[FloatArray] = []
    owners: list[NDArray[np.int32]] = []
    for ball in range(len(flights)):
        for log in flights.fly(ball, until, bounces):
            logs.append(log)
            owners.append(np.full(len(log), ball, dtype=np.int32))
            if progress is not None:
                progress(flights.part_done(ball, until, bounces))
    contacts = flights.contacts(logs, owners)
    return with_crossings(Run(flights.scene, contacts, flights.final(), flights.endings(), flights.start), flights.mode)


class Flights:
    """The balls of a scene in flight: each can be flown on, by time or by bounces.

    Attributes:
        start: (n, 4) positions and velocities at time 0.
        hits: (W,) bounces by wall so far.
    """

    def __init__(
        self, scene: Scene, *, mode: Mode = "auto", index: str = "auto", modelled: Modelled | None = None
    ) -> None:
        """Begin.

        Args:
            scene: walls, balls, and what acts.
            mode: see :func:`simulate`.
            index: see :class:`Modelled`.
            modelled: of this very scene, where it is known.
        """
        self.scene = scene
        self.modelled = Modelled(scene, index=index, machine_code=mode == "compiled") if modelled is None else modelled
        self.mode = mode
        position, velocity = np.asarray(scene.balls.position), np.asarray(scene.balls.velocity)
        self.start: FloatArray = np.hstack([position, velocity]).astype(np.float64)
        self._states = initial_states(self.modelled, position, velocity).tolist()
        self._counts = [list(START) for _ in self._states]
        self.hits = np.zeros(len(scene.walls), dtype=np.int64)
        self._work = 0
        self._features = tuple(feature is None for feature in self.modelled.model)
        # What compiled kernels are given for one ball: its radius, state and counts are written into these.
        self._one = np.empty(1), np.empty((1, STATE_SIZE)), np.empty((1, len(START)), dtype=np.int64)
        self._told = Told(self._one[0]), Told(self._one[1]), Told(self._one[2])

    def __len__(self) -> int:
        return len(self._states)

    def fly(self, ball: int, until: float, limit: int) -> Any:
        """Fly a ball on; yield its contacts in pieces, (k, LOG_STRIDE) each, local coordinates."""
        counts = self._counts[ball]
        if counts[COUNT.ending] in (Ending.TIME_REACHED, Ending.BOUNCE_LIMIT, Ending.SWINGING):
            counts[COUNT.ending] = RUNNING
        while counts[COUNT.ending] == RUNNING:
            log = self._piece(ball, until, limit)
            if len(log):
                yield log

    def _piece(self, ball: int, until: float, limit: int, room: int | None = None) -> FloatArray:
        state, counts, radius = self._states[ball], self._counts[ball], float(self.modelled.radii[ball])
        room = room or max(1, min(CHUNK, limit - counts[COUNT.bounces] + 1))
        if self._compile():
            machine_log = np.empty(room * LOG_STRIDE)
            _compiled_features.add(self._features)
            radii, states, many_counts = self._one
            radii[0], states[0], many_counts[0] = radius, state, counts
            noted = compiled(fly_all)(*self._arguments(until, limit, machine_log))
            state[:], counts[:] = states[0].tolist(), many_counts[0].tolist()
            return machine_log.reshape(room, LOG_STRIDE)[:noted]
        room = min(room, 256)
        lists, log = self.modelled.lists, [0.0] * (room * LOG_STRIDE)
        noted = fly(lists, lists.gravity, radius, state, counts, until, limit, self.hits, log, room)
        self._work += (noted + 1) * self._entries_a_bounce()
        return np.array(log).reshape(room, LOG_STRIDE)[:noted]

    def _arguments(self, until: float, limit: int, log: FloatArray) -> tuple[Any, ...]:
        """Give what the compiled kernel is called with for one ball."""
        model, gravity = self.modelled.told
        return model, gravity, *self._told, until, limit, self.hits, log, len(log) // LOG_STRIDE

    def machine_code_at_hand(self) -> bool:
        """Tell whether a compiled flight would begin at once; where not, it is being compiled from now on."""
        if self._features in _compiled_features:
            return True
        return at_hand(compile_for, fly_all, *kinds_of(self._arguments(math.inf, 1, np.empty(LOG_STRIDE))))

    def next_contact(self, ball: int) -> FloatArray | None:
        """Fly a ball on to its next contact, (LOG_STRIDE,); None if it has none."""
        counts = self._counts[ball]
        if counts[COUNT.ending] in (Ending.TIME_REACHED, Ending.BOUNCE_LIMIT, Ending.LEFT_SCENE):
            counts[COUNT.ending] = RUNNING
        counts[COUNT.changes] = 0
        if counts[COUNT.ending] != RUNNING:
            return None
        piece = self._piece(ball, math.inf, sys.maxsize, room=1)
        return piece[0] if len(piece) else None

    def ended(self, ball: int) -> float | None:
        """Give the time at which a ball came to an end of its own (rest, collapse, ambiguous corner), or None.

        None too for a ball that friction or drag stops: its flight itself ends where it rests.
        """
        ending = self._counts[ball][COUNT.ending]
        if ending in (RUNNING, Ending.TIME_REACHED, Ending.BOUNCE_LIMIT, Ending.LEFT_SCENE, Ending.SWINGING):
            return None
        if ending == Ending.AT_REST and self.modelled.model.damping is not None:
            return None
        return float(self._states[ball][STATE.time] + self._states[ball][STATE.lost])

    def place(
        self,
        ball: int,
        position: FloatArray,
        velocity: FloatArray,
        time: float,
        last: int,
        normal: FloatArray | None = None,
    ) -> None:
        """Let a ball go on from elsewhere, in the scene's coordinates.

        Args:
            ball: which.
            position: (2,) centre.
            velocity: (2,).
            time: of its clock.
            last: the feature that it touches and leaves, or NO_HIT.
            normal: (2,) of that feature, towards the ball, where it keeps to it.
        """
        state = initial_states(self.modelled, position[None], velocity[None])[0].tolist()
        state[STATE.time] = time
        counts = START._replace(last=last, bounces=self._counts[ball][COUNT.bounces])
        if normal is not None:
            model, x, y, (nx, ny) = self.modelled.lists, state[STATE.x], state[STATE.y], normal.tolist()
            side = side_of(model, model.arcs, last, x, y, nx, ny)
            counts = counts._replace(held=last, hold=PASSING, side=int(side))
        self._states[ball], self._counts[ball] = state, list(counts)

    def _compile(self) -> bool:
        if self.mode == "auto":
            return self._features in _compiled_features or (self._work > PATIENCE and self.machine_code_at_hand())
        return self.mode == "compiled"

    def _entries_a_bounce(self) -> int:
        model = self.modelled.model
        return 30 if model.grid is not None else len(model.ids) + 3

    def part_done(self, ball: int, until: float, limit: int) -> float:
        """Part of all the work that is done when this ball is where it is, 0 to 1."""
        one: float = max(
            self._states[ball][STATE.time] / max(until, 1e-300), self._counts[ball][COUNT.bounces] / max(limit, 1)
        )
        return (ball + min(one, 1.0)) / len(self)

    def final(self) -> NDArray[Any]:
        """(n,) of ``FINAL``: where the balls are now."""
        final = np.zeros(len(self), dtype=FINAL)
        states = np.array(self._states).reshape(-1, STATE_SIZE)
        ox, oy = self.modelled.origin
        final["x"], final["y"] = states[:, STATE.x] + ox, states[:, STATE.y] + oy
        final["vx"], final["vy"] = states[:, STATE.vx], states[:, STATE.vy]
        final["time"] = states[:, STATE.time] + states[:, STATE.lost]
        return final

    @property
    def bounces(self) -> NDArray[np.int64]:
        """(n,) bounces of each ball so far."""
        return np.array([counts[COUNT.bounces] for counts in self._counts], dtype=np.int64)

    def endings(self) -> tuple[Ending, ...]:
        """How each ball ended."""
        final = self.final()
        position, velocity = np.stack([final["x"], final["y"]], 1), np.stack([final["vx"], final["vy"]], 1)
        gone = is_gone(self.modelled.box, position, velocity, self.modelled.radii)
        endings = [Ending(counts[COUNT.ending]) for counts in self._counts]
        return tuple(
            Ending.LEFT_SCENE if ending == Ending.TIME_REACHED and gone[ball] else ending
            for ball, ending in enumerate(endings)
        )

    def contacts(self, logs: list[FloatArray], owners: list[NDArray[np.int32]]) -> NDArray[Any]:
        """Contacts of the scene, in its coordinates, in order of time."""
        log = np.concatenate(logs) if logs else np.empty((0, LOG_STRIDE))
        ball = np.concatenate(owners) if owners else np.empty(0, np.int32)
        order = np.lexsort((ball, log[:, LOG.time]))
        log, ball = log[order], ball[order]
        contacts = np.zeros(len(log), dtype=CONTACT)
        ox, oy = self.modelled.origin
        contacts["time"], contacts["ball"] = log[:, LOG.time], ball
        contacts["x"], contacts["y"] = log[:, LOG.x] + ox, log[:, LOG.y] + oy
        contacts["vx"], contacts["vy"] = log[:, LOG.vx], log[:, LOG.vy]
        contacts["px"], contacts["py"] = log[:, LOG.px] + ox, log[:, LOG.py] + oy
        contacts["nx"], contacts["ny"] = log[:, LOG.nx], log[:, LOG.ny]
        contacts["kind"] = log[:, LOG.kind].astype(np.uint8)
        wall, edge = self.places(log[:, LOG.feature].astype(np.int64))
        contacts["wall"], contacts["edge"] = wall, edge
        return contacts

    @cached_property
    def _wall_tables(self) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
        walls, edge_in_wall = self.modelled.index_of_edge(self.scene)
        return walls, edge_in_wall, np.repeat(np.arange(len(self.scene.walls)), np.diff(self.scene.walls.offsets))

    def places(self, feature: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Wall of each feature, and edge within it, -1 for a corner."""
        walls, edge_in_wall, corner_wall = self._wall_tables
        is_edge = feature >= 0
        wall, edge = np.zeros_like(feature), np.full_like(feature, -1)
        wall[is_edge], edge[is_edge] = walls[feature[is_edge]], edge_in_wall[feature[is_edge]]
        wall[~is_edge] = corner_wall[-2 - feature[~is_edge]]
        return wall, edge


def initial_states(modelled: Modelled, position: FloatArray, velocity: FloatArray) -> FloatArray:
    """(n, STATE_SIZE) states of balls at rest on the clock, local coordinates."""
    states = np.zeros((len(position), STATE_SIZE))
    local = position - modelled.origin
    states[:, [STATE.x, STATE.y]] = states[:, [STATE.from_x, STATE.from_y]] = local
    states[:, [STATE.vx, STATE.vy]] = states[:, [STATE.from_vx, STATE.from_vy]] = velocity
    states[:, STATE.energy] = velocity[:, 0] * velocity[:, 0] + velocity[:, 1] * velocity[:, 1]
    tolerance = TOLERANCE
    if (gravity := modelled.model.gravity) is not None:
        tolerance = FALLING_TOLERANCE
        states[:, STATE.energy] -= 2.0 * (gravity[0] * local[:, 0] + gravity[1] * local[:, 1])
    states[:, STATE.tolerance] = tolerance * np.maximum(np.abs(local).max(axis=1, initial=0.0), modelled.model.extent)
    return states


def is_gone(
    box: tuple[float, float, float, float], position: FloatArray, velocity: FloatArray, radii: FloatArray
) -> NDArray[np.bool_]:
    """Tell which balls are outside the walls' box, by more than rounding, and fly away from it."""
    beyond = radii[:, None] + 2.0**-40 * np.abs(box).max()
    low, high = np.array(box[0:2]) - beyond, np.array(box[2:4]) + beyond
    gone: NDArray[np.bool_] = np.any(
        ((position > high) & (velocity >= 0)) | ((position < low) & (velocity <= 0)), axis=1
    )
    return gone


def limits(until: float | None, bounces: int | None) -> tuple[float, int]:
    """Check the two limits of a run and give them as numbers: (until or inf, bounces or the guard)."""
    if until is None and bounces is None:
        raise SceneError(
            "neither a time nor a number of bounces was given", code="no-limit", fix="give until= or bounces="
        )
    limit_time, limit_bounces = math.inf, BOUNCE_GUARD
    if until is not None:
        may_be = "seconds, 0 or more"
        limit_time = number(until, "until", may_be, error=SceneError, code="bad-limit", least=0.0, infinite=True)
    if bounces is not None:
        limit_bounces = whole_number(
            bounces, "bounces", "a whole number, 0 or more", error=SceneError, code="bad-limit", least=0
        )
    return limit_time, limit_bounces
