import csv
import io
import json
import zipfile
from importlib.resources import files

import jsonschema
import numpy as np
import pytest

import wallkit
from wallkit import run_files
from wallkit.scene_files import read_scene


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
