"""The options of every command that may be given a drawing: how it becomes walls, said once."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable
from typing import TYPE_CHECKING, Annotated, Any, Literal, get_type_hints

import typer

if TYPE_CHECKING:
    from wallkit.walls.import_options import ImportOptions

File = Annotated[
    str, typer.Argument(metavar="FILE", help="Drawing to read (told by its content); - is standard input.")
]
_PANEL = "How a drawing becomes walls"


def _option(help_: str, *names: str, metavar: str | None = None) -> Any:
    return typer.Option(*names, help=help_, metavar=metavar, rich_help_panel=_PANEL)


_Tolerance = Annotated[
    float | None,
    _option("Largest distance between a curve and its edges (default: 0.1 % of the diagonal, at most 0.1)."),
]
_Curves = Annotated[Literal["lines", "arcs"], _option("What curves become.")]
_Layer = Annotated[
    list[str] | None, _option("Take only what is on layers or in groups of this name; may be repeated.", metavar="GLOB")
]
_Sides = Annotated[Literal["both", "outward"], _option("From where closed walls are solid.")]
_Room = Annotated[str, _option("The closed wall of this name is a room: free inside.", metavar="NAME")]
_Scale = Annotated[float, _option("Factor on all coordinates.")]
_Page = Annotated[str | None, _option("Page or artboard, from 1; or all.", metavar="N")]
_Units = Annotated[
    str | None,
    _option(
        "Of all lengths and places: px, pt, mm, cm, m, in, by the drawing's physical size; or a scale: '1 m = 100 px'.",
        metavar="UNITS",
    ),
]
_Origin = Annotated[str, _option("What becomes 0,0: page, box (their corner), or X,Y.", metavar="WHAT")]
_Grid = Annotated[float, _option("Move vertices to multiples of G.", metavar="G")]
_Via = Annotated[str, _option("ghostscript: let it run a PostScript program.", metavar="PROGRAM")]
_Snap = Annotated[float, _option("Move open ends up to D apart together, and join them.", metavar="D")]
_MinWidth = Annotated[float, _option("Remove closed walls that no disc of diameter D fits into.", metavar="D")]
_Simplify = Annotated[float, _option("Drop vertices where walls move by at most D.", metavar="D")]


def _flag(name: str, help_: str) -> Any:
    return Annotated[bool, _option(help_, name)]


_OPTIONS: dict[str, tuple[Any, Any]] = {
    "tolerance": (_Tolerance, None),
    "curves": (_Curves, "arcs"),
    "layer": (_Layer, None),
    "hidden": (_flag("--hidden", "Take hidden paths too."), False),
    "unpainted": (_flag("--unpainted", "Take paths without fill and stroke although others are painted."), False),
    "outline_strokes": (_flag("--outline-strokes", "A stroke with a width becomes the solid that it paints."), False),
    "apply_clips": (_flag("--apply-clips", "Paths end where their clips end."), False),
    "arena": (_flag("--arena", "The outermost walls are rooms: free inside."), False),
    "solid": (_flag("--solid", "The outermost walls are solid."), False),
    "room": (_Room, ""),
    "sides": (_Sides, "both"),
    "scale": (_Scale, 1.0),
    "flip_y": (_flag("--flip-y", "Mirror the y axis (SVG's points down)."), False),
    "snap": (_Snap, 0.0),
    "join": (_flag("--join", "Join open paths whose ends meet."), False),
    "drop_duplicates": (_flag("--drop-duplicates", "Drop walls and edges drawn twice."), False),
    "resolve": (_flag("--resolve", "Self-crossing walls become the outline of what they enclose."), False),
    "union": (_flag("--union", "Unite solids that overlap or share an edge."), False),
    "min_width": (_MinWidth, 0.0),
    "simplify": (_Simplify, 0.0),
    "page": (_Page, None),
    "units": (_Units, None),
    "origin": (_Origin, ""),
    "grid": (_Grid, 0.0),
    "via": (_Via, ""),
}


def with_import_options(
    curves: Literal["lines", "arcs"] = "arcs",
) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Give a command all options of the import; its parameter ``importing`` takes them as a function that makes them.

    Args:
        curves: what they become unless somebody says it.
    """

    def decorate(command: Callable[..., None]) -> Callable[..., None]:
        own = inspect.signature(command)
        hints = get_type_hints(command, include_extras=True)
        usual = {name: curves if name == "curves" else default for name, (_, default) in _OPTIONS.items()}
        given = [p.replace(annotation=hints[p.name]) for p in own.parameters.values() if p.name != "importing"]
        added = [
            inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=usual[name], annotation=hint)
            for name, (hint, _) in _OPTIONS.items()
        ]

        @functools.wraps(command)
        def run(**values: Any) -> None:
            importing = {name: values.pop(name) for name in _OPTIONS}
            command(**values, importing=importing)

        parameters = [p.replace(kind=inspect.Parameter.KEYWORD_ONLY) for p in given] + added
        run.__signature__ = own.replace(parameters=parameters)  # type: ignore[attr-defined]
        run.__annotations__ = {p.name: p.annotation for p in parameters}
        del run.__wrapped__
        return run

    return decorate


def options_of(importing: dict[str, Any]) -> ImportOptions:
    """Make the options of what the command line says; late, for it brings numpy."""
    from wallkit.walls.import_options import ImportOptions

    values = dict(importing)
    values["layers"] = values.pop("layer") or None
    values["units"] = values["units"] or ""
    page = values["page"]
    values["page"] = int(page) if page is not None and page.isdecimal() else page
    return ImportOptions(**values)
