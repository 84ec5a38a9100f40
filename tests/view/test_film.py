import io
import shutil
import subprocess
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

import wallkit
from wallkit.view import film as films
from wallkit.view.theme import ramp


@pytest.fixture(scope="module")
def run():
    walls = wallkit.Walls.from_polylines([[(0, 0), (100, 0), (100, 70), (0, 70)]])
    balls = wallkit.Balls([[30, 30]], [[31, 17]], 6)
    return wallkit.simulate(wallkit.Scene(walls, balls), until=4.0)


def test_each_frame_of_a_gif_shows_the_ball_where_the_run_says(run):
    image = Image.open(io.BytesIO(films.film(run, "gif", seconds=1.0)))
    assert image.n_frames == 26
    assert image.info["duration"] == 40
    frames = films._Frames(run, 25, 1.0, "light", None)
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
    frames, blind = (films._Frames(each, 25, 1.0, "light", None) for each in (seeing, run))
    shown, plain = (
        np.asarray(each.background.copied().reduced().convert("RGB")).astype(int) for each in (frames, blind)
    )
    rows, columns = np.nonzero(np.abs(shown - plain).max(axis=2))
    (x, top), (_, bottom) = frames.frame.points(np.array([(60.0, 60.0), (60.0, 10.0)]))
    assert len(rows) > 0.4 * (bottom - top)  # dashed: a little more than half of it is there
    assert np.abs(columns + 0.5 - x).max() <= 1.5  # a line as wide as a pixel, smoothed
    assert top - 1 <= rows.min() <= rows.max() <= bottom + 1


def test_the_caption_says_how_fast_and_how_much(run):
    frames = films._Frames(run, 25, 0.5, "light", None)
    assert frames.speedup == 1.0
    assert frames.caption(0.25) == "0.25 s, first 0.48 of 4 s"


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
    assert films._Frames(run, 25, 5.0, "light", None).speedup == 1.0
