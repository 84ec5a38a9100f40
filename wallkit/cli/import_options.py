"""The options that `import` and `check` share: how a drawing becomes walls."""

from __future__ import annotations

from typing import Annotated, Literal

import typer

File = Annotated[
    str, typer.Argument(metavar="FILE", help="Drawing to read (told by its content); - is standard input.")
]
Tolerance = Annotated[
    float | None,
    typer.Option(help="Largest distance between a curve and its edges (default: 0.1 % of the diagonal, at most 0.1)."),
]
Curves = Annotated[Literal["lines", "arcs"], typer.Option(help="What curves become.")]
Layer = Annotated[
    list[str] | None,
    typer.Option(metavar="GLOB", help="Take only what is on layers or in groups of this name; may be repeated."),
]
Hidden = Annotated[bool, typer.Option("--hidden", help="Take hidden paths too.")]
Arena = Annotated[bool, typer.Option("--arena", help="The outermost walls are rooms: free inside.")]
Sides = Annotated[Literal["both", "outward"], typer.Option(help="From where closed walls are solid.")]
Scale = Annotated[float, typer.Option(help="Factor on all coordinates.")]
FlipY = Annotated[bool, typer.Option("--flip-y", help="Mirror the y axis (SVG's points down).")]
Snap = Annotated[float, typer.Option(metavar="D", help="Move open ends up to D apart together, and join them.")]
Join = Annotated[bool, typer.Option("--join", help="Join open paths whose ends meet.")]
DropDuplicates = Annotated[bool, typer.Option("--drop-duplicates", help="Drop walls and edges drawn twice.")]
Resolve = Annotated[
    bool, typer.Option("--resolve", help="Self-crossing walls become the outline of what they enclose.")
]
Union = Annotated[bool, typer.Option("--union", help="Unite solids that overlap or share an edge.")]
MinWidth = Annotated[float, typer.Option(metavar="D", help="Remove closed walls that no disc of diameter D fits into.")]
Simplify = Annotated[float, typer.Option(metavar="D", help="Drop vertices where walls move by at most D.")]
OutlineStrokes = Annotated[
    bool, typer.Option("--outline-strokes", help="A stroke with a width becomes the solid that it paints.")
]
