"""Formats of other packages: the example in example_package is found by its entry points, writes and reads."""

from __future__ import annotations

import importlib
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest
from levels import three_walls

import wallkit
from wallkit.export import ExportError, formats

EXAMPLE = Path(__file__).parent / "example_package"


def install(folder, monkeypatch, name, groups):
    """Put a package on the path as pip would: a dist-info with its entry points."""
    info = folder / f"{name}-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n")
    lines = [f"[{group}]\n" + "".join(f"{k} = {v}\n" for k, v in points.items()) for group, points in groups.items()]
    (info / "entry_points.txt").write_text("\n".join(lines))
    monkeypatch.syspath_prepend(str(folder))
    importlib.invalidate_caches()


@pytest.fixture
def dots(tmp_path, monkeypatch):
    project = tomllib.loads((EXAMPLE / "pyproject.toml").read_text())["project"]
    monkeypatch.syspath_prepend(str(EXAMPLE))
    install(tmp_path, monkeypatch, "wallkit_dots", project["entry-points"])


@pytest.mark.usefixtures("dots")
def test_the_example_writes_walls_and_reads_them_back(tmp_path):
    walls = three_walls(names=["", "pin", ""])
    problems = walls.export(tmp_path / "level.dots")
    assert [(problem.code, problem.name) for problem in problems] == [("export-names", "pin")]
    assert formats()["dots"].title == "wallkit_dots"
    again = wallkit.import_walls(tmp_path / "level.dots")
    assert np.array_equal(again.vertices, walls.vertices)
    assert again.closed.tolist() == [True, True, False]
    assert again.source_file == str(tmp_path / "level.dots")


def test_without_the_package_neither_is_known(tmp_path):
    with pytest.raises(ExportError):
        three_walls().export(tmp_path / "level.dots")
    (tmp_path / "level.dots").write_text("dots closed 0,0 1,0 1,1\n")
    with pytest.raises(wallkit.DrawingError) as caught:
        wallkit.read_drawing(tmp_path / "level.dots")
    assert caught.value.code == "not-a-drawing"


@pytest.mark.usefixtures("dots")
def test_what_no_reader_knows_is_still_no_drawing(tmp_path):
    (tmp_path / "notes.txt").write_text("dear diary")
    with pytest.raises(wallkit.DrawingError) as caught:
        wallkit.read_drawing(tmp_path / "notes.txt")
    assert caught.value.code == "not-a-drawing"


@pytest.mark.parametrize(
    ("body", "words"),
    [
        ("def both(*arguments):\n    raise KeyError('x')\n", "failed: KeyError"),
        ("def both(*arguments):\n    return 7\n", "failed: TypeError|returned int"),
        ("", "both"),
    ],
)
def test_a_package_that_fails_is_named(body, words, tmp_path, monkeypatch):
    (tmp_path / "broken_formats.py").write_text(body)
    groups = {"wallkit.exporters": {"broken": "broken_formats:both"}}
    groups["wallkit.importers"] = {"broken": "broken_formats:both"}
    install(tmp_path, monkeypatch, "broken_package", groups)
    monkeypatch.delitem(sys.modules, "broken_formats", raising=False)
    with pytest.raises(ExportError, match=words) as caught:
        three_walls().export(tmp_path / "level.broken")
    assert caught.value.code == "bad-exporter"
    assert "broken_package" in str(caught.value)
    (tmp_path / "level.broken").write_text("what is it?")
    with pytest.raises(wallkit.DrawingError, match=words) as caught:
        wallkit.read_drawing(tmp_path / "level.broken")
    assert caught.value.code == "bad-importer"
    assert "broken_package" in str(caught.value)


@pytest.mark.usefixtures("dots")
def test_a_name_of_ours_stays_ours(tmp_path, monkeypatch):
    (tmp_path / "other").mkdir()
    install(tmp_path / "other", monkeypatch, "rival", {"wallkit.exporters": {"tmj": "wallkit_dots:write"}})
    assert formats()["tmj"].entry_point is None
