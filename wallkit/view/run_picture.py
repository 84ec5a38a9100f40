"""Pictures of runs and scenes: the path coloured along a ramp, ghosts of the balls at contacts that fade with age."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray

from importers.problems import Problem
from wallkit.geometry.arrays import FloatArray
from wallkit.scene.scene import Scene, falls
from wallkit.simulation.run import Ending
from wallkit.view.canvas import Bitmap, Canvas, Command, Disc, Label, Shape
from wallkit.view.frame import Box, Frame, united, walls_box
from wallkit.view.heat import heat_rows
from wallkit.view.outline import wall_path
from wallkit.view.picture import (
    MARGIN,
    WIDTH,
    draw_legend,
    draw_problems,
    draw_walls,
    finish,
    material_legend,
    problem_legend,
    started,
)
from wallkit.view.theme import RAMP_STEPS, STYLES
from wallkit.view.tracks import Tracks, arrays_of, tracks

if TYPE_CHECKING:
    from wallkit.simulation.run import Run

Colouring = Literal["ball", "time", "speed"]

MAX_STRETCHES = 20_000  # drawn at most; the picture says so where there are more
MAX_MEASURED = 1_000_000  # for a heat map
MAX_GHOSTS = 400
MAX_STROBES = 2_000
_POINT = 2.2  # pixels: a ball smaller than that is drawn as a dot
_ARROW = 0.35  # seconds of flight that the start's arrow shows, at most 90 pixels


def run_svg(
    run: Run,
    *,
    title: str = "",
    colour: Colouring | None = None,
    heat: bool = False,
    problems: Sequence[Problem] = (),
    width: float = WIDTH,
    strobe: float | None = None,
) -> str:
    """Draw a run as one SVG document, light or dark as its reader prefers.

    Args:
        run: what to draw: walls with normals, each ball's path, a ghost of it at its latest 400 contacts (the
            older, the fainter), start with an arrow and end. Of more than 20,000 stretches between contacts each
            ball's first ones are drawn, and the picture says how many.
        title: a line above the picture.
        colour: what the path's colour tells; None: which ball it is where there are several, else the time.
        heat: show where the balls spend their time instead of the path.
        problems: marked with numbers and listed below.
        width: of the picture in pixels.
        strobe: show the balls at whole multiples of this time too, in seconds, at most 2,000 of them.
    """
    return run_canvas(
        run, title=title, colour=colour, heat=heat, problems=problems, width=width, strobe=strobe
    ).to_svg()


def run_canvas(
    run: Run,
    *,
    title: str = "",
    colour: Colouring | None = None,
    heat: bool = False,
    problems: Sequence[Problem] = (),
    width: float = WIDTH,
    strobe: float | None = None,
) -> Canvas:
    """Draw a run as :func:`run_svg` does, on a canvas that can become SVG or pixels."""
    flight = tracks(run, MAX_MEASURED if heat else MAX_STRETCHES)
    canvas, frame = scene_base(run.scene, title, width, run_box(run, flight=flight))
    canvas.title = title or f"{len(run.ending)} balls, {int(run.bounces.sum())} bounces"
    if heat:
        size, rows = heat_rows(flight, frame)
        canvas.items.insert(0, Bitmap(frame.left, frame.top, size, rows, 0.9))
    else:
        colour = colour or usual_colouring(run)
        steps, low, high = _steps(flight, colour)
        if strobe is not None:
            _draw_strobe(canvas, run, frame, strobe, colour, low, high)
        _draw_flight(canvas, run, frame, flight, steps, colour)
    draw_problems(canvas, problems, frame)
    row = finish(canvas, frame, run.scene.walls.units)
    unit = {"ball": "", "time": " s"}.get(colour or "", f" {run.scene.walls.units or 'units'}/s")
    if heat:
        _draw_key(canvas, "time spent: none", "most", width)
    elif high > low:
        _draw_key(canvas, f"{colour} {low:.4g}", f"{high:.4g}{unit}", width)
    row = _note_thinning(canvas, flight, row)
    row = draw_legend(canvas, material_legend(run.scene.walls), row)
    problem_legend(canvas, problems, row)
    return canvas


def run_marks(run: Run) -> tuple[Canvas, Frame]:
    """Draw what :func:`run_canvas` puts over the walls, without them: paths, ghosts, starts and ends."""
    flight = tracks(run, MAX_STRETCHES)
    canvas, frame = started(run_box(run, flight=flight), run.scene.walls.y_axis == "up", title="", width=WIDTH)
    steps, _, _ = _steps(flight, "time")
    _draw_flight(canvas, run, frame, flight, steps)
    return canvas, frame


def usual_colouring(run: Run) -> Colouring:
    """Say what colours tell where nobody says it: which ball it is, as in films, or of one ball the time."""
    return "ball" if len(run.ending) > 1 else "time"


def _draw_flight(
    canvas: Canvas, run: Run, frame: Frame, flight: Tracks, steps: NDArray[np.int64], colour: Colouring = "time"
) -> None:
    draw_paths(canvas, flight, steps, frame)
    _draw_ghosts(canvas, run, frame, flight, steps)
    draw_starts(canvas, run.scene, frame, colour)
    _draw_ends(canvas, flight, frame)


def run_thumbnail(run: Run, width: float = 420.0) -> str:
    """Draw a run as a small picture without words, as one SVG document."""
    flight = tracks(run, MAX_STRETCHES)
    canvas, frame = scene_base(run.scene, "", width, run_box(run, flight=flight))
    steps, _, _ = _steps(flight, "ball")
    _draw_flight(canvas, run, frame, flight, steps)
    canvas.height = frame.height + 2 * frame.top
    return canvas.to_svg()


def scene_svg(scene: Scene, *, title: str = "", width: float = WIDTH) -> str:
    """Draw a scene as one SVG document: its walls, and its balls with an arrow each."""
    canvas, frame = scene_base(scene, title, width)
    canvas.title = title or "scene"
    draw_starts(canvas, scene, frame)
    row = finish(canvas, frame, scene.walls.units)
    draw_legend(canvas, material_legend(scene.walls), row)
    return canvas.to_svg()


def scene_base(scene: Scene, title: str, width: float, box: Box | None = None) -> tuple[Canvas, Frame]:
    """Begin a picture with a scene's walls and sensors; of ``box``, by default the scene's own."""
    position, _, _ = arrays_of(scene.balls)
    canvas, frame = started(box or scene_box(scene), scene.walls.y_axis == "up", title=title, width=width)
    draw_walls(canvas, scene.walls, frame, free=position)
    draw_sensors(canvas, scene, frame)
    return canvas, frame


def draw_sensors(canvas: Canvas, scene: Scene, frame: Frame) -> None:
    """Draw the sensors of a scene, dashed, with their names."""
    sensors = scene.sensors
    for index, name in enumerate(sensors.names if sensors is not None else ()):
        assert sensors is not None
        canvas.add(Shape("hidden", wall_path(sensors, index, frame), title=f"sensor {name or index}"))
        if name:
            x0, y0, x1, y1 = walls_box(sensors.take([index]))
            canvas.add(Label("note", *frame.point((x0 + x1) / 2, (y0 + y1) / 2), name, anchor="middle"))


def scene_box(scene: Scene) -> Box:
    """Give the box around a scene's walls, sensors and balls."""
    position, _, radius = arrays_of(scene.balls)
    boxes: list[Box] = [walls_box(walls) for walls in (scene.walls, scene.sensors) if walls is not None and len(walls)]
    if len(position):
        low, high = (position - radius[:, None]).min(axis=0), (position + radius[:, None]).max(axis=0)
        boxes.append((float(low[0]), float(low[1]), float(high[0]), float(high[1])))
    return united(boxes)


def run_box(run: Run, around: Box | None = None, flight: Tracks | None = None) -> Box:
    """Give the box around a scene, and around the paths of balls that fall, which rise above what holds them.

    A ball that leaves the scene is not followed, and no path farther than the larger side of the scene.

    Args:
        run: whose paths count.
        around: the box of the scene; by default that of walls, sensors and balls.
        flight: its tracks, where they are known.
    """
    around = scene_box(run.scene) if around is None else around
    if not falls(run.scene):
        return around
    flight = tracks(run, MAX_STRETCHES) if flight is None else flight
    left = np.array([ending is Ending.LEFT_SCENE for ending in run.ending], dtype=np.bool_)
    last = np.zeros(len(flight.time), dtype=np.bool_)
    last[flight.offsets[1:][left & (np.diff(flight.offsets) > 0)] - 1] = True
    begin, speed, pull = flight.position[~last], flight.velocity[~last], flight.pull[~last]
    with np.errstate(divide="ignore", invalid="ignore"):
        turn = -speed / pull  # when a coordinate comes to stand: the highest place of a parabola
    turns = (turn > 0.0) & (turn < (flight.until - flight.time)[~last][:, None])
    highest = begin + np.where(turns, 0.5 * speed * np.where(turns, turn, 0.0), 0.0)
    places = np.concatenate([begin, flight.target[~last], highest, np.reshape(around, (2, 2))])
    reach = max(around[2] - around[0], around[3] - around[1])
    low = np.maximum(places.min(axis=0), np.array(around[:2]) - reach)
    high = np.minimum(places.max(axis=0), np.array(around[2:]) + reach)
    return float(low[0]), float(low[1]), float(high[0]), float(high[1])


def _steps(flight: Tracks, colour: Colouring) -> tuple[NDArray[np.int64], float, float]:
    """Give each stretch its step on the ramp, and the values at the ramp's two ends."""
    if not len(flight.time):
        return np.empty(0, dtype=np.int64), 0.0, 0.0
    if colour == "ball":
        low, high, values = 0.0, float(len(flight.offsets) - 2), flight.ball.astype(np.float64)
    elif colour == "time":
        low, high, values = 0.0, float(flight.until.max()), flight.time
    else:
        values = np.hypot(*flight.velocity.T)
        low, high = float(values.min()), float(values.max())
    part = (values - low) / (high - low) if high > low else np.zeros(len(values))
    return ramp_steps(part), low, high


def ramp_steps(part: FloatArray) -> NDArray[np.int64]:
    """Give steps of the ramp for numbers from 0, its first, to 1, its last; what is beyond belongs to these."""
    steps: NDArray[np.int64] = np.clip((part * RAMP_STEPS).astype(np.int64), 0, RAMP_STEPS - 1)
    return steps


def draw_paths(canvas: Canvas, flight: Tracks, steps: NDArray[np.int64], frame: Frame, style: str = "path") -> None:
    """Draw each stretch: a line, or under gravity the parabola, which a quadratic Bezier curve is exactly.

    The ramp's steps colour a style that has no colour of its own.
    """
    begin, end = frame.points(flight.position), flight.target.copy()
    duration = flight.until - flight.time
    out = _leaves(flight, frame)
    for index in np.flatnonzero(out).tolist():
        end[index], duration[index] = _clipped(flight, index, frame)
    end = frame.points(end)
    # The control point of p + v s + a s^2 / 2 over s in [0, T] is p + v T / 2, where its end tangents meet.
    middle = frame.points(flight.position + flight.velocity * (duration / 2)[:, None])
    across = flight.velocity[:, 0] * flight.pull[:, 1] - flight.velocity[:, 1] * flight.pull[:, 0]
    bent: list[bool] = (across != 0.0).tolist()
    by_step: dict[int, list[Command]] = {}
    joined = np.concatenate([[False], (flight.contact[1:] >= 0) & (steps[1:] == steps[:-1]) & ~out[:-1]])
    for index, step in enumerate(steps.tolist()):
        commands = by_step.setdefault(step, [])
        if not (joined[index] and commands):
            commands.append(("M", *begin[index]))
        commands.append(("Q", *middle[index], *end[index]) if bent[index] else ("L", *end[index]))
    opacity = 0.95 if len(steps) < 800 else 0.6
    for step, commands in sorted(by_step.items()):
        canvas.add(Shape(style, commands, step=None if STYLES[style].stroke else step, opacity=opacity))


def _leaves(flight: Tracks, frame: Frame) -> NDArray[np.bool_]:
    x0, y0, x1, y1 = rim_of(frame)
    x, y = flight.target.T
    return np.asarray((x < x0) | (x > x1) | (y < y0) | (y > y1) | ~np.isfinite(x) | ~np.isfinite(y))


def rim_of(frame: Frame) -> Box:
    """Give the box, in the drawing's units, up to which paths are followed: a little more than is shown."""
    reach = 0.6 * MARGIN / frame.scale
    x0, y0, x1, y1 = frame.box
    return x0 - reach, y0 - reach, x1 + reach, y1 + reach


def _clipped(flight: Tracks, index: int, frame: Frame) -> tuple[FloatArray, float]:
    """Follow a stretch that leaves the picture up to its rim: the place there, and the time that it takes."""
    x0, y0, x1, y1 = rim_of(frame)
    p, v, a = flight.position[index], flight.velocity[index], flight.pull[index]
    high = min(float(flight.until[index] - flight.time[index]), 1e9 / max(float(np.hypot(*v)), 1e-9))
    low = 0.0
    for _ in range(60):  # halve until the rim is between two neighbouring numbers, as far as a picture can tell
        middle = (low + high) / 2
        x, y = p + v * middle + a * (middle * middle / 2)
        if x0 <= x <= x1 and y0 <= y <= y1:
            low = middle
        else:
            high = middle
    return p + v * low + a * (low * low / 2), low


def _draw_ghosts(canvas: Canvas, run: Run, frame: Frame, flight: Tracks, steps: NDArray[np.int64]) -> None:
    shown = np.flatnonzero(flight.contact >= 0)
    shown = shown[np.argsort(flight.time[shown], kind="stable")][-MAX_GHOSTS:]
    radius = flight.radius[flight.ball[shown]] * frame.scale
    for rank, (index, size) in enumerate(zip(shown.tolist(), radius.tolist(), strict=True)):
        contact = flight.contacts[int(flight.contact[index])]
        x, y = frame.point(float(contact["x"]), float(contact["y"]))
        opacity = round(0.12 + 0.68 * (rank + 1) / len(shown), 2)
        met = f"wall {contact['wall']}" if contact["wall"] >= 0 else f"ball {contact['other']}"
        told = f"bounce at {contact['time']:.6g} s, {met}"
        canvas.add(Disc("ghost", x, y, max(size, _POINT), int(steps[index]), size < _POINT, opacity, told))


def _draw_strobe(
    canvas: Canvas, run: Run, frame: Frame, every: float, colour: Colouring, low: float, high: float
) -> None:
    """Draw the balls where they are at 0, T, 2 T, ... until their runs end; of very many times the first ones."""
    balls, last = len(run.ending), float(run.final["time"].max(initial=0.0))
    times = np.arange(int(min(last / every, MAX_STROBES / max(balls, 1))) + 1) * every
    radius = run.scene.balls.radius * frame.scale
    for time, places in zip(times.tolist(), run.position(times), strict=True):
        if colour == "ball":
            values = np.arange(balls, dtype=np.float64)
        else:
            values = np.full(balls, time) if colour == "time" else np.hypot(*run.velocity(time).T)
        steps = ramp_steps((values - low) / (high - low) if high > low else np.zeros(balls)).tolist()
        for ball in np.flatnonzero(time <= run.final["time"]).tolist():
            x, y = frame.point(*places[ball].tolist())
            told = f"ball {ball} at {time:.6g} s"
            size = max(float(radius[ball]), _POINT)
            canvas.add(Disc("ghost", x, y, size, steps[ball], filled=True, opacity=0.3, title=told))


def draw_starts(canvas: Canvas, scene: Scene, frame: Frame, colour: Colouring = "time") -> None:
    """Draw each ball at its start, with an arrow; in its own colour where colours tell which it is."""
    position, velocity, radius = (array[:MAX_GHOSTS] for array in arrays_of(scene.balls))
    for ball, ((x, y), v, r) in enumerate(zip(frame.points(position), velocity, radius.tolist(), strict=True)):
        arrow = v * np.array([1.0, -1.0 if frame.up else 1.0]) * frame.scale * _ARROW
        length = float(np.hypot(*arrow))
        if length > 0 and len(position) <= 40:
            tip = arrow * (min(max(length, r * frame.scale + 18.0), 90.0 + r * frame.scale) / length)
            canvas.add(Shape("arrow", _arrow(x, y, tip)))
        told, size = f"start, velocity {v[0]:g}, {v[1]:g}", max(r * frame.scale, _POINT + 1)
        if colour == "ball" and len(scene.balls) > 1:
            step = int(ramp_steps(np.array([ball / (len(scene.balls) - 1)]))[0])
            canvas.add(Disc("ball", x, y, size, step, filled=True, title=f"ball {ball}: {told}"))
        else:
            canvas.add(Disc("ball", x, y, size, title=told))


def _arrow(x: float, y: float, tip: FloatArray) -> list[Command]:
    ex, ey = x + tip[0], y + tip[1]
    back = tip / np.hypot(*tip) * 7.0
    side = np.array([-back[1], back[0]]) * 0.5
    return [
        ("M", x, y), ("L", ex, ey),
        ("M", ex - back[0] + side[0], ey - back[1] + side[1]), ("L", ex, ey),
        ("L", ex - back[0] - side[0], ey - back[1] - side[1]),
    ]  # fmt: skip


def _draw_ends(canvas: Canvas, flight: Tracks, frame: Frame) -> None:
    if flight.thinned or len(flight.offsets) > MAX_GHOSTS:
        return
    last = flight.offsets[1:] - 1
    inside = ~_leaves(flight, frame)[last]
    for index in last[inside].tolist():
        x, y = frame.point(*flight.target[index])
        size = float(flight.radius[flight.ball[index]]) * frame.scale
        canvas.add(Disc("end", x, y, max(size, _POINT + 1), title=f"end at {flight.until[index]:.6g} s"))


def _draw_key(canvas: Canvas, low: str, high: str, width: float) -> None:
    """Draw the ramp with its ends' values at the foot's right."""
    side, length = 4.0, 4.0 * RAMP_STEPS
    x0, y0 = width - MARGIN - length - 8 * len(high) - 8, canvas.height - 22
    canvas.add(Bitmap(x0, y0, side, [list(range(RAMP_STEPS))] * 2))
    canvas.add(Label("note", x0 - 8, y0 + 8, low, anchor="end"), Label("note", x0 + length + 8, y0 + 8, high))


def _note_thinning(canvas: Canvas, flight: Tracks, row: float) -> float:
    if not flight.thinned:
        return row
    most = int(np.diff(flight.offsets).max())
    words = f"{len(flight.time):,} of {flight.whole:,} stretches are shown: each ball's first {most:,}"
    canvas.add(Label("note", MARGIN, row, words))
    canvas.height = max(canvas.height, row + 18)
    return row + 18
