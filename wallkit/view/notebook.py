"""What a notebook shows of a Drawing, Walls, a Scene or a Run."""

from __future__ import annotations

from importers.drawing import Drawing
from wallkit.scene.scene import Scene
from wallkit.simulation.run import Run
from wallkit.view.picture import drawing_svg, walls_svg
from wallkit.view.run_picture import run_svg, scene_svg
from wallkit.walls import Walls

_WIDTH = 720.0


def svg_of(thing: object) -> str | None:
    """Draw it as wide as a notebook's column; None for anything else."""
    if isinstance(thing, Drawing):
        return drawing_svg(thing, width=_WIDTH)
    if isinstance(thing, Walls):
        return walls_svg(thing, thing.problems, width=_WIDTH)
    if isinstance(thing, Scene):
        return scene_svg(thing, width=_WIDTH)
    return run_svg(thing, width=_WIDTH) if isinstance(thing, Run) else None
