"""Films of a run, GIF and MP4: each frame shows the exact state at its time."""

from __future__ import annotations

import contextlib
import io
import math
import shutil
import subprocess
import tempfile
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from importers.errors import WallkitError
from wallkit.arguments import ABOVE_0, number, of_type, refused, whole_number, word
from wallkit.geometry.arrays import FloatArray
from wallkit.simulation.run import Run, one_a_ball
from wallkit.simulation.ways import Stepped
from wallkit.view.canvas import Command, Disc, Item, Label, Shape
from wallkit.view.frame import Frame
from wallkit.view.picture import draw_walls, finish, round_length, started
from wallkit.view.raster import Raster
from wallkit.view.run_picture import Colouring, draw_sensors, ramp_steps, run_box
from wallkit.view.theme import RAMP_STEPS, Theme
from wallkit.view.tracks import arrays_of, tracks
from wallkit.view.ways_picture import Beside

Progress = Callable[[float], None]

_RATES = {"gif": 25, "mp4": 30}  # frames a second
_GIF_RATES = (1, 2, 4, 5, 10, 20, 25, 50)  # GIF counts in hundredths of a second
_WIDTH = 640
_CROSSING = 1.8  # seconds of film for a ball to cross the picture, which sets how fast a film runs
_TRAIL = 0.9  # seconds of film that a trail lasts, and a ghost of a contact
_TRAILS = 60  # so many balls at most draw trails


class FilmError(WallkitError):
    """A film cannot be made here; the message says what is missing."""


def film(
    run: Run,
    kind: Literal["gif", "mp4"],
    *,
    seconds: float = 12.0,
    width: int = _WIDTH,
    fps: int | None = None,
    pace: float | None = None,
    colour: Colouring = "ball",
    theme: Theme = "light",
    stepped: Stepped | None = None,
    progress: Progress | None = None,
) -> bytes:
    """Make a film of a run.

    Time runs at ``pace`` seconds of the run a second of the film; if that is not given at 1, 2 or 5 times a power of
    ten, so that the balls cross the picture in about two seconds. The film says how fast, and how much of the run it
    shows.

    Args:
        run: what to show.
        kind: ``"gif"``, or ``"mp4"`` (H.264 where ffmpeg has it).
        seconds: the film's length at most.
        width: of the film in pixels, even, 160 to 3840.
        fps: frames a second, 1 to 60, 25 or 30 if not given; of a GIF 1, 2, 4, 5, 10, 20, 25 or 50.
        pace: seconds of the run that pass in a second of the film; above 0.
        colour: what the colour of a ball tells: which it is, the time, or its speed at that time.
        theme: light or dark.
        stepped: the same scene stepped by frames, whose balls are shown in colour over the exact ones, as rings; where
            they part is marked. Balls are coloured by which they are.
        progress: called with the part done, 0 to 1.

    Raises:
        FilmError: no ffmpeg, or it failed, or an argument is none of what may be.
    """
    of_type(run, "run", Run, "a Run", error=FilmError, code="bad-argument")
    word(kind, "kind", tuple(_RATES), error=FilmError, code="bad-argument")
    may_be = "seconds, more than 0 and at most 3600"
    number(seconds, "seconds", may_be, error=FilmError, code="bad-argument", least=ABOVE_0, most=3600.0)
    word(theme, "theme", get_args(Theme), error=FilmError, code="bad-argument")
    word(colour, "colour", get_args(Colouring), error=FilmError, code="bad-argument")
    _check_width(width)
    rate = _rate(kind, fps)
    if pace is not None:
        number(pace, "pace", "a number above 0", error=FilmError, code="bad-argument", least=ABOVE_0)
    if progress is not None and not callable(progress):
        raise refused("progress", progress, "a function of one number, or None", FilmError, "bad-argument")
    if stepped is not None:
        of_type(stepped, "stepped", Stepped, "a Stepped or None", error=FilmError, code="bad-argument")
    frames = _Frames(run, Look(width, rate, pace, colour, theme), seconds, progress, stepped)
    return _gif(frames) if kind == "gif" else _mp4(frames)


def _check_width(width: int) -> None:
    may_be = "an even whole number, 160 to 3840"  # H.264 wants even numbers
    whole_number(width, "width", may_be, error=FilmError, code="bad-argument", least=160, most=3840)
    if width % 2:
        raise refused("width", width, may_be, FilmError, "bad-argument")


def _rate(kind: str, fps: int | None) -> int:
    if fps is None:
        return _RATES[kind]
    may_be = f"one of {', '.join(map(str, _GIF_RATES))}" if kind == "gif" else "a whole number, 1 to 60"
    rate = whole_number(fps, "fps", may_be, error=FilmError, code="bad-argument", least=1, most=60)
    if kind == "gif" and rate not in _GIF_RATES:
        raise refused("fps", fps, f"{may_be}, since GIF counts in hundredths of a second", FilmError, "bad-argument")
    return rate


@dataclass(frozen=True, slots=True)
class Look:
    """How a film looks: see :func:`film`."""

    width: int
    fps: int
    pace: float | None
    colour: Colouring
    theme: Theme


class _Frames:
    """The frames one by one, drawn over one background."""

    def __init__(
        self, run: Run, look: Look, seconds: float, progress: Progress | None, stepped: Stepped | None = None
    ) -> None:
        self.run, self.look, self.fps, self.progress = run, look, look.fps, progress
        box, up = run_box(run), run.scene.walls.y_axis == "up"
        canvas, self.frame = started(box, up, title="", width=float(look.width))
        start, _, radius = arrays_of(run.scene.balls)
        draw_walls(canvas, run.scene.walls, self.frame, normals=False, free=start)
        draw_sensors(canvas, run.scene, self.frame)
        finish(canvas, self.frame, run.scene.walls.units)
        self.width, self.height = canvas.width, 2.0 * math.ceil(canvas.height / 2)  # H.264 wants even numbers
        self.background = Raster(self.width, self.height, look.theme, 1.0).drawn(canvas.items)
        self.radius = np.maximum(radius * self.frame.scale, 3.0)
        self.speedup = _speedup(run, self.frame) if look.pace is None else look.pace
        self.duration = float(run.final["time"].max(initial=0.0))
        self.count = max(1, int(min(seconds, self.duration / self.speedup) * look.fps) + 1)
        self.fastest = _fastest(run) if look.colour == "speed" else 1.0
        self.beside = None if stepped is None else Beside(run, stepped, self.frame)
        if self.beside is not None:
            self.background.drawn(self.beside.exact_paths(self.count / look.fps * self.speedup))

    def caption(self, time: float) -> str:
        shown = (self.count - 1) / self.fps * self.speedup
        part = (
            "" if shown >= self.duration - self.speedup / self.fps else f", first {shown:.4g} of {self.duration:.4g} s"
        )
        pace = "" if self.speedup == 1 else f" (at {self.speedup:g} times its speed{part})"
        way = "" if self.beside is None else f"{self.beside.stepped.way}, dt {self.beside.stepped.dt:.4g} s: "
        return f"{way}{time:.2f} s{pace or part}"

    def __iter__(self) -> Iterator[Image.Image]:
        contacts = one_a_ball(self.run.contacts)
        times = contacts["time"]
        trails: list[deque[tuple[float, float, float]]] = [deque() for _ in self.run.ending[:_TRAILS]]
        passed = 0
        for frame in range(self.count):
            time = frame / self.fps * self.speedup
            upto = int(np.searchsorted(times, time, side="right"))
            for contact in contacts[passed:upto] if len(self.run.ending) <= _TRAILS else ():
                place = self.frame.point(float(contact["x"]), float(contact["y"]))
                trails[contact["ball"]].append((float(contact["time"]), *place))
            passed = upto
            balls = self.frame.points(self.run.position(time))
            yield self._frame(time, balls, self._steps(time), trails, contacts[max(0, upto - 200) : upto])
            if self.progress:
                self.progress((frame + 1) / self.count)

    def _frame(
        self,
        time: float,
        balls: FloatArray,
        steps: list[int],
        trails: list[deque[tuple[float, float, float]]],
        recent: NDArray[Any],
    ) -> Image.Image:
        items: list[Item] = []
        since = time - _TRAIL * self.speedup
        caption = Label("note", self.width - 28, self.height - 14, self.caption(time), anchor="end")
        if self.beside is not None:
            items = self.beside.items(time, balls, since)
            return self.background.copied().drawn([*items, caption]).pixels.image()
        few = len(balls) <= _TRAILS
        for ball, trail in enumerate(trails if few else []):
            trail.append((time, *balls[ball]))
            while len(trail) > 1 and trail[0][0] < since:
                trail.popleft()
            items.extend(_trail(trail, time, since, steps[ball]))
        for contact in recent[recent["time"] > since]:
            ball = int(contact["ball"])
            opacity = 0.8 * (1 - (time - float(contact["time"])) / (time - since))
            x, y = self.frame.point(float(contact["x"]), float(contact["y"]))
            items.append(Disc("ghost", x, y, float(self.radius[ball]), steps[ball], opacity=opacity))
        for ball, (x, y) in enumerate(balls.tolist()):
            items.append(Disc("ball", x, y, float(self.radius[ball]), steps[ball], filled=True))
        return self.background.copied().drawn([*items, caption]).pixels.image()

    def _steps(self, time: float) -> list[int]:
        """Give each ball its step on the ramp now."""
        count = len(self.run.ending)
        if self.look.colour == "speed":
            part = np.hypot(*self.run.velocity(time).T) / self.fastest
        elif self.look.colour == "time":
            part = np.full(count, time / max(self.duration, 1e-300))
        else:
            part = np.arange(count) / (count - 1) if count > 1 else np.full(count, 0.5)
        steps: list[int] = ramp_steps(part).tolist()
        return steps


def _fastest(run: Run) -> float:
    """The largest speed of any ball at the start and just after its bounces, and at least a little."""
    _, velocity, _ = arrays_of(run.scene.balls)
    after = np.hypot(run.contacts["vx"], run.contacts["vy"])
    return max(float(np.hypot(*velocity.T).max(initial=0.0)), float(after.max(initial=0.0)), 1e-300)


def _trail(points: deque[tuple[float, float, float]], time: float, since: float, step: int) -> list[Shape]:
    """Draw a trail in three parts that fade with age."""
    parts: list[Shape] = []
    places = list(points)
    for part in range(3):
        low = since + (time - since) * part / 3
        high = since + (time - since) * (part + 1) / 3
        inside = [index for index, (t, _, _) in enumerate(places) if low <= t <= high]
        if inside and inside[0] > 0:
            inside.insert(0, inside[0] - 1)
        if len(inside) > 1:
            commands: list[Command] = [("M" if i == inside[0] else "L", *places[i][1:]) for i in inside]
            parts.append(Shape("trail", commands, step=step, opacity=0.25 + 0.25 * part))
    return parts


def _speedup(run: Run, frame: Frame) -> float:
    """Choose how fast time runs, from the speed on the way: each stretch counts with its length, so rest does not."""
    flight = tracks(run, 200_000)
    duration = flight.until - flight.time
    last = flight.velocity + flight.pull * duration[:, None]
    speeds = (np.hypot(*flight.velocity.T) + np.hypot(*last.T)) / 2  # the mean of both ends is near enough
    length = speeds * duration
    total = float(length.sum())
    if not (total > 0 and np.isfinite(total)):
        return 1.0
    speed = float((length * speeds).sum()) / total
    crossing = max(frame.box[2] - frame.box[0], frame.box[3] - frame.box[1]) / speed
    return round_length(crossing / _CROSSING)


def _gif(frames: _Frames) -> bytes:
    every: list[Item] = [
        Disc("ball", 20 * step, 20 * part, 9, step, filled=True, opacity=part / 4)
        for step in range(RAMP_STEPS)
        for part in (1, 2, 3, 4)
    ]
    every += [Disc("apart", 20 * k, 100, 9) for k in range(4)] if frames.beside is not None else []
    colours = frames.background.copied().drawn(every).pixels.image().quantize(128)  # one palette, or the film flickers
    images = (image.quantize(palette=colours, dither=Image.Dither.NONE) for image in frames)
    data = io.BytesIO()
    next(images).save(data, "GIF", save_all=True, append_images=images, duration=1000 // frames.fps, loop=0)
    return data.getvalue()


def _mp4(frames: _Frames) -> bytes:
    program = shutil.which("ffmpeg")
    if program is None:
        raise FilmError(
            "there is no ffmpeg here, which makes MP4 files",
            code="no-ffmpeg",
            fix="install ffmpeg, or write .gif or .html",
        )
    with tempfile.TemporaryDirectory(prefix="wallkit-") as folder:
        target = Path(folder) / "film.mp4"
        size = f"{int(frames.width)}x{int(frames.height)}"
        command = [program, "-v", "error", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", size, "-r", str(frames.fps),
                   "-i", "-", "-an", "-pix_fmt", "yuv420p", "-movflags", "+faststart", str(target)]  # fmt: skip
        with subprocess.Popen(command, stdin=subprocess.PIPE, stderr=subprocess.PIPE) as process:
            assert process.stdin is not None
            with contextlib.suppress(BrokenPipeError):  # it has given up; what it says is below
                for image in frames:
                    process.stdin.write(image.tobytes())
            _, said = process.communicate()
        if process.returncode != 0 or not target.exists():
            last = said.decode("utf-8", "replace").strip().splitlines()[-1:] or ["no reason given"]
            raise FilmError(f"ffmpeg failed: {last[0]}", code="ffmpeg-failed", fix="write .gif or .html instead")
        return target.read_bytes()
