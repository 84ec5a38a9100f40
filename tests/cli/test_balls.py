"""`wallkit survey` and `wallkit check --balls` as a stranger uses them."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from importlib import resources

import jsonschema
import numpy as np
import pytest

import wallkit as library

LEVEL = """<svg xmlns="http://www.w3.org/2000/svg" width="200" height="120">
<rect id="room" fill="none" stroke="black" width="200" height="120"/>
<circle id="hole" data-target="goal" cx="160" cy="60" r="20" fill="none" stroke="green"/>
<circle id="tee" data-spawn="tee" cx="30" cy="60" r="3"/></svg>"""


def wallkit(*arguments, folder):
    return subprocess.run(
        [sys.executable, "-m", "wallkit", *map(str, arguments)],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=300,
        env=os.environ | {"NO_COLOR": "1", "PYTHONPATH": os.pathsep.join(sys.path)},
    )


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "level.svg").write_text(LEVEL)
    return tmp_path


def validated(text, name):
    value = json.loads(text)
    schema = json.loads((resources.files("wallkit.schemas") / f"{name}.schema.json").read_text("utf-8"))
    jsonschema.validate(value, schema)
    return value


def test_a_survey_writes_counts_and_goes_on_from_its_checkpoint(folder):
    (folder / "room.svg").write_text('<svg xmlns="http://www.w3.org/2000/svg"><rect width="200" height="120"/></svg>')
    asked = ["survey", "room.svg", "--radius", 0, "--bounces", 10, "--checkpoint", "part.json"]
    first = wallkit(*asked, "--balls", 200, folder=folder)
    assert (first.returncode, first.stderr) == (0, "")
    assert "bounces  2,000 in" in first.stdout
    more = wallkit(*asked, "--balls", "4e2", "-o", "totals.npz", "--json", folder=folder)
    assert more.returncode == 0
    told = validated(more.stdout, "survey")
    counts = library.Counts.load(folder / "totals.npz")
    assert (told["balls"], told["digest"]) == (400, counts.digest())
    with np.load(folder / "totals.npz") as archive:
        assert archive["edge_hits"].sum() == 4000


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["survey", "level.svg", "--balls", "1.5"], "--balls is 1.5"),
        (["survey", "level.svg", "--balls", "many"], "--balls is 'many'"),
        (["survey", "level.svg", "--balls", "9", "-o", "totals.csv"], "give a name that ends on .npz"),
        (["survey", "level.svg", "--balls", "9", "--executor", "cluster"], "executor is 'cluster'"),
        (["survey", "level.svg", "--balls", "9", "--from", "cup"], "there is no place called 'cup'"),
        (["check", "level.svg", "--to", "goal"], "--to: only with --balls"),
        (["check", "level.svg", "--balls", "9", "--to", "cup"], "there is no target 'cup'"),
        (["check", "level.svg", "--balls", "9", "-o", "report.pdf"], "give a name that ends on .html"),
    ],
    ids=lambda value: value[-1] if isinstance(value, list) else "",
)
def test_what_cannot_be_is_said_with_what_to_do(arguments, words, folder):
    result = wallkit(*arguments, folder=folder)
    assert result.returncode == 2
    assert words in result.stderr
    assert "Traceback" not in result.stderr


def test_a_check_with_balls_tells_who_comes_to_the_target(folder):
    asked = ["check", "level.svg", "--balls", 60, "--from", "tee", "--to", "goal", "--bounces", 60]
    result = wallkit(*asked, "--json", "-o", "report.html", folder=folder)
    assert result.returncode == 0, result.stderr
    told = validated(result.stdout, "check")["balls"]
    reached = told["fates"]["reached"]
    assert reached["balls"] + told["fates"]["slow"]["balls"] == 60
    assert reached["low"] < reached["share"] <= reached["high"]
    assert told["target"] == "goal"
    assert len(told["edge_hits"]) == 4
    page = (folder / "report.html").read_text()
    assert "of 60 balls" in page
    assert page.count("<svg") == 1


def test_a_target_that_is_walled_in_is_a_finding_that_ends_with_1(folder):
    post = '<rect fill="#888" x="120" y="20" width="80" height="80"/><circle data-target="goal"'
    (folder / "shut.svg").write_text(LEVEL.replace('<circle id="hole" data-target="goal"', post))
    asked = ["--balls", 20, "--from", "tee", "--to", "goal", "--bounces", 20]
    result = wallkit("check", "shut.svg", *asked, folder=folder)
    assert result.returncode == 1
    assert "warning[target-missed] none of 20 balls reached 'goal': a ball's chance is below 0.1391" in result.stdout
