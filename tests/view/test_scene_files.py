import json
import tomllib
from importlib.resources import files

import jsonschema
import numpy as np
import pytest

import wallkit
from importers.errors import LimitError
from wallkit import Balls, Material, Scene, SceneError, Walls
from wallkit.scene.file_kinds import kind_of
from wallkit.scene.scene_files import load_scene, read_scene, scene_to_json
from wallkit.walls.walls_json import dumps

ROOM = """
# a room with a bumper
gravity = [0, -9.81]
[run]
until = 12.5
[[balls]]
position = [5, 5]
velocity = [1.5, 2]
radius = 0.25
[[walls]]
vertices = [[0, 0], [10, 0], [10, 10], [0, 10]]
layer = "room"
[[walls]]
vertices = [[2, 2], [3, 2], [3, 3]]
bulges = [0, 0.5, 0]
layer = "toys"
name = "bumper-left"
[[materials]]
layer = "*"
tangential_restitution = 0.5
[[materials]]
wall = "bumper-*"
restitution = 0.9
"""


def test_a_toml_scene_says_walls_balls_gravity_materials_and_its_end():
    read = read_scene(ROOM.encode())
    scene = read.scene
    assert scene.gravity == (0, -9.81)
    assert (read.until, read.bounces) == (12.5, None)
    assert np.array_equal(scene.balls.position, [[5, 5]])
    assert np.array_equal(scene.balls.radius, [0.25])
    assert scene.walls.materials == (Material(1, 0.5), Material(0.9, 0.5))
    assert scene.walls[1].bulges.tolist() == [0, 0.5, 0]


def test_a_scene_written_as_json_reads_back_to_the_same_bits():
    walls = Walls.from_polylines([[(0.1, 0.2), (1 / 3, 7), (5, 1e-17)]], bulges=[[0, 0.3, -1]])
    scene = Scene(walls, Balls([[1 / 7, 2]], [[np.pi, -0.0]], 0.1), gravity=(0, 1e-300))
    again = read_scene(json.dumps(scene_to_json(scene, until=1.5)).encode())
    assert again.until == 1.5
    assert again.scene.gravity == scene.gravity
    for name in ("position", "velocity", "radius"):
        mine, theirs = np.asarray(getattr(scene.balls, name)), np.asarray(getattr(again.scene.balls, name))
        assert mine.tobytes() == theirs.tobytes()
    assert again.scene.walls.vertices.tobytes() == walls.vertices.tobytes()
    assert again.scene.walls.bulges.tobytes() == walls.bulges.tobytes()


@pytest.fixture
def schema():
    return json.loads((files("wallkit.schemas") / "scene.schema.json").read_text())


def test_scenes_fit_their_schema_and_what_does_not_is_refused_by_both(schema):
    jsonschema.validate(tomllib.loads(ROOM), schema)
    scene = Scene(Walls.from_polylines([[(0, 0), (1, 0), (1, 1)]]), Balls([[1, 2]], [[3, 4]]), gravity=(0, 1))
    jsonschema.validate(scene_to_json(scene, bounces=3), schema)
    polyline = "[[walls]]\nvertices = [[0, 0], [1, 0]]\n"
    for wrong in (
        "frogs = 1",
        "gravity = [1]",
        "[[balls]]\nradius = -1",
        "version = 3",
        "[import]\nsnap = 1",
        "drawing = 'x'",
    ):
        text = f"{wrong}\n{polyline}"
        if wrong != "[import]\nsnap = 1":  # goes only with a drawing, which the schema leaves to the reader
            with pytest.raises(jsonschema.ValidationError):
                jsonschema.validate(tomllib.loads(text), schema)
        with pytest.raises(SceneError):
            read_scene(text.encode())


def test_a_drawing_brings_its_balls_along(tmp_path):
    (tmp_path / "room.svg").write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" width="90" height="90"><rect width="80" height="60"/>'
        '<g id="balls"><circle cx="20" cy="30" r="4"/><path d="M20 30L50 70"/></g></svg>'
    )
    (tmp_path / "scene.toml").write_text('drawing = "room.svg"\n[import]\narena = true\n')
    scene = load_scene(tmp_path / "scene.toml").scene
    assert np.allclose(scene.balls.position, [[20, 30]])
    assert np.allclose(scene.balls.velocity, [[30, 40]])
    assert np.allclose(scene.balls.radius, [4])
    assert len(scene.walls) == 1


def test_walls_in_a_file_of_their_own_are_found_beside_the_scene(tmp_path):
    walls = Walls.from_polylines([[(0, 0), (1, 0), (1, 1)]])
    (tmp_path / "w.json").write_text(dumps(walls))
    (tmp_path / "s.toml").write_text('walls = "w.json"\n')
    assert len(load_scene(tmp_path / "s.toml").scene.walls) == 1


def test_a_scene_from_a_stranger_may_not_name_files():
    with pytest.raises(SceneError, match="may not name other files"):
        read_scene(b'walls = "/etc/passwd"')


def test_everything_wrong_is_said_at_once_each_with_its_key():
    text = """
    gravity = [0]
    frogs = 3
    [[balls]]
    position = [1, "x"]
    radius = -1
    [[walls]]
    vertices = [[0, 0], [1, 1]]
    [[materials]]
    wall = "nobody"
    [[materials]]
    restitution = 20
    """
    with pytest.raises(SceneError) as error:
        read_scene(text.encode(), file="s.toml")
    message = str(error.value)
    said = [
        "frogs: no such key",
        "gravity: [0] is not a pair",
        "balls[0].position[1]: 'x'",
        "balls[0].radius: -1",
        "materials[0]: no wall has the name 'nobody'",
        "materials[1].restitution: 20 is not from 0 to 10",
    ]
    assert [part for part in said if part not in message] == []
    assert message.startswith("s.toml: ")


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ('walls = [\n"', "s:2: "),
        ("a = 1\n b = = 2", "s:2:6: "),
        ('{"format": "wallkit-scene",\n  nonsense}', "s:2:3"),
        ('{"a": NaN}', "NaN"),
    ],
)
def test_bad_toml_and_json_are_named_with_line_and_column(text, place):
    with pytest.raises(SceneError, match=place):
        read_scene(text.encode(), file="s")


def test_a_deeply_nested_file_is_an_error_and_no_crash():
    with pytest.raises(SceneError, match="deeply"):
        read_scene(b'{"a":' + b"[" * 100_000)


def test_a_huge_file_hits_the_limit():
    with pytest.raises(LimitError):
        read_scene(b" " * (64 * 1024 * 1024 + 1))


@pytest.mark.parametrize(
    ("text", "kind"),
    [
        ("24 803 m\n69 828 l\n", "drawing"),
        ("(Layer 1) Ln\n24 803 m", "drawing"),
        ("%!PS-Adobe-3.0 EPSF-3.0\n[1 2] 0 d", "drawing"),
        ("[3 2] 0 d\n10 10 m", "drawing"),
        ("<svg/>", "drawing"),
        ("%PDF-1.6", "drawing"),
        ("# a scene\n\ngravity = [0, 1]", "scene"),
        ("\ufeff[[walls]]\n", "scene"),
        ('{"format": "wallkit-scene"}', "scene"),
        ('{"format": "wallkit-run", "scene": {"walls": {"format": "wallkit-walls"}}}', "scene"),
        ('{"format": "wallkit-walls", "version": 1}', "walls"),
    ],
)
def test_what_a_file_is_is_told_by_its_content(text, kind):
    assert kind_of(text.encode()) == kind


def test_what_acts_beside_gravity_reads_back(schema):
    walls = Walls.from_polylines([[(0, 0), (9, 0), (9, 9)]])
    goal = Walls.from_polylines([[(1, 1), (2, 1)]], closed=False, names=["goal"])
    for acts in ({"rolling_friction": 0.5}, {"drag": 0.25}, {"sensors": goal}):
        written = scene_to_json(Scene(walls, **acts))
        jsonschema.validate(written, schema)
        again = read_scene(json.dumps(written).encode()).scene
        assert (again.rolling_friction, again.drag) == (acts.get("rolling_friction"), acts.get("drag"))
        assert (again.sensors is None) == ("sensors" not in acts)


def test_walls_become_sensors_by_their_names_and_then_bounce_nothing(schema):
    text = """
    sensors = ["goal*"]
    [[balls]]
    position = [5, 5]
    velocity = [0, -1]
    [[walls]]
    vertices = [[0, 0], [10, 0], [10, 10], [0, 10]]
    [[walls]]
    vertices = [[2, 3], [8, 3]]
    closed = false
    name = "goal-left"
    """
    jsonschema.validate(tomllib.loads(text), schema)
    scene = read_scene(text.encode()).scene
    assert (len(scene.walls), scene.sensors.names) == (1, ("goal-left",))
    run = wallkit.simulate(scene, until=6.0)
    assert run.contacts["time"].tolist() == [2.0, 5.0]
    assert [wallkit.ContactKind(kind).label for kind in run.contacts["kind"]] in (["enter", "edge"], ["exit", "edge"])
    with pytest.raises(SceneError, match="no wall has a name or layer like 'gaol'"):
        read_scene(text.replace("goal*", "gaol").encode())


@pytest.mark.parametrize(("axis", "pull"), [("up", (0.0, -9.81)), ("down", (0.0, 9.81))])
def test_gravity_as_one_number_pulls_down_on_the_screen(tmp_path, axis, pull):
    text = f"""gravity = 9.81
y_axis = "{axis}"
walls = [{{ vertices = [[0, 0], [0, 5], [5, 5], [5, 0]] }}]
[[balls]]
position = [2, 2]
"""
    (tmp_path / "scene.toml").write_text(text)
    assert wallkit.open_scene(tmp_path / "scene.toml").scene.gravity == pull
    half = wallkit.open_scene(tmp_path / "scene.toml", wallkit.Wishes(gravity=1.62)).scene
    assert half.gravity == (0.0, np.copysign(1.62, pull[1]))
