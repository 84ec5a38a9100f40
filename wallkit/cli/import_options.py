"""The options that `import` and `check` share: how a drawing becomes walls."""

from __future__ import annotations

from typing import Annotated, Literal

import typer

File = Annotated[
    str, typer.Argument(metavar="FILE", help="Drawing to read (told by its content); - is standard input.")
]
Tolerance = Annotated[
    float | None,
    typer.Option(help="Largest distance between a curve and its edges [default: 0.1 % of the diagonal, at most 0.1]."),
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
