"""``wallkit warm``: compile beforehand, so that nobody waits for it later."""

from __future__ import annotations

import os
import time
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from wallkit.scene.scene import Scene

IMPORTING = "large drawings"
MEMORY = 4
"""Processes that compile at once, at most, where nobody says how many: each takes up to a gigabyte."""


def register(app: typer.Typer) -> None:
    """Attach the command."""
    app.command("warm", rich_help_panel="Balls")(warm)


def warm(
    files: Annotated[
        list[str] | None,
        typer.Argument(metavar="FILE", help="Drawings, walls or scenes; if none, plain rooms and the samples."),
    ] = None,
    processes: Annotated[
        int | None,
        typer.Option(
            min=1, help=f"Processes that compile, each a gigabyte; as many as processors, up to {MEMORY}, if not given."
        ),
    ] = None,
) -> None:
    """Compile what flights and aims in such levels need and keep it on disk: for images, CI and the first lesson."""
    from concurrent.futures import ProcessPoolExecutor
    from multiprocessing import get_context

    from wallkit.kernels.jit import cache_folder

    names = [*(files or _usual()), IMPORTING]
    if files:
        for file in files:
            _opened(file)  # what cannot be opened is told before anything is compiled
    count = min(processes or min(os.cpu_count() or 1, MEMORY), len(names))
    with ProcessPoolExecutor(count, mp_context=get_context("spawn")) as workers:
        for name, said in zip(names, workers.map(warmed, names), strict=True):
            typer.echo(f"{name} ... {said}")
    typer.echo(f"what is compiled here is kept in {cache_folder()}")


def warmed(name: str) -> str:
    """Compile for a scene or a task of that name; how long it took, in words."""
    from wallkit.levels.aim import warm_aim
    from wallkit.simulation.warming import plain_scenes
    from wallkit.simulation.warming import warm as warm_scene
    from wallkit.walls.checking.rooms_by_kernels import look_at_a_few
    from wallkit.walls.importing.arc_fitting.curves_to_arcs import fit_a_few
    from wallkit.walls.importing.curves_to_lines import flatten_a_few
    from wallkit.walls.near_boxes import ask_a_few

    began = time.perf_counter()
    if name == IMPORTING:
        for task in (fit_a_few, flatten_a_few, ask_a_few, look_at_a_few):
            task()
    else:
        scene = dict(plain_scenes()).get(name) or _opened(name)
        if not len(scene.balls):
            return "no ball, nothing to compile"
        warm_scene(scene)
        if not scene.meeting:
            warm_aim(scene)
    return f"{time.perf_counter() - began:.1f} s"


def _opened(file: str) -> Scene:
    from wallkit.cli.scene_input import opened
    from wallkit.scene.wishes import Wishes

    return opened(file, Wishes(may_be_empty=True)).scene


def _usual() -> list[str]:
    """Name what most people meet; a wheel comes with the kernels for it."""
    from wallkit.scene.samples import shown
    from wallkit.simulation.warming import plain_scenes

    return [*(name for name, _ in plain_scenes()), *(str(sample.path) for sample in shown())]
