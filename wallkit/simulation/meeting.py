"""The discs of a scene in which balls meet, in flight together; see ``wallkit.kernels.meeting.meet``."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.kernels.compile_aside import at_hand
from wallkit.kernels.jit import compile_for, compiled
from wallkit.kernels.meeting.cell_list import row_and_column
from wallkit.kernels.meeting.meet import begin, lay_out, meet
from wallkit.kernels.meeting.records import (
    AFTER,
    BEING,
    BOUNCES,
    CELL,
    DISCS,
    DUE,
    FLOATS,
    FLYING,
    FRESH,
    LEAVE,
    MASS,
    MET,
    NOBODY,
    NOTHING,
    NUMBER,
    NUMBERS,
    PARTNER,
    PLACE,
    RADIUS,
    ROOM,
    ROW,
    UNHEAPED,
    Discs,
    Queue,
)
from wallkit.kernels.meeting.wall_contacts import states_at
from wallkit.kernels.records import AT_REST, LOG_STRIDE, STATE, STATE_SIZE, TIME_REACHED, Counts, in_lists
from wallkit.kernels.signatures import kinds_of
from wallkit.scene.scene import Scene
from wallkit.simulation.aligned_arrays import on_cache_lines
from wallkit.simulation.damping import damping_of
from wallkit.simulation.meeting_cells import along_a_curve, box_of, cell_of, cells_for, near_walls
from wallkit.simulation.meeting_hops import hop_speed
from wallkit.simulation.meeting_rules import check_modelled
from wallkit.simulation.modelled import Modelled
from wallkit.simulation.shared_clock import SharedClock

PER_DISC = 3.0
"""Cells a disc, where the discs themselves do not set their size."""
CHUNK = 1 << 16
"""Contacts in one piece of a log."""
SOON = 40_000
"""Events that interpreted kernels take, some 50 microseconds each, before a run asks for machine code."""
FEW = 500
"""Discs up to which it is worth while to interpret at all."""
MANY, OFTEN = 2_000, 50
"""Discs from which on they are brought into order again, so that neighbours are close in memory, and after how many
contacts a disc."""
_COLD = [STATE.energy, STATE.from_x, STATE.from_y, STATE.from_vx, STATE.from_vy, STATE.tolerance]
_compiled: set[tuple[bool, ...]] = set()


class Meeting:
    """The discs of a scene, flown on together up to a time or a number of contacts.

    Attributes:
        modelled: what the kernels see of the scene.
        numbers: (k,) of the discs in the scene, in the order in which they lie in memory.
        hits: (W,) contacts by wall so far.
        now: time of the last event.
        reached: 1 where the end in time is reached, 2 where a disc has made as many contacts as it may, else 0.
    """

    def __init__(
        self,
        scene: Scene,
        start: Counts,
        *,
        mode: str = "auto",
        per_disc: float = PER_DISC,
        modelled: Modelled | None = None,
    ) -> None:
        check_modelled(scene)
        self._clock = SharedClock(scene.drag) if scene.drag and damping_of(scene) is not None else None
        if self._clock is not None:
            scene, modelled = replace(scene, drag=None), None
        self.modelled = modelled or Modelled(scene, machine_code=mode == "compiled")
        self.mode = mode
        self.numbers = np.flatnonzero(self.modelled.radii > 0.0)
        self.hits = np.zeros(len(scene.walls), dtype=np.int64)
        self.now, self.reached = 0.0, 0
        self._count = len(self.numbers)
        self._features = tuple(part is None for part in (*self.modelled.model, _restitution(scene)))
        self._discs = self._made(scene, start, per_disc)
        self._lists: Discs | None = None
        if self._interprets():
            self._lists = in_lists(self._discs)
            begin(self.modelled.lists.gravity, self._lists, 0.0)
        else:
            compiled(begin)(self.modelled.model.gravity, self._discs, 0.0)
        self._since, self._interpreted = 0, 0

    def __len__(self) -> int:
        return self._count

    def machine_code_at_hand(self) -> bool:
        """Tell whether compiled kernels would begin at once; where not, they are compiled aside from now on."""
        if self._features in _compiled:
            return True
        model, discs, log = self.modelled.model, self._discs, np.empty(ROW)
        states, endings = np.zeros((self._count, STATE_SIZE)), np.zeros(self._count, dtype=np.int64)
        called: list[tuple[Any, tuple[Any, ...]]] = [
            (begin, (model.gravity, discs, 0.0)),
            (meet, (model, model.gravity, discs, 0.0, 1, self.hits, log, 1, 1)),
            (states_at, (model, model.gravity, discs, 0.0, states, endings)),
            (lay_out, (discs,)),
        ]
        return at_hand(compile_each, *((entry, kinds_of(arguments)) for entry, arguments in called))

    def _made(self, scene: Scene, start: Counts, per_disc: float) -> Discs:
        from wallkit.simulation.simulate import initial_states

        balls = scene.balls
        place = balls.position[self.numbers] - self.modelled.origin
        radii = self.modelled.radii[self.numbers]
        cells = cells_for(box_of(self.modelled, place), radii, per_disc)
        order = along_a_curve(cell_of(cells, place))
        self.numbers, radii = self.numbers[order], radii[order]
        states = initial_states(self.modelled, balls.position[self.numbers], balls.velocity[self.numbers])
        count = self._count
        ball = _rows(count, FLOATS, np.float64)
        link = ball.view(np.uint32)
        ball[:, 0:4], ball[:, RADIUS], ball[:, LEAVE] = states[:, 0:4], radii, math.inf
        ball[:, MASS] = balls.mass[self.numbers]
        link[:, PARTNER], link[:, NUMBER], link[:, MET], link[:, BEING] = NOTHING, self.numbers, NOBODY, FLYING
        link[:, PLACE] = UNHEAPED
        counts = np.array(start, dtype=np.int64)
        near = near_walls(scene.walls, self.modelled.origin, cells, float(radii.max(initial=0.0)))
        hits = np.zeros(max(len(scene.walls), 1), dtype=np.int64)
        return Discs(
            ball=ball,
            link=link,
            queue=_empty_queue(count),
            head=_rows(len(near) // ROOM, ROOM, np.uint32).reshape(-1),
            near=near,
            cells=cells,
            restitution=_restitution(scene),
            cold=np.hstack([states[:, _COLD], np.zeros((count, 1))]),
            counts=np.tile(counts.astype(np.int32), (count, 1)),
            hop=hop_speed(scene, radii),
            tries=(np.zeros(STATE_SIZE), counts.copy(), hits, np.zeros(LOG_STRIDE)),
            start=counts,
        )

    def _interprets(self) -> bool:
        if self.mode == "auto":
            return self._count <= FEW and self._features not in _compiled
        return self.mode == "interpreted"

    def go(self, until: float, limit: int, *, keep: bool = True, most: int = 0) -> Iterator[FloatArray]:
        """Fly on; yield the contacts in pieces, (k, ROW) each, in local coordinates; empty ones unless they are kept.

        Args:
            until: time at which to stop, or inf.
            limit: contacts of a disc at which to stop.
            keep: whether contacts are kept.
            most: contacts in a piece; 0 for as many as it takes to be quick.
        """
        self.reached = 0 if self._count else 1
        clock = self._clock
        if clock is not None:
            until = clock.free(until)
        while not self.reached:
            room = (most or CHUNK) if keep else max(CHUNK, OFTEN * self._count)
            budget = 2**62
            if self._lists is not None:
                room, budget = min(room, 1024), SOON if self.mode == "auto" else budget
                log: Any = [0.0] * (ROW * room if keep else 0)
                gravity = self.modelled.lists.gravity
                made, now, self.reached = meet(
                    self.modelled.lists, gravity, self._lists, until, limit, self.hits, log, room, budget
                )
                self._interpreted += made
                long = made < room or self._interpreted > SOON // 4
                if self.mode == "auto" and not self.reached and long and self.machine_code_at_hand():
                    self._compile()
            else:
                _compiled.add(self._features)
                log = np.empty(ROW * room if keep else 0)
                gravity = self.modelled.model.gravity
                made, now, self.reached = compiled(meet)(
                    self.modelled.model, gravity, self._discs, until, limit, self.hits, log, room, budget
                )
            self.now = max(self.now, now if clock is None else float(clock.time(np.array(now))))
            self._since += made
            if self._count >= MANY and self._since > OFTEN * self._count:
                self._bring_into_order()
            rows = np.array(log[: made * ROW]).reshape(-1, ROW)
            if clock is not None:
                rows[:, [3, 4, 15, 16]] *= clock.kept(rows[:, 0])[:, None]
                rows[:, 0] = clock.time(rows[:, 0])
            yield rows

    def _compile(self) -> None:
        """Go on with machine code from where the interpreted kernels are."""
        _copy_back(self._discs, self._lists)
        self._lists = None

    def _bring_into_order(self) -> None:
        """Lay neighbours next to one another in memory; no bit of what is to come depends on it."""
        discs = self._discs
        row, column = row_and_column(discs.cells, discs.link[:, CELL].astype(np.int64))
        order = along_a_curve(np.stack([column, row], axis=1))
        place = np.empty(self._count, dtype=np.uint32)
        place[order] = np.arange(self._count, dtype=np.uint32)
        for part in (discs.ball, discs.cold, discs.counts):
            part[:] = part[order]
        self.numbers = self.numbers[order]
        for column, above in ((PARTNER, DISCS), (MET, NOBODY)):
            named = discs.link[:, column] < above
            discs.link[named, column] = place[discs.link[named, column]]
        compiled(lay_out)(discs)
        self._since = 0

    def place(self, ball: int, position: FloatArray, velocity: FloatArray, time: float) -> None:
        """Let a disc, by its number in the scene, go on from elsewhere (local coordinates); all look again then."""
        row = int(np.flatnonzero(self.numbers == ball)[0])
        discs = self._discs if self._lists is None else self._lists
        for column, value in enumerate((*position.tolist(), *velocity.tolist(), time, 0.0)):
            discs.ball[row][column] = value
        discs.link[row][MET], discs.link[row][BEING] = NOBODY, FRESH
        if self._lists is None:
            compiled(begin)(self.modelled.model.gravity, discs, time)
        else:
            begin(self.modelled.lists.gravity, discs, time)

    def states(self, time: float) -> tuple[FloatArray, IntArray]:
        """(n, STATE_SIZE) states of the discs at a time, and (n,) how they ended or are: RUNNING; by number.

        At inf: after their last contact; under drag where they have stopped.
        """
        clock = self._clock
        if clock is not None:
            time = clock.free(time)
        states, endings = np.zeros((self._count, STATE_SIZE)), np.zeros(self._count, dtype=np.int64)
        if self._lists is not None:
            rows, codes = states.tolist(), endings.tolist()
            states_at(self.modelled.lists, self.modelled.lists.gravity, self._lists, time, rows, codes)
            states, endings = np.array(rows).reshape(-1, STATE_SIZE), np.array(codes, dtype=np.int64)
        else:
            model = self.modelled.model
            compiled(states_at)(model, model.gravity, self._discs, time, states, endings)
        if clock is not None:
            free = states[:, STATE.time] + states[:, STATE.lost]
            states[:, STATE.vx : STATE.vy + 1] *= clock.kept(free)[:, None]
            states[:, STATE.time], states[:, STATE.lost] = clock.time(free), 0.0
            if time == clock.whole:
                states[:, STATE.vx : STATE.vy + 1] = 0.0
                endings[endings == TIME_REACHED] = AT_REST
        back = np.argsort(self.numbers)
        return states[back], endings[back]

    @property
    def next_time(self) -> float:
        """When something is next to be done: up to then the states of all discs are known."""
        discs = self._discs if self._lists is None else self._lists
        rows = np.array(discs.ball).reshape(-1, FLOATS)
        return float(rows[:, [DUE, LEAVE]].min(initial=math.inf))

    @property
    def bounces(self) -> NDArray[np.int64]:
        """(n,) contacts of each disc so far, by number."""
        link = self._discs.link if self._lists is None else np.array(self._lists.link).reshape(-1, NUMBERS)
        found: NDArray[np.int64] = link[np.argsort(self.numbers), BOUNCES].astype(np.int64)
        return found


def _rows(count: int, columns: int, kind: Any) -> NDArray[Any]:
    """Rows of zeros, none of which reaches into two lines of the cache."""
    rows = on_cache_lines(count * columns, kind).reshape(count, columns)
    rows[:] = 0
    return rows


def _empty_queue(count: int) -> Queue:
    stretches = 1 << max((count - 1) // 4, 3).bit_length()
    return Queue(
        lists=_rows(stretches, ROOM, np.uint32).reshape(-1),
        filled=np.zeros(stretches, dtype=np.uint8),
        heap=np.zeros(count, dtype=np.uint32),
        times=np.zeros(count),
        state=np.zeros(4, dtype=np.int64),
        scale=np.zeros(2),
    )


def compile_each(*wanted: tuple[Any, tuple[Any, ...]]) -> None:
    """Compile kernels, each given with the kinds of its arguments."""
    for entry, types in wanted:
        compile_for(entry, *types)


def _restitution(scene: Scene) -> FloatArray | None:
    pair = (scene.ball_restitution, scene.ball_tangential_restitution)
    return None if pair == (1.0, 1.0) else np.array(pair, dtype=np.float64)


def _copy_back(arrays: Any, lists: Any) -> None:
    """Write lists into the arrays that they were made of."""
    if isinstance(arrays, Discs):  # two views of the same rows: each gives its own columns
        arrays.ball[:, : MASS + 1] = np.array(lists.ball).reshape(-1, FLOATS)[:, : MASS + 1]
        arrays.link[:, CELL : AFTER + 1] = np.array(lists.link).reshape(-1, NUMBERS)[:, CELL : AFTER + 1]
        arrays, lists = arrays[2:], lists[2:]
    for array, values in zip(arrays, lists, strict=True):
        if isinstance(array, np.ndarray):
            array[...] = np.array(values, dtype=array.dtype).reshape(array.shape)
        elif isinstance(array, tuple):
            _copy_back(array, values)
