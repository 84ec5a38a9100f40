"""The extensions for Inkscape: run by their own script, and by Inkscape itself on a screen that nobody sees."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
from lxml import etree
from typer.testing import CliRunner

import wallkit
from wallkit.cli.app import _register_commands, app
from wallkit.cli.inkscape import HERE, SCRIPT, extensions_folder, install_into
from wallkit.export import formats

ROOM = Path(__file__).parents[2] / "samples/room.svg"
USER_UNIT = 240 / 25.4 * 96 / 960  # px: the page is 240 mm and 960 user units wide
SVG = "{http://www.w3.org/2000/svg}"
LABEL = "{http://www.inkscape.org/namespaces/inkscape}label"


@pytest.fixture
def extensions(tmp_path):
    install_into(tmp_path / "extensions")
    return tmp_path / "extensions"


def extension(folder, document, *options):
    """Run the script as Inkscape does: in the folder of the extensions, the document's file last."""
    command = [sys.executable, SCRIPT, *options, str(document)]
    return subprocess.run(command, cwd=folder, capture_output=True, timeout=120)


def changed(folder, document, *options):
    done = extension(folder, document, *options)
    assert done.returncode == 0, done.stderr
    assert done.stderr == b""  # Inkscape would show it in a dialog and wait
    return etree.fromstring(done.stdout)


def layer(root, name):
    (found,) = root.xpath(f"//*[@id='wallkit-layer-{name}']")
    return found


def circles(group):
    """Centres in user units, through the layer's own matrix."""
    a, _, _, d, e, f = map(float, group.get("transform")[7:-1].split(","))
    found = group.iter(f"{SVG}circle")
    return np.array([(a * float(c.get("cx")) + e, d * float(c.get("cy")) + f) for c in found])


def test_check_marks_each_problem_at_its_place_in_the_documents_own_units(extensions):
    group = layer(changed(extensions, ROOM, "--effect=check"), "check")
    walls = wallkit.open_scene(ROOM).scene.walls
    expected = [(p.x, p.y) for p in walls.problems if p.x is not None]
    assert len(expected) > 3
    marks = circles(group) * USER_UNIT
    # A mark is written to a hundredth of a pixel of a picture 960 pixels wide
    assert all(np.abs(marks - place).max(axis=1).min() < 0.02 for place in expected)
    words = [text.text for text in group.iter(f"{SVG}text")]
    assert any(walls.problems[0].message in word for word in words)


def test_shoot_draws_a_ghost_at_every_contact(extensions):
    group = layer(changed(extensions, ROOM, "--effect=shoot", "--bounces=7"), "shot")
    opened = wallkit.open_scene(ROOM)
    run = wallkit.simulate(opened.scene, bounces=7)
    ghosts = circles(group) * USER_UNIT
    for contact in run.contacts:
        assert np.abs(ghosts - (contact["x"], contact["y"])).max(axis=1).min() < 0.02
    assert len(ghosts) == len(run.contacts) + 2  # a start and an end


def test_a_document_that_is_turned_as_a_whole_has_its_marks_where_the_walls_are(extensions, tmp_path):
    head = (
        '<svg xmlns="http://www.w3.org/2000/svg" width="300" height="200" viewBox="0 0 600 400" transform="rotate(90)">'
    )
    path = '<path d="M100 100 h100 v50" fill="none" stroke="black"/></svg>'
    (tmp_path / "a.svg").write_text(head + path)
    root = changed(extensions, tmp_path / "a.svg", "--effect=check")
    a, b, c, d, e, f = map(float, layer(root, "check").get("transform")[7:-1].split(","))
    found = next(layer(root, "check").iter(f"{SVG}circle"))  # an open path, told at its end
    x, y = float(found.get("cx")), float(found.get("cy"))
    assert [a * x + c * y + e, b * x + d * y + f] == pytest.approx([200, 150], abs=0.05)


def test_a_layer_is_replaced_and_makes_no_walls(extensions, tmp_path):
    first = tmp_path / "first.svg"
    first.write_bytes(extension(extensions, ROOM, "--effect=shoot").stdout)
    plain, marked = (wallkit.import_walls(file) for file in (ROOM, first))
    assert np.array_equal(plain.vertices, marked.vertices)
    again = changed(extensions, first, "--effect=shoot", "--aim=true", "--angle=90", "--speed=10")
    assert len(circles(layer(again, "shot"))) == 22


def test_the_rest_of_the_document_stays(extensions, tmp_path):
    text = '<?xml version="1.0"?><!-- mine --><svg xmlns="http://www.w3.org/2000/svg" xmlns:x="urn:x" x:own="1">' \
           '<!-- a --><rect width="9" height="9" x:k="v"/><g/></svg>'  # fmt: skip
    (tmp_path / "a.svg").write_text(text)
    root = changed(extensions, tmp_path / "a.svg", "--effect=check")
    layer(root, "check").getparent().remove(layer(root, "check"))
    assert etree.tostring(root, method="c14n") == etree.tostring(etree.fromstring(text.encode()), method="c14n")


def test_export_writes_the_level_and_leaves_the_document(extensions, tmp_path):
    out = tmp_path / "level.tmj"
    root = changed(extensions, ROOM, "--effect=export", f"--out={out}", "--format=ending")
    assert etree.tostring(root, method="c14n") == etree.tostring(etree.parse(ROOM).getroot(), method="c14n")
    level = json.loads(out.read_text())
    objects = [one for each in level["layers"] for one in each["objects"]]
    assert len(objects) == 16


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--effect=export"], "no file is named"),
        (["--effect=export", "--out=level.xyz"], "does not tell the format"),
        (["--effect=shoot", "--bounces=-1"], "bounces"),
    ],
)
def test_what_cannot_be_done_is_one_sentence_and_no_document(extensions, options, message):
    done = extension(extensions, ROOM, *options)
    assert done.returncode == 1
    assert done.stdout == b""
    assert message in done.stderr.decode()
    assert b"Traceback" not in done.stderr


def test_a_python_that_is_gone_is_named(extensions):
    script = extensions / SCRIPT
    script.write_text(script.read_text().replace(repr(sys.executable), "'/no/python'"))
    assert b"/no/python does not run" in extension(extensions, ROOM, "--effect=check").stderr


def test_the_menu_offers_all_formats_and_no_others():
    menu = etree.parse(HERE / "wallkit_export.inx")
    found = menu.xpath("//*[local-name()='param'][@name='format']/*/@value")
    own = [each.name for each in formats().values() if each.entry_point is None]
    assert sorted(found) == sorted(["ending", *own])


@pytest.mark.parametrize(
    ("system", "variables", "folder"),
    [
        ("linux", {"XDG_CONFIG_HOME": "/c"}, "/c/inkscape/extensions"),
        ("linux", {"INKSCAPE_PROFILE_DIR": "/p"}, "/p/extensions"),
        ("win32", {"APPDATA": "/a"}, "/a/inkscape/extensions"),
        ("darwin", {"HOME": "/h"}, "/h/Library/Application Support/org.inkscape.Inkscape/config/inkscape/extensions"),
    ],
)
def test_the_folder_is_that_of_inkscape_on_each_system(system, variables, folder, monkeypatch):
    for name in ("INKSCAPE_PROFILE_DIR", "XDG_CONFIG_HOME", "APPDATA"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(sys, "platform", system)
    for name, value in variables.items():
        monkeypatch.setenv(name, value)
    assert extensions_folder() == Path(folder)


def test_the_command_says_where_and_what_it_wrote(tmp_path):
    _register_commands()
    told = CliRunner().invoke(app, ["inkscape", "--to", str(tmp_path / "e")])
    assert str(tmp_path / "e") in told.output
    assert not (tmp_path / "e").exists()
    done = CliRunner().invoke(app, ["inkscape", "--install", "--to", str(tmp_path / "e")])
    assert done.exit_code == 0
    assert len(list((tmp_path / "e").iterdir())) == 4
    (tmp_path / "file").touch()
    refused = CliRunner().invoke(app, ["inkscape", "--install", "--to", str(tmp_path / "file" / "e")])
    assert refused.exception.code == "cannot-write"


@contextmanager
def screen():
    """A screen that nobody sees; Inkscape runs extensions only where there is one."""
    for name in ("inkscape", "Xvfb"):
        if not shutil.which(name):
            pytest.skip(f"{name} is not installed")
    reader, writer = os.pipe()
    command = ["Xvfb", "-displayfd", str(writer), "-screen", "0", "800x600x24", "-nolisten", "tcp"]
    with subprocess.Popen(command, pass_fds=[writer], stderr=subprocess.DEVNULL) as server:
        os.close(writer)
        try:
            with os.fdopen(reader) as display:
                yield f":{display.readline().strip()}"
        finally:
            server.terminate()


def inkscape(folder, display, names, document, out):
    """Let Inkscape run extensions on a document, whatever the person who tests has set in an Inkscape of theirs."""
    actions = "".join(f"wallkit.{name}.noprefs;" for name in names)
    command = ["inkscape", "--batch-process", f"--actions={actions}export-filename:{out};export-do", str(document)]
    own = {"DISPLAY": display, "INKSCAPE_PROFILE_DIR": str(folder), "HOME": str(folder)}
    done = subprocess.run(command, env=os.environ | own, capture_output=True, text=True, timeout=120)
    assert out.exists(), done.stderr
    return out


def test_inkscape_itself_runs_all_three(extensions, tmp_path):
    menu, level = extensions / "wallkit_export.inx", tmp_path / "level.tmj"
    menu.write_text(menu.read_text().replace('gui-text="Write to"/>', f'gui-text="Write to">{level}</param>'))
    with screen() as display:  # of several in one go Inkscape 1.2 keeps what the last one gave
        checked = inkscape(tmp_path, display, ["export", "check"], ROOM, tmp_path / "checked.svg")
        shot = inkscape(tmp_path, display, ["shoot"], checked, tmp_path / "shot.svg")
    assert sum(len(each["objects"]) for each in json.loads(level.read_text())["layers"]) == 16
    root = etree.parse(shot).getroot()
    assert [layer(root, name).get(LABEL) for name in ("check", "shot")] == ["wallkit check", "wallkit shot"]
    # Inkscape's own word on where things are, in px: id, x, y, width, height
    told = subprocess.run(["inkscape", "--query-all", shot], capture_output=True, text=True, timeout=60).stdout
    boxes = [line.split(",") for line in told.splitlines()]
    middles = np.array([(float(x) + float(w) / 2, float(y) + float(h) / 2) for _, x, y, w, h in boxes])
    opened = wallkit.open_scene(ROOM)
    contacts = wallkit.simulate(opened.scene, bounces=20).contacts
    places = [*zip(contacts["x"], contacts["y"], strict=True), *((p.x, p.y) for p in opened.problems if p.x)]
    assert all(np.abs(middles - place).max(axis=1).min() < 0.02 for place in places)
