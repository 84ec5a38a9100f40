import csv
import io
import json
import zipfile
from importlib.resources import files

import jsonschema
import numpy as np
import pytest

import wallkit
from wallkit.scene.scene_files import read_scene
from wallkit.simulation import run_files


@pytest.fixture(scope="module")
def run():
    walls = wallkit.Walls.from_polylines([[(0, 0), (10, 0), (10, 7), (0, 7)]], layers=["</script>"])
    balls = wallkit.Balls([[3, 3], [5, 2]], [[1.1, 0.7], [-2.3, 1.9]], [0.5, 0])
    return wallkit.simulate(wallkit.Scene(walls, balls), bounces=25)


def test_csv_reads_back_to_the_same_bits(run):
    text = run_files.to_csv(run)
    assert text.startswith("time,ball,x,y,vx,vy,px,py,nx,ny,wall,edge,kind\n")
    rows = list(csv.DictReader(io.StringIO(text)))
    assert len(rows) == len(run.contacts) == 50
    for name in run.contacts.dtype.names[:-1]:
        again = np.array([float(row[name]) for row in rows]).astype(run.contacts[name].dtype)
        assert again.tobytes() == run.contacts[name].tobytes()
    assert {row["kind"] for row in rows} <= {"edge", "vertex"}


def test_json_has_the_columns_and_its_scene_flies_again_to_the_same_bits(run):
    text = run_files.to_json(run, bounces=25)
    whole = json.loads(text)
    assert (whole["format"], whole["version"]) == ("wallkit-run", 1)
    assert list(whole["contacts"]) == list(run.contacts.dtype.names)
    assert whole["ending"] == ["bounce limit", "bounce limit"]
    read = read_scene(text.encode())
    again = wallkit.simulate(read.scene, read.until, read.bounces)
    assert again.contacts.tobytes() == run.contacts.tobytes()


def test_json_fits_its_schema_with_and_without_a_horizon(run):
    schema = json.loads((files("wallkit.schemas") / "run.schema.json").read_text())
    good = [{"time": 1.5, "bounces": 2, "tolerance": 1e-6}, None]
    for trusted in (None, good):
        jsonschema.validate(json.loads(run_files.to_json(run, trusted)), schema)


def test_npz_needs_no_pickle_and_is_the_same_each_time(run):
    data = run_files.to_npz(run)
    with np.load(io.BytesIO(data), allow_pickle=False) as arrays:
        assert list(arrays) == list(run.contacts.dtype.names)
        for name in arrays:
            assert arrays[name].tobytes() == np.ascontiguousarray(run.contacts[name]).tobytes()
    assert data == run_files.to_npz(run)
    assert {info.date_time for info in zipfile.ZipFile(io.BytesIO(data)).infolist()} == {(1980, 1, 1, 0, 0, 0)}


def test_a_run_is_saved_and_loaded_with_every_bit(run, tmp_path):
    full = wallkit.Scene(
        run.scene.walls, run.scene.balls, gravity=(0.1, -9.81), sensors=wallkit.Walls.from_polylines([[(0, 4), (9, 4)]])
    )
    for each in (run, wallkit.simulate(full, until=3.0), wallkit.simulate(wallkit.Scene(full.walls), until=1.0)):
        each.save(tmp_path / "run.json")
        with (tmp_path / "run.json").open("rb") as binary, (tmp_path / "run.json").open(encoding="utf-8") as text:
            loaded = [wallkit.Run.load(source) for source in (tmp_path / "run.json", binary, text)]
        for again in loaded:
            assert again.contacts.tobytes() == each.contacts.tobytes()
            assert again.contacts.dtype == each.contacts.dtype
            assert again.final.tobytes() == each.final.tobytes()
            assert again.ending == each.ending
            assert again.scene.walls == each.scene.walls
            assert again.scene.gravity == each.scene.gravity
            assert again.position(0.7).tobytes() == each.position(0.7).tobytes()


def test_a_scene_is_saved_and_loaded_with_every_bit(run, tmp_path):
    scene = wallkit.Scene(run.scene.walls, run.scene.balls, drag=0.1, sensors=run.scene.walls)
    scene.save(tmp_path / "scene.json")
    again = wallkit.Scene.load(tmp_path / "scene.json")
    assert (again.walls, again.sensors, again.drag) == (scene.walls, scene.sensors, scene.drag)
    for name in ("position", "velocity", "radius"):
        assert getattr(again.balls, name).tobytes() == getattr(scene.balls, name).tobytes()


@pytest.mark.parametrize(
    "spoil",
    [
        lambda whole: whole.update(format="wallkit-walls"),
        lambda whole: whole.pop("contacts"),
        lambda whole: whole["contacts"].pop("vx"),
        lambda whole: whole["contacts"].update(kind=["bounce"] * 50),
        lambda whole: whole["contacts"].update(ball=[2] * 50),
        lambda whole: whole["contacts"].update(x=[1.0]),
        lambda whole: whole["contacts"].update(x=["a"] * 50),
        lambda whole: whole.update(ending=["bounce limit"]),
        lambda whole: whole.update(final=5),
        lambda whole: whole["scene"].update(gravity="down"),
    ],
)
def test_what_is_no_run_is_an_error(run, spoil):
    whole = json.loads(run_files.to_json(run))
    spoil(whole)
    with pytest.raises(wallkit.WallkitError):
        wallkit.Run.load(io.BytesIO(json.dumps(whole).encode()))


@pytest.mark.parametrize("data", [b"", b"[]", b"5", b"{", b"\xff\xfe", b"[" * 100_000])
def test_what_is_not_even_json_is_an_error(data):
    with pytest.raises(wallkit.WallkitError, match="no run"):
        wallkit.Run.load(io.BytesIO(data))
