"""What the page saves of a run is what the library draws of it, up to the time that is shown."""

import io

import pytest
from PIL import Image

import wallkit
from wallkit.cli.play import reader
from wallkit.scene.wishes import USUAL
from wallkit.view.page.answers import FILM_SECONDS, SAVED, Answers, QuestionError
from wallkit.view.page.questions import Opening
from wallkit.view.page.worlds import CompilingError
from wallkit.view.run_picture import run_svg
from wallkit.view.ways_picture import ways_canvas

ROOM = """<svg xmlns="http://www.w3.org/2000/svg" width="400" height="300">
<path id="room" d="M0 0H400V300H0Z"/>
<path id="gate" data-sensor="gate" d="M300 0V300" fill="none" stroke="black"/>
<g id="balls" data-role="ball"><circle cx="100" cy="100" r="10"/></g></svg>"""
BALL = {"x": 100, "y": 100, "vx": 30, "vy": 40, "radius": 10}
FLOWN = "Wallkit.page.player.motion && !Wallkit.page.flying.busy && !Wallkit.page.player.motion.partial"


@pytest.fixture(scope="module")
def answers():
    return Answers(reader())


@pytest.fixture(scope="module")
def document(answers):
    return answers.open(Opening(ROOM.encode(), "my room.svg", None, USUAL))


@pytest.fixture(scope="module")
def saved(compiled_aside):
    def ask(answers, document, **body):
        while True:
            try:
                return answers.save({"balls": [BALL], "until": 12, **body}, document)
            except CompilingError:  # the page's worker asks again, too
                compiled_aside()

    return ask


@pytest.fixture(scope="module")
def run(document):
    scene = document.opened.scene
    balls = wallkit.Balls([(100.0, 100.0)], [(30.0, 40.0)], 10.0)
    return wallkit.simulate(wallkit.Scene(scene.walls, balls, sensors=scene.sensors), until=12)


def test_a_picture_is_that_of_the_run(answers, document, run, saved):
    download = saved(answers, document, what="picture")
    assert (download.name, download.media) == ("my-room.svg", "image/svg+xml")
    assert download.content == run_svg(run, title="my room.svg")


def test_a_picture_of_a_way_shows_its_frames(answers, document, run, saved):
    download = saved(answers, document, what="picture", way="stop", dt=1)
    own = ways_canvas(run, wallkit.step_through(run.scene, "stop", 1.0, 12.0), title="my room.svg")
    assert download.content == own.to_svg()


@pytest.mark.parametrize("way", [{}, {"way": "overlap", "dt": 0.5}])
def test_a_film_ends_where_the_run_does(answers, document, way, saved):
    download = saved(answers, document, what="film", **way)
    assert (download.name, download.media) == ("my-room.gif", "image/gif")
    image = Image.open(io.BytesIO(download.content))
    assert 1 < image.n_frames <= 25 * FILM_SECONDS + 1


def test_what_cannot_be_saved_is_refused_with_what_can(answers, document):
    with pytest.raises(QuestionError) as refused:
        answers.save({"balls": [BALL], "what": "song"}, document)
    assert all(what in refused.value.fix for what in SAVED)


@pytest.mark.browser
@pytest.mark.parametrize(("what", "begins"), [("picture", b"<svg"), ("film", b"GIF8")])
def test_a_button_saves_what_is_shown(opened, server, drop, until, tmp_path, what, begins):
    page = opened(server.url, accept_downloads=True)
    drop(page, "room.svg", ROOM)
    page.select_option("#way", "stop")
    page.fill("#dt", "1")
    page.click("#shoot")
    until(page, FLOWN)
    page.evaluate("Wallkit.page.player.pause(); Wallkit.page.player.seek(3)")
    with page.expect_download() as download:
        page.click(f"[data-save={what}]")
    target = tmp_path / download.value.suggested_filename
    download.value.save_as(target)
    data = target.read_bytes()
    assert data.startswith(begins)
    if what == "picture":
        assert b"never 1 % of the drawing off the exact path, up to 3 s" in data
