"""What many elements say alike is worked out once; each is read as if it stood alone."""

import itertools

import numpy as np
import pytest

from importers.read import read_drawing_text

HEAD = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 400 300" width="800" height="600">'
ATTRIBUTES = (
    ("transform", ("translate(3,4)", "rotate(30)", "scale(2) translate(1,1)", "scale(x)", "scale(1e999)")),
    ("style", ("fill:red", "stroke:blue;stroke-width:2", "opacity:0", "display:none", "--a:2;fill:var(--b,lime)")),
    ("fill", ("none", "#123456", "currentColor", "var(--c)")),
    ("stroke", ("#0f0", "none")),
    ("stroke-width", ("5%", "3", "1e999")),
    ("color", ("teal",)),
    ("visibility", ("hidden", "visible")),
    ("clip-path", ("url(#half)", "none")),
    ("data-wall", ("soft", "")),
    ("font-size", ("2em",)),
)
CLIP = '<clipPath id="half"><rect width="10" height="8"/></clipPath>'


def attributes(random, most=3):
    names = random.permutation(len(ATTRIBUTES))[: random.integers(0, most + 1)]
    return "".join(f' {name}="{random.choice(texts)}"' for name, texts in (ATTRIBUTES[n] for n in names))


def groups(random, count):
    made = []
    for number in range(count):
        title = random.choice(["", "", "<title>wall</title>", "<desc>[sensor]</desc>"])
        name = random.choice(["", "", ' data-name="gate"', f' id="g{number}"'])
        path = '<path d="M1,2L30,5 20,40Z"{}/>'
        paths = "".join(path.format(attributes(random)) for _ in range(2))
        inner = f"<g{attributes(random, 2)}>{paths}</g>"
        made.append(f"<g{name}{attributes(random, 2)}>{title}{inner}{paths}</g>")
    return made


def paths_of(body):
    return read_drawing_text(f"{HEAD}<g{body[0]}>{CLIP}{body[1]}</g></svg>")


def plain(path):
    clipped, path.clipped = path.clipped, None
    return path, clipped is None


@pytest.mark.parametrize("seed", range(6))
def test_each_group_among_many_is_read_as_it_is_alone(seed):
    random = np.random.default_rng(seed)
    outer, made = attributes(random, 2), groups(random, 60)
    together = paths_of((outer, "".join(made)))
    alone = [paths_of((outer, one)) for one in made]
    wanted = list(itertools.chain.from_iterable(drawing.paths for drawing in alone))
    assert [plain(path) for path in together.paths] == [plain(path) for path in wanted]
    for code in {problem.code for drawing in alone for problem in drawing.problems} & {"bad-number", "bad-transform"}:
        each = {problem.message for drawing in alone for problem in drawing.problems if problem.code == code}
        assert {problem.message for problem in together.problems if problem.code == code} == each


def test_a_number_that_is_too_large_is_told_at_every_element():
    path = '<path d="M1,2L30,5" transform="scale(1e999)"/>'
    drawing = read_drawing_text(f"{HEAD}{path * 5}</svg>")
    assert len([problem for problem in drawing.problems if problem.code == "bad-number"]) == 5
    columns = [problem.column for problem in drawing.problems if problem.code == "bad-number"]
    assert columns == sorted(set(columns))
