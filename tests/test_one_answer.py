"""One level, one answer: whichever door a drawing comes through, walls, balls, room and bits are the same.

Doors: the library (`wallkit.open_scene`), a scene file that only names the drawing, `wallkit check`, the page, and
`import_walls`, which places no ball and so knows less of a drawing without any.
"""

import json
import math
from pathlib import Path

import numpy as np
import pytest

import wallkit
from wallkit.cli.play import reader
from wallkit.scene.wishes import USUAL
from wallkit.view.page.answers import Answers
from wallkit.view.page.questions import Opening
from wallkit.walls.checking.free_space import free_space
from wallkit.walls.walls_json import to_json

HERE = Path(__file__).parent
LEVELS = HERE / "levels"
SAMPLES = HERE.parent / "samples"
DRAWINGS = sorted([*LEVELS.glob("*.svg"), *(p for p in SAMPLES.iterdir() if p.suffix in (".svg", ".ai", ".txt"))])


def bits(scene):
    """Every number of walls and balls, and the room."""
    walls, balls = scene.walls, scene.balls
    arrays = (walls.vertices, walls.bulges, walls.offsets, walls.closed, walls.depth, *(
        np.asarray(getattr(balls, name)) for name in ("position", "velocity", "radius")))  # fmt: skip
    return [array.tobytes() for array in arrays], walls.sides, walls.names, walls.layers, walls.solid


@pytest.mark.parametrize("file", DRAWINGS, ids=lambda file: file.name)
def test_a_drawing_is_the_same_level_through_every_door(file, tmp_path, said):
    opened = wallkit.open_scene(file)
    mine = bits(opened.scene)
    assert bits(wallkit.open_scene(wallkit.read_drawing(file)).scene) == mine

    (tmp_path / file.name).write_bytes(file.read_bytes())
    (tmp_path / "level.toml").write_text(f'drawing = "{file.name}"\n')
    named = wallkit.open_scene(tmp_path / "level.toml")
    assert bits(named.scene) == mine
    assert named.assumed == opened.assumed
    assert [(p.code, p.x, p.y) for p in named.problems] == [(p.code, p.x, p.y) for p in opened.problems]

    answers = Answers(reader())
    document = answers.open(Opening(file.read_bytes(), file.name, None, USUAL))
    table = answers.document_table(document)
    assert bits(document.opened.scene) == mine
    assert table["balls"][0]["vx"] == np.asarray(opened.scene.balls.velocity)[0, 0]
    assert [(p["code"], p["x"], p["y"]) for p in table["problems"]] == [(p.code, p.x, p.y) for p in opened.problems]

    answer = json.loads(said("check", file, "--json")[1])
    assert answer["solid"] == opened.scene.walls.solid.to_json()
    found = {(p["code"], p["x"], p["y"]) for p in answer["problems"]}
    assert found >= {(p.code, p.x, p.y) for p in opened.problems}


@pytest.mark.parametrize("file", DRAWINGS, ids=lambda file: file.name)
def test_import_knows_the_same_walls_unless_only_the_place_of_a_ball_tells(file):
    walls = wallkit.import_walls(file, curves="arcs")
    opened = wallkit.open_scene(file).scene.walls
    assert opened == walls or opened.solid.how == "start"


def test_the_samples_are_rooms_and_solids_as_one_who_knows_them_says():
    rooms = {name: wallkit.open_scene(SAMPLES / name).scene.walls.solid.room for name in
             ("mushroom.svg", "sinai.svg", "stadium.svg", "pinball.svg", "room.svg", "lagoon.ai")}  # fmt: skip
    assert rooms == {"mushroom.svg": True, "sinai.svg": True, "stadium.svg": True,
                     "pinball.svg": False, "room.svg": False, "lagoon.ai": False}  # fmt: skip


@pytest.mark.parametrize("wishes", [wallkit.Wishes(), wallkit.Wishes(balls=200)], ids=["one ball", "many"])
def test_balls_without_a_place_start_between_a_frame_and_its_pillars_not_in_them(wishes):
    opened = wallkit.open_scene(LEVELS / "frame-and-pillars.svg", wishes)
    x, y = np.asarray(opened.scene.balls.position).T
    radius = opened.scene.balls.radius
    assert (np.minimum(np.minimum(x - 10, 390 - x), np.minimum(y - 10, 290 - y)) >= radius).all()
    for centre, pillar in ((120, 40), (300, 60)):
        assert (np.hypot(x - centre, y - 150) >= pillar - 0.1 + radius).all()  # arcs are within 0.1
    assert (opened.scene.walls.solid.room, opened.scene.walls.solid.how) == (True, "start")


@pytest.mark.parametrize("name", ["ball-in-a-group.svg", "ball-on-a-layer.svg"])
def test_a_circle_in_a_group_called_balls_is_a_ball_and_no_wall(name):
    scene = wallkit.open_scene(LEVELS / name).scene
    assert (len(scene.walls), len(scene.balls)) == (1, 1)
    first = wallkit.simulate(scene, bounces=1).contacts[0]
    # from x = 150 to where a ball of radius 10 meets x = 290, at 50 cos 30 degrees; y moves 75 of the 80 there are
    assert first["time"] == pytest.approx(130 / (50 * math.cos(math.radians(30))), rel=1e-14)


def test_asking_for_the_layer_of_balls_makes_no_walls_of_them():
    walls = wallkit.import_walls(LEVELS / "ball-on-a-layer.svg", layers=["balls"])
    assert len(walls) == 0
    assert "left-out-balls" in [problem.code for problem in walls.problems]


def test_a_tag_says_what_a_path_is(tmp_path):
    (tmp_path / "tagged.svg").write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" width="90" height="90"><rect width="80" height="60" fill="#eee"/>'
        '<circle cx="20" cy="30" r="4" data-role="ball"/>'
        '<g id="balls"><circle cx="60" cy="30" r="9" data-role="wall"/></g></svg>'
    )
    scene = wallkit.open_scene(tmp_path / "tagged.svg").scene
    assert np.asarray(scene.balls.position) == pytest.approx(np.array([[20, 30]]))
    assert len(scene.walls) == 2


def test_a_room_that_is_solid_from_outside_alone_keeps_its_ball_in_a_scene_file_too(said):
    opened = wallkit.open_scene(LEVELS / "block-in-a-room-outward.toml")
    run = wallkit.simulate(opened.scene, opened.until, opened.bounces)
    assert len(run.contacts) == 25
    drawn = wallkit.open_scene(
        LEVELS / "block-in-a-room.svg", wallkit.Wishes(importing=wallkit.ImportOptions(curves="arcs", sides="outward"))
    )
    assert wallkit.simulate(drawn.scene, bounces=25).contacts.tobytes() == run.contacts.tobytes()


def test_a_ball_without_a_velocity_flies_alike_from_drawing_and_scene_file(tmp_path):
    (tmp_path / "still.svg").write_bytes((LEVELS / "still.svg").read_bytes())
    (tmp_path / "still.toml").write_text('drawing = "still.svg"\n')
    for file in (tmp_path / "still.svg", tmp_path / "still.toml"):
        velocity = np.asarray(wallkit.open_scene(file).scene.balls.velocity)
        assert velocity == pytest.approx(np.array([[50 * math.sqrt(0.75), 25]]), rel=1e-15)


def test_a_stroked_outline_around_filled_shapes_is_a_room():
    walls = wallkit.open_scene(LEVELS / "caverns.svg").scene.walls
    assert (walls.solid.room, walls.solid.how) == (True, "paint")
    assert walls.depth.tolist() == [1, 2]
    import shapely

    cave, rock = (shapely.Polygon(wall.vertices) for wall in wallkit.import_walls(LEVELS / "caverns.svg"))
    free = shapely.difference(cave, rock)
    largest = shapely.length(shapely.maximum_inscribed_circle(free, tolerance=0.01))
    space = free_space(walls)
    # circles of free_space are local optima to 1e-5; the walls are within their tolerance of the lines judged here
    assert max(r for _, _, r in space.closed_rooms.tolist()) == pytest.approx(largest, abs=0.15)


def test_filled_ground_is_solid_the_air_is_free_and_a_ring_around_a_ball_is_a_marker():
    opened = wallkit.open_scene(LEVELS / "platforms.svg")
    walls = opened.scene.walls
    assert (walls.solid.room, walls.solid.how) == (False, "paint")
    assert "start" not in walls.names
    marker = next(problem for problem in opened.problems if problem.code == "left-out-marker")
    assert (marker.name, marker.severity) == ("start", "info")
    assert not [problem for problem in opened.problems if problem.code in ("ball-in-material", "shut-in")]
    contacts = wallkit.simulate(opened.scene, bounces=30).contacts
    assert len(contacts) == 30  # the ring kept nothing in, and nothing left through the joints


def test_a_ring_is_a_wall_where_it_is_all_that_there_is(tmp_path):
    (tmp_path / "ring.svg").write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" width="90" height="90"><circle cx="40" cy="40" r="18" fill="none" '
        'stroke="black"/><g id="balls"><circle cx="40" cy="40" r="10"/></g></svg>'
    )
    assert len(wallkit.import_walls(tmp_path / "ring.svg")) == 1


@pytest.mark.parametrize(
    ("name", "code", "place"),
    [
        ("ball-in-a-block.svg", "ball-in-material", (260, 150)),
        ("vault.svg", "shut-in", (110, 200)),
        ("box-beside-lines.svg", "ball-in-material", (295, 205)),
    ],
)
def test_a_ball_in_material_or_shut_in_is_a_finding_with_its_place_everywhere(name, code, place, said):
    opened = wallkit.open_scene(LEVELS / name)
    assert not opened.scene.walls.solid.room
    about = [problem for problem in opened.problems if problem.code in ("ball-in-material", "shut-in")]
    assert [(p.code, p.severity, (p.x, p.y)) for p in about] == [(code, "warning", place)]
    _, told, _ = said("simulate", LEVELS / name, "--bounces", 3)
    assert f"at ({place[0]}, {place[1]})" in told
    exit_code, told, _ = said("check", LEVELS / name, "--json")
    assert exit_code == 1
    assert (code, *place) in [(p["code"], p["x"], p["y"]) for p in json.loads(told)["problems"]]


def test_what_paints_nothing_is_no_wall_unless_asked_for_or_nothing_is_painted(tmp_path):
    walls = wallkit.import_walls(LEVELS / "unpainted.svg")
    assert walls.names == ("room",)
    problem = next(problem for problem in walls.problems if problem.code == "left-out-unpainted")
    assert (problem.name, problem.x, problem.y) == ("helper", 50, 60)
    assert problem.message.startswith("1 path ")
    assert wallkit.import_walls(LEVELS / "unpainted.svg", unpainted=True).names == ("room", "helper")
    (tmp_path / "outlines.svg").write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" width="90" height="90" fill="none"><rect width="80" height="60"/>'
        '<g id="balls"><circle cx="20" cy="30" r="4" fill="red"/></g></svg>'
    )
    assert len(wallkit.import_walls(tmp_path / "outlines.svg")) == 1


def test_the_picture_of_walls_says_what_was_assumed():
    from wallkit.view.picture import walls_svg

    for name in ("caverns.svg", "platforms.svg"):
        walls = wallkit.import_walls(LEVELS / name)
        assert f"assumed: {walls.solid.sentence()}".replace("'", "&#x27;")[:60] in walls_svg(walls).replace(
            "'", "&#x27;"
        )


def test_an_option_or_a_key_goes_before_every_guess(tmp_path, said):
    file = LEVELS / "block-in-a-room.svg"
    for words, room in ((["--solid"], False), (["--arena"], True), (["--room", "block"], False)):
        code, out, err = said("import", file, *words)
        assert (code, json.loads(out)["solid"]["room"], json.loads(out)["solid"]["how"]) == (0, room, "asked"), err
    (tmp_path / "a.svg").write_bytes(file.read_bytes())
    (tmp_path / "a.toml").write_text('drawing = "a.svg"\n[import]\nroom = "block"\n')
    assert wallkit.open_scene(tmp_path / "a.toml").scene.walls.depth.tolist() == [0, 1]
    assert said("simulate", tmp_path / "a.toml", "--arena", "--room", "")[0] == 2  # both are said then
    code, _, err = said("import", file, "--room", "hall")
    assert code == 2
    assert "no closed wall has the name 'hall'" in err
    assert "'block'" in err


def test_every_command_takes_the_repairs_that_its_messages_propose(tmp_path, said):
    (tmp_path / "bow.svg").write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" width="200" height="200">'
        '<path d="M20 20 L180 180 L180 20 L20 180 Z" fill="none" stroke="black"/></svg>'
    )
    (tmp_path / "bow.toml").write_text('drawing = "bow.svg"\n')
    said("import", tmp_path / "bow.svg", "-o", tmp_path / "bow.json")
    for file in ("bow.svg", "bow.toml", "bow.json"):
        found = [p["code"] for p in json.loads(said("check", tmp_path / file, "--json")[1])["problems"]]
        assert "self-crossing" in found
        found = [p["code"] for p in json.loads(said("check", tmp_path / file, "--json", "--resolve")[1])["problems"]]
        assert "self-crossing" not in found
        assert "repaired-resolve" in found
        assert said("simulate", tmp_path / file, "--resolve", "--bounces", 5)[0] == 0


@pytest.mark.parametrize(
    ("keys", "told"),
    [
        ({"sides": "outwrd"}, "sides is 'outwrd'"),
        ({"arena": "yes"}, "arena is 'yes'"),
        ({"layers": "solid"}, "layers is 'solid'"),
        ({"curves": "splines"}, "curves is 'splines'"),
        ({"snap": -1}, "snap is -1"),
        ({"tolerance": 0}, "tolerance is 0"),
        ({"scale": "2"}, "scale is '2'"),
        ({"room": 3}, "room is 3"),
        ({"arena": True, "solid": True}, "arena and solid do not go together"),
    ],
)
def test_a_wrong_option_is_an_error_with_its_name_in_the_library_and_in_a_file(keys, told, tmp_path):
    with pytest.raises(wallkit.WallkitError, match=told) as error:
        wallkit.import_walls(SAMPLES / "sinai.svg", **keys)
    assert "give" in error.value.fix
    (tmp_path / "s.svg").write_bytes((SAMPLES / "sinai.svg").read_bytes())
    lines = "\n".join(f"{key} = {json.dumps(value)}" for key, value in keys.items())
    (tmp_path / "s.toml").write_text(f'drawing = "s.svg"\n[import]\n{lines}\n')
    with pytest.raises(wallkit.SceneError, match=f"import.{told}"):
        wallkit.open_scene(tmp_path / "s.toml")


def test_the_schema_of_scenes_and_the_command_line_know_every_option(said):
    from importlib.resources import files

    from wallkit.walls.import_options import as_option, option_names

    schema = json.loads((files("wallkit.schemas") / "scene.schema.json").read_text())
    assert set(schema["properties"]["import"]["properties"]) == set(option_names()) - {"via"}  # who opens it says that
    for command in ("import", "check", "simulate", "play", "report"):
        told = said(command, "--help")[1]
        assert [name for name in option_names() if as_option(name) not in told] == []


def test_walls_given_as_numbers_follow_their_winding():
    room, island = [(0, 0), (0, 300), (400, 300), (400, 0)], [(150, 100), (250, 100), (250, 200), (150, 200)]
    space = free_space(wallkit.Walls.from_polylines([room, island]))
    x, y, _ = max(space.closed_rooms.tolist(), key=lambda found: found[2])
    assert not (150 <= x <= 250 and 100 <= y <= 200)


def test_a_scene_says_which_way_its_own_y_axis_points():
    walls = "[[walls]]\nvertices = [[0, 0], [4, 0], [4, 3]]\n"
    from wallkit.scene.scene_files import read_scene

    assert read_scene(walls.encode()).scene.walls.y_axis == "up"
    assert read_scene(f'y_axis = "down"\n{walls}'.encode()).scene.walls.y_axis == "down"
    with pytest.raises(wallkit.SceneError, match="y_axis: 'left' is not up or down"):
        read_scene(f'y_axis = "left"\n{walls}'.encode())
    with pytest.raises(wallkit.SceneError, match="y_axis: only goes with walls of the scene's own"):
        read_scene(json.dumps({"y_axis": "down", "walls": to_json(wallkit.Walls.from_polylines([]))}).encode())


def test_a_report_knows_the_room_of_four_touching_solids():
    from wallkit.accuracy.contest import _room

    scene = wallkit.open_scene(LEVELS / "four-solids.svg").scene
    low_x, low_y, high_x, high_y = _room(scene).bounds  # wider by a thousandth of the size, 0.4
    assert (low_x, low_y, high_x, high_y) == pytest.approx((19.6, 19.6, 380.4, 280.4), abs=1e-9)
