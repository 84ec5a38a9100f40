"""docs/walkthroughs.md, run as it stands: drawing to Tiled, to Godot, to a game in pymunk; to planck in a page."""

from __future__ import annotations

import json
import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from levels import program, run

ROOT = Path(__file__).parents[2]


@pytest.fixture
def followed(tmp_path):
    """Run the commands of a section in a folder that has the samples and examples."""
    for folder in ("samples", "examples"):
        shutil.copytree(ROOT / folder, tmp_path / folder)

    def follow(section):
        text = (ROOT / "docs" / "walkthroughs.md").read_text()
        part = text.split(f"## {section}\n")[1].split("\n## ")[0]
        said = ""
        for line in "".join(re.findall(r"```sh\n(.*?)```", part, re.S)).splitlines():
            name, *arguments = shlex.split(line)
            command = {"wallkit": [sys.executable, "-m", "wallkit"], "python": [sys.executable]}[name]
            result = subprocess.run(
                [*command, *arguments], cwd=tmp_path, capture_output=True, text=True, timeout=120, env=os.environ
            )
            assert result.returncode == 0, result.stderr
            said += result.stdout
        return said

    return follow


def test_to_tiled(followed, tmp_path):
    pytiled_parser = pytest.importorskip("pytiled_parser")
    followed("To Tiled")
    layers = pytiled_parser.parse_map(tmp_path / "level.tmj").layers
    walls = [one for layer in layers for one in layer.tiled_objects]
    assert len(walls) == 16
    assert {one.class_ for one in walls} == {"wall"}


def test_to_godot(followed, tmp_path):
    followed("To Godot")
    assert (tmp_path / "level.tscn").read_text().startswith("[gd_scene load_steps=")
    godot = program("godot3-server", "godot3")
    (tmp_path / "project.godot").write_text("config_version=4\n")
    (tmp_path / "look.gd").write_text(
        'extends SceneTree\nfunc _init():\n\tvar level = load("res://level.godot3.tscn").instance()\n'
        "\tvar bounces = {}\n\tfor wall in level.get_children():\n"
        "\t\tbounces[wall.name] = wall.physics_material_override.bounce\n"
        '\tprint("RESULT " + to_json(bounces))\n\tquit()\n'
    )
    out = run(
        [godot, "--path", str(tmp_path), "-s", "look.gd"], env={"HOME": str(tmp_path), "PATH": os.environ["PATH"]}
    )
    (line,) = [line for line in out.splitlines() if line.startswith("RESULT ")]
    bounces = json.loads(line.removeprefix("RESULT "))
    assert len(bounces) == 18
    assert bounces["bumper-left"] == 1
    assert bounces["flipper-left"] == 0.5


def test_to_pymunk(followed):
    pytest.importorskip("pymunk")
    said = followed("To pymunk")
    assert "flipper" in said
    x, y = (float(number) for number in re.search(r"the ball is at \((.+), (.+)\)", said).groups())
    assert 0 < x < 440
    assert 0 < y < 780


def test_the_game_is_of_sixty_lines():
    code = (ROOT / "examples" / "pymunk_game.py").read_text().split('"""', 2)[2]
    assert len([line for line in code.splitlines() if line.strip()]) <= 60
