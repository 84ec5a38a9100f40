"""`wallkit aim`: all shots that reach a target, as a table, JSON and a picture."""

from __future__ import annotations

import json
import math
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from wallkit.cli import import_options as drawing_options
from wallkit.cli import simulate as flight
from wallkit.cli.watching import watchable

if TYPE_CHECKING:
    from wallkit.levels.windows import Window, Windows
    from wallkit.scene.opening import OpenedScene

SHOWN = 12
"""Windows that are told to people, the widest; JSON has all."""


def register(app: typer.Typer) -> None:
    """Attach the command."""
    app.command("aim", rich_help_panel="Balls")(aim_at)


@drawing_options.with_import_options()
@watchable
def aim_at(
    file: flight.File,
    to: Annotated[
        str, typer.Option("--to", metavar="X,Y,R|NAME", help="Disc, or the name of a target, spawn or sensor.")
    ],
    bounces: Annotated[int, typer.Option("--bounces", metavar="K", help="Bounces at most.", min=0)],
    start: Annotated[
        str | None, typer.Option("--from", metavar="X,Y", help="Where the ball starts (default: the level's ball).")
    ] = None,
    radius: Annotated[
        float | None,
        typer.Option(metavar="R", help="Of the ball (default: that of the level's ball; with --from a point)."),
    ] = None,
    speed: Annotated[
        float | None,
        typer.Option(metavar="S", help="Of the ball; matters under gravity, friction and drag alone."),
    ] = None,
    gravity: flight.Gravity = None,
    restitution: flight.Restitution = None,
    tangential_restitution: flight.Tangential = None,
    friction: flight.Friction = None,
    drag: flight.Drag = None,
    resolution: Annotated[
        float, typer.Option(metavar="RAD", help="Of the search: radians between shots that differ.", min=1e-12, max=0.1)
    ] = 1e-7,
    most_beams: Annotated[
        int, typer.Option(metavar="N", help="A limit on beams, and on shots of the search.", min=1)
    ] = 10_000_000,
    as_json: Annotated[bool, typer.Option("--json", help="Write all windows as JSON to standard output.")] = False,
    out: Annotated[str, typer.Option("-o", "--out", metavar="PICTURE", help="Draw the beams (.svg, .png).")] = "",
    theme: Annotated[Literal["light", "dark"], typer.Option(help="Of PNG; SVG follows the reader.")] = "light",
    importing: dict[str, Any] | None = None,
) -> None:
    """Find all directions that reach a target within K bounces, and how wide each window is."""
    from wallkit.cli.progress import progress_bar
    from wallkit.cli.scene_input import gravity_or_none, opened, pair
    from wallkit.levels.aim import aim
    from wallkit.levels.targets import given_target
    from wallkit.scene.wishes import Wishes
    from wallkit.view.write import check_picture_ending

    if out:
        check_picture_ending(Path(out).suffix, out)
    wishes = Wishes(ball=() if start is None else (pair(start, "--from"),), radius=radius, speed=speed, bounces=bounces,
                    gravity=gravity_or_none(gravity), restitution=restitution,
                    tangential_restitution=tangential_restitution, friction=friction, drag=drag,
                    importing=drawing_options.options_of(importing or {}))  # fmt: skip
    level = opened(file, wishes)
    ball = level.scene.balls
    place, size = (float(ball.position[0, 0]), float(ball.position[0, 1])), float(ball.radius[0])
    pace = float(math.hypot(*ball.velocity[0])) or None
    with progress_bar("aiming") as report:
        progress = None if report is None else (lambda beams: report(beams / most_beams))
        windows = aim(level.scene, place, given_target(to), bounces, size, speed=pace, resolution=resolution,
                      most_beams=most_beams, progress=progress)  # fmt: skip
    if out:
        _draw(level, windows, pace, out, theme, "" if file == "-" else Path(file).name)
    if as_json:
        print(json.dumps(windows.to_json(), ensure_ascii=False, allow_nan=False))
    _tell(file, level, windows, out, sys.stderr if as_json else sys.stdout)


def _draw(level: OpenedScene, windows: Windows, speed: float | None, out: str, theme: Any, title: str) -> None:
    from wallkit.view.aim_picture import aim_canvas
    from wallkit.view.write import write_picture

    write_picture(out, aim_canvas(level.scene, windows, speed=speed or 50.0, title=title), theme)


def _tell(file: str, level: OpenedScene, windows: Windows, out: str, stream: Any) -> None:
    from wallkit.cli.messages import plain

    (x, y), (tx, ty, r) = windows.start, windows.target
    counts = " ".join(str(count) for count in windows.by_bounces.tolist())
    ball = f"a ball of radius {windows.radius:g}" if windows.radius else "a point"
    rows = [
        ("from", f"({x:.6g}, {y:.6g}), {ball}, to ({tx:.6g}, {ty:.6g}), radius {r:g}"),
        ("found", windows.sentence()),
        *([("bounces", f"{counts} windows with 0 to {windows.most_bounces}")] if windows.most_bounces else []),
        ("sure", windows.certainty()),
    ]
    rows += [("assumed", words) for words in _assumed(level)]
    rows += [("wrote", plain(out))] if out else []
    name = "standard input" if file == "-" else plain(file)
    print("\n".join([f"{name} ({level.kind})", *(f"  {word:<9}{words}" for word, words in rows)]), file=stream)
    if len(windows):
        print(_table(windows), file=stream)


def _assumed(level: OpenedScene) -> list[str]:
    """Leave out what does not matter here: the direction, and the speed where nothing but walls acts."""
    scene = level.scene
    acts = scene.gravity is not None or scene.rolling_friction is not None or scene.drag is not None
    said = [words for words in level.assumed if "(--angle)" not in words and (acts or "(--speed)" not in words)]
    return [words.replace("--ball", "--from") for words in said]


def _table(windows: Windows) -> str:
    """Write the widest windows, a line each."""
    widest = sorted(windows, key=lambda window: -window.width)[:SHOWN]
    lines = ["    degrees         width, rad   bounces  off"]
    lines += [
        f"    {math.degrees(one.middle):>11.6f}  {one.width:>12.6g}  {one.bounces:>8}  {_word(windows, one)}"
        for one in widest
    ]
    if len(windows) > SHOWN:
        lines.append(f"    and {len(windows) - SHOWN:,} narrower ones (--json)")
    return "\n".join(lines)


def _word(windows: Windows, window: Window) -> str:
    from wallkit.cli.messages import plain

    names = windows.walls.names
    return ", ".join(plain(names[wall]) or f"wall {wall}" for wall in window.word)
