"""Work that any process can do: balls by their numbers, flown in a scene that each process prepares once."""

from __future__ import annotations

import hashlib
import pickle
import threading
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any, Generic, Protocol, TypeVar

import numpy as np

from importers.errors import WallkitError
from wallkit.arguments import refused
from wallkit.scene.scene import Balls, Scene, SceneError, no_balls
from wallkit.simulation.counts import Counts
from wallkit.simulation.prepared import PreparedScene, prepare, prepare_again
from wallkit.simulation.survey import survey
from wallkit.version import __version__
from wallkit.walls import Walls

Draw = Callable[[int, int], Balls]
PROBED = 4
"""So many first balls of a draw tell it from others."""
KEPT = 2
"""Works that a process keeps prepared."""


def check_draw(draw: object) -> None:
    """Refuse what is no function that draws balls.

    Raises:
        SceneError: it cannot be called.
    """
    if not callable(draw):
        may_be = "a function of a first number and a count that returns Balls, such as RandomBalls"
        raise refused("draw", draw, may_be, SceneError, "bad-argument")


class Part(Protocol):
    """What some balls came to: whole numbers that add up to the same in any order."""

    @property
    def balls(self) -> int:
        """How many flew."""

    @property
    def bounces(self) -> int:
        """Of all."""

    def __add__(self, other: Any) -> Any: ...

    def to_json(self) -> dict[str, Any]:
        """Give it as numbers and lists."""


Result = TypeVar("Result", bound=Part)


@dataclass(eq=False)
class Work(Generic[Result]):
    """A scene, how balls are drawn for it, and the limits; what is done with them is a subclass's :meth:`fly`.

    Attributes:
        scene: walls and what acts; its balls do not count.
        draw: gives the balls from a number on.
        until: seconds, or None.
        bounces: a ball, or None.
    """

    scene: Scene
    draw: Draw
    until: float | None
    bounces: int | None
    _ready: PreparedScene | None = field(default=None, init=False, repr=False)

    def fly(self, first: int, count: int) -> Result:
        """Fly balls ``first`` to ``first + count`` on this thread."""
        raise NotImplementedError

    def read(self, value: dict[str, Any]) -> Result:
        """Read what ``to_json`` of a result gave."""
        raise NotImplementedError

    def words(self) -> tuple[object, ...]:
        """All that decides the result beside scene and balls, with one ``repr`` a value."""
        return (type(self).__name__, self.until, self.bounces)

    def prepared(self, first: int, count: int) -> PreparedScene:
        """Give the scene with these balls, its walls prepared once in this process."""
        balls = self.draw(first, count)
        with _preparing:
            if self._ready is None:
                self._ready = prepare(replace(self.scene, balls=balls))
                return self._ready
        return prepare_again(self._ready, balls)

    def digest(self) -> str:
        """64 hexadecimal digits of all that decides what comes out: version, scene, draw and limits.

        A draw is told by its first balls, so that the same balls count as the same whatever gives them.
        """
        digest = hashlib.sha256(repr((__version__, *self.words())).encode())
        for walls in (self.scene.walls, self.scene.sensors):
            _add_walls(digest, walls)
        acts = (self.scene.gravity, self.scene.rolling_friction, self.scene.drag)
        digest.update(repr(acts).encode())
        balls = self.draw(0, PROBED)
        for array in (balls.position, balls.velocity, balls.radius):
            digest.update(np.ascontiguousarray(array).tobytes())
        return digest.hexdigest()

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "scene": replace(self.scene, balls=no_balls()), "_ready": None}


class SurveyWork(Work[Counts]):
    """A survey: balls come to :class:`Counts`."""

    def fly(self, first: int, count: int) -> Counts:
        """Survey balls ``first`` to ``first + count`` on this thread."""
        return Counts.of(survey(self.prepared(first, count), self.until, self.bounces, threads=1, by_edge=True))

    def read(self, value: dict[str, Any]) -> Counts:
        """Read counts."""
        return Counts.of_json(value)


def _add_walls(digest: Any, walls: Walls | None) -> None:
    if walls is None:
        digest.update(b"none")
        return
    for array in (walls.vertices, walls.bulges, walls.offsets, walls.closed):
        digest.update(repr((array.dtype.str, array.shape)).encode() + np.ascontiguousarray(array).tobytes())
    digest.update(repr((tuple(walls.sides), tuple(map(repr, walls.materials)))).encode())


_preparing = threading.Lock()
_keeping = threading.Lock()
_kept: OrderedDict[str, Work[Any]] = OrderedDict()


def keep(digest: str, work: Work[Any] | bytes) -> None:
    """Keep a work, or its pickled bytes, for the chunks that this process will be given.

    Raises:
        WallkitError: what was sent is not the same here, as where another version is installed.
    """
    known: Work[Any] = pickle.loads(work) if isinstance(work, bytes) else work
    if known is not work and known.digest() != digest:
        message = f"a worker has wallkit {__version__}, and what it is asked for is of another version"
        raise WallkitError(message, code="other-version", fix="install the same version on all machines")
    with _keeping:
        _kept[digest] = known
        while len(_kept) > KEPT:
            _kept.popitem(last=False)


def fly_chunk(digest: str, work: bytes | None, first: int, count: int) -> Any:
    """Fly some balls; runs in any process, and is the one task that executors are given.

    Args:
        digest: of the work; what was made of its walls is kept under it.
        work: pickled; None where :func:`keep` was called before.
        first: number of the first ball.
        count: how many.
    """
    with _keeping:
        known = _kept.get(digest)
    if known is None:
        if work is None:
            raise LookupError(f"the work {digest} was not kept")
        keep(digest, work)
        known = _kept[digest]
    return known.fly(first, count)
