"""The lessons: every number that one states is computed here, by the library or from first principles."""

import json
import math
import re
import tomllib
from importlib.resources import files

import jsonschema
import numpy as np
import pytest

from wallkit import Balls, ContactKind, Ending, Scene, SceneError, Walls, open_scene, simulate, step_through
from wallkit.scene.lesson import FRAME_WAYS
from wallkit.scene.look_over import given_of, look_over
from wallkit.scene.samples import lessons, samples, shown
from wallkit.scene.scene_files import read_scene

LESSONS = {lesson.path.stem: lesson for lesson in lessons()}
NUMBER = re.compile(r"\d+(?:\.\d+)?")


def flown(name, **limits):
    opened = open_scene(LESSONS[name].path)
    return simulate(opened.scene, **(limits or {"until": opened.until}))


def bounces_of(run, ball):
    return run.contacts[(run.contacts["ball"] == ball) & (run.contacts["kind"] <= ContactKind.VERTEX)]


def mirror_law():
    run = flown("mirror-law")
    floor, along, across = run.contacts[0], 50 * math.cos(math.radians(30)), 50 * math.sin(math.radians(30))
    assert [floor["vx"], floor["vy"]] == pytest.approx([along, across])  # turned round across, kept along
    assert np.abs(run.contacts["vx"]) == pytest.approx(along)
    assert np.abs(run.contacts["vy"]) == pytest.approx(across)
    directions = {(vx > 0, vy > 0) for vx, vy in zip(run.contacts["vx"], run.contacts["vy"], strict=True)}
    point = Balls([(60, 100)], [(280, -200)])  # at (340, -100), in a second
    hit = simulate(Scene(run.scene.walls, point), until=1)
    assert hit.position(1.0)[0] == pytest.approx([340, 100])
    turned = [reflected(math.radians(30), math.radians(tilt)) for tilt in (0, 10)]
    return [50, 30, along, across, 150, floor["time"], floor["x"] - 60, len(directions), 60, 100, 340, 100, 340, 100,
            hit.contacts["x"][0], math.degrees(math.atan2(200, 280)), math.hypot(280, 200),
            10, math.degrees(turned[1] - turned[0])]  # fmt: skip


def reflected(angle, wall):
    """The direction after a mirror that is turned by ``wall``, as v - 2 (v.n) n."""
    way, normal = np.array([math.cos(angle), -math.sin(angle)]), np.array([-math.sin(wall), math.cos(wall)])
    out = way - 2 * (way @ normal) * normal
    return math.atan2(out[1], out[0])


def restitution():
    run = flown("restitution")
    tops = {}
    for ball in (0, 1, 2):
        times = bounces_of(run, ball)["time"][:5]
        middles = (times[:-1] + times[1:]) / 2
        tops[ball] = (run.position(middles)[:, ball, 1] - 10).tolist()
    assert tops[0] == pytest.approx([100] * 4)
    assert run.ending[1:] == (Ending.AT_REST, Ending.AT_REST)
    first = bounces_of(run, 0)[0]
    assert first["vy"] == pytest.approx(200)
    rest = run.final["time"]
    parts = [material.restitution for material in run.scene.walls.materials]
    kept = tops[1][0] / 100
    return [100, *parts, -run.scene.gravity[1], first["time"], first["vy"], 2, 2, *tops[1][:3], rest[1], rest[2],
            100 * (1 - kept), kept, *tops[2][:2], 0.5, math.sqrt(0.5), rest[1] - first["time"]]  # fmt: skip


def frames():
    scene = open_scene(LESSONS["frames"].path).scene
    speed, dt, reach, wall = 1200.0, 1 / 60, float(scene.balls.radius[0]), float(scene.walls.vertices[-1, 0])
    stepped = step_through(scene, "overlap", dt, 0.6)
    through = stepped.flown_through()
    assert (through[0].wall, through[0].lost) == (1, True)
    frame = int(np.searchsorted(stepped.time, through[0].time))
    before, after = stepped.state[frame - 1 : frame + 1, 0, 0]
    for limit, at in ((reach / dt, dt), (speed, reach / speed), (2 * speed, reach / (2 * speed))):
        assert tunnels(scene, limit * 0.999, at) == 0  # from wherever it starts
        assert tunnels(scene, limit * 1.01, at) > 0
    part = tunnels(scene, speed, dt)
    exact = flown("frames").contacts["time"][0]
    return [1 / dt, reach, speed, wall, speed * dt, before, wall - before, after, exact, reach / dt, 100 * part,
            speed * dt - reach, speed / reach, 2 * speed / reach]  # fmt: skip


def tunnels(scene, speed, dt, starts=200):
    """The part of balls that go through the thin wall at the first try, from starts over one frame's way."""
    x = 30 + speed * dt * (np.arange(starts) + 0.5) / starts
    balls = Balls(np.stack([x, np.full(starts, 60.0)], axis=1), np.tile((speed, 0.0), (starts, 1)), 12.0)
    stepped = step_through(Scene(scene.walls, balls), "overlap", dt, 300 / speed)
    return np.count_nonzero(stepped.state[-1, :, 0] > 300) / starts


def parabolas():
    run = flown("parabolas")
    assert run.ending == (Ending.ABSORBED,) * 3
    ranges, times = run.final["x"] - 30, run.final["time"]
    assert ranges[0] == pytest.approx(ranges[2])
    heights = [run.position(times[ball] / 2)[ball, 1] - 4 for ball in range(3)]
    speed = np.hypot(*run.scene.balls.velocity[1])
    moon = simulate(Scene(run.scene.walls, run.scene.balls, (0.0, run.scene.gravity[1] / 6)), until=60)
    faster = Balls([(30, 4)], [run.scene.balls.velocity[1] * math.sqrt(2)], 4)
    meadow = Walls.from_polylines([[(0, -20), (3000, -20), (3000, 0), (0, 0)]], material=run.scene.walls.materials[0])
    twice = simulate(Scene(meadow, faster, run.scene.gravity), until=60)
    assert twice.final["x"][0] - 30 == pytest.approx(2 * ranges[1])
    far = Scene(meadow, Balls([(30, 4)], [run.scene.balls.velocity[1]], 4), moon.scene.gravity)
    lunar = simulate(far, until=60).final
    return [speed, 30, 45, 60, -run.scene.gravity[1], ranges[1], ranges[0], 90, 2, 2, 2, *heights, *times[::-1],
            (lunar["x"][0] - 30) / ranges[1], lunar["x"][0] - 30, lunar["time"][0] / times[1],
            np.hypot(*faster.velocity[0])]  # fmt: skip


def chaos():
    run = flown("chaos", until=30)
    hair = run.scene.balls.position[1, 0] - run.scene.balls.position[0, 0]
    parted = first_apart(run)
    closer = Balls([(3, -7), (3 + 1e-12, -7)], [(80, 31)] * 2, 2)
    later = first_apart(simulate(Scene(run.scene.walls, closer), until=45))
    straight = Walls.from_polylines([[(-100, -50), (-100, 50), (100, 50), (100, -50)]])
    plain = simulate(Scene(straight, run.scene.balls), until=60)
    assert math.dist(*plain.position(60.0)) == pytest.approx(hair, rel=1e-3)
    at_ten = math.dist(*run.position(10.0))
    assert at_ten / hair == pytest.approx(300, rel=0.1)  # "three hundred times the first"
    bounced = [len(bounces_of(run, ball)[bounces_of(run, ball)["time"] < parted]) for ball in (0, 1)]
    assert bounced[0] == bounced[1]
    assert later < 2 * parted
    growth = (1 / hair) ** (1 / parted)
    return [
        hair,
        10,
        at_ten,
        parted,
        bounced[0],
        1,
        16,
        1e-12,
        later,
        later - parted,
        growth,
        parted / math.log2(1 / hair),
    ]


def first_apart(run):
    """When the two balls are 1 unit apart, to a thousandth of a second."""
    times = np.arange(0, float(run.final["time"].min()), 1e-3)
    places = run.position(times)
    return float(times[np.argmax(np.hypot(*(places[:, 1] - places[:, 0]).T) > 1)])


def counting_pi():
    run = flown("counting-pi")
    between = int(np.count_nonzero(run.contacts["kind"] == ContactKind.BALL))
    scene = run.scene
    counts = {}
    for mass in (1, 100, 10_000, 1_000_000):
        balls = Balls(scene.balls.position, scene.balls.velocity, scene.balls.radius, mass=[1, mass])
        counts[mass] = len(simulate(Scene(scene.walls, balls, meeting=True), until=1000).contacts)
        assert counts[mass] == math.ceil(math.pi / math.atan(math.sqrt(1 / mass))) - 1  # Galperin's own formula
    assert counts[100] == len(run.contacts)
    start = float(-scene.balls.velocity[1, 0])
    rows = run.contacts
    light = np.where(rows["ball"] == 0, rows["vx"], rows["other_vx"])
    end = run.velocity(25.0)[:, 0]
    assert 0 < end[0] < end[1]
    return [100, *counts.values(), 10_000, 2003, len(rows), between, len(rows) - between, np.abs(light).max(), start,
            start * 10, 1, end[1], end[0]]  # fmt: skip


COMPUTED = {"mirror-law": mirror_law, "restitution": restitution, "frames": frames, "parabolas": parabolas,
            "chaos": chaos, "counting-pi": counting_pi}  # fmt: skip


def test_there_are_six_lessons_in_the_gallery_and_no_two_files_of_one_name():
    assert list(LESSONS) == list(COMPUTED)
    assert len({sample.name for sample in shown()}) == len(lessons()) + len(samples())


@pytest.mark.parametrize("name", COMPUTED)
def test_every_number_of_a_lesson_is_right(name):
    lesson = open_scene(LESSONS[name].path).lesson
    said = NUMBER.findall("\n".join([lesson.text, *(part for pair in lesson.questions for part in pair)]))
    values = [float(value) for value in COMPUTED[name]()]
    assert [token for token in said if not any(rounds_to(value, token) for value in values)] == []
    unsaid = [value for value in values if not any(math.isclose(value, float(token), rel_tol=0.07) for token in said)]
    assert unsaid == []


def rounds_to(value, token):
    """A number is written with as many decimals as were wanted; half of the last one is rounding."""
    return abs(value - float(token)) <= 0.5001 * 10.0 ** -len(token.partition(".")[2])


@pytest.mark.parametrize("name", COMPUTED)
def test_a_lesson_is_a_screen_of_text_with_questions_and_nothing_doubtful(name):
    opened = open_scene(LESSONS[name].path)
    assert not [problem for problem in look_over(given_of(opened), None).problems if problem.severity != "info"]
    assert 100 < len(opened.lesson.text.split()) < 220
    assert 3 <= len(opened.lesson.questions) <= 5
    assert LESSONS[name].title == opened.lesson.title


def test_lessons_obey_the_schema_and_the_reader_says_the_same():
    schema = json.loads(files("wallkit.schemas").joinpath("scene.schema.json").read_text())
    for lesson in lessons():
        jsonschema.validate(tomllib.loads(lesson.path.read_text()), schema)
    assert set(schema["properties"]["lesson"]["properties"]["way"]["enum"]) == set(FRAME_WAYS)


@pytest.mark.parametrize(
    ("lesson", "words"),
    [
        ("3", "lesson: not a table"),
        ("{}", "needs a title"),
        ('{title="a", texts="b"}', "lesson.texts: no such key"),
        ('{title="a", text=3}', "lesson.text: 3 is not text"),
        ('{title="a", questions=[{question="b"}]}', "questions[0]: needs a question and an answer"),
        ('{title="a", questions=[3]}', "questions[0]: not a table"),
        ('{title="a", way="exact"}', "lesson.way: 'exact' is not stop"),
        ('{title="a", dt=0.1}', "only goes with lesson.way"),
        ('{title="a", way="overlap", dt=0}', "lesson.dt: 0 is not"),
    ],
)
def test_what_is_wrong_with_a_lesson_is_told_by_its_key(lesson, words):
    text = f"lesson = {lesson}\nwalls = [{{vertices = [[0, 0], [0, 9], [9, 9], [9, 0]]}}]\n"
    with pytest.raises(SceneError) as error:
        read_scene(text.encode())
    assert words in str(error.value)
