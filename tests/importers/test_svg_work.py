"""What a small file can ask for grows no faster than the file, or ends in an error that names the limit."""

import json

import pytest

from importers.errors import LimitError
from importers.limits import MAX_STEPS, STEPS_OF_AN_ELEMENT, Work
from importers.svg import variables
from importers.svg.reader import Reader
from importers.svg.source import STEPS_OF_A_FUNCTION, parse

NS = 'xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"'
RECT = '<rect width="1" height="1"/>'


def svg(body, before=""):
    return f"{before}<svg {NS}>{body}</svg>"


def uses(target, number):
    return target + '<use href="#a"/>' * number


# Each kind by its size: what grows with it is one thing, so work that is linear in the file doubles with it.
GROWING = {
    "blanks behind url(": lambda n: svg(f'<rect width="1" height="1" fill="url({" " * n}x"/>'),
    "blanks behind url(#a)": lambda n: svg(f'<rect width="1" height="1" fill="url(#a){" " * n}x"/>'),
    "references to entities of elements": lambda n: svg("&a;" * n, '<!DOCTYPE svg [<!ENTITY a "<g/>">]>'),
    "errors in long lines": lambda n: svg(f'<path d="M0 0L{" " * n}#"/>' * 3),
    "errors behind many attributes": lambda n: svg(
        f'<path {" ".join(f"a{i}={chr(39)}{chr(39)}" for i in range(n))} d="M#"/>'
    ),
    "errors that stand in no attribute": lambda n: svg(
        '<style>path{d:path("M0 0L#")}</style>' + "<path/>" * 20 + "a" * n
    ),
    "errors in numbers that do not end": lambda n: svg(f'<path d="M0 0L{"1" * n}.."/>'),
    "one class said often": lambda n: svg("<style>" + ".a{fill:red}" * n + "</style>" + '<g class="a"/>' * 20),
    "one class asked for often": lambda n: svg("<style>" + ".a" * n + "{fill:red}</style>" + '<g class="a"/>' * 20),
    "one class had often": lambda n: svg(f"<style>.a{{fill:red}}</style><g class='{'a ' * n}'/>"),
    "many declarations of one rule": lambda n: svg("<style>rect{" + "fill:red;" * n + "}</style>" + RECT * 20),
    "words of a long attribute": lambda n: svg(
        "<style>" + "".join(f"[a~=x{i}]{{fill:red}}" for i in range(10)) + f"</style><g a='{'y ' * n}'/>"
    ),
    "many selectors of words": lambda n: svg(
        "<style>" + "".join(f"[a~=x{i}]{{fill:red}}" for i in range(n)) + f"</style><g a='{'y ' * 50}'/>"
    ),
    "selectors in one :is()": lambda n: svg(
        f"<style>:is({','.join(f'.a{i}' for i in range(n))}){{fill:red}}</style><g class='b'/>"
    ),
    "rules in rules": lambda n: svg("<style>.a{" + "&amp; .b{fill:red}" * n + "}</style>"),
    "functions of a transform": lambda n: svg(f"<g transform='{'scale(1)' * n}'/>"),
    "functions of a transform in a style": lambda n: svg(f"<g style='transform:{'scale(1)' * n}'/>"),
    "a long path shown often": lambda n: svg(uses(f'<path id="a" d="M0 0{"h1" * 40}"/>', n)),
    "blanks of a path shown often": lambda n: svg(uses(f'<path id="a" d="M0 0{" " * n}"/>', 20)),
    "attributes shown often": lambda n: svg(
        uses(f"<g id='a' {' '.join(f'a{i}={chr(34)}{chr(34)}' for i in range(n))}/>", 20)
    ),
    "defs in a group shown often": lambda n: svg(uses(f'<g id="a"><defs>{RECT * n}</defs></g>', 20)),
    "a switch shown often": lambda n: svg(uses(f'<switch id="a">{RECT * n}</switch>', 20)),
    "tags that come down": lambda n: svg(
        f"<g {' '.join(f'data-a{i}={chr(34)}{chr(34)}' for i in range(n))}>{RECT * 20}</g>"
    ),
    "a chain of variables": lambda n: svg(
        "<style>g{" + "".join(f"--a{i}:var(--a{i + 1});" for i in range(n)) + f"--a{n}:red}}</style><g/>"
    ),
    "colours that only a parser of CSS reads": lambda n: svg("".join(f'<g fill="rgb({i}%,1%,2%)"/>' for i in range(n))),
    "lengths of calc(), all others": lambda n: svg("".join(f'<rect width="calc(1px*{i})"/>' for i in range(n))),
    "declarations that are wrong": lambda n: svg("<g style='" + "".join(f"x:a{i};" for i in range(n)) + "'/>"),
    "declarations of a sheet that are wrong": lambda n: svg(
        "<style>" + "".join(f"rect{{x:a{i}}}\n" for i in range(n)) + "</style>" + RECT
    ),
    "dashes without end": lambda n: svg(f'<rect stroke-dasharray="{"1e1 " * n}"/>'),
    "fallbacks side by side": lambda n: svg(f"<g style='fill:{'var(--a,b)' * n}'/>"),
}


def work(text):
    source = parse(text, "")
    Reader(source).read()
    return source.work.done


@pytest.mark.parametrize("kind", GROWING)
def test_twice_the_file_is_no_more_than_twice_the_work(kind):
    make = GROWING[kind]
    once, twice = (work(make(size)) for size in (600, 1200))
    assert twice < 2.3 * once


def bomb(levels, width):
    groups = [f'<g id="g0">{RECT}</g>']
    groups += [f'<g id="g{i}">{f"<use href={chr(39)}#g{i - 1}{chr(39)}/>" * width}</g>' for i in range(1, levels + 1)]
    return svg(f"<defs>{''.join(groups)}</defs><use href='#g{levels}'/>")


# What is more than the budget: how the file asks for it, and what the error says that the work was spent on
TOO_MUCH = {
    "copies of copies": (bomb(3, 10), "steps of work"),
    "many matches of one class": (
        svg("<style>" + ".a{fill:red}" * 200 + "</style>" + '<g class="a"/>' * 400),
        "declarations",
    ),
    "many selectors of long attributes": (
        svg(
            "<style>"
            + "".join(f"[a~=x{i}]{{fill:red}}" for i in range(50))
            + "</style>"
            + f"<g a='{'y ' * 4000}'/>" * 9
        ),
        "selectors",
    ),
    "a style sheet for the slow parser": (svg("<style>" + "a{fill:red}" * 600 + "</style>"), "style sheets"),
    "attributes shown too often": (
        svg(uses(f"<g id='a' {' '.join(f'a{i}={chr(34)}{chr(34)}' for i in range(500))}/>", 80)),
        "attributes",
    ),
    "a long calc()": (svg(f'<rect width="calc(1px{" + 1px" * 90})" height="1"/>'), "letters of a length"),
    "a long length that is inherited": (
        svg(f'<g style="stroke:red;stroke-width:max(1px{",1px" * 20_000})">{RECT * 9}</g>'),
        "letters of a length",
    ),
    "tags by the thousand": (
        svg(f"<g {' '.join(f'data-a{i}={chr(34)}{chr(34)}' for i in range(300))}>{RECT * 100}</g>"),
        "tags",
    ),
}


@pytest.mark.parametrize("kind", TOO_MUCH)
def test_more_than_the_budget_is_refused_by_the_name_of_the_limit(kind, monkeypatch):
    monkeypatch.setattr("importers.limits.MAX_STEPS", 30_000)
    text, named = TOO_MUCH[kind]
    source = parse(text, "a.svg")
    with pytest.raises(LimitError, match=named.replace("()", "")):
        Reader(source).read()
    assert source.work.done < 2 * source.work.most


def test_a_chain_of_parts_is_charged_for_each_element_that_it_is_tested_on():
    text = svg("<style>" + ".b .a{fill:red}" * 50 + "</style>" + '<rect class="a"/>' * 100)
    source = parse(text, "")
    Reader(source).read()
    assert source.work.spent["selectors"] > 2 * 50 * 100


def test_a_place_that_overflows_is_no_place():
    shape = '<path d="M0 0l-0,3.25.5.5.5"/>'
    drawing = Reader(parse(f'<svg {NS} viewBox="1e3 1e308 .5 .5" width="1" height="9">{shape}</svg>', "")).read()
    assert {problem.code for problem in drawing.problems} == {"bad-path-data", "bad-coordinate"}
    assert all(problem.y is None for problem in drawing.problems)
    json.dumps(drawing.to_json(), allow_nan=False)


def test_a_budget_says_what_most_of_it_was_spent_on():
    budget = Work("a.svg", letters=8, elements=2)
    budget.charge("this", 1000)
    budget.charge("that", MAX_STEPS // 2)
    with pytest.raises(LimitError) as caught:
        budget.charge("that", MAX_STEPS)
    most = MAX_STEPS + 2 + 2 * STEPS_OF_AN_ELEMENT
    assert caught.value.message == f"limit hit: steps of work, most of them on that, at most {most:,}"


def test_a_large_drawing_is_paid_for_by_its_own_size():
    shape = '<path class="a" style="fill:#{:06x};stroke:red" d="M0 0C1 1 2 2 3 3z"/>'
    text = svg("<style>.a{stroke-width:2}</style>" + "".join(map(shape.format, range(2000))))
    source = parse(text, "")
    assert len(Reader(source).read().paths) == 2000
    assert source.work.done < source.work.most - MAX_STEPS


def test_a_value_is_paid_for_when_it_is_first_met():
    """So a drawing of one colour is not refused for its size, and one where each value is another is."""
    same = work(svg('<g fill="rgb(1%,2%,3%)"/>' * 2000))
    other = work(svg("".join(f'<g fill="rgb({i}%,2%,3%)"/>' for i in range(2000))))
    assert other - same >= 1999 * STEPS_OF_A_FUNCTION


class Counted:
    """A pattern that counts how often it searches."""

    def __init__(self, pattern):
        self.pattern, self.searches = pattern, 0

    def search(self, *arguments):
        self.searches += 1
        return self.pattern.search(*arguments)


def test_fallbacks_in_fallbacks_are_looked_through_once_each(monkeypatch):
    searches = []
    for size in (200, 400):
        monkeypatch.setattr(variables, "_SIGN", Counted(variables._SIGN))
        work(svg(f"<g style='--a:{'var(--b,' * size}1{')' * size}'/>"))
        searches.append(variables._SIGN.searches)
    assert 0 < searches[1] < 2.3 * searches[0]
