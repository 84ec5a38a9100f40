"""Clips that are applied: what is seen becomes walls. Judges: closed forms, shapely, and the pixels of Ghostscript."""

from __future__ import annotations

import html
import io
import os
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pikepdf
import pytest
import shapely
from drawn import codes
from PIL import Image

import wallkit

HEAD = '<svg xmlns="http://www.w3.org/2000/svg" width="200" height="200">'


def svg(body, defs):
    return io.StringIO(f"{HEAD}<defs>{defs}</defs>{body}</svg>")


def clip(shapes, attributes=""):
    return f'<clipPath id="c" {attributes}>{shapes}</clipPath>'


def area(walls):
    return shapely.area(walls.to_shapely())


BIG = '<rect x="10" y="10" width="100" height="80" fill="red" clip-path="url(#c)"/>'


@pytest.mark.parametrize(
    ("shapes", "attributes", "expected"),
    [
        ('<rect x="50" y="50" width="100" height="100"/>', "", 60 * 40),
        ('<polygon points="10,10 110,10 10,90"/>', "", 4000),
        ('<rect x="0" y="0" width="50" height="200"/><rect x="30" width="40" height="200"/>', "", 60 * 80),
        ('<rect x="0.25" width="0.5" height="0.5"/>', 'clipPathUnits="objectBoundingBox"', 50 * 40),
        ('<rect width="50" height="50"/>', 'transform="translate(80 60)"', 30 * 30),
        ('<path d="M20 20h60v60h-60zM40 40h20v20h-20z"/>', "", 60 * 60),  # nonzero: the inner one is no hole
        ('<path d="M20 20h60v60h-60zM40 40v20h20v-20z"/>', "", 60 * 60 - 20 * 20),
        ('<path d="M20 20h60v60h-60zM40 40h20v20h-20z" fill-rule="evenodd"/>', "", 60 * 60),  # for fills alone
        ('<path d="M20 20h60v60h-60zM40 40h20v20h-20z" clip-rule="evenodd"/>', "", 60 * 60 - 20 * 20),
    ],
)
def test_a_filled_shape_becomes_what_is_seen_of_its_area(shapes, attributes, expected):
    walls = wallkit.import_walls(svg(BIG, clip(shapes, attributes)), apply_clips=True)
    assert area(walls) == pytest.approx(expected, rel=1e-12)
    assert "clip-not-applied" not in codes(walls)
    assert "clip-applied" in codes(walls)
    whole = wallkit.import_walls(svg(BIG, clip(shapes, attributes)))
    assert area(whole) == 8000
    assert "clip-not-applied" in codes(whole)


RINGS = '<path d="M20 20h60v60h-60zM40 40h20v20h-20zM10 70h50v15h-50z" {}/>'
STAR = '<polygon points="60,12 85,88 20,40 100,40 35,88" {}/>'
EVENODD = 'clip-rule="evenodd"'
FRAME = '<path id="p" d="M0 0h50v50h-50zM10 10h30v30h-30z"/>'
RULES = {
    "on the shape": clip(RINGS.format(EVENODD)),
    "on a star": clip(STAR.format(EVENODD)),
    "nonzero again": clip(STAR.format('clip-rule="nonzero"'), EVENODD),
    "for fills alone": clip(STAR.format('fill-rule="evenodd"')),
    "on the clip": clip(STAR.format(""), EVENODD),
    "around the clip": f"<g {EVENODD}>{clip(RINGS.format(''))}</g>",
    "around the clip, as a style": f'<g style="fill-rule:evenodd;clip-rule:evenodd">{clip(STAR.format(""))}</g>',
    "by a sheet": "<style>clipPath path { clip-rule: evenodd }</style>" + clip(RINGS.format("")),
    "inherited": f"<g {EVENODD}>" + clip(STAR.format('style="clip-rule:inherit"')) + "</g>",
    "initial": f"<g {EVENODD}>" + clip(STAR.format('style="clip-rule:initial"')) + "</g>",
    "two shapes": clip(STAR.format(EVENODD) + '<rect x="53" y="46" width="14" height="8"/>'),
    "through a use": f"<g {EVENODD}>{FRAME}</g>" + clip('<use href="#p" x="30" y="20"/>'),
    "a use that says it": FRAME + clip(f'<use href="#p" x="30" y="20" {EVENODD}/>'),
    "where the clip is named": clip(STAR.format("")) + f"|{EVENODD}",
}


@pytest.fixture(scope="module")
def seen(tmp_path_factory):
    """What Chromium shows of all cases, side by side: case to (200, 200) booleans."""
    names = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
    browser = os.environ.get("CHROMIUM") or next(filter(None, map(shutil.which, names)), None)
    if not browser:
        pytest.skip("no browser")
    folder = tmp_path_factory.mktemp("clips")
    pictures = "".join(f'<iframe srcdoc="{html.escape(drawn(case))}"></iframe>' for case in RULES)
    style = "<style>*{margin:0}iframe{border:0;width:200px;height:200px;float:left}</style>"
    (folder / "all.html").write_text(f"<!doctype html>{style}{pictures}")
    command = [
        browser,
        "--headless",
        "--no-sandbox",
        "--disable-gpu",
        "--hide-scrollbars",
        "--run-all-compositor-stages-before-draw",
    ]
    command += [f"--user-data-dir={folder / 'profile'}", f"--window-size=200,{200 * len(RULES)}"]
    command += [f"--screenshot={folder / 'all.png'}", (folder / "all.html").as_uri()]
    subprocess.run(command, check=True, capture_output=True, timeout=240)
    pixels = np.asarray(Image.open(folder / "all.png").convert("RGB"))
    return {case: pixels[200 * k : 200 * (k + 1), :200, 1] < 128 for k, case in enumerate(RULES)}


def drawn(case):
    defs, _, attribute = RULES[case].partition("|")
    shape = BIG.replace("/>", f" {attribute}/>").replace("red", "#000")
    margin = "<style>svg{display:block}</style>"
    return f"<style>*{{margin:0}}</style>{HEAD}<defs>{defs}</defs>{margin}{shape}</svg>"


@pytest.mark.browser
@pytest.mark.parametrize("case", RULES)
def test_the_rule_of_a_clip_is_that_of_a_browser(case, seen):
    text = drawn(case)
    walls = wallkit.import_walls(io.StringIO(text[text.index("<svg") :]), apply_clips=True)
    x, y = np.meshgrid(np.arange(200) + 0.5, np.arange(200) + 0.5)
    inside = walls.to_shapely().geoms[0]
    clear = ~shapely.dwithin(inside.boundary, shapely.points(x, y), 1.5)  # of edges, which a browser blurs
    shown = shapely.contains_xy(inside, x, y)
    assert clear.sum() > 30_000
    assert seen[case].any()
    np.testing.assert_array_equal(shown[clear], seen[case][clear])


def test_what_is_wholly_inside_keeps_its_curves_and_what_is_outside_goes():
    defs = clip('<rect x="50" y="50" width="100" height="100"/>')
    body = (
        '<g clip-path="url(#c)"><circle id="in" cx="100" cy="100" r="20"/><circle id="out" cx="20" cy="20" r="5"/></g>'
    )
    walls = wallkit.import_walls(svg(body, defs), apply_clips=True, curves="arcs")
    assert walls.names == ("in",)
    assert walls.has_arcs
    assert len(walls.vertices) <= 4
    assert not {"clip-not-applied", "outside-clip"} & set(codes(walls))


def test_a_circle_under_a_half_plane_is_half_a_disc_within_the_tolerance():
    body = '<circle cx="100" cy="100" r="50" fill="red" clip-path="url(#c)"/>'
    walls = wallkit.import_walls(svg(body, clip('<rect width="100" height="200"/>')), apply_clips=True, tolerance=1e-3)
    # The farthest that a chord of the circle is off is what the walls say of themselves, at its middle
    radius = np.hypot(*(walls.vertices - 100).T)
    on_circle = radius > 50 - 1e-6
    chords = np.hypot(*np.diff(walls.vertices[on_circle], axis=0).T)
    sagitta = 50 - np.sqrt(2500 - chords[chords < 50] ** 2 / 4)
    assert walls.measured_error == pytest.approx(sagitta.max(), rel=1e-3)
    assert 0 < walls.measured_error <= 1e-3
    # Chords within t of the circle leave less than its length times t
    assert area(walls) == pytest.approx(np.pi * 50**2 / 2, abs=np.pi * 50 * 1e-3)


def test_an_outline_that_is_cut_becomes_the_lines_that_are_seen():
    body = '<rect x="10" y="10" width="100" height="80" fill="none" stroke="red" clip-path="url(#c)"/>'
    walls = wallkit.import_walls(svg(body, clip('<rect x="50" y="-50" width="100" height="200"/>')), apply_clips=True)
    assert walls.closed.tolist() == [False]
    assert sorted(walls.vertices.tolist()) == [[50, 10], [50, 90], [110, 10], [110, 90]]


def test_clips_on_clips_cut_one_after_another_and_units_and_scale_come_after():
    defs = (
        clip('<rect x="50" y="0" width="200" height="200"/>')
        + '<clipPath id="d"><rect width="70" height="50"/></clipPath>'
    )
    body = f'<g clip-path="url(#d)">{BIG}</g>'
    assert area(wallkit.import_walls(svg(body, defs), apply_clips=True)) == pytest.approx(20 * 40)
    small = wallkit.import_walls(svg(body, defs), apply_clips=True, units="in", scale=2.0)
    assert area(small) == pytest.approx(20 * 40 / 96**2 * 4, rel=1e-12)


def test_masks_are_still_told_and_taken_whole():
    body = '<rect width="50" height="50" fill="red" mask="url(#m)"/>'
    walls = wallkit.import_walls(svg(body, '<mask id="m"><rect width="9" height="9"/></mask>'), apply_clips=True)
    assert area(walls) == 2500
    assert "mask-not-applied" in codes(walls)


def pdf(content, resources=None):
    document = pikepdf.new()
    page = document.add_blank_page(page_size=(200, 200))
    page.Contents = document.make_stream(content.encode())
    if resources is not None:
        page.Resources = resources(document)
    data = io.BytesIO()
    document.save(data)
    return io.BytesIO(data.getvalue())


STAR = "100 190 m 155 25 l 10 130 l 190 130 l 45 25 l h"


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        ("q 50 50 100 100 re W n 0 0 80 80 re f Q 0 0 10 10 re f", 30 * 30 + 100),
        ("50 50 100 100 re W n 60 60 100 100 re W n 0 0 200 200 re f", 90 * 90),
        ("q 2 0 0 2 10 10 cm 0 0 20 20 re W n Q 100 100 10 10 re f", 100),
        (f"{STAR} W* n 0 0 200 200 re f", None),
        (f"{STAR} W n 0 0 200 200 re f", None),
        (f"20 20 50 50 re W n {STAR} f*", None),
    ],
)
def test_clipping_paths_of_a_pdf(content, expected, tmp_path):
    walls = wallkit.import_walls(pdf(content), apply_clips=True)
    if expected is not None:
        assert area(walls) == pytest.approx(expected, rel=1e-12)
    if not shutil.which("gs"):
        pytest.skip("Ghostscript, the judge of the rest, is not installed")
    (tmp_path / "a.pdf").write_bytes(pdf(content).getvalue())
    out = tmp_path / "a.pgm"
    subprocess.run(["gs", "-q", "-o", out, "-sDEVICE=pgmraw", "-r144", tmp_path / "a.pdf"], check=True, timeout=60)
    pixels = np.frombuffer(out.read_bytes()[-400 * 400 :], dtype=np.uint8)
    # A pixel is a quarter of a square point; it is black when the shape touches it, so edges add half a pixel's width
    edge = shapely.length(walls.to_shapely())
    assert area(walls) == pytest.approx((pixels < 128).sum() / 4, abs=0.5 * edge)


def test_a_pdf_says_what_clips_and_soft_masks_cut_and_forms_end_at_their_box():
    drawing = wallkit.read_drawing(
        pdf("q 50 50 100 100 re W n 60 60 9 9 re f 0 0 80 80 re f 0 0 9 9 re f Q 0 0 9 9 re f")
    )
    told = {problem.code: problem.message for problem in drawing.problems}
    assert told["clip-not-applied"].startswith("2 shapes")
    assert told["outside-clip"].startswith("a shape")

    def masked(document):
        state = pikepdf.Dictionary(SMask=pikepdf.Dictionary(S=pikepdf.Name.Luminosity))
        none = pikepdf.Dictionary(SMask=pikepdf.Name("/None"))
        return pikepdf.Dictionary(ExtGState=pikepdf.Dictionary(G0=state, G1=none))

    drawing = wallkit.read_drawing(pdf("/G0 gs 0 0 9 9 re f /G1 gs 0 0 9 9 re f", masked))
    assert [problem.message[:7] for problem in drawing.problems if problem.code == "mask-not-applied"] == ["a shape"]

    def form(document):
        stream = document.make_stream(b"0 0 100 100 re f")
        stream.Type, stream.Subtype, stream.BBox = pikepdf.Name.XObject, pikepdf.Name.Form, [10, 10, 30, 40]
        return pikepdf.Dictionary(XObject=pikepdf.Dictionary(F=stream))

    assert area(wallkit.import_walls(pdf("2 0 0 2 0 0 cm /F Do", form), apply_clips=True)) == pytest.approx(40 * 60)


def test_a_clip_group_of_illustrator_cuts_what_is_in_it():
    text = "q 50 50 m 150 50 L 150 150 L 50 150 L 50 50 L h W n 0 0 m 80 0 L 80 80 L 0 80 L f Q 0 0 m 9 0 L 9 9 L f"
    data = "\n".join(
        [
            "%!PS-Adobe-3.0",
            "%%Creator: Adobe Illustrator(R) 8.0",
            "%%EndSetup",
            *text.replace(" Q", "\nQ\n").replace(" m", " m\n").replace(" L", " L\n").split("\n"),
            "%%EOF",
        ]
    )
    walls = wallkit.import_walls(io.StringIO(data), apply_clips=True)
    assert area(walls) == pytest.approx(30 * 30 + 9 * 9 / 2)
    assert "clip-not-applied" in codes(wallkit.import_walls(io.StringIO(data)))


def test_a_clip_that_crosses_itself_ten_thousand_times_ends_in_a_limit_by_name():
    angle = np.random.default_rng(3).uniform(0, 200, (600, 2))
    points = " ".join(f"{x:.3f},{y:.3f}" for x, y in angle)
    with pytest.raises(wallkit.WallkitError, match="crossings of a clip") as caught:
        wallkit.import_walls(svg(BIG, clip(f'<polygon points="{points}"/>')), apply_clips=True)
    assert caught.value.exit_code == 3


def test_the_samples_have_no_clip_that_cuts():
    for sample in sorted((Path(__file__).parents[2] / "samples").glob("*.svg")):
        assert "clip-not-applied" not in codes(wallkit.import_walls(sample)), sample.name


def test_clips_over_and_over_cost_one_and_hundreds_in_each_other_are_told():
    page = wallkit.read_drawing(pdf("0 0 200 200 re W n 9 9 190 190 re W n " * 20_000 + "0 0 99 99 re f"))
    assert "mask-not-applied" not in {problem.code for problem in page.problems}
    (path,) = [path for path in page.paths if not path.clip]
    assert path.clipped.outer.outer is None
    shrinking = "".join(f"{k / 9} 0 200 200 re W n " for k in range(300))
    page = wallkit.read_drawing(pdf(f"{shrinking} 0 0 99 99 re f"))
    assert "mask-not-applied" in {problem.code for problem in page.problems}
