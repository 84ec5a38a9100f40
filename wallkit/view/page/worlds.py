"""Worlds: what the kernels see of a document's walls, kept from one question to the next."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from wallkit.scene.scene import Scene
from wallkit.view.page.documents import Document
from wallkit.view.page.payload import Table

if TYPE_CHECKING:
    from wallkit.simulation.modelled import Modelled
    from wallkit.simulation.run import Run

Fly = Callable[[float | None, int], "Run"]
"""Flies all balls to a time, or for so many bounces each."""
SLOWING = ("rolling_friction", "drag")
WORLD = ("restitution", "tangential_restitution", "gravity", *SLOWING)
"""What of a question changes the world that balls fly in; the balls alone differ while somebody aims."""


class CompilingError(Exception):
    """The kernels that a question needs are still being compiled, in a process apart; it can be answered after that."""


def check_index(scene: Scene) -> None:
    """Refuse to wait for an index that interpreted kernels would make for too long.

    Raises:
        CompilingError: there are so many edges that nothing can be said without machine code.
    """
    from wallkit.simulation.modelled import WAITING_PAYS, index_at_hand

    if 2 * len(scene.walls.edge_starts) > WAITING_PAYS and not index_at_hand(scene.walls.has_arcs):
        raise CompilingError


class Worlds:
    """Remembers the last world asked about: its walls need not be indexed again for the next ball."""

    def __init__(self) -> None:
        self._key: Any = None
        self._modelled: Modelled | None = None

    def flight(self, body: Table, document: Document, scene: Scene) -> tuple[Fly, bool]:
        """Give what flies a scene, and whether machine code is at hand for it; else that is being compiled.

        Raises:
            CompilingError: there are so many edges that nothing can be said without machine code.
            WallkitError: a disc overlaps a wall at the start, or the scene cannot be simulated.
        """
        from wallkit.scene.start_overlaps import check_starts
        from wallkit.simulation.simulate import Flights, flown

        check_starts(scene)
        check_index(scene)
        if scene.meeting:
            return _together(scene)
        flights = Flights(scene, mode="interpreted", modelled=self._model(body, document, scene))
        if ready := flights.machine_code_at_hand():
            flights.mode = "auto"
        return (lambda until, bounces: flown(flights, math.inf if until is None else until, bounces)), ready

    def _model(self, body: Table, document: Document, scene: Scene) -> Modelled:
        from wallkit.simulation.modelled import Modelled

        key = (document.edition, *(repr(body.get(name)) for name in WORLD))
        known = self._modelled.with_balls(scene.balls) if self._modelled is not None and key == self._key else None
        self._key, self._modelled = key, known or Modelled(scene)
        return self._modelled


def _together(scene: Scene) -> tuple[Fly, bool]:
    """The same where balls meet."""
    from wallkit.simulation.meeting import Meeting
    from wallkit.simulation.simulate import START, simulate

    ready = Meeting(scene, START, mode="interpreted").machine_code_at_hand()
    return (lambda until, bounces: simulate(scene, until, bounces, mode="auto" if ready else "interpreted")), ready
