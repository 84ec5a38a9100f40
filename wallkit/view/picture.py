"""Pictures of walls and drawings: fills by material, normals as ticks, problems as numbered marks."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from importers.drawing import Drawing, Subpath
from importers.problems import Problem
from wallkit.geometry.arrays import FloatArray
from wallkit.view.canvas import Canvas, Command, Disc, Label, Shape
from wallkit.view.frame import Box, Frame, fit, united, walls_box
from wallkit.view.outline import solid_areas, tick_places, wall_path
from wallkit.view.theme import MATERIALS
from wallkit.walls import Material, Walls

WIDTH = 960.0
_MAX_HEIGHT = 1100.0
MARGIN = 28.0
_TITLE = 34.0
_FOOT = 40.0
_LINE = 18.0
_MARKS = 60
_TICK = 8.0
_NO_PLACES = np.empty((0, 2))


def walls_svg(
    walls: Walls,
    problems: Sequence[Problem] = (),
    *,
    title: str = "",
    normals: bool = True,
    ways: Sequence[NDArray[np.float64]] = (),
    width: float = WIDTH,
) -> str:
    """Draw walls as one SVG document: light or dark as its reader prefers, the right way up.

    Closed walls are filled even-odd, open ones are thick lines, normals are ticks on the outside (at most one
    about every 26 pixels), problems with a place are numbered marks with a legend below.

    Args:
        walls: what to draw.
        problems: what to mark; those without a place stand in the legend alone.
        title: a line above the picture.
        normals: draw them.
        ways: polylines (n, 2) through leaks, drawn dashed.
        width: of the picture in pixels; its height follows the drawing.
    """
    return walls_canvas(walls, problems, title=title, normals=normals, ways=ways, width=width).to_svg()


def walls_canvas(
    walls: Walls,
    problems: Sequence[Problem] = (),
    *,
    title: str = "",
    normals: bool = True,
    ways: Sequence[NDArray[np.float64]] = (),
    width: float = WIDTH,
) -> Canvas:
    """Draw walls as :func:`walls_svg` does, on a canvas that can become SVG or pixels."""
    canvas, frame = started(_marked_box(walls, problems), walls.y_axis == "up", title=title, width=width)
    canvas.title = title or f"{len(walls)} walls"
    draw_walls(canvas, walls, frame, normals=normals)
    _draw_ways(canvas, ways, frame)
    draw_problems(canvas, problems, frame)
    row = finish(canvas, frame, walls.units)
    legend = material_legend(walls)
    row = draw_legend(canvas, legend, row)
    if walls.solid is not None and walls.solid.how != "asked":
        canvas.add(Label("note", MARGIN, row, f"assumed: {walls.solid.sentence()}"))
        row += _LINE
        canvas.height = max(canvas.height, row)
    problem_legend(canvas, problems, row)
    return canvas


def walls_marks(
    walls: Walls, problems: Sequence[Problem], *, ways: Sequence[NDArray[np.float64]] = (), note: str = ""
) -> tuple[Canvas, Frame]:
    """Draw what :func:`walls_canvas` puts over the walls, without them: marks, ways through leaks, words below."""
    canvas, frame = started(_marked_box(walls, problems), walls.y_axis == "up", title="", width=WIDTH)
    _draw_ways(canvas, ways, frame)
    draw_problems(canvas, problems, frame)
    row = frame.top + frame.height + MARGIN
    canvas.add(Label("text", MARGIN, row, note, bold=True))
    problem_legend(canvas, problems, row + _LINE)
    return canvas, frame


def _marked_box(walls: Walls, problems: Sequence[Problem]) -> Box:
    """The box around walls and marks."""
    # What was left out by rule (info) may lie anywhere, such as a guide off the page; it shall not shrink the rest.
    marked = [p for p in problems if p.severity != "info" or not len(walls)]
    places = [(p.x, p.y, p.x, p.y) for p in marked if p.x is not None and p.y is not None]
    return united([*([walls_box(walls)] if len(walls) else []), *places])


def _draw_ways(canvas: Canvas, ways: Sequence[NDArray[np.float64]], frame: Frame) -> None:
    for way in ways:
        corners = [frame.point(x, y) for x, y in way.tolist()]
        canvas.add(Shape("way", [("M" if i == 0 else "L", x, y) for i, (x, y) in enumerate(corners)]))


def started(box: Box, up: bool, *, title: str, width: float) -> tuple[Canvas, Frame]:
    """Begin a picture: its frame, room for a foot line, and the title when there is one."""
    top = _TITLE if title else 0.0
    frame = fit(box, up, width=width, max_height=_MAX_HEIGHT, margin=MARGIN, top=top)
    canvas = Canvas(width, top + frame.height + 2 * MARGIN + _FOOT, title)
    if title:
        shown = title if len(title) * 9 < width else title[: int(width / 9) - 1] + "…"
        canvas.add(Label("title", MARGIN, 26, shown, 16, bold=True))
    return canvas, frame


def draw_walls(
    canvas: Canvas, walls: Walls, frame: Frame, *, normals: bool = True, free: FloatArray = _NO_PLACES
) -> None:
    """Draw fills, outlines and normals; ``free`` is a place that is not material, such as a ball's."""
    numbers = shades(walls)
    for material, members, framed in solid_areas(walls, free):
        commands = [command for index in members for command in wall_path(walls, index, frame)]
        if framed:
            commands = [*_around(frame), *commands]
        canvas.add(Shape(f"material{numbers[material]}", commands))
    for index, closed in enumerate(walls.closed):
        told = " · ".join(part for part in (walls.layers[index], walls.names[index]) if part)
        canvas.add(Shape("outline" if closed else "open", wall_path(walls, index, frame), title=told))
    if normals:
        ticks: list[Command] = []
        for x, y, nx, ny, both in tick_places(walls, frame):
            back = _TICK if both else 0.0
            ticks += [("M", x - back * nx, y - back * ny), ("L", x + _TICK * nx, y + _TICK * ny)]
        if ticks:
            canvas.add(Shape("normal", ticks))


def _around(frame: Frame) -> list[Command]:
    """Give the ring a little outside the box: a room's wall has a body as thick as that."""
    rim = 12.0
    x0, y0 = frame.left - rim, frame.top - rim
    x1, y1 = frame.left + frame.width + rim, frame.top + frame.height + rim
    return [("M", x0, y0), ("L", x1, y0), ("L", x1, y1), ("L", x0, y1), ("Z",)]


def shades(walls: Walls) -> dict[Material, int]:
    """Number the materials in order, the plain one always 0; beyond the sixth, shades come round again."""
    others = [material for material in dict.fromkeys(walls.materials) if material != Material()]
    return {Material(): 0, **{material: 1 + index % (MATERIALS - 1) for index, material in enumerate(others)}}


def material_legend(walls: Walls) -> list[tuple[str, str]]:
    """Give (style, words) for each material, where there is something to tell."""
    if all(material == Material() for material in walls.materials):
        return []
    return [
        (f"material{shade}", f"restitution {m.restitution:g}, tangential {m.tangential_restitution:g}")
        for m, shade in shades(walls).items()
        if m in walls.materials
    ]


def draw_legend(canvas: Canvas, entries: Sequence[tuple[str, str]], row: float) -> float:
    """Draw swatches with words below the picture from ``row`` on, and give the next free row."""
    for style, words in entries:
        box: list[Command] = [("M", MARGIN, row - 10), ("L", MARGIN + 14, row - 10), ("L", MARGIN + 14, row + 2),
                              ("L", MARGIN, row + 2), ("Z",)]  # fmt: skip
        canvas.add(Shape(style, box), Shape("outline", box), Label("text", MARGIN + 24, row, words))
        row += _LINE
    canvas.height = max(canvas.height, row)
    return row


def draw_problems(canvas: Canvas, problems: Sequence[Problem], frame: Frame) -> None:
    """Put a numbered mark at each problem's place in the frame (the first 60; the legend counts the rest)."""
    for number, problem in enumerate(problems[:_MARKS], start=1):
        if problem.x is not None and problem.y is not None:
            x, y = frame.point(problem.x, problem.y)
            if abs(x - frame.left - frame.width / 2) <= frame.width / 2 + MARGIN and (
                abs(y - frame.top - frame.height / 2) <= frame.height / 2 + MARGIN
            ):
                canvas.add(*_mark(problem, number, x, y, problem.message))


def _mark(problem: Problem, number: int, x: float, y: float, title: str = "") -> list[Disc | Label]:
    return [
        Disc(problem.severity, x, y, 8.5, title=title),
        Label("number", x, y + 3.6, str(number), 10 if number < 100 else 8, "middle", bold=True),
    ]


def problem_legend(canvas: Canvas, problems: Sequence[Problem], row: float) -> None:
    """List the problems under the picture with their numbers, and how many are not listed."""
    letters = int((canvas.width - 2 * MARGIN - 28) / 6.4)
    for number, problem in enumerate(problems[:_MARKS], start=1):
        canvas.add(*_mark(problem, number, MARGIN + 8, row - 4))
        words = problem.message.rstrip(".") + (f"; {problem.fix}" if problem.fix else "")
        for line in textwrap.wrap(" ".join(words.split()), letters)[:3] or [problem.code]:
            canvas.add(Label("text", MARGIN + 26, row, line))
            row += _LINE
        row += 4
    if len(problems) > _MARKS:
        canvas.add(Label("note", MARGIN, row, f"and {len(problems) - _MARKS} more problems, not listed here"))
        row += _LINE
    if problems:
        canvas.height = max(canvas.height, row + 4)


def finish(canvas: Canvas, frame: Frame, units: str) -> float:
    """Draw the scale bar under the picture, and give the row where legends may begin."""
    length = round_length(canvas.width / 6 / frame.scale)
    pixels = length * frame.scale
    foot = canvas.height - 18
    x0, x1 = MARGIN, MARGIN + pixels
    bar: list[Command] = [("M", x0, foot - 4), ("L", x0, foot + 4), ("M", x0, foot), ("L", x1, foot),
                          ("M", x1, foot - 4), ("L", x1, foot + 4)]  # fmt: skip
    canvas.add(Shape("scale", bar), Label("note", x1 + 8, foot + 4, f"{length:g} {units or 'units'}"))
    return canvas.height + 10


def round_length(length: float) -> float:
    """Give the largest of 1, 2, 5 times a power of ten that is not longer."""
    power = 10.0 ** np.floor(np.log10(length))
    return float(max(step * power for step in (1, 2, 5) if step * power <= length * (1 + 1e-9)))


def drawing_svg(drawing: Drawing, *, title: str = "", width: float = WIDTH) -> str:
    """Draw what a file holds, curves exactly as they are there; hidden paths and guides are dashed."""
    box = drawing.control_box()
    canvas, frame = started(united([box] if box else []), drawing.y_axis == "up", title=title, width=width)
    canvas.title = title or f"{drawing.kind or 'drawing'} with {len(drawing.paths)} paths"
    for path in drawing.paths:
        plain = path.visible and not path.guide and not path.clip
        commands = [command for sub in path.subpaths for command in _subpath(sub, frame)]
        told = " · ".join(part for part in (path.layer, path.name) if part)
        if plain and path.fill is not None:
            canvas.add(Shape("material0", commands))
        canvas.add(Shape("outline" if plain else "hidden", commands, title=told))
    finish(canvas, frame, drawing.units)
    return canvas.to_svg()


def _subpath(sub: Subpath, frame: Frame) -> list[Command]:
    commands: list[Command] = []
    for segment in sub.segments:
        if segment[0] == "A":
            rx, ry, rotation, large, sweep, x, y = segment[1:]
            if frame.up:  # turned over: the axes' angle and the way round change sign
                rotation, sweep = -rotation, 1 - sweep
            commands.append(("A", rx * frame.scale, ry * frame.scale, rotation, int(large), int(sweep),
                             *frame.point(x, y)))  # fmt: skip
        else:
            numbers = segment[1:]
            places = (frame.point(x, y) for x, y in zip(numbers[0::2], numbers[1::2], strict=True))
            commands.append((segment[0], *(value for place in places for value in place)))
    if sub.closed:
        commands.append(("Z",))
    return commands
