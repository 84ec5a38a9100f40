"""``wallkit warm``: compile beforehand, so that nobody waits for it later."""

from __future__ import annotations

import time
from typing import Annotated

import typer


def register(app: typer.Typer) -> None:
    """Attach the command."""
    app.command("warm", rich_help_panel="Balls")(warm)


def warm(
    files: Annotated[
        list[str] | None, typer.Argument(metavar="[FILE]...", help="Drawings, walls or scenes; the samples if none.")
    ] = None,
) -> None:
    """Compile what flights and aims in such levels need and keep it on disk: for images, CI and the first lesson."""
    from wallkit.cli.scene_input import opened
    from wallkit.kernels.jit import cache_folder
    from wallkit.levels.aim import warm_aim
    from wallkit.scene.samples import samples
    from wallkit.scene.wishes import Wishes
    from wallkit.simulation.warming import warm as warm_scene
    from wallkit.walls.importing.arc_fitting.curves_to_arcs import fit_a_few

    for file in files or [str(sample.path) for sample in samples()]:
        scene = opened(file, Wishes(may_be_empty=True)).scene
        typer.echo(f"{file} ... ", nl=False)
        began = time.perf_counter()
        warm_scene(scene)
        if not scene.meeting:
            warm_aim(scene)
        typer.echo(f"{time.perf_counter() - began:.1f} s" if len(scene.balls) else "no ball, nothing to compile")
    typer.echo("arcs for drawings of many curves ... ", nl=False)
    began = time.perf_counter()
    fit_a_few()
    typer.echo(f"{time.perf_counter() - began:.1f} s")
    typer.echo(f"compiled code is kept in {cache_folder()}")
