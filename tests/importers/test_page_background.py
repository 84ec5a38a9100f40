"""The rectangle of the page's size that programs paint behind everything."""

import pytest

from importers.drawing import Artboard, Drawing, DrawnPath, Subpath
from importers.page_background import note_background, page_background
from importers.read import read_drawing_text

HEAD = '<svg xmlns="http://www.w3.org/2000/svg" width="200" height="100">'
PAPER = '<rect id="paper" width="200" height="100" fill="white"/>'
SHAPE = '<path id="shape" d="M20 20H90V60z"/>'


def found(body, head=HEAD):
    problems = read_drawing_text(f"{head}{body}</svg>").problems
    return [problem.name for problem in problems if problem.code == "page-background"]


@pytest.mark.parametrize(
    "paper",
    [
        PAPER,
        '<path id="paper" d="M0 0H200V100H0z" fill="#fff" stroke="black"/>',
        '<polygon id="paper" points="0,100 0,0 200,0 200,100 0,100" fill="url(#g)"/>'
        '<linearGradient id="g"><stop/></linearGradient>',
        '<g transform="translate(4 96)"><polygon id="paper" fill="white" points="-4,4 -4,-96 196,-96 196,4 -4,4"/></g>',
        '<path id="none" d="M0 0H200V100H0z" fill="none"/><rect id="paper" x="-.5" width="201" height="100.5"/>',
    ],
)
def test_a_filled_rectangle_of_the_page_behind_everything_is_named(paper):
    assert found(paper + SHAPE) == ["paper"]


@pytest.mark.parametrize(
    "body",
    [
        SHAPE,
        PAPER,
        SHAPE + PAPER,
        PAPER.replace('"white"', '"none" stroke="black"') + SHAPE,
        PAPER.replace("200", "180") + SHAPE,
        PAPER.replace("rect", 'rect rx="20"') + SHAPE,
        PAPER.replace("rect", 'rect transform="rotate(1)"') + SHAPE,
        '<circle r="100" cx="100" cy="50"/>' + SHAPE,
        '<path d="M0 0H200V100H0zM5 5H9V9z"/>' + SHAPE,
        '<path d="M0 0H200V100H0V50H90z"/>' + SHAPE,
        PAPER.replace("rect", 'rect display="none"') + SHAPE,
    ],
)
def test_what_else_comes_first_is_no_page(body):
    assert found(body) == []


def test_an_artboard_is_a_page_too_and_what_clips_is_no_paper():
    paper = DrawnPath([Subpath([("M", 0, 0), ("L", 9, 0), ("L", 9, 5), ("L", 0, 5)], True)], fill="#ffffff")
    shape = DrawnPath([Subpath([("M", 1, 1), ("L", 2, 1), ("L", 2, 2)], True)], fill="#000000")
    drawing = Drawing("pt", "up", paths=[paper, shape], artboards=[Artboard("one", 0, 0, 9, 5)])
    assert page_background(drawing) is paper
    note_background(drawing)
    assert (drawing.problems[0].x, drawing.problems[0].y) == (0, 0)
    paper.clip = True
    assert page_background(drawing) is None
