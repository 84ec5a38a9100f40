"""Walls as JSON: they read back bit for bit, fit their schema, and a bad file says what is wrong."""

from __future__ import annotations

import io
import json
from importlib.resources import files

import jsonschema
import numpy as np
import pytest
from drawn import circle, drawing, line, path, square
from hypothesis import given, settings
from hypothesis import strategies as st

from wallkit.walls import Material, Walls
from wallkit.walls.importing.pipeline import import_walls
from wallkit.walls.walls import WallsError
from wallkit.walls.walls_json import dumps, loads

number = st.floats(allow_nan=False, allow_infinity=False)


@settings(max_examples=80)
@given(
    st.lists(st.lists(st.tuples(number, number, st.floats(-1, 1)), min_size=2, max_size=6), max_size=4),
    st.text(max_size=5),
    st.booleans(),
)
def test_every_number_and_name_reads_back_bit_for_bit(rows, name, closed):
    arrays = [np.array(row) for row in rows]
    walls = Walls.from_polylines(
        [a[:, :2] for a in arrays],
        closed,
        bulges=[a[:, 2] for a in arrays] if arrays else None,
        names=[name] * len(rows),
        material=Material(0.9, 0.3),
    )
    with np.errstate(over="ignore", invalid="ignore"):
        text = dumps(walls) if np.isfinite(walls.normals).all() else None
    if text is not None:
        assert loads(text) == walls


def test_imported_walls_fit_the_schema_and_reload(tmp_path):
    d = drawing(path(square(0, 0, 9)), path(circle(3, 3, 1), name="pin"), path(line((0, 0), (1, 1))), sha256="0" * 64)
    walls = import_walls(d)
    schema = json.loads((files("wallkit.schemas") / "walls.schema.json").read_text())
    jsonschema.validate(json.loads(dumps(walls)), schema)
    walls.save(tmp_path / "walls.json")
    assert Walls.load(tmp_path / "walls.json") == walls
    assert Walls.load(io.BytesIO((tmp_path / "walls.json").read_bytes())) == walls


def test_different_walls_are_not_equal():
    a = Walls.from_polylines([[(0, 0), (1, 0), (0, 1)]])
    b = Walls.from_polylines([[(0, 0), (1, 0), (0, np.nextafter(1, 2))]])
    assert a != b
    assert a == Walls.from_polylines([[(0, 0), (1, 0), (0, 1)]])


DECIDED = '{"format": "wallkit-walls", "version": 1, "walls": [], "solid": %s}'


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("{", "not JSON"),
        ("[]", "not walls"),
        ('{"format": "wallkit-walls", "version": 2}', "version 2"),
        ('{"format": "wallkit-walls", "version": 1}', "'walls' is missing"),
        ('{"format": "wallkit-walls", "version": 1, "walls": [{"closed": true}]}', "'vertices' is missing"),
        ('{"format": "wallkit-walls", "version": 1, "walls": [{"closed": true, "vertices": [[1]]}]}', "polyline 0"),
        (
            '{"format": "wallkit-walls", "version": 1, "walls": [{"closed": true, "vertices": [[1, 2], [NaN, 0]]}]}',
            "not finite",
        ),
        (DECIDED % '{"room": true, "how": "guessed", "why": "so"}', "solid.how.*guessed.*'asked', 'paint'"),
        (DECIDED % '{"room": "yes", "how": "asked", "why": "so"}', "solid.room.*yes.*True or False"),
        (DECIDED % '{"room": true, "how": "asked", "why": 3}', "solid.why.*3.*a text"),
        (DECIDED % '{"room": true, "how": "asked"}', "'why' is missing"),
    ],
)
def test_bad_files_say_what_is_wrong(text, message):
    with pytest.raises(WallsError, match=message):
        loads(text, "w.json")
