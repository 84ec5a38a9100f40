"""PostScript programs by way of Ghostscript, through every door."""

from __future__ import annotations

import shutil

import pytest
from typer.testing import CliRunner

from importers.errors import WallkitError
from wallkit import ImportOptions, Wishes, import_walls, open_scene
from wallkit.cli.app import _register_commands, app

needs_ghostscript = pytest.mark.skipif(shutil.which("gs") is None, reason="Ghostscript is not installed")


@needs_ghostscript
def test_every_command_takes_a_program_by_way_of_ghostscript_and_no_scene_file_may_ask_for_it(tmp_path, monkeypatch):
    head = "%!PS-Adobe-3.0 EPSF-3.0\n%%BoundingBox: 0 0 200 100\n"
    program = f"{head}/box {{ rectfill }} def\n10 20 30 40 box showpage\n"
    (tmp_path / "a.eps").write_text(program)
    (tmp_path / "a.svg").write_text('<svg xmlns="http://www.w3.org/2000/svg"><path d="M1 1L9 1L9 9z"/></svg>')
    (tmp_path / "a.toml").write_text('drawing = "a.svg"\n[import]\nvia = "ghostscript"\n')
    (tmp_path / "b.toml").write_text('drawing = "a.eps"\n')
    asked = ImportOptions(via="ghostscript")
    for file in ("a.eps", "b.toml"):
        walls = open_scene(tmp_path / file, Wishes(importing=asked, ball=((1, 1),))).scene.walls
        assert sorted(walls.vertices.tolist()) == [[10, 20], [10, 60], [40, 20], [40, 60]]
    assert len(import_walls(tmp_path / "a.eps", via="ghostscript")) == 1
    with pytest.raises(WallkitError, match=r"import\.via: no such key"):
        open_scene(tmp_path / "a.toml")
    monkeypatch.chdir(tmp_path)
    _register_commands()
    for command in (["import", "-o", "w.json"], ["check"], ["simulate"], ["export", "-o", "l.tmj"], ["inspect"]):
        done = CliRunner().invoke(app, [command[0], "a.eps", "--via", "ghostscript", *command[1:]])
        assert done.exit_code in (0, 1), done.output
        assert "1 wall" in done.output or command[0] == "inspect"
        assert done.exception is None or isinstance(done.exception, SystemExit)
    with pytest.raises(WallkitError, match="via is 'acrobat'"):
        ImportOptions(via="acrobat")
