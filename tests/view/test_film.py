import io
import shutil
import subprocess
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

import wallkit
from wallkit.view import film as films
from wallkit.view.theme import RAMP_STEPS, ramp

LOOK = films.Look(width=640, fps=25, pace=None, colour="ball", theme="light")


@pytest.fixture(scope="module")
def run():
    walls = wallkit.Walls.from_polylines([[(0, 0), (100, 0), (100, 70), (0, 70)]])
    balls = wallkit.Balls([[30, 30]], [[31, 17]], 6)
    return wallkit.simulate(wallkit.Scene(walls, balls), until=4.0)


def test_each_frame_of_a_gif_shows_the_ball_where_the_run_says(run):
    image = Image.open(io.BytesIO(films.film(run, "gif", seconds=1.0)))
    assert image.n_frames == 26
    assert image.info["duration"] == 40
    frames = films._Frames(run, LOOK, 1.0, None)
    hue = np.array(list(bytes.fromhex(ramp(16, "light")[1:])))
    for number in (0, 10, 25):
        image.seek(number)
        pixels = np.asarray(image.convert("RGB")).astype(int)
        rows, columns = np.nonzero(np.abs(pixels - hue).max(axis=2) < 12)
        x, y = frames.frame.points(run.position(number / 25 * frames.speedup))[0]
        middle = (columns.min() + columns.max() + 1) / 2, (rows.min() + rows.max() + 1) / 2
        # The trail has the ball's colour too, fainter: the disc's own box decides, to about a pixel.
        assert np.hypot(middle[0] - x, middle[1] - y) < 1.5


def test_a_film_shows_the_sensors_where_they_are(run):
    sensors = wallkit.Walls.from_polylines([[(60.0, 10.0), (60.0, 60.0)]], False)
    seeing = replace(run, scene=replace(run.scene, sensors=sensors))
    frames, blind = (films._Frames(each, LOOK, 1.0, None) for each in (seeing, run))
    shown, plain = (
        np.asarray(each.background.copied().pixels.image().convert("RGB")).astype(int) for each in (frames, blind)
    )
    rows, columns = np.nonzero(np.abs(shown - plain).max(axis=2))
    (x, top), (_, bottom) = frames.frame.points(np.array([(60.0, 60.0), (60.0, 10.0)]))
    assert len(rows) > 0.4 * (bottom - top)  # dashed: a little more than half of it is there
    assert np.abs(columns + 0.5 - x).max() <= 1.5  # a line as wide as a pixel, smoothed
    assert top - 1 <= rows.min() + 0.5 <= rows.max() + 0.5 <= bottom + 1  # middles: half the pen, and half a ramp


def test_the_caption_says_how_fast_and_how_much(run):
    frames = films._Frames(run, LOOK, 0.5, None)
    assert frames.speedup == 1.0
    assert frames.caption(0.25) == "0.25 s, first 0.48 of 4 s"


def test_size_rate_and_pace_are_those_asked_for(run):
    image = Image.open(io.BytesIO(films.film(run, "gif", seconds=9.0, width=320, fps=10, pace=0.5)))
    assert (image.size[0], image.info["duration"], image.n_frames) == (320, 100, 4 / 0.5 * 10 + 1)
    frames = films._Frames(run, films.Look(320, 10, 0.5, "ball", "light"), 9.0, None)
    assert frames.caption(1.5) == "1.50 s (at 0.5 times its speed)"


@pytest.mark.parametrize(("colour", "parts"), [("ball", (0.0, 1.0)), ("speed", (0.5, 1.0)), ("time", (0.25, 0.25))])
def test_the_colour_of_a_ball_tells_which_it_is_its_speed_or_the_time(colour, parts):
    walls = wallkit.Walls.from_polylines([[(0, 0), (100, 0), (100, 70), (0, 70)]])
    scene = wallkit.Scene(walls, wallkit.Balls([[30, 20], [30, 50]], [[10, 0], [20, 0]], 5))
    run = wallkit.simulate(scene, until=4.0)
    look = films.Look(640, 25, 1.0, colour, "light")
    frame = np.asarray(list(films._Frames(run, look, 1.0, None))[25].convert("RGB"))
    balls = films._Frames(run, look, 1.0, None).frame.points(run.position(1.0))
    for (x, y), part in zip(balls, parts, strict=True):
        step = min(int(part * RAMP_STEPS), RAMP_STEPS - 1)
        assert frame[int(y), int(x)].tolist() == list(bytes.fromhex(ramp(step, "light")[1:]))


@pytest.mark.parametrize(
    ("wishes", "words"),
    [({"fps": 30}, "hundredths"), ({"fps": 0}, "fps is 0"), ({"width": 321}, "even"), ({"pace": 0.0}, "pace is 0")],
)
def test_what_no_film_can_be_is_refused(run, wishes, words):
    with pytest.raises(films.FilmError) as refused:
        films.film(run, "gif", **wishes)
    assert words in f"{refused.value} {refused.value.fix}"


def test_progress_ends_at_one(run):
    parts = []
    films.film(run, "gif", seconds=0.2, progress=parts.append)
    assert parts == sorted(parts)
    assert parts[-1] == 1.0


def test_without_ffmpeg_the_error_says_what_to_do(run, monkeypatch):
    monkeypatch.setattr(shutil, "which", lambda name: None)
    with pytest.raises(films.FilmError, match=r"install ffmpeg, or write \.gif"):
        films.film(run, "mp4")


@pytest.mark.skipif(shutil.which("ffmpeg") is None, reason="no ffmpeg here")
def test_an_mp4_has_the_frames_that_were_asked_for(run, tmp_path):
    (tmp_path / "film.mp4").write_bytes(films.film(run, "mp4", seconds=0.5))
    said = subprocess.run(
        ["ffmpeg", "-v", "error", "-i", tmp_path / "film.mp4", "-f", "framecrc", "-"],
        capture_output=True,
        text=True,
        check=True,
    )
    assert len([line for line in said.stdout.splitlines() if not line.startswith("#")]) == 16


def test_a_film_of_a_ball_that_comes_to_rest_is_paced_by_its_flight():
    walls = wallkit.Walls.from_polylines([[(0, 0), (100, 0), (100, 70), (0, 70)]], material=wallkit.Material(0.6, 1))
    scene = wallkit.Scene(walls, wallkit.Balls([[30, 60]], [[10.0, 0]], 2), gravity=(0, -100))
    run = wallkit.simulate(scene, until=20.0)
    # It falls 58 units in 1.08 s and bounces lower and lower: some 50 units a second on the way, so that 100 units in
    # 1.8 s ask for about 1.1 (the median over all bounces, most of them tiny, would ask for far more).
    assert films._Frames(run, LOOK, 5.0, None).speedup == 1.0
