"""The picture of a Drawing, Walls, a Scene or a Run: what a notebook shows, and what ``to_svg`` returns."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, get_args

from importers.drawing import Drawing
from importers.errors import WallkitError
from importers.problems import Problem
from wallkit import arguments
from wallkit.scene.scene import Scene
from wallkit.simulation.run import Run
from wallkit.view.picture import drawing_svg, walls_svg
from wallkit.view.run_picture import Colouring, run_svg, scene_svg
from wallkit.walls import Walls

_WIDTH = 720.0  # as wide as a notebook's column
_BAD: dict[str, Any] = {"error": WallkitError, "code": "bad-argument"}


def svg_of(thing: object, **options: Any) -> str | None:
    """Draw it; None for what is none of the four.

    Args:
        thing: what is drawn.
        **options: see :meth:`importers.pictured.Pictured.to_svg`.

    Raises:
        WallkitError: an option is not known, or has a value that it cannot have.
    """
    for kind, (draw, more) in _PAINTERS.items():
        if isinstance(thing, kind):
            known = ("title", "width", *more)
            for name, value in options.items():
                if name not in known:
                    raise WallkitError(
                        f"there is no option {name!r} here", code="bad-argument", fix=f"one of: {', '.join(known)}"
                    )
                _CHECKS[name](value)
            return draw(thing, **{"width": _WIDTH, **options})
    return None


def _draw_walls(walls: Walls, **options: Any) -> str:
    return walls_svg(walls, **{"problems": walls.problems, **options})


def _width(value: object) -> None:
    arguments.number(value, "width", "pixels, 100 to 20000", least=100.0, most=20000.0, **_BAD)


def _problems(value: object) -> None:
    if not isinstance(value, Sequence) or not all(isinstance(one, Problem) for one in value):
        raise arguments.refused("problems", value, "a list of Problems", WallkitError, "bad-argument")


_PAINTERS: dict[type, tuple[Callable[..., str], tuple[str, ...]]] = {
    Drawing: (drawing_svg, ()),
    Walls: (_draw_walls, ("problems", "normals")),
    Scene: (scene_svg, ()),
    Run: (run_svg, ("colour", "heat", "problems", "strobe")),
}
_CHECKS: dict[str, Callable[[Any], Any]] = {
    "title": lambda value: arguments.text(value, "title", **_BAD),
    "width": _width,
    "problems": _problems,
    "normals": lambda value: arguments.flag(value, "normals", **_BAD),
    "strobe": lambda value: arguments.number(value, "strobe", "seconds above 0", least=1e-9, **_BAD),
    "heat": lambda value: arguments.flag(value, "heat", **_BAD),
    "colour": lambda value: arguments.word(value, "colour", get_args(Colouring), **_BAD),
}
