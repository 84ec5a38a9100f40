"""``wallkit warm``: compile beforehand, so that nobody waits for it later."""

from __future__ import annotations

import time
from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from wallkit.scene.scene import Scene


def register(app: typer.Typer) -> None:
    """Attach the command."""
    app.command("warm", rich_help_panel="Balls")(warm)


def warm(
    files: Annotated[
        list[str] | None,
        typer.Argument(metavar="[FILE]...", help="Drawings, walls or scenes; if none, plain rooms and the samples."),
    ] = None,
) -> None:
    """Compile what flights and aims in such levels need and keep it on disk: for images, CI and the first lesson."""
    from wallkit.kernels.jit import cache_folder
    from wallkit.levels.aim import warm_aim
    from wallkit.simulation.warming import warm as warm_scene
    from wallkit.walls.importing.arc_fitting.curves_to_arcs import fit_a_few

    for name, scene in _scenes(files) if files else _usual_scenes():
        typer.echo(f"{name} ... ", nl=False)
        began = time.perf_counter()
        warm_scene(scene)
        if not scene.meeting:
            warm_aim(scene)
        typer.echo(f"{time.perf_counter() - began:.1f} s" if len(scene.balls) else "no ball, nothing to compile")
    typer.echo("arcs for drawings of many curves ... ", nl=False)
    began = time.perf_counter()
    fit_a_few()
    typer.echo(f"{time.perf_counter() - began:.1f} s")
    typer.echo(f"what is compiled here is kept in {cache_folder()}")


def _scenes(files: list[str]) -> Iterator[tuple[str, Scene]]:
    from wallkit.cli.scene_input import opened
    from wallkit.scene.wishes import Wishes

    for file in files:
        yield file, opened(file, Wishes(may_be_empty=True)).scene


def _usual_scenes() -> Iterator[tuple[str, Scene]]:
    """Give what most people meet; a wheel comes with the kernels for it."""
    from wallkit.scene.samples import shown
    from wallkit.simulation.warming import plain_scenes

    yield from plain_scenes()
    yield from _scenes([str(sample.path) for sample in shown()])
