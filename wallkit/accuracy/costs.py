"""What each modelled thing costs: time per bounce with nothing, and with one thing more."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from wallkit.accuracy import scenes
from wallkit.scene.scene import Balls, Scene
from wallkit.walls import Material, Walls

SPEED = 50.0
_AIM = (SPEED * math.cos(0.5), SPEED * math.sin(0.5))


@dataclass(frozen=True, slots=True)
class Cost:
    """One row: what is modelled, the time a bounce takes, and the part more than without it."""

    what: str
    nanoseconds: float
    more: float | None


def _scene(walls: Walls, radius: float = 0.0, **acts: Any) -> Scene:
    return Scene(walls, Balls([(3.0, -7.0)], [_AIM], radius), **acts)


def _star(material: Material | None = None, bulge: float = 0.0) -> Walls:
    walls = scenes.star()
    bulges = [[bulge, *[0.0] * 9]] if bulge else None
    return Walls.from_polylines([walls.vertices], bulges=bulges, material=material)


def _surveyed(scene: Scene, bounces: int) -> int:
    from wallkit.simulation.survey import survey

    return int(survey(scene, bounces=bounces, threads=1).bounces[0])


def _simulated(scene: Scene, bounces: int) -> int:
    from wallkit.simulation.simulate import simulate

    return len(simulate(scene, bounces=bounces, mode="compiled").contacts)


def _with_horizon(scene: Scene, bounces: int) -> int:
    from wallkit.simulation.horizon import predicted_errors
    from wallkit.simulation.simulate import simulate

    contacts = simulate(scene, bounces=bounces, mode="compiled").contacts
    predicted_errors(scene, contacts)
    return len(contacts)


def _sensed(scene: Scene, bounces: int) -> int:
    from wallkit.simulation.simulate import simulate

    return int(simulate(scene, bounces=bounces, mode="compiled").bounces[0])


def _with_sensor() -> Scene:
    scene = _scene(_star())
    scene.sensors = Walls.from_polylines([[(-20.0, -20.0), (20.0, -20.0), (20.0, 20.0), (-20.0, 20.0)]])
    return scene


_RECORDING = "recording every contact"
_ROWS: list[tuple[str, Callable[[], Scene], Callable[[Scene, int], int], str]] = [
    # what, its scene, how it is flown, the row with which it is compared: "" for the first
    ("nothing: a point among ten lines, totals only", lambda: _scene(_star()), _surveyed, ""),
    ("restitution, all 1 (absent)", lambda: _scene(_star(Material(1.0, 1.0))), _surveyed, ""),
    ("gravity of 0 (absent)", lambda: _scene(_star(), gravity=(0.0, 0.0)), _surveyed, ""),
    ("friction and drag of 0 (absent)", lambda: _scene(_star(), rolling_friction=0.0, drag=0.0), _surveyed, ""),
    ("corners: a disc", lambda: _scene(_star(), 5.0), _surveyed, ""),
    ("arcs: one edge is one", lambda: _scene(_star(bulge=1e-3)), _surveyed, ""),
    ("restitution", lambda: _scene(_star(Material(1.0, 1.0 - 1e-9))), _surveyed, ""),
    ("gravity", lambda: _scene(_star(), gravity=(0.0, -1e-3)), _surveyed, ""),
    ("rolling friction", lambda: _scene(_star(), rolling_friction=1e-6), _surveyed, ""),
    ("drag", lambda: _scene(_star(), drag=1e-8), _surveyed, ""),
    ("a sensor", _with_sensor, _surveyed, ""),
    (_RECORDING, lambda: _scene(_star()), _simulated, ""),
    ("recording, and the horizon", lambda: _scene(_star()), _with_horizon, _RECORDING),
    ("recording, and a sensor", _with_sensor, _sensed, _RECORDING),
]


def costs(bounces: int = 300_000, runs: int = 5) -> Iterator[Cost]:
    """Measure every row; each time is the least of ``runs``, compiling not counted."""
    spent: dict[str, float] = {}
    for what, make, fly, base in _ROWS:
        more = spent.get(base or _ROWS[0][0])
        spent[what] = _least(make, fly, bounces, runs)
        yield Cost(what, spent[what], spent[what] / more - 1 if more else None)


def _least(make: Callable[[], Scene], fly: Callable[[Scene, int], int], bounces: int, runs: int) -> float:
    """Nanoseconds a bounce."""
    scene = make()
    fly(scene, 100)
    least = math.inf
    for _ in range(runs):
        begin = time.process_time()
        made = fly(scene, bounces)
        least = min(least, (time.process_time() - begin) / max(made, 1))
    return 1e9 * least
