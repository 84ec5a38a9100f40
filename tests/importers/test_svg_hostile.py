"""Hostile files, made here: each ends in a typed error (or a drawing) under 5 s and 512 MB, in a process apart."""

import json
import resource
import subprocess
import sys
from pathlib import Path

import pytest

SVG = '<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" viewBox="0 0 10 10">'
SHAPE = "<circle r='1'/>"


def use_bomb(levels, width):
    groups = [f'<g id="g0">{SHAPE}</g>']
    groups += [f'<g id="g{i}">{f"<use href={chr(39)}#g{i - 1}{chr(39)}/>" * width}</g>' for i in range(1, levels + 1)]
    return f"{SVG}<defs>{''.join(groups)}</defs><use href='#g{levels}'/></svg>"


def entities(declarations, body=SHAPE):
    return f"<!DOCTYPE svg [{declarations}]>{SVG}{body}</svg>"


def laughs():
    nested = "".join(f'<!ENTITY e{i} "{f"&e{i - 1};" * 10}">' for i in range(1, 10))
    return entities(f'<!ENTITY e0 "ha">{nested}', "&e9;")


# name: how to make it (in the process that reads it), what the error names
HOSTILE = {
    "20,000 nested groups": ("SVG + '<g>' * 20_000 + '</g>' * 20_000 + '</svg>'", "256"),
    "nested groups in a huge file": (
        "SVG + '<g>' * 2_000 + '<!--' + 'x' * 10**7 + '-->' + '</g>' * 2_000 + '</svg>'",
        "256",
    ),
    "use of itself": ('SVG + \'<g id="a"><use href="#a"/></g></svg>\'', ""),
    "use of each other": ('SVG + \'<g id="a"><use href="#b"/></g><g id="b"><use href="#a"/></g></svg>\'', ""),
    "2 kB use bomb": ("use_bomb(12, 10)", "500,000"),
    "wide use bomb": ("use_bomb(3, 900)", "500,000"),
    "use of a big group": (
        "SVG + '<g id=\"a\">' + SHAPE * 2000 + '</g>' + '<use href=\"#a\"/>' * 2000 + '</svg>'",
        "1,000,000",
    ),
    "long chain of uses": (
        "SVG + ''.join(f'<use id=\"u{i}\" href=\"#u{i + 1}\"/>' for i in range(50_000)) + '</svg>'",
        "",
    ),
    "a million and one elements": ("SVG + '<g/>' * 1_000_001 + '</svg>'", "1,000,000"),
    "65 MiB": ("SVG + ' ' * (65 * 2**20) + '</svg>'", "64 MiB"),
    "billion laughs": ("laughs()", "entities in entities"),
    "one entity of 8 MB": ("entities('<!ENTITY a \"' + 'x' * 8_000_000 + '\">', '&a;' * 1000)", "1,024"),
    "65 entities": ("entities(''.join(f'<!ENTITY a{i} \"x\">' for i in range(65)))", "64"),
    "an entity of elements, often": ("entities('<!ENTITY a \"' + SHAPE * 60 + '\">', '&a;' * 200_000)", "64 MiB"),
    "an entity that is a file": (
        "entities('<!ENTITY a SYSTEM \"file:///etc/passwd\">', '<text>&a;</text>')",
        "outside",
    ),
    "a parameter entity": ("entities('<!ENTITY % a \"<!ENTITY b \\'c\\'>\"> %a;')", "entities"),
    "gzip bomb": ("gzip.compress(SVG.encode() + b' ' * 10**8)", "75 MB"),
    "one path of ten million signs": ("SVG + '<path d=\"M0 0' + '-' * 10**7 + '\"/></svg>'", ""),
    "blanks without end": ("SVG + '<path d=\"M0 0' + ' ' * 10**7 + 'x\"/></svg>'", ""),
    "one number of ten million digits": ("SVG + '<path d=\"M0 ' + '1' * 10**7 + '\"/></svg>'", ""),
    "transform without end": ("SVG + '<g transform=\"' + 'scale(1)' * 10**6 + '\"/></svg>'", "steps of work"),
    "brackets in a style sheet": ("SVG + '<style>a{b:' + '(' * 200_000 + '</style></svg>'", ""),
    "brackets in calc": ("SVG + '<rect width=\"calc(' + '(' * 100_000 + '\"/></svg>'", ""),
    "many rules on many elements": (
        "SVG + '<style>' + ''.join(f'.a{i} .b{i}{{fill:red}}' for i in range(2000)) + '</style>'"
        " + '<g class=\"a1\">' * 100 + SHAPE * 2000 + '</g>' * 100 + '</svg>'",
        "",
    ),
    "a selector that looks everywhere": (
        "SVG + '<style>rect ' + 'g ' * 40 + 'circle{r:2px}</style>' + '<g>' * 200"
        " + SHAPE * 1000 + '</g>' * 200 + '</svg>'",
        "steps of work",
    ),
    "a selector of five thousand parts": (
        "SVG + '<style>' + 'g ' * 5000 + '{fill:red} circle{r:3px}</style><circle/></svg>'",
        "",
    ),
    "forty names within brackets": (
        "SVG + '<style>:is(' + 'g ' * 40 + 'rect){r:2px} circle{r:3px}</style><circle/></svg>'",
        "",
    ),
    "brackets in brackets in a selector": (
        "SVG + '<style>' + ':is(g ' * 40 + 'rect' + ')' * 40 + '{r:2px} circle{r:3px}</style><circle/></svg>'",
        "",
    ),
    "thousands of siblings": (
        "SVG + '<style>rect ~ circle:nth-of-type(2){r:2px}</style>' + SHAPE * 5000 + '</svg>'",
        "",
    ),
    "a path as long as a file may be": ("SVG + '<path d=\"M0 0' + 'L1 1' * (15 * 2**20) + '\"/></svg>'", "3,000,000"),
    "points as many as a file may hold": (
        "SVG + '<polygon points=\"' + '1 1 ' * (15 * 2**20) + '\"/></svg>'",
        "3,000,000",
    ),
    "more segments than a drawing may have": (
        "SVG + ('<path d=\"M0 0' + 'h1' * 60_000 + '\"/>') * 20 + '</svg>'",
        "1,000,000",
    ),
    "a style attribute without end": ("SVG + '<g style=\"' + 'fill:red;' * 10**6 + '\"/></svg>'", ""),
    "a style sheet without end": (
        "SVG + '<style>' + 'a{fill:red}' * 10**5 + '</style>' + SHAPE * 100 + '</svg>'",
        "1,000,000",
    ),
    "many faults": ("SVG + '<path d=\"M0 0L#\"/>' * 30_000 + '</svg>'", ""),
    "boxes in boxes": (
        "SVG + '<g style=\"transform:scale(2);transform-box:fill-box\">' * 200 + SHAPE * 100 + '</g>' * 200 + '</svg>'",
        "",
    ),
    "blanks behind url(": ("SVG + '<g><rect width=\"1\" height=\"1\" fill=\"url(' + ' ' * 200 + 'x\"/></g></svg>'", ""),
    "a megabyte of blanks behind url(": (
        "SVG + '<g><rect width=\"1\" height=\"1\" fill=\"url(' + ' ' * 10**6 + 'x\"/></g></svg>'",
        "",
    ),
    "a comment full of document types": (
        "'<!--' + '<!DOCTYPE [' * 10**5 + '--><!DOCTYPE svg [ ]>' + SVG + '</svg>'",
        "",
    ),
    "comments that do not end": (
        "entities('<!ENTITY a \"<g/>\">', '&a;' + '<!--' * 250_000)",
        "not well-formed",
    ),
    "errors in no attribute beside a long text": (
        "SVG + '<style>path{d:path(\"M0 0L#\")}</style>' + '<path/>' * 200 + 'a' * 10**6 + '</svg>'",
        "",
    ),
    "errors in one long line": ("SVG + '<path d=\"M0 0L#\"/>' * 200 + ' ' * 3 * 10**7 + '</svg>'", ""),
    "errors behind long numbers": ("SVG + ('<path d=\"M0 0L' + '1' * 400 + '..\"/>') * 5000 + '</svg>'", ""),
    "a chain of a thousand names": ("SVG + '<' + 'a' * 10**6 + ' x=\"\"/></svg>'", ""),
    "a calc() of fifty thousand terms": (
        "SVG + '<rect width=\"calc(1px' + ' + 1px' * 50_000 + ')\" height=\"1\"/></svg>'",
        "letters of a length",
    ),
    "digits without end in a style": ("SVG + '<rect style=\"width:' + '1' * 5000 + 'px\" height=\"1\"/></svg>'", ""),
    "many declarations for many elements": (
        "SVG + '<style>circle{' + 'fill:red;' * 20_000 + '}</style>' + SHAPE * 2000 + '</svg>'",
        "",
    ),
    "one class said five thousand times": (
        "SVG + '<style>' + '.a{fill:red}' * 5000 + '</style>' + '<g class=\"a\"/>' * 2000 + '</svg>'",
        "steps of work",
    ),
    "hundreds of selectors on long attributes": (
        "SVG + '<style>' + ''.join(f'[a~=x{i}]{{fill:red}}' for i in range(500)) + '</style>'"
        " + ('<g a=\"' + 'y ' * 5000 + '\"/>') * 20 + '</svg>'",
        "steps of work",
    ),
    "many rules in the rule of a long selector": (
        "SVG + '<style>.a' + (':is(.a' + ',b' * 20 + ')') * 30 + '{' + '.a{fill:red}' * 500 + '}</style><g/></svg>'",
        "steps of work",
    ),
    "a long path shown often": (
        "SVG + '<path id=\"a\" d=\"M0 0' + ' ' * 100_000 + '\"/>' + '<use href=\"#a\"/>' * 2000 + '</svg>'",
        "",
    ),
    "many attributes shown often": (
        "SVG + '<rect id=\"a\" ' + ' '.join(f'a{i}=\"\"' for i in range(5000)) + '/>'"
        " + '<use href=\"#a\"/>' * 2000 + '</svg>'",
        "steps of work",
    ),
    "large defs in a group shown often": (
        "SVG + '<g id=\"a\"><defs>' + SHAPE * 20_000 + '</defs></g>' + '<use href=\"#a\"/>' * 500 + '</svg>'",
        "",
    ),
    "a hundred thousand names of elements": (
        "SVG + ''.join(f'<a{i}/>' for i in range(100_000)) + '</svg>'",
        "",
    ),
    "variables that double": (
        "SVG + '<style>g{' + ''.join(f'--a{i}:var(--a{i + 1}) var(--a{i + 1});' for i in range(40))"
        " + '--a40:red;fill:var(--a0)}</style>' + '<g/>' * 100 + '</svg>'",
        "",
    ),
    "rules in rules that double": (
        "SVG + '<style>.a{' + '&amp; &amp; {' * 40 + 'fill:red' + '}' * 41 + '</style><g class=\"a\"/></svg>'",
        "",
    ),
    "attributes by the thousand": ("SVG + '<g ' + ' '.join(f'a{i}=\"\"' for i in range(100_000)) + '/></svg>'", ""),
}

PROGRAM = """
import gzip, json, resource, sys, time
sys.path[:0] = [".", "tests", "tests/importers"]
from test_svg_hostile import *
from importers.read import read_drawing_text
from importers.errors import WallkitError
from processor import slowness

def most_memory():
    # KiB so far, of this program alone: what getrusage says begins with what the parent held at the fork
    with open("/proc/self/status") as status:
        return next(int(line.split()[1]) for line in status if line.startswith("VmHWM"))

for name, (expression, _) in HOSTILE.items():
    data = eval(expression)
    slow, start = slowness(), time.process_time()
    try:
        drawing = read_drawing_text(data)
        said = f"drawing of {len(drawing.paths)} paths"
    except WallkitError as error:
        said = f"{type(error).__name__} {error.message}"
    seconds = (time.process_time() - start) / slow
    data = drawing = None  # what one file holds is no cost of the next
    print(json.dumps([name, said, seconds, most_memory() // 1024]), flush=True)
"""


@pytest.fixture(scope="module")
def readings():
    """What was said of each file, in how many seconds, at how many MB at most so far; all in one process."""
    limit = 4 * 2**30  # of address space: a runaway ends here instead of taking the machine with it
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM],
        capture_output=True,
        text=True,
        timeout=900,
        cwd=Path(__file__).parents[2],
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)),
    )
    found = {name: rest for name, *rest in map(json.loads, done.stdout.splitlines())}
    assert len(found) == len(HOSTILE), done.stderr[-2000:]
    return found


@pytest.mark.parametrize("name", HOSTILE)
def test_a_hostile_file_costs_little_and_ends_in_a_typed_error_or_a_drawing(name, readings):
    said, seconds, megabytes = readings[name]
    names = HOSTILE[name][1]
    assert names in said
    assert said.startswith(("LimitError", "DrawingError") if names else ("LimitError", "DrawingError", "drawing"))
    assert seconds < 5  # of processor time, for the reading alone: the stated figure, on the stated processor
    assert megabytes < 512
