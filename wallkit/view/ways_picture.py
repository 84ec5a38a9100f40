"""A way to be wrong in pictures and films: its frames in colour over the exact path, and marks where the two part."""

from __future__ import annotations

import textwrap
from dataclasses import replace

import numpy as np
import shapely
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray
from wallkit.simulation.run import Run
from wallkit.simulation.ways import Stepped, flown_through, partings, sentence
from wallkit.view.canvas import Canvas, Command, Disc, Item, Label, Shape
from wallkit.view.frame import Frame
from wallkit.view.picture import MARGIN, WIDTH, draw_legend, finish, material_legend
from wallkit.view.run_picture import (
    MAX_STRETCHES,
    draw_paths,
    draw_starts,
    ramp_steps,
    rim_of,
    run_box,
    scene_base,
)
from wallkit.view.tracks import Tracks, arrays_of, tracks

MOST_DOTS = 2_000
"""Frames that a picture marks with a dot each; of more only the way between them is drawn."""
MOST_MARKS = 20
"""Balls whose parting is marked, the earliest."""
_LETTER = 6.2  # pixels that a letter of a note takes
_RING = 5.0  # pixels between a ball and the ring that marks where it parted


def ways_canvas(run: Run, stepped: Stepped, *, title: str = "", width: float = WIDTH) -> Canvas:
    """Draw a run in grey and over it, in colour, the same balls stepped by frames; where they part is ringed.

    Each frame is a dot. A ring is where a ball first is somewhere else than its exact run says, with a thin line to the
    exact ball of that moment; a cross is where it went through a wall.
    """
    canvas, frame = scene_base(run.scene, title, width, run_box(run))
    beside = Beside(run, stepped, frame)
    canvas.title = title or beside.sentence
    canvas.add(*beside.exact_paths(float(stepped.time[-1])))
    for ball, step in enumerate(beside.steps):
        canvas.add(*beside.path(ball, step, 0, len(stepped.time)))
    draw_starts(canvas, run.scene, frame)
    canvas.add(*beside.marks(float(stepped.time[-1])))
    row = finish(canvas, frame, run.scene.walls.units)
    for line in textwrap.wrap(f"Grey: exact. In colour: {beside.sentence}.", int((width - 2 * MARGIN) / _LETTER)):
        canvas.add(Label("note", MARGIN, row, line))
        row += 18
    canvas.height = max(canvas.height, row)
    draw_legend(canvas, material_legend(run.scene.walls), row)
    return canvas


class Beside:
    """A way beside its exact run, on one frame: what pictures and films of it are made of.

    Attributes:
        stepped: the way.
        parted: where balls part.
        through: which walls they went through.
        sentence: both in words.
        steps: (n,) the ramp's step of each ball.
    """

    def __init__(self, run: Run, stepped: Stepped, frame: Frame) -> None:
        self.run, self.stepped, self.frame = run, stepped, frame
        self.parted, self.through = partings(run, stepped), flown_through(stepped)
        self.sentence = sentence(stepped, self.parted, self.through)
        balls = len(run.ending)
        part = np.arange(balls) / (balls - 1) if balls > 1 else np.full(balls, 0.5)
        self.steps: list[int] = ramp_steps(part).tolist()
        self._radius = np.maximum(arrays_of(run.scene.balls)[2] * frame.scale, 3.0)

    def exact_paths(self, until: float) -> list[Item]:
        """The exact paths up to a time."""
        canvas = Canvas(0.0, 0.0)
        flight = _begun(tracks(self.run, MAX_STRETCHES), until)
        draw_paths(canvas, flight, np.zeros(len(flight.time), dtype=np.int64), self.frame, "exact")
        return canvas.items

    def path(self, ball: int, step: int, first: int, last: int) -> list[Item]:
        """Frames ``first`` to before ``last`` of a ball: a dot each, and straight ways between them."""
        places = self.stepped.state[first:last, ball, 0:2]
        x0, y0, x1, y1 = rim_of(self.frame)
        inside = (places >= (x0, y0)).all(axis=1) & (places <= (x1, y1)).all(axis=1)
        items: list[Item] = []
        if (commands := _within(places, (x0, y0, x1, y1), self.frame)) and len(places) > 1:
            items.append(Shape("path", commands, step=step, opacity=0.75))
        if len(places) * len(self.steps) <= MOST_DOTS:
            items += [Disc("ball", x, y, 1.8, step, filled=True) for x, y in self.frame.points(places[inside]).tolist()]
        return items

    def marks(self, time: float) -> list[Item]:
        """What marks where balls parted and what they went through, up to a time."""
        items: list[Item] = []
        earliest = sorted(self.parted, key=lambda parting: parting.time)[:MOST_MARKS]
        for index, parting in enumerate(parting for parting in earliest if parting.time <= time):
            (x, y), exact = self.frame.point(*parting.place), self.frame.point(*parting.exact)
            size = float(self._radius[parting.ball]) + _RING
            told = f"parts at {parting.time:.6g} s"
            items.append(Shape("apart", [("M", x, y), ("L", *exact)], opacity=0.6))
            items.append(Disc("apart", x, y, size, title=told))
            if index == 0 and self._shown(x, y):
                items.append(self._words(x, y, size, told))
        for through in sorted(self.through, key=lambda through: through.time)[:MOST_MARKS]:
            x, y = self.frame.point(*through.place)
            if through.time <= time and self._shown(x, y):
                items.append(Shape("apart", _cross(x, y, 6.0), title=f"through wall {through.wall}"))
        return items

    def items(self, time: float, exact: FloatArray, since: float) -> list[Item]:
        """What a film shows at a time: exact balls as rings, the others as discs with the frames since a time."""
        items: list[Item] = []
        last = int(np.searchsorted(self.stepped.time, time, side="right"))
        first = min(int(np.searchsorted(self.stepped.time, since)), last - 1)
        shown = self.frame.points(self.stepped.state[last - 1, :, 0:2]).tolist()
        for ball, ((x, y), (u, v), step) in enumerate(zip(shown, exact.tolist(), self.steps, strict=True)):
            size = float(self._radius[ball])
            items.append(Disc("exact", u, v, size))
            items += self.path(ball, step, first, last) if len(shown) <= MOST_MARKS else []
            if self._shown(x, y):
                items.append(Disc("ball", x, y, size, step, filled=True))
        return items + self.marks(time)

    def _shown(self, x: float, y: float) -> bool:
        frame = self.frame
        return abs(x - frame.left - frame.width / 2) <= frame.width / 2 + MARGIN and (
            abs(y - frame.top - frame.height / 2) <= frame.height / 2 + MARGIN
        )

    def _words(self, x: float, y: float, size: float, told: str) -> Label:
        """Words over a ring, within the picture."""
        half, frame = 3.5 * len(told), self.frame
        middle = min(max(x, frame.left + half), frame.left + frame.width - half)
        return Label("apart-words", middle, y - size - 5, told, 12.0, "middle", True)


def _begun(flight: Tracks, until: float) -> Tracks:
    """Stretches that begin before a time."""
    keep: NDArray[np.bool_] = flight.time < until
    names = ("time", "until", "position", "target", "velocity", "pull", "contact")
    return replace(flight, **{name: getattr(flight, name)[keep] for name in names})


def _within(places: FloatArray, rim: tuple[float, float, float, float], frame: Frame) -> list[Command]:
    """The straight ways from place to place, as far as the rim."""
    if len(places) < 2:
        return []
    inside = shapely.clip_by_rect(shapely.linestrings(places), *rim)
    commands: list[Command] = []
    for line in shapely.get_parts(inside):
        points = frame.points(shapely.get_coordinates(line)).tolist()
        commands += [("M" if index == 0 else "L", *point) for index, point in enumerate(points)]
    return commands


def _cross(x: float, y: float, size: float) -> list[Command]:
    return [("M", x - size, y - size), ("L", x + size, y + size), ("M", x - size, y + size), ("L", x + size, y - size)]
