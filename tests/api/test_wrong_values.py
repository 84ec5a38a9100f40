"""Bad values never pass in silence or leave as a bare TypeError: each parameter of each public name is tried."""

import inspect
import math
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

import wallkit
from wallkit import Balls, Material, Scene, WallkitError, Walls, World

ROOT = Path(__file__).parents[2]
SQUARE = [(0.0, 0.0), (0.0, 10.0), (10.0, 10.0), (10.0, 0.0)]
ROOM = Walls.from_polylines([SQUARE])
TWO = Walls.from_polylines([SQUARE, [(2.0, 2.0), (3.0, 2.0)]], [True, False])
DRAW = wallkit.RandomBalls((4.0, 4.0, 6.0, 6.0))
SCENE = Scene(ROOM, Balls([(5.0, 5.0)], [(3.0, 4.0)], 1.0))
RUN = wallkit.simulate(SCENE, until=5.0)
NO_NUMBERS = ("3", None, True, math.nan, math.inf, 1j, [1.0, 2.0])
NO_WHOLE_NUMBERS = ("3", True, 2.5, -1, math.nan, math.inf, [1], 10**30)
NO_FLAGS = ("yes", 1, None)
NO_TEXTS = (5, None, ["a"])
NO_PAIRS = (
    5.0,
    "3",
    ["1", "2"],
    [(1.0, 2.0, 3.0)],
    [(math.nan, 0.0)],
    [(1.0, 2.0), (1.0,)],
    [(True, False)],
    [(1j, 0)],
)
NO_NUMBERS_BUT_NONE = tuple(value for value in NO_NUMBERS if value is not None)
NO_PAGES = (0, -1, 2.5, "first", [1], 10**6)
NO_READERS = ("inkscape", 5)
NO_TIMES = tuple(value for value in NO_NUMBERS if value not in (None, math.inf))
ARRAYS = {
    "vertices": ROOM.vertices, "offsets": ROOM.offsets, "closed": ROOM.closed, "bulges": ROOM.bulges,
    "depth": ROOM.depth, "sides": ROOM.sides, "materials": ROOM.materials, "names": ROOM.names, "layers": ROOM.layers,
}  # fmt: skip

ENSEMBLE = {
    "balls": (*NO_WHOLE_NUMBERS, None, 0),
    "executor": ("thread", "dask://", 4, ThreadPoolExecutor, ["threads"]),
    "workers": (*NO_WHOLE_NUMBERS, 0),
    "chunk": (*NO_WHOLE_NUMBERS, 0),
    "checkpoint": (5, "/no/such/folder/survey.json", "/"),
    "progress": ("bar", 1, True),
}

# What is called, good arguments for all that must be given, and for each parameter values that may not be.
CALLS = {
    "Balls": (Balls, {"position": [(5.0, 5.0)], "velocity": [(3.0, 4.0)]}, {
        "position": (*NO_PAIRS, None, [(1.0, 2.0), (3.0, 4.0)]),
        "velocity": (*NO_PAIRS, None, []),
        "radius": (-1.0, "1", None, True, math.nan, math.inf, [1.0, 2.0], [[1.0]]),
        "mass": (-1.0, "1", True, math.nan, math.inf, [1.0, 2.0], [[1.0]]),
    }),
    "Balls.take": (SCENE.balls.take, {}, {"balls": (1, -1, 0.0, "0", [True, False], [[0]], None, slice("a", None))}),
    "Material": (Material, {}, {
        "restitution": (*NO_NUMBERS, -0.1, 10.1),
        "tangential_restitution": (*NO_NUMBERS, -0.1, 1.1),
        "static_friction": (*NO_NUMBERS, -0.1),
    }),
    "Scene": (Scene, {"walls": ROOM}, {
        "walls": (None, "level.svg", SQUARE),
        "balls": (None, [(1.0, 2.0)], (SQUARE, SQUARE)),
        "gravity": (5, -9.81, "down", (0.0,), (0.0, math.nan), (0.0, math.inf), ("0", "1"), [(0.0, 1.0)], True),
        "rolling_friction": (-1.0, "1", math.nan, math.inf, True, (1.0,)),
        "drag": (-1.0, "1", math.nan, math.inf, True, (1.0,)),
        "sensors": ("level.svg", SQUARE, True),
        "meeting": NO_FLAGS,
        "ball_restitution": (*NO_NUMBERS, -0.1, 1.1),
        "ball_tangential_restitution": (*NO_NUMBERS, -0.1, 1.1),
    }),
    "Walls": (Walls, ARRAYS, {
        "vertices": (None, "a", SQUARE[:3], [1.0], [(math.nan, 0.0)] * 4, [("0", "1")] * 4),
        "offsets": (None, [0], [], [0, 3], [1, 4], [0, 4, 4], [0.5, 4], "04"),
        "closed": (None, [1], ["yes"], [True, False], True),
        "bulges": (None, [0.0], [math.nan] * 4, "0000"),
        "depth": (None, [], [0.5], ["0"]),
        "sides": (None, ("outwrd",), ("both", "both"), (None,), "both"),
        "materials": (None, (0.5,), (), Material()),
        "names": (None, (1,), ()),
        "layers": (None, (1,), ()),
        "units": NO_TEXTS,
        "y_axis": ("left", None, 1),
        "tolerance": (*NO_NUMBERS, -1.0),
        "measured_error": (*NO_NUMBERS, -1.0),
        "measured_normal_error": (-1.0, "1", math.nan, True),
        "source_file": NO_TEXTS,
        "source_sha256": NO_TEXTS,
        "problems": (None, ["open path"], "open path"),
        "solid": (True, "room"),
        "origins": (None, ({},), 5, "a"),
        "markers": (None, [(1.0, 2.0)], "spawn"),
        "sensors": ("goal", [SQUARE], True),
    }),
    "Walls.from_polylines": (Walls.from_polylines, {"polylines": [SQUARE]}, {
        "polylines": (None, 5, "abc", SQUARE, [SQUARE[:1]], [[("0", "1"), ("2", "3")]], [[(0.0, math.inf)] * 2]),
        "closed": ("yes", 1, None, [1], [True, False], []),
        "bulges": ("0000", 5, [], [[0.0]], [[math.nan] * 4], [0.0], [["0"] * 4]),
        "sides": ("outwrd", "outwards", None, 1, ["both", "both"], [None]),
        "material": (0.5, "steel", [0.5], [], {"restitution": 0.5}),
        "names": (5, [5], [], ["a", "b"]),
        "layers": (5, [5], [], ["a", "b"]),
        "origins": (5, [5], [], "a"),
    }),
    "Walls.__getitem__": (ROOM.__getitem__, {}, {"index": ("wall", 0.0, None, slice(1))}),
    "Walls.take": (TWO.take, {}, {"walls": (2, -1, 0.0, "0", [True], [[0]], None, slice("a", None))}),
    "Walls.to_shapely": (ROOM.to_shapely, {}, {"tolerance": ("1", True, math.nan, math.inf, 0.0, -1.0, [1.0])}),
    "Walls.straightened": (ROOM.straightened, {}, {"tolerance": ("1", True, math.nan, math.inf, 0.0, -1.0, [1.0])}),
    "Walls.save": (ROOM.save, {}, {"path": (5, None, "/no/such/folder/walls.json", "/")}),
    "Walls.load": (Walls.load, {}, {"source": (5, None, "/no/such/walls.json", "/", ROOM)}),
    "World": (World, {"scene": SCENE}, {
        "scene": (None, ROOM, wallkit.prepare(SCENE)),
        "way": ("exactly", None, 1, ["exact"]),
        "compile": NO_FLAGS,
    }),
    "step_through": (wallkit.step_through, {"scene": SCENE, "way": "stop", "dt": 0.1, "until": 1.0}, {
        "scene": (None, ROOM),
        "way": ("exactly", None, 1, ["exact"]),
        "dt": (*NO_NUMBERS, 0.0, -1.0, 1e-9),
        "until": (*NO_NUMBERS, -1.0, 1e9),
    }),
    "World.step": (World(SCENE).step, {}, {"dt": (*NO_NUMBERS, -1.0)}),
    "World.place": (World(SCENE).place, {"ball": 0}, {
        "ball": (*NO_WHOLE_NUMBERS, 1, None),
        "position": (5.0, "ab", [(1.0, 2.0)], (1.0, math.nan), ("1", "2"), (1.0, 2.0, 3.0)),
        "velocity": (5.0, "ab", [(1.0, 2.0)], (1.0, math.nan), ("1", "2"), (1.0, 2.0, 3.0)),
    }),
    "Run.contacts_of": (RUN.contacts_of, {}, {"ball": (*NO_WHOLE_NUMBERS, 1, None)}),
    "Run.position": (RUN.position, {}, {"time": (-1.0, "1", None, math.nan, [0.0, -1.0], [[1.0], [1.0, 2.0]], ["1"])}),
    "Run.velocity": (RUN.velocity, {}, {"time": (-1.0, "1", None, math.nan, [0.0, -1.0], [[1.0], [1.0, 2.0]], ["1"])}),
    "Run.save": (RUN.save, {}, {"path": (5, None, "/no/such/folder/run.json", "/")}),
    "Run.load": (wallkit.Run.load, {}, {"source": (5, None, "/no/such/run.json", "/", RUN)}),
    "Scene.save": (SCENE.save, {}, {"path": (5, None, "/no/such/folder/scene.json", "/")}),
    "Scene.load": (Scene.load, {}, {"path": (5, None, "/no/such/scene.json", "/", SCENE)}),
    "Run.take": (RUN.take, {}, {"balls": (1, -1, 0.0, "0", [0, 0], [True, False], [[0]], None, slice("a", None))}),
    "Run.trusted_until": (RUN.trusted_until, {}, {
        "tolerance": (*NO_NUMBERS, 0.0, -1.0),
        "source": ("round", None, 1),
    }),
    "prepare": (wallkit.prepare, {"scene": SCENE}, {"scene": (None, ROOM, "level.toml"), "check": NO_FLAGS}),
    "simulate": (wallkit.simulate, {"scene": SCENE, "until": 1.0}, {
        "scene": (None, ROOM, "level.toml", wallkit.prepare(SCENE)),
        "until": (*NO_TIMES, -1.0),
        "bounces": NO_WHOLE_NUMBERS,
        "mode": ("fast", None, True),
        "settle": NO_FLAGS,
        "progress": ("bar", 1, True),
    }),
    "aim": (wallkit.aim, {"scene": SCENE, "start": (3.0, 3.0), "target": (6.0, 6.0, 0.5), "bounces": 1}, {
        "scene": (None, ROOM, "level.toml"),
        "start": (5.0, "ab", [(1.0, 2.0)], (1.0, math.nan), ("1", "2"), (1.0, 2.0, 3.0)),
        "target": (5.0, "goal", None, (1.0, 2.0), (1.0, 2.0, 0.0), (1.0, 2.0, math.inf), ("1", "2", "3")),
        "bounces": (*NO_WHOLE_NUMBERS, -1, None),
        "radius": (*NO_NUMBERS, -1.0),
        "speed": ("1", True, math.nan, math.inf, 0.0, -1.0),
        "resolution": (*NO_NUMBERS, 0.0, 1.0),
        "most_beams": (*NO_WHOLE_NUMBERS, 0, None),
        "progress": ("bar", 1, True),
    }),
    "survey": (wallkit.survey, {"scene": SCENE, "until": 1.0}, {
        "scene": (None, ROOM, "level.toml"),
        "until": (*NO_TIMES, -1.0),
        "bounces": NO_WHOLE_NUMBERS,
        "threads": (*NO_WHOLE_NUMBERS, 0),
        "executor": ("threads", 4, ThreadPoolExecutor),
        "check": NO_FLAGS,
        "by_edge": NO_FLAGS,
    }),
    "count": (wallkit.count, {"scene": SCENE, "draw": DRAW, "balls": 5, "bounces": 3}, {
        "scene": (None, ROOM),
        "draw": (None, SCENE.balls),
        "until": (*NO_TIMES, -1.0),
        "bounces": NO_WHOLE_NUMBERS,
        **ENSEMBLE,
    }),
    "check_level": (wallkit.check_level, {"scene": SCENE, "draw": DRAW, "balls": 5, "bounces": 3}, {
        "scene": (None, ROOM),
        "draw": (None, SCENE.balls),
        "until": (*NO_TIMES, -1.0),
        "bounces": NO_WHOLE_NUMBERS,
        "target": (5, "nobody", (1.0, 2.0), (1.0, 2.0, 0.0), (1.0, 2.0, math.inf), ("1", "2", "3")),
        **ENSEMBLE,
    }),
    "RoomBalls": (wallkit.RoomBalls, {"triangles": [[(0.0, 0.0), (9.0, 0.0), (0.0, 9.0)]]}, {
        "triangles": (None, [], SQUARE, [[(0.0, 0.0)] * 3], [[(0.0, 0.0), (math.nan, 0.0), (0.0, 9.0)]], "box"),
        "speed": (*NO_NUMBERS, -1.0),
        "radius": (*NO_NUMBERS, -1.0),
        "seed": (*NO_WHOLE_NUMBERS, None),
    }),
    "read_drawing": (wallkit.read_drawing, {"source": ROOT / "samples" / "room.svg"}, {
        "source": (5, None, [], "/no/such/drawing.svg", "/", ""),
        "page": NO_PAGES,
        "via": NO_READERS,
    }),
    "read_drawing_text": (wallkit.read_drawing_text, {"text": "<svg/>"}, {
        "text": (5, None, ["<svg/>"], "", "no drawing"),
        "file": (5, None, b"a.svg"),
        "page": NO_PAGES,
        "via": NO_READERS,
    }),
    "open_scene": (wallkit.open_scene, {"source": ROOT / "samples" / "room.svg"}, {
        "source": (5, None, [], "/no/such/drawing.svg", "/", b"", b"no drawing"),
        "wishes": (5, "bounces", {"bounces": 3}),
        "name": NO_TEXTS,
        "folder": (5, "samples"),
    }),
    "Wishes": (wallkit.Wishes, {}, {
        "ball": (5, "1,2", [5.0], [(1.0, 2.0, 3.0)], [(math.nan, 0.0)], [("1", "2")]),
        "velocity": (5, "1,2", (1.0,), (math.inf, 0.0)),
        "speed": NO_NUMBERS_BUT_NONE,
        "angle": NO_NUMBERS_BUT_NONE,
        "radius": (*NO_NUMBERS_BUT_NONE, -1.0),
        "balls": (*NO_WHOLE_NUMBERS, 0),
        "seed": NO_WHOLE_NUMBERS,
        "gravity": (math.nan, True, "down", (0.0,), (0.0, math.nan)),
        "restitution": (*NO_NUMBERS_BUT_NONE, -0.1),
        "tangential_restitution": (*NO_NUMBERS_BUT_NONE, -0.1, 1.1),
        "friction": (*NO_NUMBERS_BUT_NONE, -1.0),
        "drag": (*NO_NUMBERS_BUT_NONE, -1.0),
        "meeting": ("yes", 1),
        "ball_restitution": (*NO_NUMBERS_BUT_NONE, -0.1, 1.1),
        "until": (*NO_NUMBERS_BUT_NONE, -1.0),
        "bounces": NO_WHOLE_NUMBERS,
        "importing": (5, "lines", {"curves": "arcs"}),
        "may_be_empty": ("yes", 1),
        "put_ball": ("yes", 1),
    }),
    "Walls.export": (ROOM.export, {"path": "/no/such/folder/level.tmj"}, {
        "path": (5, None, "/no/such/folder/level.tmj"),
        "format": ("doc", 5),
        "options": ({"no_such_option": 1},),
    }),
    "drawing_from_svgpathtools": (wallkit.drawing_from_svgpathtools, {"paths": []}, {
        "paths": (5, None, "M 0 0 L 1 1", [5], [["M"]], [[None]]),
        "units": ("parsec", 5, None),
        "y_axis": ("left", 5, None),
    }),
    "Repairs": (wallkit.Repairs, {}, {
        **dict.fromkeys(("snap", "min_width", "simplify"), (*NO_NUMBERS, -1.0)),
        **dict.fromkeys(("join", "drop_duplicates", "resolve", "union"), NO_FLAGS),
    }),
    "free_space": (wallkit.free_space, {"walls": ROOM}, {
        "walls": (None, SQUARE, SCENE),
        "narrow": (*NO_NUMBERS, 0.0),
    }),
    "RandomBalls": (wallkit.RandomBalls, {"box": (0.0, 0.0, 9.0, 9.0)}, {
        "box": (None, (0.0, 0.0), (9.0, 0.0, 0.0, 9.0), (0.0, 0.0, math.inf, 9.0), "box"),
        "speed": (*NO_NUMBERS, -1.0),
        "radius": (*NO_NUMBERS, -1.0),
        "seed": (*NO_WHOLE_NUMBERS, None),
    }),
    "survey_stream": (wallkit.survey_stream, {"scene": SCENE, "draw": DRAW, "count": 5, "until": 1.0}, {
        "scene": (None, ROOM),
        "draw": (None, SCENE.balls),
        "count": (*NO_WHOLE_NUMBERS, None),
        "until": (*NO_TIMES, -1.0),
        "bounces": NO_WHOLE_NUMBERS,
        "threads": (*NO_WHOLE_NUMBERS, 0),
        "chunk": (*NO_WHOLE_NUMBERS, None, 0),
    }),
    "film": (wallkit.film, {"run": RUN, "kind": "gif"}, {
        "run": (None, SCENE),
        "kind": (None, "avi", 1),
        "seconds": (*NO_NUMBERS, 0.0, -1.0),
        "width": (*NO_WHOLE_NUMBERS, None, 0, 321),
        "fps": (*NO_WHOLE_NUMBERS, 0, 30),
        "pace": (*(wrong for wrong in NO_NUMBERS if wrong is not None), 0.0, -1.0),
        "colour": (None, "red"),
        "theme": (None, "grey"),
        "stepped": ("stop", RUN),
        "progress": ("bar", 1, True),
    }),
    "replay_html": (wallkit.replay_html, {"run": RUN}, {
        "run": (None, SCENE),
        "title": NO_TEXTS,
        "max_contacts": (*NO_WHOLE_NUMBERS, None, 0),
        "lesson": ("The mirror law", 3),
    }),
    "Reference": (wallkit.Reference, {"scene": SCENE}, {
        "scene": (None, ROOM, Scene(ROOM, SCENE.balls, drag=0.5)),
        "digits": (*NO_WHOLE_NUMBERS, None, 15),
    }),
    "sure_events": (wallkit.sure_events, {"scene": SCENE, "bounces": 2}, {
        "scene": (None, ROOM, Scene(ROOM, SCENE.balls, rolling_friction=0.5)),
        "bounces": (*NO_WHOLE_NUMBERS, None),
        "ball": (*NO_WHOLE_NUMBERS, None, 1),
        "digits": (*NO_WHOLE_NUMBERS, None, 15),
        "most": (*NO_WHOLE_NUMBERS, None),
    }),
    **{f"{type(thing).__name__}.to_svg": (lambda thing=thing, **said: thing.to_svg(**said["options"]), {}, {
        "options": (
            {"titel": "a"}, {"title": 5}, {"width": 0}, {"width": "wide"},
            {"heat": 1}, {"colour": "red"}, {"problems": "none"}, {"normals": "yes"},
        ),
    }) for thing in (ROOM, SCENE, RUN)},
}  # fmt: skip

RESULTS = {
    "Counts",
    "FreeSpace",
    "Gap",
    "Horizon",
    "LevelCheck",
    "OpenedScene",
    "PreparedScene",
    "Stepped",
    "SurveyTotals",
    "Wall",
    "Window",
    "Windows",
    "__version__",
}  # made by wallkit
DTYPES = {"CONTACT", "FINAL"}
READ = {"Drawing", "DrawnPath", "Layer", "Problem", "Subpath"}  # plain records, filled by the readers piece by piece
ENUMS_AND_ERRORS = {"DrawingError", "Ending", "ContactKind", "LimitError", "SceneError", "WallkitError", "WallsError"}
TESTED_ELSEWHERE = {"ImportOptions", "import_walls"}  # with the options that every door shares

CASES = [
    (name, key, value) for name, (_, _, wrong) in CALLS.items() for key, values in wrong.items() for value in values
]


@pytest.mark.parametrize("name", CALLS)
def test_the_good_values_are_taken(name):
    call, good, _ = CALLS[name]
    assert call is not None
    inspect.signature(call).bind_partial(**good)
    if name in (
        "Balls",
        "Material",
        "Scene",
        "Walls",
        "Walls.from_polylines",
        "World",
        "World.place",
        "prepare",
        "simulate",
        "survey",
    ):
        call(**good)


@pytest.mark.parametrize(("name", "key", "value"), CASES)
def test_a_wrong_value_is_an_error_that_names_the_argument_and_what_may_be(name, key, value):
    call, good, _ = CALLS[name]
    with pytest.raises(WallkitError) as caught:
        call(**{**good, key: value})
    assert caught.value.code not in ("", "error")
    assert str(caught.value)


@pytest.mark.parametrize("name", CALLS)
def test_every_parameter_has_wrong_values_in_the_table(name):
    call, _, wrong = CALLS[name]
    if name.endswith(".to_svg"):  # its options are keywords of their own
        return
    assert set(wrong) == set(inspect.signature(call).parameters)


def test_every_public_name_is_in_the_table_or_left_out_for_a_reason():
    held = {name.split(".")[0] for name in CALLS}
    assert held | DTYPES | RESULTS | READ | ENUMS_AND_ERRORS | TESTED_ELSEWHERE == set(wallkit.__all__)


def test_every_method_with_arguments_is_in_the_table():
    for name in ("Balls", "Scene", "Walls", "World", "Run", "Material"):
        for method, function in inspect.getmembers(getattr(wallkit, name), inspect.isroutine):
            if method.startswith("_"):
                continue
            if set(inspect.signature(function).parameters) - {"self"}:
                assert f"{name}.{method}" in CALLS, f"{name}.{method}"


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Walls.from_polylines([SQUARE], sides="outwrd"), "sides is 'outwrd' (give 'both' or 'outward')"),
        (lambda: Scene(ROOM, gravity=5), "gravity is 5 (give two finite numbers, (GX, GY), or None)"),
        (lambda: Scene(ROOM, drag=-1), "drag is -1 (give a finite number, 0 or more, or None)"),
        (lambda: wallkit.simulate(SCENE, until="3"), "until is '3' (give seconds, 0 or more)"),
        (lambda: wallkit.simulate(SCENE, bounces=2.5), "bounces is 2.5 (give a whole number, 0 or more)"),
        (
            lambda: wallkit.simulate(SCENE, until=1.0, mode="fast"),
            "mode is 'fast' (give 'auto', 'interpreted' or 'compiled')",
        ),
    ],
)
def test_the_message_says_what_was_given_and_what_may_be(make, message):
    with pytest.raises(WallkitError) as caught:
        make()
    assert str(caught.value) == message


def test_attributes_of_a_scene_and_of_walls_are_checked_when_they_are_set():
    scene, walls = Scene(ROOM), Walls.from_polylines([SQUARE])
    for thing, name, value in (
        (scene, "gravity", 5),
        (scene, "drag", -1),
        (walls, "sides", ["in"]),
        (walls, "y_axis", "x"),
    ):
        before = getattr(thing, name)
        with pytest.raises(WallkitError):
            setattr(thing, name, value)
        assert getattr(thing, name) == before


def test_what_numpy_and_python_call_numbers_is_taken():
    from fractions import Fraction

    scene = Scene(ROOM, Balls(np.array([5, 5]), [[Fraction(3), 4]], np.float32(1)), gravity=[0, np.int64(-2)])
    assert scene.gravity == (0.0, -2.0)
    assert scene.balls.velocity.tolist() == [[3.0, 4.0]]
    run = wallkit.simulate(scene, until=np.float32(1), bounces=1e6)
    assert run.final["time"][0] == 1.0
