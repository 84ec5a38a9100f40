"""Balls that meet on the page: the same run as by the library, masses and all."""

import base64

import numpy as np
import pytest

from wallkit import simulate
from wallkit.cli.play import reader
from wallkit.simulation.run import ContactKind
from wallkit.view.page.answers import Answers


def column(packed):
    return np.frombuffer(base64.b64decode(packed["data"]), packed["type"]).tolist()


@pytest.mark.parametrize(("sample", "until"), [("cradle.toml", 3.0), ("break.toml", 0.4)])
def test_the_page_flies_balls_that_meet_as_the_library_does(sample, until, compiled_aside):
    answers = Answers(reader())
    document = answers.sample({"name": sample})
    scene = document.opened.scene
    table = answers.document_table(document)
    body = {"balls": table["balls"], "gravity": table["gravity"], "until": until}
    answer = answers.simulate(body, document)
    while answer.get("partial"):  # the page asks again, too
        compiled_aside()
        answer = answers.simulate(body, document)
    run = simulate(scene, until=until)
    assert np.count_nonzero(run.contacts["kind"] == ContactKind.BALL) > 5
    assert set(column(answer["contacts"]["time"])) == set(run.contacts["time"].tolist())
    assert column(answer["end"]["x"]) == run.final["x"].tolist()


def test_a_mass_that_is_said_comes_back_and_others_are_areas():
    answers = Answers(reader())
    document = answers.sample({"name": "cradle.toml"})
    scene = document.opened.scene
    balls = answers.document_table(document)["balls"]
    areas = np.pi * scene.balls.radius**2
    assert [ball.get("mass", area) for ball, area in zip(balls, areas, strict=True)] == scene.balls.mass.tolist()


def test_a_fan_from_one_place_flies_alone():
    answers = Answers(reader())
    document = answers.sample({"name": "cradle.toml"})
    ball = answers.document_table(document)["balls"][0]
    fan = [{**ball, "vx": 10.0, "vy": float(k)} for k in range(3)]
    answer = answers.simulate({"balls": fan, "alone": True, "bounces": 2}, document)
    assert answer["ending"] == ["bounce limit"] * 3
