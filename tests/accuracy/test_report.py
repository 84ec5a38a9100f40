"""The report: its figures are those of the contestants, its files are whole, its errors are for people."""

import json
import re
import xml.etree.ElementTree as ElementTree
from dataclasses import replace

import numpy as np
import pytest
from typer.testing import CliRunner

from wallkit import Balls, Material, Scene, SceneError, Walls
from wallkit.accuracy import engines, scenes, tables
from wallkit.accuracy.cases import Case, Verdict
from wallkit.accuracy.contest import MEETINGS, METHODS, Contest, Effort, Point, Subject, _taken, contest
from wallkit.accuracy.own import flattened, of_scene
from wallkit.accuracy.pool_engine import FRICTIONS, pooltool_engines
from wallkit.accuracy.reference_pairs import sure_meetings
from wallkit.accuracy.report import Report, machine
from wallkit.cli.app import _register_commands, app
from wallkit.view.report_page import report_html
from wallkit.view.work_precision import WIDTH, work_precision_svg

SMALL = Effort(bounces=8, runs=1, steps=(1 / 30,), tolerances=(1e-3,))


@pytest.fixture(scope="module")
def box():
    return contest(Subject.of(scenes.built_in()[0]), SMALL)


@pytest.fixture(scope="module", autouse=True)
def _commands():
    _register_commands()


def test_the_exact_ways_are_exact_and_the_others_are_not(box):
    by_series = {name: points[0] for name, points in box.series().items()}
    # three bounces of coordinates up to 400 at 50 units/s, a rounding or two each
    assert by_series["exact, lines"].error < 1e-12
    assert by_series["step, exact"].error < 1e-12
    for way in ("stop", "full-step", "reflect-in-place"):
        # each bounce is wrong by up to a frame's way, 50 / 30, and by some of it on average
        assert 0.05 < by_series[f"step, {way}"].error < 3 * 2 * 50 / 30


def test_an_engine_that_escapes_is_seen():
    gone = engines.Contestant(
        "gone", "", 0.0, lambda times, _: engines.Flown(times[:, None, None] * [1e3, 0], np.ones((1, 2)), 1.0)
    )
    from wallkit.accuracy import contest as module

    truth = Subject.of(scenes.built_in()[0]).truth(400.0)
    times = np.arange(1.0, 8.0)
    places = np.full((7, 1, 2), 100.0)
    point = module._judged(gone, gone.fly(times, 1), places, 400.0, module._room(truth), truth, taken=2)
    assert point.escaped
    assert point.wrong == 1
    assert point.error == pytest.approx(np.hypot(2900.0, 100.0))


def test_a_slow_contestant_stops_at_the_limit_of_steps():
    scene = scenes.built_in()[0].scene()
    flown = engines.stepped(scene, "exact", 1e-9).fly(np.array([1.0, 2.0]), 1)
    assert len(flown.position) == 0
    assert np.isnan(flown.seconds)


@pytest.fixture(scope="module")
def the_break():
    """Forty contacts, of which the twentieth of two balls is the one at which the error is taken."""
    return contest(Subject.of_the_break(), Effort(bounces=40, runs=1, steps=(1 / 240,), fine_steps=()))


def test_balls_that_meet_are_judged_all_of_them(the_break):
    by_series = {name: points[0] for name, points in the_break.series().items()}
    # coordinates up to 254 and ten contacts a ball at most, each of which multiplies an error by a few: 2e-13 measured
    assert by_series["exact, lines"].error < 1e-11
    assert by_series["step, exact"].error < 1e-11
    assert by_series["exact, lines"].wrong is None
    assert by_series["step, exact"].wrong is None
    assert by_series["exact, lines"].reached == 40
    assert abs(by_series["exact, lines"].drift) < 1e-14
    assert set(by_series) <= {"exact, lines", "step, exact", "pymunk", "billiards", "pooltool"}


def test_an_engine_of_one_frame_for_ten_contacts_is_elsewhere(the_break):
    pytest.importorskip("pymunk")
    # the first eleven contacts of the rack take 3.2 ms, less than one frame of 1/240 s
    (point,) = the_break.series()["pymunk"]
    assert point.error > 1.0
    assert point.wrong is not None


def test_friction_brought_down_brings_pooltool_to_the_reference(the_break):
    pytest.importorskip("pooltool")
    points = the_break.series()["pooltool"]
    assert [point.value for point in points] == list(FRICTIONS)
    errors = np.array([point.error for point in points])
    # what friction takes is in proportion to it, until the 1e-9 m are left by which pooltool moves balls at a contact
    assert errors[1:3] / errors[:2] == pytest.approx(0.01, rel=0.2)
    assert errors[3] < 1e-6


def test_pooltool_is_asked_for_equal_balls_on_a_rectangle_alone():
    table = scenes.break_of_fifteen()
    assert len(list(pooltool_engines(table))) == len(FRICTIONS)
    assert not list(pooltool_engines(replace(table, walls=scenes.star())))
    balls = Balls(table.balls.position, table.balls.velocity, table.balls.radius, np.arange(1.0, 17.0))
    assert not list(pooltool_engines(replace(table, balls=balls)))


def test_the_break_is_sure_and_its_twentieth_meeting_stands_alone():
    truth = scenes.break_of_fifteen()
    events = sure_meetings(truth, 40, digits=16)
    met = [index for index, event in enumerate(events) if event.other >= 0][MEETINGS - 1]
    assert events[met + 1].time - events[met].time > 0.05  # longer than any time step of the report
    assert _taken(events, 39) == met


def test_a_picture_says_after_what_the_error_is_taken(box, the_break):
    assert "after 3 bounces (units)" in work_precision_svg([box])
    assert "after 20 contacts of balls (units)" in work_precision_svg([the_break])
    assert "after 3 bounces, or 20 contacts of balls (units)" in work_precision_svg([box, the_break])


def test_a_scene_file_in_which_balls_meet_is_the_first_ball_alone():
    subject = of_scene("mine", replace(scenes.break_of_fifteen(), ball_restitution=0.9))
    assert not subject.lines(1.0).meeting
    assert engines.lossless(subject.lines(1.0))


def test_the_best_is_the_fastest_of_the_least_wrong():
    points = [
        Point("s", str(k), 0.0, e, s, None, 0.0, False, 5) for k, (e, s) in enumerate([(1, 1), (0.1, 5), (0.15, 2)])
    ]
    assert tables.best(points).setting == "2"


def test_the_diagram_is_xml_with_a_panel_a_scene(box):
    root = ElementTree.fromstring(work_precision_svg([box, box], "machine & versions"))
    words = "".join(root.itertext())
    assert words.count("nothing grows but the rounding") == 2
    assert "machine & versions" in words


@pytest.mark.parametrize("scenes", [1, 2, 3, 4, 7])
def test_the_diagram_leaves_no_third_of_its_width_blank(box, scenes):
    svg = work_precision_svg([box] * scenes)
    groups = re.findall(r'<g transform="translate\(([\d.]+) ([\d.]+)\)">(.*?)</g>\n?(?=<g transform|</svg>)', svg, re.S)
    assert len(groups) == scenes + 1
    ends = {}  # of what stands in each row: panels, and words of the legend of some 5 pixels a letter
    for x, y, inside in groups:
        own = [float(width) for width in re.findall(r'<rect class="field" width="([\d.]+)"', inside)]
        own += [float(a) + 5 * len(b) for a, b in re.findall(r'<text class="ink" x="([\d.]+)"[^>]*>([^<]*)', inside)]
        ends[y] = max(ends.get(y, 0.0), float(x) + max(own))
    assert min(ends.values()) > 2 / 3 * WIDTH
    bottom = max(float(y) for _, y, _ in groups)
    assert float(re.search(r'height="([\d.]+)"', svg)[1]) - bottom < 400  # nor a row below


def test_points_without_a_figure_are_left_out_of_the_diagram():
    nan = float("nan")
    found = Contest("x", "", 5, 1.0, 0.0, [Point("exact, lines", "", 0, nan, nan, None, 0, False, 0)])
    assert "nan" not in work_precision_svg([found])


def test_the_page_loads_nothing(box):
    page = report_html(Report(machine(), [box]))
    assert "<script" not in page
    assert "src=" not in page
    assert "Every figure" in page


def test_json_is_plain(box):
    text = json.dumps(Report(machine(), [box]).to_json(), allow_nan=False)
    assert json.loads(text)["scenes"][0]["points"][0]["series"] == "exact, lines"


def test_flattening_keeps_the_tolerance():
    walls = scenes.stadium()
    lines = flattened(walls, 1e-3)
    assert not lines.has_arcs
    a, b = lines.vertices, np.roll(lines.vertices, -1, axis=0)
    middle = (a + b) / 2
    across = np.hypot(np.maximum(np.abs(middle[:, 0]) - 100.0, 0.0), middle[:, 1])
    assert np.all(across <= 100.0 + 1e-12)
    assert np.all(across >= 100.0 - 1e-3)
    subject = of_scene("mine", Scene(scenes.box(), Balls([(1.0, 1.0)], [(1.0, 0.5)])))
    assert subject.arcs is None
    assert np.array_equal(subject.lines(1.0).walls.vertices, scenes.box().vertices)


def test_a_scene_with_gravity_and_losses_is_flown_by_those_who_know_both():
    walls = Walls.from_polylines([scenes.stadium().vertices], bulges=[scenes.stadium().bulges], material=Material(0.9))
    scene = Scene(walls, Balls([(0.0, 0.0), (1.0, 1.0)], [(30.0, 20.0), (0.0, 0.0)], 5.0), gravity=(0.0, -20.0))
    found = contest(of_scene("mine", scene), SMALL)
    assert set(found.series()) == {"exact, lines", "exact, arcs", *(f"step, {way}" for way in METHODS)}
    # coordinates up to 200 and a few operations a bounce; the reference finds the quartic's roots in its own way
    assert found.series()["exact, arcs"][0].error < 1e-11
    assert found.series()["step, exact"][0].error < 1e-11
    assert np.isnan(found.points[0].drift)


def test_a_scene_without_a_ball_is_refused():
    with pytest.raises(SceneError, match="no ball"):
        of_scene("mine", Scene(scenes.box()))


def test_an_open_wall_keeps_its_ends():
    wall = Walls.from_polylines([[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)]], closed=False, bulges=[[0.5, 0.0, 0.0]])
    lines = flattened(wall, 1e-3)
    assert lines.vertices[0].tolist() == [0.0, 0.0]
    assert lines.vertices[-2:].tolist() == [[1.0, 0.0], [2.0, 0.0]]
    assert not lines.closed[0]


def test_the_command_writes_page_and_table(tmp_path):
    target = tmp_path / "report.html"
    result = CliRunner().invoke(app, ["report", "--quick", "--scene", "box", "-o", str(target), "--precision", "106"])
    assert result.exit_code == 0, result.output
    assert "exact, lines" in result.stdout
    assert target.read_text().startswith("<!doctype html>")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--scene", "moon"], "no built-in scene 'moon'"),
        (["-o", "report.pdf"], "cannot be written"),
        (["--hard", "--scene", "box"], "takes no FILE"),
        (["file.svg", "--scene", "box"], "built-in scene"),
    ],
)
def test_wrong_use_is_told(arguments, words):
    result = CliRunner().invoke(app, ["report", *arguments])
    assert words in str(result.exception)


def test_known_answers_are_shown_and_counted(monkeypatch):
    outcomes = [Verdict("1", "1", 0.0, 0.0, ""), Verdict("1", "2", np.float64(1.0), np.float64(0.5), "")]
    cases = [Case(f"case {k}", "group", "", False, lambda o=o: o) for k, o in enumerate(outcomes)]
    monkeypatch.setattr("wallkit.accuracy.cases.all_cases", lambda: cases)
    result = CliRunner().invoke(app, ["report", "--hard"])
    assert result.exit_code == 1
    assert "ok   case 0" in result.stdout
    assert "FAIL case 1" in result.stdout
    plain = json.loads(CliRunner().invoke(app, ["report", "--hard", "--json"]).stdout)
    assert [row["holds"] for row in plain["cases"]] == [True, False]
