"""wallkit turns a drawing into walls that can be trusted and shoots balls at them with the exact answer, fast.

The names below are all that others may rely on. Each is imported when it is first used, so that
``import wallkit`` stays quick: llvmlite, scipy and pikepdf are only loaded by what needs them.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

try:
    from importers.errors import DrawingError, LimitError, WallkitError
except ImportError as error:  # a user's own ``importers`` folder or an unrelated package stands before ours
    import importers as _shadow

    raise ImportError(
        f"wallkit needs its own package 'importers', but {_shadow.__file__ or list(_shadow.__path__)} stands "
        "before it on the import path; rename or move that one"
    ) from error
from importers.pictured import paint_with
from wallkit.version import __version__

if TYPE_CHECKING:
    from importers.drawing import Drawing, DrawnPath, Layer, Subpath
    from importers.problems import Problem
    from importers.read import read_drawing, read_drawing_text
    from importers.svg.svgpathtools_paths import drawing_from_svgpathtools
    from wallkit.accuracy.reference import Reference, sure_events
    from wallkit.levels.aim import aim
    from wallkit.levels.check_level import LevelCheck, check_level
    from wallkit.levels.windows import Window, Windows
    from wallkit.scene.opening import OpenedScene, open_scene
    from wallkit.scene.room_balls import RoomBalls
    from wallkit.scene.scene import Balls, Scene, SceneError
    from wallkit.scene.wishes import Wishes
    from wallkit.simulation.count import count
    from wallkit.simulation.counts import Counts
    from wallkit.simulation.horizon import Horizon
    from wallkit.simulation.prepared import PreparedScene, prepare
    from wallkit.simulation.run import CONTACT, FINAL, ContactKind, Ending, Run
    from wallkit.simulation.simulate import simulate
    from wallkit.simulation.streams import RandomBalls, survey_stream
    from wallkit.simulation.survey import SurveyTotals, survey
    from wallkit.simulation.ways import Stepped, step_through
    from wallkit.simulation.world import World
    from wallkit.view.film import film
    from wallkit.view.replay import replay_html
    from wallkit.walls import Material, Wall, Walls
    from wallkit.walls.checking.free_space import FreeSpace, Gap, free_space
    from wallkit.walls.import_options import ImportOptions
    from wallkit.walls.importing.pipeline import import_walls
    from wallkit.walls.repairing.repairs import Repairs
    from wallkit.walls.walls import WallsError

_HOMES = {
    "importers.drawing": ("Drawing", "DrawnPath", "Layer", "Subpath"),
    "importers.problems": ("Problem",),
    "importers.read": ("read_drawing", "read_drawing_text"),
    "importers.svg.svgpathtools_paths": ("drawing_from_svgpathtools",),
    "wallkit.accuracy.reference": ("Reference", "sure_events"),
    "wallkit.levels.check_level": ("LevelCheck", "check_level"),
    "wallkit.levels.aim": ("aim",),
    "wallkit.levels.windows": ("Window", "Windows"),
    "wallkit.scene.opening": ("OpenedScene", "open_scene"),
    "wallkit.scene.wishes": ("Wishes",),
    "wallkit.scene.room_balls": ("RoomBalls",),
    "wallkit.simulation.count": ("count",),
    "wallkit.simulation.counts": ("Counts",),
    "wallkit.simulation.horizon": ("Horizon",),
    "wallkit.simulation.run": ("CONTACT", "FINAL", "Ending", "ContactKind", "Run"),
    "wallkit.simulation.streams": ("RandomBalls", "survey_stream"),
    "wallkit.view.film": ("film",),
    "wallkit.view.replay": ("replay_html",),
    "wallkit.walls.checking.free_space": ("FreeSpace", "Gap", "free_space"),
    "wallkit.walls.repairing.repairs": ("Repairs",),
    "wallkit.scene.scene": ("Balls", "Scene", "SceneError"),
    "wallkit.simulation.simulate": ("simulate",),
    "wallkit.simulation.prepared": ("PreparedScene", "prepare"),
    "wallkit.simulation.survey": ("SurveyTotals", "survey"),
    "wallkit.walls": ("Material", "Wall", "Walls"),
    "wallkit.walls.walls": ("WallsError",),
    "wallkit.walls.importing.pipeline": ("import_walls",),
    "wallkit.walls.import_options": ("ImportOptions",),
    "wallkit.simulation.ways": ("Stepped", "step_through"),
    "wallkit.simulation.world": ("World",),
}
_HOME = {name: module for module, names in _HOMES.items() for name in names}

__all__ = [
    "CONTACT",
    "FINAL",
    "Balls",
    "ContactKind",
    "Counts",
    "Drawing",
    "DrawingError",
    "DrawnPath",
    "Ending",
    "FreeSpace",
    "Gap",
    "Horizon",
    "ImportOptions",
    "Layer",
    "LevelCheck",
    "LimitError",
    "Material",
    "OpenedScene",
    "PreparedScene",
    "Problem",
    "RandomBalls",
    "Reference",
    "Repairs",
    "RoomBalls",
    "Run",
    "Scene",
    "SceneError",
    "Stepped",
    "Subpath",
    "SurveyTotals",
    "Wall",
    "WallkitError",
    "Walls",
    "WallsError",
    "Window",
    "Windows",
    "Wishes",
    "World",
    "__version__",
    "aim",
    "check_level",
    "count",
    "drawing_from_svgpathtools",
    "film",
    "free_space",
    "import_walls",
    "open_scene",
    "prepare",
    "read_drawing",
    "read_drawing_text",
    "replay_html",
    "simulate",
    "step_through",
    "sure_events",
    "survey",
    "survey_stream",
]


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module 'wallkit' has no attribute {name!r}")
    value = getattr(importlib.import_module(_HOME[name]), name)
    globals()[name] = value
    return value


def _paint(thing: object, options: dict[str, Any]) -> str | None:
    svg: str | None = importlib.import_module("wallkit.view.notebook").svg_of(thing, **options)
    return svg


paint_with(_paint)


def __dir__() -> list[str]:
    return sorted({*__all__, *(name for name in globals() if name.startswith("__"))})
