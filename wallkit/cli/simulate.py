"""`wallkit simulate`: a drawing, walls or a scene becomes contacts, pictures and films; a summary for people."""

from __future__ import annotations

import functools
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from wallkit.cli import import_options as drawing_options
from wallkit.cli.watching import watchable

if TYPE_CHECKING:
    from wallkit.scene.opening import OpenedScene
    from wallkit.simulation.run import Run
    from wallkit.simulation.ways import Stepped

Format = Literal["csv", "json", "npz", "svg", "png", "gif", "mp4", "html"]
FORMATS: tuple[Format, ...] = ("csv", "json", "npz", "svg", "png", "gif", "mp4", "html")
_PICTURES: tuple[Format, ...] = ("svg", "png")
_FILMS: tuple[Format, ...] = ("gif", "mp4")
_SHOW_WAYS = (*_PICTURES, *_FILMS)
_SHOWN_IN: dict[str, tuple[Format, ...]] = {
    "colour": _SHOW_WAYS, "strobe": _PICTURES, "heat": _PICTURES, "theme": ("png", *_FILMS), "size": _SHOW_WAYS,
    "seconds": _FILMS, "fps": _FILMS, "pace": _FILMS,
}  # fmt: skip
"""Which files show what an option of "What is written" asks for."""

File = Annotated[
    str, typer.Argument(metavar="FILE", help="Drawing, walls or scene (told by its content); - is standard input.")
]


def _option(panel: str) -> Any:
    """Make options that the help shows in one panel."""
    return functools.partial(typer.Option, rich_help_panel=panel)


_ball, _acts, _frames, _ends, _output = (
    _option(panel) for panel in ("Balls", "What acts", "Frames", "When it ends", "What is written")
)
Ball = Annotated[list[str] | None, _ball("--ball", metavar="X,Y", help="A ball's centre; may be repeated.")]
Velocity = Annotated[str | None, _ball(metavar="VX,VY", help="Velocity of every ball, units per second.")]
Speed = Annotated[float | None, _ball(metavar="S", help="Speed of every ball (default: 50).")]
Angle = Annotated[float | None, _ball(metavar="DEG", help="Direction, from the x towards the y axis (default: 30).")]
Radius = Annotated[float | None, _ball(metavar="R", help="Radius of every ball; 0 is a point.")]
Count = Annotated[int | None, _ball("--balls", metavar="N", help="N balls at random places and directions.")]
Seed = Annotated[int | None, _ball(metavar="K", help="Seed of --balls (default: 0).")]
Settle = Annotated[
    bool, _ball("--settle", help="Move discs that overlap a wall at the start to the nearest free spot.")
]
Gravity = Annotated[
    str | None,
    _acts(metavar="G", help="Units per second squared: GX,GY in the drawing's axes; or one number, downwards."),
]
Restitution = Annotated[
    float | None, _acts(metavar="E", help="Part of the normal speed that a bounce leaves.", min=0, max=10)
]
Tangential = Annotated[
    float | None, _acts("--tangential-restitution", metavar="E", help="The same along the wall.", min=0, max=1)
]
Friction = Annotated[
    float | None, _acts(metavar="A", help="Rolling friction: speed that a ball loses per second.", min=0)
]
Drag = Annotated[float | None, _acts(metavar="K", help="Drag: rate of dv/dt = -K v, per second.", min=0)]
WayOfFrames = Annotated[
    Literal["exact", "stop", "full-step", "reflect-in-place", "overlap"] | None,
    _frames(
        "--way",
        help="Step by frames, and treat contacts within one so; pictures and films show it over the exact run, and "
        "where they part.",
        show_default=False,
    ),
]
Dt = Annotated[
    float | None,
    _frames(
        "--dt", metavar="T", help="Seconds of a frame (default: 1/60); without --way, frames of the exact run.", min=0
    ),
]
Until = Annotated[float | None, _ends(metavar="T", help="End after T seconds.", min=0)]
Bounces = Annotated[
    int | None, _ends(metavar="N", help="End after N bounces a ball (default, without --until: 100).", min=0)
]
Meeting = Annotated[
    bool | None,
    _acts("--meeting/--no-meeting", help="Discs meet one another; points never do.", show_default=False),
]
BallRestitution = Annotated[
    float | None,
    _acts(metavar="E", help="Part of their normal speed that a contact of two discs leaves.", min=0, max=1),
]
Out = Annotated[
    list[str] | None,
    _output("-o", "--out", metavar="OUT", help=f"Where to; the ending decides: {' '.join(FORMATS)}. Repeatable."),
]
Form = Annotated[Format | None, _output("--format", help="Format, whatever the ending says.")]
Colour = Annotated[
    Literal["ball", "time", "speed"] | None,
    _output(help="What colours tell (default: ball, where there are several; time).", show_default=False),
]
Strobe = Annotated[float | None, _output(metavar="T", help="Pictures show the balls every T seconds too.", min=1e-9)]
Heat = Annotated[bool, _output("--heat", help="Pictures show where balls spend their time.")]
Theme = Annotated[
    Literal["light", "dark"] | None,
    _output(help="Of PNG, GIF and MP4 (default: light); SVG and HTML follow the reader.", show_default=False),
]
Size = Annotated[
    int | None,
    _output(metavar="W", help="Width of pictures and films in pixels (a PNG is twice as fine).", min=160, max=3840),
]
Seconds = Annotated[
    float | None, _output(metavar="T", help="Length of a film at most (default: 12).", min=0.1, max=600)
]
Fps = Annotated[int | None, _output(metavar="N", help="Frames a second of a film.", min=1, max=60)]
Pace = Annotated[
    float | None, _output(metavar="P", help="Seconds of the run in a second of film; 1 is real time.", min=1e-6)
]


def register(app: typer.Typer) -> None:
    """Attach the command."""
    app.command("simulate", rich_help_panel="Balls")(simulate_file)


@drawing_options.with_import_options()
@watchable
def simulate_file(
    file: File,
    out: Out = None,
    form: Form = None,
    ball: Ball = None,
    velocity: Velocity = None,
    speed: Speed = None,
    angle: Angle = None,
    radius: Radius = None,
    balls: Count = None,
    seed: Seed = None,
    settle: Settle = False,
    until: Until = None,
    bounces: Bounces = None,
    gravity: Gravity = None,
    restitution: Restitution = None,
    tangential_restitution: Tangential = None,
    friction: Friction = None,
    drag: Drag = None,
    meeting: Meeting = None,
    ball_restitution: BallRestitution = None,
    way: WayOfFrames = None,
    dt: Dt = None,
    colour: Colour = None,
    strobe: Strobe = None,
    heat: Heat = False,
    theme: Theme = None,
    size: Size = None,
    seconds: Seconds = None,
    fps: Fps = None,
    pace: Pace = None,
    importing: dict[str, Any] | None = None,
) -> None:
    """Shoot balls at walls: every contact, exact, and how each ball ended."""
    from wallkit.cli.scene_input import gravity_or_none, opened, pair_or_none, pairs
    from wallkit.scene.wishes import Wishes

    _check_seed(seed, balls)
    wishes = Wishes(
        pairs(ball, "--ball"), pair_or_none(velocity, "--velocity"), speed, angle, radius,
        balls, seed or 0, gravity_or_none(gravity), restitution, tangential_restitution,
        friction, drag, meeting, ball_restitution, until, bounces, drawing_options.options_of(importing or {}),
    )  # fmt: skip
    targets = _targets(out or [], form)
    way = "exact" if way is None and dt is not None else way
    look: dict[str, Any] = {"colour": colour, "heat": heat or None, "theme": theme, "size": size, "strobe": strobe}
    look |= {"seconds": seconds, "fps": fps, "pace": pace}
    _check_way(way, look, targets)
    _check_look(look, targets)
    scene = opened(file, wishes)
    run = _flown(scene, settle)
    stepped = look["stepped"] = _stepped(run, way, 1 / 60 if dt is None else dt)
    trust = _trust(run)
    for target, kind in targets:
        _write(target, kind, run, scene, trust, {**look, "title": "" if file == "-" else Path(file).name})
    stream = sys.stderr if any(target == "-" for target, _ in targets) else sys.stdout
    for line in _summary(file, scene, run, trust, stepped, targets):
        print(line, file=stream)


def _targets(out: list[str], form: Format | None) -> list[tuple[str, Format]]:
    """Pair each OUT with its format; a format alone goes to standard output."""
    from wallkit.scene.wishes import UsageError

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
    from wallkit.cli.progress import progress_bar
    from wallkit.simulation.simulate import simulate

    with progress_bar("simulating") as report:
        return simulate(scene.scene, scene.until, scene.bounces, settle=settle, progress=report)


def _check_way(way: str | None, look: dict[str, Any], targets: list[tuple[str, Format]]) -> None:
    """Refuse what would be left out in silence: files and colours that tell of exact runs alone."""
    from wallkit.scene.wishes import UsageError

    if way is None:
        return
    told = "" if look["colour"] in (None, "ball") else f"--colour {look['colour']}"
    option = "--heat" if look["heat"] else "--strobe" if look["strobe"] is not None else told
    if option:
        raise UsageError(
            f"{option} is for exact runs, and --way is given", code="usage", fix="leave out one of the two"
        )
    for name, kind in targets:
        if kind not in _SHOW_WAYS and way != "exact":
            raise UsageError(
                f"{name}: a {kind} file holds exact runs alone, not the way {way!r}",
                code="usage",
                fix=f"use one of {', '.join('.' + each for each in _SHOW_WAYS)}, or leave out --way",
            )


def _check_look(look: dict[str, Any], targets: list[tuple[str, Format]]) -> None:
    """Refuse what would be left out in silence: a look that no file which is written can show."""
    from wallkit.scene.wishes import UsageError

    written = {kind for _, kind in targets}
    for name, kinds in _SHOWN_IN.items():
        if look[name] is not None and not written.intersection(kinds):
            raise UsageError(
                f"--{name}: only with a file that shows it",
                code="usage",
                fix=f"write one, such as -o run.{kinds[0]} ({', '.join('.' + kind for kind in kinds)} show it), "
                "or leave it out",
            )


def _check_seed(seed: int | None, balls: int | None) -> None:
    from wallkit.scene.wishes import UsageError

    if seed is not None and balls is None:
        raise UsageError("--seed: only with --balls", code="usage", fix="say how many balls fly, such as --balls 10")


def _stepped(run: Run, way: Any, dt: float) -> Stepped | None:
    """Step the balls of a run by frames, if a way is given."""
    if way is None:
        return None
    from wallkit.simulation.ways import last_moment, step_through

    return step_through(run.scene, way, dt, last_moment(run))


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
    given = {name: look[name] for name in ("colour",) if look[name] is not None}
    size = {} if look["size"] is None else {"width": look["size"]}
    given |= size
    theme: Any = look["theme"] or "light"
    if kind in ("gif", "mp4"):
        from wallkit.cli.progress import progress_bar
        from wallkit.view.film import film

        chosen = {name: look[name] for name in ("seconds", "fps", "pace", "stepped") if look[name] is not None}
        with progress_bar("filming") as report:
            return film(run, kind, theme=theme, **chosen, **given, progress=report)
    from wallkit.view.run_picture import run_canvas
    from wallkit.view.write import picture_data

    if look["stepped"] is not None:
        from wallkit.view.ways_picture import ways_canvas

        return picture_data(f".{kind}", ways_canvas(run, look["stepped"], title=look["title"], **size), theme)
    canvas = run_canvas(run, title=look["title"], heat=bool(look["heat"]), strobe=look["strobe"], **given)
    return picture_data(f".{kind}", canvas, theme)


def _summary(
    file: str,
    scene: OpenedScene,
    run: Run,
    trust: list[Any],
    stepped: Stepped | None,
    targets: list[tuple[str, Format]],
) -> list[str]:
    from wallkit.cli.messages import count_by_severity, plain
    from wallkit.cli.summary import ball_words, bounce_words, drawing_words, ending_words, energy_words, wall_words

    rows = [("walls", wall_words(run.scene.walls)), ("balls", ball_words(run)), ("bounces", bounce_words(run)),
            ("ended", ending_words(run)), ("energy", energy_words(run))]  # fmt: skip
    if stepped is not None:
        from wallkit.simulation.ways import flown_through, partings, sentence

        rows.append(("way", sentence(stepped, partings(run, stepped), flown_through(stepped))))
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
