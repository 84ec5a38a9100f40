"""Pictures of an aim: walls, the target, and the beams of the widest windows from bounce to bounce."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray
from wallkit.levels.windows import Windows
from wallkit.scene.scene import Balls, Scene, falls
from wallkit.simulation.run import ContactKind, Ending, Run
from wallkit.simulation.simulate import simulate
from wallkit.view.canvas import Canvas, Command, Disc, Label, Shape
from wallkit.view.frame import Frame, united
from wallkit.view.picture import MARGIN, WIDTH, draw_walls, finish, started
from wallkit.view.run_picture import draw_paths, draw_sensors, scene_box
from wallkit.view.theme import RAMP_STEPS
from wallkit.view.tracks import tracks

MOST_DRAWN = 60
"""Beams that are drawn, the widest; the picture says so where there are more."""
_LOOKS, _FALL = 4001, 100.0  # places on the last flight of a falling shot; how long it is looked at without an end
INNER = 2.0**-20
"""Of its width: so far within a window its outermost shots are flown."""


def aim_canvas(scene: Scene, windows: Windows, *, speed: float = 50.0, title: str = "", width: float = WIDTH) -> Canvas:
    """Draw windows as beams that leave the ball and end at the target, coloured by bounces; the widest has a line.

    Under gravity a beam is drawn as the path in its middle.

    Args:
        scene: in which they were found.
        windows: what to draw.
        speed: of the shots that are flown for the picture.
        title: a line above the picture.
        width: of the picture in pixels.
    """
    x, y, r = windows.target
    sx, sy = windows.start
    box = united([scene_box(scene), (x - r, y - r, x + r, y + r), (sx, sy, sx, sy)])
    canvas, frame = started(box, scene.walls.y_axis == "up", title=title, width=width)
    canvas.title = title or windows.sentence()
    draw_walls(canvas, scene.walls, frame, free=np.array([windows.start]))
    draw_sensors(canvas, scene, frame)
    shown = np.argsort(-windows.width, kind="stable")[:MOST_DRAWN]
    for index in shown[::-1].tolist():
        (_draw_path if falls(scene) else _draw_beam)(canvas, frame, scene, windows, index, speed)
    if len(shown) and not falls(scene):
        middle = _paths(scene, windows, [windows[int(shown[0])].middle], int(windows.bounces[shown[0]]), speed)[0]
        _line(canvas, frame, middle, windows.target)
    canvas.add(Disc("target", *frame.point(x, y), max(r * frame.scale, 3.0), title="target"))
    canvas.add(Disc("ball", *frame.point(sx, sy), max(windows.radius * frame.scale, 3.2), title="start"))
    row = finish(canvas, frame, scene.walls.units)
    more = f"; the {MOST_DRAWN} widest are drawn" if len(windows) > MOST_DRAWN else ""
    for words in (windows.sentence() + more, windows.certainty()):
        canvas.add(Label("note", MARGIN, row, words))
        row += 18
    canvas.height = max(canvas.height, row)
    return canvas


def _draw_beam(canvas: Canvas, frame: Frame, scene: Scene, windows: Windows, index: int, speed: float) -> None:
    """Draw one beam: between its two outermost shots, flight by flight."""
    window = windows[index]
    inner = INNER * window.width
    paths = _paths(scene, windows, [window.low + inner, window.high - inner], window.bounces, speed)
    if len(paths[0]) != len(paths[1]):
        return
    x, y, r = windows.target
    for path in paths:
        path[-1] = _at_target(path[-2], path[-1], (x, y, r))
    low, high = (frame.points(path) for path in paths)
    commands: list[Command] = []
    for k in range(len(low) - 1):
        corners = (low[k], low[k + 1], high[k + 1], high[k])
        commands += [("M" if i == 0 else "L", *corner) for i, corner in enumerate(corners)]
        commands.append(("Z",))
    step = _step(windows, window.bounces)
    by = "searched" if window.searched else "unfolded"
    told = f"{window.width:.3g} rad at {math.degrees(window.middle):.4f} degrees, {window.bounces} bounces, {by}"
    for k in range(0, len(commands), 5):  # a path of its own for each flight: even-odd would cut out where they cross
        canvas.add(Shape("beam", commands[k : k + 5], step=step, opacity=0.35, title=told))


def _draw_path(canvas: Canvas, frame: Frame, scene: Scene, windows: Windows, index: int, speed: float) -> None:
    """Draw the shot in the middle of a window, with its parabolas, until it enters the target."""
    window = windows[index]
    velocity = speed * np.array([[math.cos(window.middle), math.sin(window.middle)]])
    shot = replace(scene, balls=Balls([windows.start], velocity, windows.radius), sensors=None)
    run = simulate(shot, bounces=window.bounces + 1)
    met = run.contacts_of(0)
    met = met["time"][(met["kind"] == ContactKind.EDGE) | (met["kind"] == ContactKind.VERTEX)]
    since = float(met[window.bounces - 1]) if window.bounces else 0.0
    until = float(met[window.bounces]) if len(met) > window.bounces else since + _FALL * (since or 1.0)
    times = np.linspace(since, until, _LOOKS)
    x, y, r = windows.target
    near = np.hypot(*(run.position(times)[:, 0] - (x, y)).T)
    end = float(times[int(np.argmax(near < r)) if (near < r).any() else int(near.argmin())])
    flight = tracks(simulate(shot, until=end))
    draw_paths(canvas, flight, np.full(len(flight.time), _step(windows, window.bounces)), frame)


def _step(windows: Windows, bounces: int) -> int:
    """Give the step on the ramp of so many bounces."""
    return round((RAMP_STEPS - 1) * bounces / max(windows.most_bounces, 1))


def _line(canvas: Canvas, frame: Frame, path: FloatArray, target: tuple[float, float, float]) -> None:
    path[-1] = _at_target(path[-2], path[-1], target)
    points = frame.points(path)
    canvas.add(Shape("arrow", [("M" if i == 0 else "L", *point) for i, point in enumerate(points)], opacity=0.8))


def _at_target(a: FloatArray, b: FloatArray, target: tuple[float, float, float]) -> FloatArray:
    """Where the line from a towards b comes nearest to the target's middle, or enters it, but not behind b."""
    d, w = b - a, np.array(target[:2]) - a
    square = float(d @ d)
    if square == 0.0:
        return b
    along, off = float(w @ d) / square, float(w[0] * d[1] - w[1] * d[0]) ** 2 / square
    part = along - math.sqrt(max(target[2] ** 2 - off, 0.0) / square)
    return a + min(max(part, 0.0), 1.0) * d


def _paths(scene: Scene, windows: Windows, angles: list[float], bounces: int, speed: float) -> list[FloatArray]:
    """Fly shots: (bounces + 2, 2) start, bounces, and the end of the flight that reaches the target, for each."""
    n = len(angles)
    velocity = speed * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    balls = Balls(np.tile(windows.start, (n, 1)), velocity, windows.radius)
    run = simulate(replace(scene, balls=balls, sensors=None), bounces=bounces + 1)
    return [_places(run, ball, windows, bounces) for ball in range(n)]


def _places(run: Run, ball: int, windows: Windows, bounces: int) -> FloatArray:
    own = run.contacts_of(ball)
    own = own[(own["kind"] == ContactKind.EDGE) | (own["kind"] == ContactKind.VERTEX)]
    met: NDArray[np.float64] = np.column_stack([own["x"], own["y"]])[: bounces + 1]
    places = np.concatenate([[windows.start], met])
    if len(places) < bounces + 2:  # it leaves the scene, or comes to rest
        final = run.final[ball]
        end = np.array([final["x"], final["y"]])
        if run.ending[ball] == Ending.LEFT_SCENE:
            away = np.array([final["vx"], final["vy"]])
            far = float(np.hypot(*(np.array(windows.target[:2]) - end))) + windows.target[2]
            end = end + away / np.hypot(*away) * far
        places = np.concatenate([places, [end]])
    return places
