"""What is doubtful about a scene that is opened: one answer for `check`, the page and the extension of Inkscape."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from importers.problems import Problem
from wallkit.geometry.arrays import FloatArray
from wallkit.walls import Walls

if TYPE_CHECKING:
    from importers.drawing import Drawing
    from wallkit.scene.opening import OpenedScene
    from wallkit.walls.checking.free_space import FreeSpace
    from wallkit.walls.checking.leaks import Reach
    from wallkit.walls.import_options import ImportOptions
    from wallkit.walls.met_lines import MetLines


@dataclass(slots=True, eq=False)
class Given:
    """What FILE holds: walls, places and radii of its balls, all that was found in it, and what was assumed.

    ``met`` says where the walls meet, or did before they changed, where somebody has looked for that.
    """

    walls: Walls
    places: FloatArray
    radii: FloatArray
    problems: list[Problem] = field(default_factory=list)
    assumed: list[str] = field(default_factory=list)
    sensors: Walls | None = None
    drawing: Drawing | None = None
    importing: ImportOptions | None = None
    met: MetLines | None = None


def given_of(found: OpenedScene) -> Given:
    """Take what FILE holds, opened as `simulate` does; a ball that would only be put somewhere does not count."""
    walls, balls = found.scene.walls, found.scene.balls
    assumed = [] if walls.solid is None or walls.solid.how == "asked" else [walls.solid.sentence()]
    places, radii = np.asarray(balls.position), np.asarray(balls.radius)
    if found.found_place:
        places, radii = np.empty((0, 2)), np.empty(0)
    sensors, drawing = found.scene.sensors, found.drawing
    return Given(walls, places, radii, list(found.problems), assumed, sensors, drawing, found.importing, found.met)


@dataclass(frozen=True, slots=True)
class Look:
    """What was found about what FILE holds: problems with the severe first, free space, and where balls get to."""

    walls: Walls
    problems: list[Problem]
    space: FreeSpace
    reach: Reach

    @property
    def findings(self) -> int:
        """How many problems are more than a note."""
        return sum(problem.severity != "info" for problem in self.problems)


def look_over(given: Given, radius: float | None) -> Look:
    """Look for leaks of a ball of a radius (None: the smallest given, else any), and whatever else is doubtful."""
    from wallkit.walls.checking.ball_places import ball_problems, goal_problems
    from wallkit.walls.checking.free_space import free_space_among
    from wallkit.walls.checking.leaks import leak_problems, reach_of
    from wallkit.walls.checking.self_check import straight_edges
    from wallkit.walls.met_lines import MetLines

    walls = given.walls
    if radius is None and len(given.radii):
        radius = float(given.radii.min())
        given.assumed.append(f"a ball of radius {radius:.6g}, the smallest that is given (--radius)")
    edges, met = straight_edges(walls), given.met
    known = MetLines.of(walls, edges) if met is None or not met.same_as(walls) else met
    space = free_space_among(walls, edges, known)
    reach = reach_of(space, walls, radius, given.places)
    found = ball_problems(space, walls, given.places, given.radii)
    found += [] if given.sensors is None else goal_problems(space, given.sensors, given.places)
    found += [*leak_problems(space, reach), *given.problems, *_without_walls(walls)]
    return Look(walls, sorted(_once(found), key=_rank), space, reach)


def _without_walls(walls: Walls) -> list[Problem]:
    if len(walls):
        return []
    fix = "see what the file holds with: wallkit inspect; take other layers (--layer) or hidden paths (--hidden)"
    return [Problem("no-walls", "warning", "there is nothing in it that makes a wall", fix)]


def _once(problems: list[Problem]) -> list[Problem]:
    """Leave out what was told before of the same place: the opening tells some of what is looked at closer here."""
    told: dict[Any, Problem] = {}
    for index, problem in enumerate(problems):
        placed = problem.code in ("ball-in-material", "shut-in")
        told.setdefault((problem.code, problem.x, problem.y) if placed else index, problem)
    return list(told.values())


def _rank(problem: Problem) -> int:
    """The severe first, and among those in the order of coming: a picture has no room for all."""
    return ("error", "warning", "info").index(problem.severity)
