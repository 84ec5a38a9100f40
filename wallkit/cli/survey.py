"""`wallkit survey`: any number of balls, down to counts, on threads, processes or a cluster."""

from __future__ import annotations

import json
import sys
from typing import TYPE_CHECKING, Annotated, Any

import typer

from wallkit.cli import import_options as drawing_options
from wallkit.cli.simulate import (
    Bounces,
    Drag,
    File,
    Friction,
    Gravity,
    Radius,
    Restitution,
    Speed,
    Tangential,
    Until,
)

if TYPE_CHECKING:
    from wallkit.levels.starts import Starts
    from wallkit.scene.opening import OpenedScene
    from wallkit.simulation.counts import Counts

FORMAT, VERSION = "wallkit-survey", 1

Balls = Annotated[str, typer.Option("--balls", metavar="N", help="How many; 1e7 is a number.")]
From = Annotated[
    str | None,
    typer.Option("--from", metavar="NAME|X,Y", help="All start at this spawn or place (default: all over the room)."),
]
Where = Annotated[str, typer.Option("--executor", metavar="WHERE", help="threads, processes, or dask://HOST:PORT.")]
Workers = Annotated[int | None, typer.Option(metavar="N", help="Threads or processes (default: one a core).", min=1)]
Chunk = Annotated[int | None, typer.Option(metavar="N", help="Balls at a time; no result depends on it.", min=1)]
Checkpoint = Annotated[
    str | None, typer.Option(metavar="PATH", help="Keep there what has flown; if it is there, fly only the rest.")
]


def register(app: typer.Typer) -> None:
    """Attach the command."""
    app.command("survey")(survey_file)


@drawing_options.with_import_options()
def survey_file(
    file: File,
    balls: Balls,
    out: Annotated[str | None, typer.Option("-o", "--out", metavar="OUT.npz", help="Write the counts as NPZ.")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Write the counts as JSON to standard output.")] = False,
    start: From = None,
    speed: Speed = None,
    radius: Radius = None,
    seed: Annotated[int, typer.Option(metavar="K", help="Seed of places and directions.", min=0)] = 0,
    until: Until = None,
    bounces: Bounces = None,
    gravity: Gravity = None,
    restitution: Restitution = None,
    tangential_restitution: Tangential = None,
    friction: Friction = None,
    drag: Drag = None,
    executor: Where = "threads",
    workers: Workers = None,
    chunk: Chunk = None,
    checkpoint: Checkpoint = None,
    importing: dict[str, Any] | None = None,
) -> None:
    """Fly any number of balls and keep only counts: endings, bounces by edge, crossings. Memory does not grow."""
    from wallkit.cli.progress import progress_bar
    from wallkit.cli.scene_input import gravity_or_none, opened
    from wallkit.levels.starts import starts_of
    from wallkit.scene.wishes import Wishes
    from wallkit.simulation.count import count

    wishes = Wishes(
        speed=speed, radius=radius, seed=seed, gravity=gravity_or_none(gravity),
        restitution=restitution, tangential_restitution=tangential_restitution, friction=friction, drag=drag,
        until=until, bounces=bounces, importing=drawing_options.options_of(importing or {}), may_be_empty=True,
    )  # fmt: skip
    many = how_many(balls)
    _check_ending(out)
    scene = opened(file, wishes)
    starts = starts_of(scene, place_given(start), speed=speed, radius=radius, seed=seed)
    with progress_bar("surveying") as report:
        counts = count(
            scene.scene, starts.draw, many, scene.until, scene.bounces, executor=executor, workers=workers,
            chunk=chunk, checkpoint=checkpoint, progress=report,
        )  # fmt: skip
    if out is not None:
        counts.save(out)
    if as_json:
        print(json.dumps(_report(scene, counts), ensure_ascii=False))
    for line in _summary(file, scene, starts, counts, out):
        print(line, file=sys.stderr if as_json or out == "-" else sys.stdout)


def how_many(text: str) -> int:
    """Read a number of balls, ``1e7`` too.

    Raises:
        UsageError: it is no whole number above 0.
    """
    from wallkit.arguments import whole_number
    from wallkit.scene.wishes import UsageError

    try:
        value: object = int(text) if text.isdecimal() else float(text)
    except ValueError:
        value = text
    may_be = "a whole number, 1 or more, such as 1000000 or 1e7"
    return whole_number(value, "--balls", may_be, error=UsageError, code="usage", least=1)


def place_given(text: str | None) -> str | tuple[float, float] | None:
    """Read ``X,Y`` as a place, and anything else as a name."""
    from wallkit.cli.scene_input import pair

    if text is None:
        return None
    parts = text.split(",")
    return pair(text, "--from") if len(parts) == 2 and all(_is_number(part) for part in parts) else text


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _check_ending(out: str | None) -> None:
    from wallkit.scene.wishes import UsageError

    if out is not None and out != "-" and not out.lower().endswith(".npz"):
        raise UsageError(
            "counts are written as NPZ", code="unknown-ending", fix="give a name that ends on .npz", file=out
        )


def _report(scene: OpenedScene, counts: Counts) -> dict[str, Any]:
    walls = scene.scene.walls
    return {
        "format": FORMAT,
        "version": VERSION,
        "source": {"file": walls.source_file, "sha256": walls.source_sha256},
        "until": scene.until,
        "bounce_limit": scene.bounces,
        "digest": counts.digest(),
        "seconds": counts.seconds,
        "ended": dict(counts.ended()),
        **counts.to_json(),
    }


def _summary(file: str, scene: OpenedScene, starts: Starts, counts: Counts, out: str | None) -> list[str]:
    from wallkit.cli.messages import plain
    from wallkit.cli.summary import counted, wall_words
    from wallkit.simulation.survey import hits_by_wall

    hits = hits_by_wall(scene.scene.walls, counts.edge_hits, counts.vertex_hits)
    never = int((counts.edge_hits == 0).sum())
    rows = [
        ("walls", wall_words(scene.scene.walls)),
        ("balls", f"{counts.balls:,}, radius {starts.radius:g}"),
        ("bounces", f"{counts.bounces:,} in {counts.seconds:.6g} s of all together"),
        ("ended", ", ".join(f"{label} {number:,}" for label, number in counts.ended())),
        ("hits", f"{counted(int((hits > 0).sum()), 'wall')} hit, {counted(never, 'edge')} never"),
        ("digest", counts.digest()[:16]),
    ]
    rows += [("assumed", words) for words in [*starts.assumed, *_limits_assumed(scene)]]
    rows += [("wrote", plain(out))] if out not in (None, "-") else []
    name = "standard input" if file == "-" else plain(file)
    return [f"{name} ({scene.kind})", *(f"  {word:<9}{words}" for word, words in rows)]


def _limits_assumed(scene: OpenedScene) -> list[str]:
    """What was assumed when the scene was opened, but for the one ball that does not fly here."""
    return [
        words for words in scene.assumed if not any(of in words for of in ("--ball", "--speed", "--angle", "drawn"))
    ]
