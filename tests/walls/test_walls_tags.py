"""Words of the author, in labels, notes and data: what is read, which of them counts, what they make of a path."""

from __future__ import annotations

import io
import json
import re
import tomllib
from dataclasses import replace
from importlib.resources import files

import jsonschema
import numpy as np
import pytest
from drawn import codes, drawing, line, path, square

import wallkit
from importers.drawing import Level
from wallkit.simulation.run import ContactKind, Ending
from wallkit.walls import Material, Walls
from wallkit.walls.importing.pipeline import import_walls
from wallkit.walls.roles import said_of
from wallkit.walls.tags import read_data, read_label, read_note
from wallkit.walls.walls_json import dumps, loads

INKSCAPE = 'xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" xmlns:xlink="http://www.w3.org/1999/xlink"'


def svg(body):
    text = f'<svg xmlns="http://www.w3.org/2000/svg" {INKSCAPE} viewBox="0 0 400 300">{body}</svg>'
    return wallkit.read_drawing_text(text)


def room(body, around=""):
    """A room of 400 by 300 and what is in it."""
    return svg(in_room(body, around))


def in_room(body, around=""):
    return f'<g id="Level{around}"><rect id="room" width="400" height="300" fill="none" stroke="#000"/>{body}</g>'


@pytest.mark.parametrize(
    ("label", "name", "words"),
    [
        ("ramp", "ramp", {}),
        ("", "", {}),
        ("ramp #one-way", "ramp", {"one-way": ""}),
        ("#one-way", "", {"one-way": ""}),
        ("ramp [restitution=0.8, one-way]", "ramp", {"restitution": "0.8", "one-way": ""}),
        ("[sensor:left] goal", "goal", {"sensor": "left"}),
        ("a [x=1] b #y:2; z", "a b", {"x": "1", "y": "2", "z": ""}),
        ("ramp #One_Way", "ramp", {"one-way": ""}),
        ("ice #tangential-restitution=0.9", "ice", {"tangential_restitution": "0.9"}),
        ("tree #2", "tree #2", {}),  # a number is a number of an object
        ("issue [see 12!]", "issue [see 12!]", {}),
        ("a#", "a#", {}),
        ("[]", "[]", {}),
        ("open [one", "open [one", {}),
        ("Wände #spawn:Öl", "Wände", {"spawn": "Öl"}),
    ],
)
def test_words_stand_in_brackets_or_behind_a_hash_and_all_else_is_the_name(label, name, words):
    assert (read_label(label)[0], dict(read_label(label)[1])) == (name, words)


@pytest.mark.parametrize(
    ("note", "words"),
    [
        ("restitution=0.8 one-way", {"restitution": "0.8", "one-way": ""}),
        ("material=rubber", {"material": "rubber"}),
        ("the door to the garden", {}),
        ("the door, see #12, #sensor", {"sensor": ""}),
        ("", {}),
    ],
)
def test_a_note_is_words_alone_or_prose_with_marked_words(note, words):
    assert dict(read_note(note)) == words


def test_data_say_the_same_as_words():
    said = read_data({"role": "ball", "one_way": "true", "restitution": "0.5", "target": " exit "})
    assert said == {"ball": "", "one-way": "", "restitution": "0.5", "target": "exit"}


# what says it, from the farthest to the nearest, and how each writes the word
SAYERS = ("scene", "layer", "outer", "inner", "object", "clone")


@pytest.mark.parametrize("way", ["label", "data"])
@pytest.mark.parametrize("speaking", [(near, far) for n, near in enumerate(SAYERS) for far in SAYERS[:n]])
def test_the_nearest_word_counts(tmp_path, way, speaking):
    near, far = speaking
    values = {near: 0.25, far: 0.75}

    def said(who):
        if who not in values:
            return f'id="{who}"'
        if way == "label":
            return f'id="{who}" inkscape:label="{who} [restitution={values[who]}]"'
        return f'id="{who}" data-restitution="{values[who]}"'

    body = (
        f'<g inkscape:groupmode="layer" {said("layer")}><g {said("outer")}><g {said("inner")}>'
        f'<rect width="9" height="9" {said("object")}/></g></g></g>'
    )
    if "clone" in values:
        body = f'<defs>{body}</defs><use xlink:href="#layer" {said("clone")}/>'
    (tmp_path / "a.svg").write_text(f'<svg xmlns="http://www.w3.org/2000/svg" {INKSCAPE}>{body}</svg>')
    rule = f"[[materials]]\nrestitution = {values['scene']}" if "scene" in values else ""
    (tmp_path / "a.toml").write_text(f'drawing = "a.svg"\n{rule}\n')
    opened = wallkit.open_scene(tmp_path / "a.toml", wallkit.Wishes(may_be_empty=True))
    assert [m.restitution for m in opened.scene.walls.materials] == [0.25]


def test_a_nearer_role_ends_a_farther_one_and_no_takes_a_word_back():
    layer = Level("layer", "goals #sensor #one-way")
    assert said_of(path(square(0, 0, 1), levels=(layer, Level("object", "a")))).role == "sensor"
    wall = said_of(path(square(0, 0, 1), levels=(layer, Level("object", "a #wall"))))
    assert (wall.role, dict(wall.tags)) == ("wall", {"one-way": ""})
    free = said_of(path(square(0, 0, 1), levels=(layer, Level("object", "a", {"sensor": "no", "one-way": "no"}))))
    assert free.role == "wall"
    plain = Level("object", "", {"role": "wall", "one-way": "no"})
    walls = import_walls(drawing(path(square(0, 0, 1), levels=(layer, plain))))
    assert walls.sides == ("both",)


def test_a_reader_without_levels_has_words_too():
    ice = path(
        square(0, 0, 9), name="floe [tangential_restitution=0.9]", layer="ice #restitution=0.1", groups=("g #x",)
    )
    noted = path(square(20, 0, 9), tags={"note": "restitution=0.5"})
    walls = import_walls(drawing(ice, noted))
    assert walls.materials == (Material(0.1, 0.9), Material(0.5))
    assert (walls.names, walls.layers) == (("floe", ""), ("ice", ""))
    assert walls.origins[0].groups == ("g",)
    assert [(p.code, p.message) for p in walls.problems] == [
        ("unknown-tag", "the word 'x' means nothing here; it is kept in the wall's tags")
    ]


def test_a_clone_has_its_own_label_and_an_original_without_one_its_id():
    body = (
        '<g id="g1" inkscape:label="bumper"><circle id="c1" cx="40" cy="40" r="7"/></g>'
        '<use id="u1" xlink:href="#g1" inkscape:label="second #restitution=0.5" transform="translate(50,20)"/>'
        '<use id="u2" xlink:href="#g1" transform="translate(100,20)"/>'
        '<use id="u3" xlink:href="#u1" transform="translate(200,90)"/>'
        '<use id="u4" xlink:href="#u1" transform="translate(150,90)" inkscape:label="fourth #restitution=0.7"/>'
    )
    walls = import_walls(svg(body))
    assert walls.names == ("c1", "second", "c1", "second", "fourth")
    assert [m.restitution for m in walls.materials] == [1, 0.5, 1, 0.5, 0.7]


def test_an_id_that_inkscape_shows_with_a_hash_is_no_word():
    walls = import_walls(svg('<rect id="rect10" inkscape:label="#rect10" width="9" height="9"/>'))
    assert dict(walls.tags[0]) == {}
    assert codes(walls) == []


def test_unknown_words_are_kept_and_told_once_a_word_with_what_was_meant():
    two = '<rect width="9" height="9"/><rect x="20" width="9" height="9"/>'
    walls = import_walls(svg(f'<g id="a #restituion=0.3 wood">{two}</g>'))
    assert [dict(tags) for tags in walls.tags] == [{"restituion": "0.3", "wood": ""}] * 2
    told = [(p.severity, p.message.split(";")[0], p.fix[:28]) for p in walls.problems if p.code == "unknown-tag"]
    assert told == [
        ("info", "2 times: the word 'restituion' means nothing here", "did you mean restitution?"),
        ("info", "2 times: the word 'wood' means nothing here", "known words are: restitution"),
    ]


@pytest.mark.parametrize(
    "word", ["restitution=much", "restitution=10.5", "restitution=-1", "restitution", "sides=left"]
)
def test_a_value_that_is_none_is_a_warning_and_changes_nothing(word):
    walls = import_walls(drawing(path(square(0, 0, 9), name=f"a #{word}")))
    assert [(p.code, p.severity) for p in walls.problems] == [("bad-tag", "warning")]
    assert (walls.materials, walls.sides) == ((Material(),), ("both",))


THINGS = (
    '<rect id="block" x="200" y="100" width="20" height="20" fill="#f00"/>'
    '<rect inkscape:label="gate #sensor" x="100" y="1" width="4" height="298" fill="none"/>'
    '<circle data-target="exit" cx="300" cy="150" r="20" fill="#0f0"/>'
    '<circle inkscape:label="hero #spawn" cx="50" cy="150" r="5" fill="#0f0"/>'
    '<rect id="legend #ignore" width="9" height="9" fill="#0f0"/>'
)


def test_sensors_targets_and_spawns_are_no_walls_and_act_through_every_door(tmp_path):
    walls = import_walls(room(THINGS))
    assert walls.names == ("room", "block")
    assert [(m.kind, m.name, m.x, m.y, m.radius) for m in walls.markers] == [
        ("target", "exit", 300, 150, 20),
        ("spawn", "hero", 50, 150, pytest.approx(5)),
    ]
    assert walls.sensors.names == ("gate", "exit")
    opened = wallkit.open_scene(room(THINGS))
    assert opened.scene.walls.sensors is None
    assert opened.scene.sensors.names == ("gate", "exit")
    assert opened.scene.balls.position.tolist() == [[50, 150]]
    assert any("at the spawn 'hero'" in words for words in opened.assumed)

    walls.save(tmp_path / "walls.json")
    opened.scene.save(tmp_path / "scene.json")
    (tmp_path / "named.toml").write_text('walls = "walls.json"\n')
    for file in ("walls.json", "scene.json", "named.toml"):
        again = wallkit.open_scene(tmp_path / file).scene
        assert again.sensors.names == ("gate", "exit"), file
        assert again.balls.position.tolist() == [[50, 150]], file


def test_a_scene_file_says_roles_as_a_layer_around_all_and_words_in_the_drawing_go_before_it(tmp_path):
    body = (
        '<g inkscape:groupmode="layer" inkscape:label="doors">'
        '<rect id="gate" x="100" y="1" width="4" height="298" fill="#00f"/>'
        '<rect inkscape:label="shut #wall" x="150" y="1" width="4" height="98" fill="#00f"/></g>'
        '<circle id="hero" cx="50" cy="150" r="5" fill="#00f"/>'
        '<rect id="exit" x="300" y="9" width="9" height="9" fill="#0f0"/>'
    )
    (tmp_path / "level.svg").write_text(f"<svg xmlns='http://www.w3.org/2000/svg' {INKSCAPE}>{in_room(body)}</svg>")
    rules = """
    [colours]
    "#0f0" = { role = "target:out" }
    [[materials]]
    layer = "doors"
    role = "sensor"
    [[materials]]
    wall = "hero"
    role = "spawn"
    """
    (tmp_path / "level.toml").write_text(f'drawing = "level.svg"\n{rules}')
    schema = json.loads(files("wallkit.schemas").joinpath("scene.schema.json").read_text())
    jsonschema.validate(tomllib.loads((tmp_path / "level.toml").read_text()), schema)
    scene = wallkit.open_scene(tmp_path / "level.toml").scene
    assert scene.walls.names == ("room", "shut")
    assert scene.sensors.names == ("gate", "out")
    assert [(m.kind, m.name) for m in scene.walls.markers] == [("spawn", "hero"), ("target", "out")]
    assert scene.balls.position.tolist() == [[50, 150]]


@pytest.mark.parametrize(
    ("drawing", "rule", "told"),
    [
        (True, 'wall = "room"\nrole = "door"', "materials[0].role: 'door' is not"),
        (True, 'wall = "nobody"\nrole = "sensor"', "no wall has the name 'nobody'"),
        (False, 'wall = "*"\nrole = "sensor"', "materials[0].role: only goes with a drawing"),
    ],
)
def test_a_role_that_is_none_or_has_nobody_is_told(tmp_path, drawing, rule, told):
    (tmp_path / "level.svg").write_text(f"<svg xmlns='http://www.w3.org/2000/svg'>{in_room('')}</svg>")
    own = "[[walls]]\nvertices = [[0, 0], [9, 0], [9, 9]]"
    head = 'drawing = "level.svg"' if drawing else own
    (tmp_path / "level.toml").write_text(f"{head}\n[[materials]]\n{rule}\n")
    with pytest.raises(wallkit.WallkitError, match=re.escape(told)):
        wallkit.open_scene(tmp_path / "level.toml")


def test_many_balls_start_at_the_spawns_in_turn_and_smaller_ones_anywhere_in_their_circles():
    two = THINGS + '<circle inkscape:label="#spawn" cx="350" cy="250" r="20" fill="#0f0"/>'
    exact = wallkit.open_scene(room(two), wallkit.Wishes(balls=5)).scene.balls
    assert exact.position.tolist() == [[50, 150], [350, 250], [50, 150], [350, 250], [50, 150]]
    assert exact.radius == pytest.approx([5, 20, 5, 20, 5])
    assert np.hypot(*exact.velocity.T) == pytest.approx(np.full(5, 50.0))
    small = wallkit.open_scene(room(two), wallkit.Wishes(balls=4000, radius=4.0)).scene.balls
    away = np.hypot(*(small.position - [[50, 150], [350, 250]] * 2000).T)
    assert away[0::2].max() <= 1 + 1e-9
    assert away[1::2].max() <= 16 + 1e-9
    # Evenly over a disc of radius R the mean distance is 2 R / 3, its standard error R / sqrt(18 n): six of them
    assert away[1::2].mean() == pytest.approx(32 / 3, abs=6 * 16 / np.sqrt(18 * 2000))


def test_a_ball_that_flies_through_a_gate_and_a_target_is_reported_and_not_bounced():
    run = wallkit.simulate(wallkit.open_scene(room(THINGS), wallkit.Wishes(speed=100, angle=0)).scene, until=3)
    # the centre flies from x = 50 along y = 150, which the block at y < 120 does not reach, to the wall at 395
    told = [(ContactKind(c["kind"]).name, c["x"], c["wall"]) for c in run.contacts]
    assert told == [
        ("ENTER", pytest.approx(100), 0),
        ("EXIT", pytest.approx(104), 0),
        ("ENTER", pytest.approx(280, abs=0.1), 1),  # curves of sensors are as exact as those of walls
        ("EXIT", pytest.approx(320, abs=0.1), 1),
    ]


def test_a_sensor_in_another_is_a_whole_one_and_a_hole_in_one_is_a_hole():
    frame = path(square(0, 0, 50), square(10, 10, 30, clockwise=True), name="frame #sensor")
    inner = path(square(20, 20, 5, clockwise=True), name="inner #sensor")
    sensors = import_walls(drawing(path(square(-99, -99, 500)), frame, inner)).sensors
    assert sensors.depth.tolist() == [0, 1, 0]
    corners = [sensors.vertices[a:b] for a, b in zip(sensors.offsets, sensors.offsets[1:], strict=False)]
    shoelace = [np.sum(p[:, 0] * np.roll(p[:, 1], -1) - p[:, 1] * np.roll(p[:, 0], -1)) / 2 for p in corners]
    assert shoelace == [2500, -900, 25]


def test_a_line_from_left_to_right_stops_what_falls_in_either_axis():
    shelf = path(line((10, 50), (90, 50)), name="shelf #one-way", stroke="#000000", stroke_width=1.0)
    down = drawing(path(square(0, 0, 100), stroke="#000000"), shelf, y_axis="down", units="px")
    for options, gravity, above in (({}, 100.0, 30.0), ({"flip_y": True}, -100.0, -30.0)):
        walls = import_walls(down, **options)
        scene = wallkit.Scene(walls, wallkit.Balls([[50, above]], [[0, 0]], 1.0), gravity=(0, gravity))
        first = wallkit.simulate(scene, bounces=1).contacts[0]
        assert walls.names[first["wall"]] == "shelf #one-way"[:5]
        under = replace(scene, balls=wallkit.Balls([[50, 2.5 * above]], [[0, -np.sign(gravity) * 200]], 1.0))
        assert walls.names[wallkit.simulate(under, bounces=1).contacts[0]["wall"]] == ""


def test_tags_groups_colours_and_titles_are_in_the_file_and_read_back():
    titled = '<rect width="9" height="9" x="50" y="50" fill="#0a0"><title>A box</title></rect>'
    walls = import_walls(room(f'<g id="box #wood">{titled}</g>{THINGS}'))
    text = dumps(walls)
    schema = json.loads(files("wallkit.schemas").joinpath("walls.schema.json").read_text())
    jsonschema.validate(json.loads(text), schema)
    assert loads(text) == walls
    origin = loads(text)[1].origin
    assert (origin.title, origin.groups, origin.fill, dict(origin.tags)) == ("A box", ("box",), "#00aa00", {"wood": ""})
    assert walls.take([1]).origins == (origin,)


@pytest.mark.parametrize("words", ['"tags": {"a": 1}', '"groups": "x"', '"title": 3', '"tags": []'])
def test_a_walls_file_with_tags_that_are_none_is_refused(words):
    entry = f'{{"vertices": [[0, 0], [1, 0], [0, 1]], "closed": true, {words}}}'
    with pytest.raises(wallkit.WallkitError, match="texts"):
        loads(f'{{"format": "wallkit-walls", "version": 1, "walls": [{entry}]}}')


def test_repair_keeps_what_is_known_of_a_wall_and_joins_only_what_is_alike():
    ends = [path(line((0, 0), (10, 0)), name="a #wood"), path(line((10, 0), (10, 9)), name="b #wood"),
            path(line((10, 9), (0, 9)), name="c #one-way")]  # fmt: skip
    walls = import_walls(drawing(*ends), join=True)
    assert sorted((wall.name, wall.sides) for wall in walls) == [("a", "both"), ("c", "outward")]
    assert "wood" in walls.tags[walls.names.index("a")]


def test_colours_and_groups_carry_materials_and_sides_and_tags_go_before_them(tmp_path):
    body = (
        '<g id="layer"><g id="soft"><rect id="a" x="50" y="50" width="9" height="9" fill="#f00"/>'
        '<rect id="b" data-restitution="0.3" data-sides="both" x="90" y="50" width="9" height="9" fill="#f00"/></g>'
        '<rect id="c" x="150" y="50" width="9" height="9" fill="#f00"/></g>'
    )
    outline = '<rect id="room" width="400" height="300" fill="none" stroke="#000"/>'
    (tmp_path / "a.svg").write_text(f'<svg xmlns="http://www.w3.org/2000/svg">{outline}{body}</svg>')
    (tmp_path / "a.toml").write_text(
        'drawing = "a.svg"\n[colours]\n"#F00" = { restitution = 1.2 }\n"#000000" = { tangential_restitution = 0.5 }\n'
        '[[materials]]\ngroup = "so*"\nsides = "outward"\ntangential_restitution = 0.8\n'
    )
    opened = wallkit.open_scene(tmp_path / "a.toml")
    walls = opened.scene.walls
    assert dict(zip(walls.names, zip(walls.materials, walls.sides, strict=True), strict=True)) == {
        "room": (Material(1, 0.5), "both"),
        "a": (Material(1.2, 0.8), "outward"),
        "b": (Material(0.3, 0.8), "both"),
        "c": (Material(1.2, 1), "both"),
    }
    assert "energy-grows" in [p.code for p in opened.problems]
    schema = json.loads(files("wallkit.schemas").joinpath("scene.schema.json").read_text())
    import tomllib

    jsonschema.validate(tomllib.loads((tmp_path / "a.toml").read_text()), schema)


@pytest.mark.parametrize(
    ("rule", "told"),
    [
        ('[colours]\n"#123456" = { restitution = 1 }', "colours.#123456: no wall is painted so"),
        ('[colours]\n"#000000" = { bounce = 1 }', "colours.#000000.bounce: no such key"),
        ('[colours]\n"#000000" = 3', "colours.#000000: not a table"),
        ('[[materials]]\ngroup = "no"\nsides = "both"', "materials[0]: no wall has the name '*' in a group 'no'"),
        ('[[materials]]\nsides = "left"', "materials[0].sides: 'left' is not both or outward"),
    ],
)
def test_a_rule_that_fits_nothing_or_says_nothing_is_told(tmp_path, rule, told):
    (tmp_path / "a.svg").write_text('<svg xmlns="http://www.w3.org/2000/svg"><rect width="9" height="9"/></svg>')
    (tmp_path / "a.toml").write_text(f'drawing = "a.svg"\n{rule}\n')
    with pytest.raises(wallkit.WallkitError) as error:
        wallkit.open_scene(tmp_path / "a.toml")
    assert told in str(error.value)


def box(restitution):
    corners = [(0.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, 0.0)]  # clockwise: a room
    return Walls.from_polylines([corners], material=Material(restitution))


def test_a_bumper_multiplies_the_speed_at_every_bounce():
    scene = wallkit.Scene(box(1.25), wallkit.Balls([[0.5, 0.5]], [[1.0, 0.0]]))
    run = wallkit.simulate(scene, bounces=20)
    speeds = np.abs(run.contacts["vx"])
    # e^k, each of k products and one Newton step rounded: 4 k half ulps at most
    np.testing.assert_allclose(speeds, 1.25 ** np.arange(1, 21), rtol=40 * 2.0**-52)
    times = 0.5 + np.concatenate([[0], np.cumsum(1 / speeds[:-1])])
    np.testing.assert_allclose(run.contacts["time"], times, rtol=1e-13)


def test_endless_bounces_between_bumpers_in_a_finite_time_end_as_a_collapse():
    # the k-th flight takes e^-k: with e = 2 all of them end at 0.5 + 1/2 + 1/4 + ... = 1.5
    scene = wallkit.Scene(box(2.0), wallkit.Balls([[0.5, 0.5]], [[1.0, 0.0]]))
    run = wallkit.simulate(scene, until=1e6)
    assert run.ending == (Ending.COLLAPSE,)
    assert run.final["time"][0] == pytest.approx(1.5, abs=1e-12)
    totals = wallkit.survey(scene, until=1e6)
    assert list(totals.ending) == [Ending.COLLAPSE]


def test_under_gravity_a_bumper_floor_throws_higher_by_e_squared():
    scene = wallkit.Scene(box(1.0), wallkit.Balls([[0.5, 0.5]], [[0.0, 0.0]]), gravity=(0.0, -10.0))
    low = replace(scene, walls=Walls.from_polylines([[(0, 0), (0, 100), (1, 100), (1, 0)]], material=Material(1.2)))
    speeds = wallkit.simulate(low, bounces=4).contacts["vy"]
    # falls from 0.5 with v^2 = 2 g h = 10, and comes back as fast as it was thrown up
    np.testing.assert_allclose(speeds, np.sqrt(10) * 1.2 ** np.arange(1, 5), rtol=1e-13)


def test_the_drawing_is_unchanged_by_what_is_read_of_it():
    one = room(THINGS)
    before = io.StringIO(json.dumps(one.to_json())).read()
    import_walls(one)
    assert json.dumps(one.to_json()) == before
