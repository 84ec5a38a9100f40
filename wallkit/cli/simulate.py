"""`wallkit simulate`: a drawing, walls or a scene becomes contacts, pictures and films; a summary for people."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from wallkit.cli import import_options as drawing_options
from wallkit.cli.watching import watchable

if TYPE_CHECKING:
    from wallkit.scene.opening import OpenedScene
    from wallkit.simulation.run import Run

Format = Literal["csv", "json", "npz", "svg", "png", "gif", "mp4", "html"]
FORMATS: tuple[Format, ...] = ("csv", "json", "npz", "svg", "png", "gif", "mp4", "html")

File = Annotated[
    str, typer.Argument(metavar="FILE", help="Drawing, walls or scene (told by its content); - is standard input.")
]
Ball = Annotated[list[str] | None, typer.Option("--ball", metavar="X,Y", help="A ball's centre; may be repeated.")]
Velocity = Annotated[str | None, typer.Option(metavar="VX,VY", help="Velocity of every ball, units per second.")]
Speed = Annotated[float | None, typer.Option(metavar="S", help="Speed of every ball (default: 50).")]
Angle = Annotated[
    float | None, typer.Option(metavar="DEG", help="Direction, from the x towards the y axis (default: 30).")
]
Radius = Annotated[float | None, typer.Option(metavar="R", help="Radius of every ball; 0 is a point.")]
Count = Annotated[int | None, typer.Option("--balls", metavar="N", help="N balls at random places and directions.")]
Seed = Annotated[int, typer.Option(metavar="K", help="Seed of --balls.")]
Until = Annotated[float | None, typer.Option(metavar="T", help="End after T seconds.", min=0)]
Bounces = Annotated[
    int | None, typer.Option(metavar="N", help="End after N bounces a ball (default, without --until: 100).", min=0)
]
Gravity = Annotated[str | None, typer.Option(metavar="GX,GY", help="Units per second squared, in the drawing's axes.")]
Restitution = Annotated[
    float | None, typer.Option(metavar="E", help="Part of the normal speed that a bounce leaves.", min=0, max=10)
]
Tangential = Annotated[
    float | None,
    typer.Option("--tangential-restitution", metavar="E", help="The same along the wall.", min=0, max=1),
]
Friction = Annotated[
    float | None,
    typer.Option(metavar="A", help="Rolling friction: speed that a ball loses per second.", min=0),
]
Drag = Annotated[
    float | None,
    typer.Option(metavar="K", help="Drag: rate of dv/dt = -K v, per second.", min=0),
]
Meeting = Annotated[
    bool | None,
    typer.Option("--meeting/--no-meeting", help="Discs meet one another; points never do.", show_default=False),
]
BallRestitution = Annotated[
    float | None,
    typer.Option(metavar="E", help="Part of their normal speed that a contact of two discs leaves.", min=0, max=1),
]
Out = Annotated[
    list[str] | None,
    typer.Option("-o", "--out", metavar="OUT", help=f"Where to; the ending decides: {' '.join(FORMATS)}. Repeatable."),
]


def register(app: typer.Typer) -> None:
    """Attach the command."""
    app.command("simulate")(simulate_file)


@drawing_options.with_import_options()
@watchable
def simulate_file(
    file: File,
    out: Out = None,
    form: Annotated[Format | None, typer.Option("--format", help="Format, whatever the ending says.")] = None,
    ball: Ball = None,
    velocity: Velocity = None,
    speed: Speed = None,
    angle: Angle = None,
    radius: Radius = None,
    balls: Count = None,
    seed: Seed = 0,
    settle: Annotated[
        bool, typer.Option("--settle", help="Move balls that overlap a wall at the start to the nearest free spot.")
    ] = False,
    until: Until = None,
    bounces: Bounces = None,
    gravity: Gravity = None,
    restitution: Restitution = None,
    tangential_restitution: Tangential = None,
    friction: Friction = None,
    drag: Drag = None,
    meeting: Meeting = None,
    ball_restitution: BallRestitution = None,
    colour: Annotated[Literal["time", "speed"], typer.Option(help="What the path's colour tells.")] = "time",
    heat: Annotated[bool, typer.Option("--heat", help="Pictures show where balls spend their time.")] = False,
    theme: Annotated[
        Literal["light", "dark"], typer.Option(help="Of PNG, GIF and MP4; SVG and HTML follow the reader.")
    ] = "light",
    seconds: Annotated[float, typer.Option(metavar="T", help="Length of a film at most.", min=0.1, max=600)] = 12.0,
    importing: dict[str, Any] | None = None,
) -> None:
    """Shoot balls at walls: every contact, exact, and how each ball ended."""
    from wallkit.cli.scene_input import opened, pair, pairs
    from wallkit.scene.opening import Wishes

    wishes = Wishes(
        pairs(ball, "--ball"), None if velocity is None else pair(velocity, "--velocity"), speed, angle, radius,
        balls, seed, None if gravity is None else pair(gravity, "--gravity"), restitution, tangential_restitution,
        friction, drag, meeting, ball_restitution, until, bounces, drawing_options.options_of(importing or {}),
    )  # fmt: skip
    targets = _targets(out or [], form)
    scene = opened(file, wishes)
    run = _flown(scene, settle)
    look = {"colour": colour, "heat": heat, "theme": theme, "seconds": seconds}
    trust = _trust(run)
    for target, kind in targets:
        _write(target, kind, run, scene, trust, {**look, "title": "" if file == "-" else Path(file).name})
    stream = sys.stderr if any(target == "-" for target, _ in targets) else sys.stdout
    for line in _summary(file, scene, run, trust, targets):
        print(line, file=stream)


def _targets(out: list[str], form: Format | None) -> list[tuple[str, Format]]:
    """Pair each OUT with its format; a format alone goes to standard output."""
    from wallkit.scene.opening import UsageError

    targets: list[tuple[str, Format]] = []
    for name in out or (["-"] if form else []):
        ending = Path(name).suffix.lower().removeprefix(".")
        kind = form or ("csv" if name == "-" else ending)
        if kind not in FORMATS:
            raise UsageError(
                f"a run cannot be written as {'.' + ending if ending else 'a file without an ending'}",
                code="unknown-ending",
                fix=f"use an ending of these: {', '.join('.' + f for f in FORMATS)}; or --format",
                file=name,
            )
        targets.append((name, kind))
    return targets


def _flown(scene: OpenedScene, settle: bool) -> Run:
    from wallkit.simulation.simulate import simulate

    with progress_bar("simulating") as report:
        return simulate(scene.scene, scene.until, scene.bounces, settle=settle, progress=report)


@contextmanager
def progress_bar(label: str, after: float = 0.5) -> Iterator[Callable[[float], None] | None]:
    """Show how much is done on standard error, where that is a terminal and the work takes longer than a moment."""
    if not sys.stderr.isatty():
        yield None
        return
    begun = last = time.monotonic()
    shown = False

    def report(part: float) -> None:
        nonlocal last, shown
        now = time.monotonic()
        if now - begun < after or now - last < 0.1:
            return
        last, shown = now, True
        filled = int(30 * min(max(part, 0.0), 1.0))
        sys.stderr.write(f"\r{label} [{'#' * filled}{'.' * (30 - filled)}] {100 * part:3.0f} %")
        sys.stderr.flush()

    try:
        yield report
    finally:
        if shown:
            sys.stderr.write("\r\x1b[K")
            sys.stderr.flush()


def _trust(run: Run) -> list[Any]:
    """Ask for each ball of a small run how far it is good; many balls would take longer than their flight."""
    if run.scene.meeting or not 0 < len(run.ending) <= 10 or len(run.contacts) > 20_000:
        return []
    return list(run.trusted_until())


def _write(target: str, kind: Format, run: Run, scene: OpenedScene, trust: list[Any], look: dict[str, Any]) -> None:
    from wallkit.simulation import run_files
    from wallkit.write_file import write_whole

    if kind == "csv":
        write_whole(target, run_files.to_csv(run))
    elif kind == "json":
        good = [{"time": h.time, "bounces": h.bounces, "tolerance": h.tolerance} for h in trust] if trust else None
        write_whole(target, run_files.to_json(run, good, scene.until, scene.bounces))
    elif kind == "npz":
        write_whole(target, run_files.to_npz(run))
    else:
        write_whole(target, _pictured(kind, run, look))


def _pictured(kind: Format, run: Run, look: dict[str, Any]) -> str | bytes:
    if kind == "html":
        from wallkit.view.replay import replay_html

        page: str = replay_html(run, title=look["title"])
        return page
    if kind in ("gif", "mp4"):
        from wallkit.view.film import film

        with progress_bar("filming") as report:
            return film(run, kind, seconds=look["seconds"], theme=look["theme"], progress=report)
    from wallkit.view.run_picture import run_canvas
    from wallkit.view.write import picture_data

    canvas = run_canvas(run, title=look["title"], colour=look["colour"], heat=look["heat"])
    return picture_data(f".{kind}", canvas, look["theme"])


def _summary(file: str, scene: OpenedScene, run: Run, trust: list[Any], targets: list[tuple[str, Format]]) -> list[str]:
    from wallkit.cli.messages import count_by_severity, plain
    from wallkit.cli.summary import ball_words, bounce_words, drawing_words, ending_words, energy_words, wall_words

    rows = [("walls", wall_words(run.scene.walls)), ("balls", ball_words(run)), ("bounces", bounce_words(run)),
            ("ended", ending_words(run)), ("energy", energy_words(run))]  # fmt: skip
    if trust:
        worst = min(trust, key=lambda horizon: (horizon.whole, horizon.time))
        rows.append(("trust", worst.sentence() + (" (the worst ball)" if len(trust) > 1 else "")))
        rows += [("drawing", words) for words in drawing_words(run)]
    rows += [("assumed", words) for words in scene.assumed]
    balls = [problem for problem in scene.problems if problem.code in ("ball-in-material", "shut-in")]
    rows += [("doubtful", f"{ball.message}, at ({ball.x:.6g}, {ball.y:.6g})") for ball in balls[:3]]
    if scene.problems:
        counted = count_by_severity(scene.problems)
        rows.append(("problems", f"{counted}: wallkit check {plain(file)} lists them"))
    rows += [("wrote", plain(target)) for target, _ in targets if target != "-"]
    name = "standard input" if file == "-" else plain(file)
    return [f"{name} ({scene.kind})", *(f"  {word:<9}{words}" for word, words in rows)]
