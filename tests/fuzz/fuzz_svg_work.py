"""Looks for SVG files that cost much work a letter: it grows documents from a grammar, by counters and not by a clock.

    python tests/fuzz/fuzz_svg_work.py --minutes 60 --seed 1

A document is a list of pieces, each with a number of times that it is said. The work of reading it is counted in two
ways: the calls that Python makes (sys.setprofile), which nobody can forget to charge, and the steps that the budget of
work was charged. What costs most calls a letter lives on and is changed again. At the end it prints the costliest
documents, and those whose calls exceed their steps by most: there a loop draws too little on the budget.
"""

import argparse
import heapq
import random
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from importers.errors import WallkitError
from importers.svg.reader import Reader
from importers.svg.source import parse

NS = 'xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"'
SHAPES = [
    '<rect width="1" height="1"{a}/>',
    '<path d="M0 0{d}"{a}/>',
    '<circle r="calc(1px{c})"{a}/>',
    '<polygon points="{p}"{a}/>',
    "<text>{t}</text>",
    '<use href="#{i}"{a}/>',
    "<{i}{a}/>",
]
GROUPS = ["<g{a}>{x}</g>", "<defs>{x}</defs>", "<switch{a}>{x}</switch>", "<symbol{a}>{x}</symbol>"]
GROUPS += ["<svg{a}>{x}</svg>", "<clipPath{a}>{x}</clipPath>", "<linearGradient{a}>{x}</linearGradient>"]
ATTRIBUTES = [
    ' id="{i}"',
    ' class="{w}"',
    ' data-{i}="{t}"',
    ' style="{s}"',
    ' transform="{f}"',
    ' fill="url(#{i}){t}"',
    ' clip-path="url(#{i})"',
    ' mask="url(#{i})"',
    ' stroke="red" stroke-width="max(1px{m})"',
    ' {i}="{w}"',
    ' style="transform-box:fill-box;transform:scale(2)"',
    ' font-size="1.5em"',
    ' fill="var(--{i},{t})"',
]
SMALL = {
    "d": ["h1", " ", "a1 1 0 0 1 1 1", "q1 1 2 0", "#"],
    "c": [" + 1px", " * 2", " + (1px)"],
    "m": [",1px", ",min(1px,2em)"],
    "p": ["1 1 ", " ", "1e3,"],
    "t": ["a", " ", "x_x41_", "&amp;"],
    "w": ["a ", "b ", "x", " "],
    "f": ["scale(1)", "rotate(1 2 3)", " "],
    "s": ["fill:red;", "--a:var(--b) var(--b);", "--b:1;", "/**/x:1px;", "transform:rotate(1deg);", "fill:var(--a,b);"],
    "i": ["a", "b", "c"],
    "r": [
        ".a{fill:red}",
        "g .b{x:1px}",
        "[class~=x]{r:2px}",
        "rect:nth-child(2n){fill:red}",
        ":is(.a,.b) > *{fill:red}",
        ".a{& .b{fill:red}}",
        "* ~ *{fill:red}",
        ":not(:has(.x)){fill:red}",
        "@media not (width<1px){.a{fill:red}}",
        ".a{--a:var(--b);fill:var(--a)}",
    ],
}
LONGEST = 20_000


class Grower:
    """Makes and changes documents; a document is a list of (times, text)."""

    def __init__(self, seed):
        self.random = random.Random(seed)

    def fill(self, text, depth=0):
        """Put something in the place of each letter in braces."""
        out = []
        for index, piece in enumerate(text.replace("{", "\0").replace("}", "\0").split("\0")):
            out.append(piece if index % 2 == 0 else self.some(piece, depth))
        return "".join(out)

    def some(self, letter, depth):
        choice, times = self.random.choice, self.random.choice((0, 1, 1, 2, 3, 10, 60, 400))
        if letter == "x":
            kinds = SHAPES if depth > 3 else SHAPES + GROUPS
            return "".join(self.fill(choice(kinds), depth + 1) for _ in range(self.random.choice((0, 1, 2, 4)))) * (
                1 + times // 20
            )
        if letter == "a":
            return "".join({self.fill(one, 9).split("=")[0]: self.fill(one, 9) for one in self.attributes()}.values())
        if letter == "i":
            return choice(SMALL["i"])
        if letter == "t" and depth == 9 and times > 10:
            times = 10
        return choice(SMALL[letter]) * times

    def attributes(self):
        return self.random.sample(ATTRIBUTES, self.random.choice((0, 0, 1, 1, 2, 3)))

    def piece(self):
        if self.random.random() < 0.3:
            rules = [self.random.choice(SMALL["r"]) for _ in range(self.random.choice((1, 2, 5)))]
            return 1, "<style>" + "".join(rules * self.random.choice((1, 3, 30))).replace("<", "&lt;") + "</style>"
        return self.random.choice((1, 1, 2, 10, 100)), self.fill(self.random.choice(SHAPES + GROUPS))

    def change(self, document):
        """Give a neighbour of a document: a piece more, fewer, other, or said more often."""
        pieces = list(document)
        where = self.random.randrange(len(pieces))
        what = self.random.random()
        if what < 0.3:
            pieces.insert(where, self.piece())
        elif what < 0.5 and len(pieces) > 1:
            del pieces[where]
        elif what < 0.7:
            times, text = pieces[where]
            pieces[where] = max(1, int(times * self.random.choice((0.5, 2, 4)))), text
        else:
            pieces[where] = self.piece()
        return pieces


def written(document):
    return f"<svg {NS}>{''.join(text * times for times, text in document)}</svg>"


def cost(text):
    """Calls made and steps charged in reading a text; None when it is refused before it is walked."""
    calls = 0

    def count(frame, event, argument):
        nonlocal calls
        calls += event == "call" or event == "c_call"

    try:
        source = parse(text, "")
    except WallkitError:
        return None
    sys.setprofile(count)
    try:
        Reader(source).read()
    except WallkitError:
        pass
    finally:
        sys.setprofile(None)
    return calls, source.work.done


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--minutes", type=float, default=1.0)
    options.add_argument("--seed", type=int, default=0)
    options = options.parse_args()
    grower, end = Grower(options.seed), time.monotonic() + 60 * options.minutes
    alive, under, tried = [], [], 0
    while time.monotonic() < end:
        start = [grower.piece() for _ in range(3)]
        document = grower.change(grower.random.choice(alive)[2]) if alive and grower.random.random() < 0.7 else start
        text = written(document)
        found = cost(text) if len(text) <= LONGEST else None
        if found is None:
            continue
        tried += 1
        calls, steps = found
        heapq.heappush(alive, (calls / (500 + len(text)), tried, document))
        heapq.heappush(under, (calls / (20_000 + steps), tried, text, calls, steps))
        for best, most in ((alive, 40), (under, 10)):
            if len(best) > most:
                heapq.heappop(best)
    print(f"{tried} documents")
    for ratio, _, document in sorted(alive, reverse=True)[:5]:
        print(f"{ratio:8.1f} calls a letter: {written(document)[:300]}")
    for ratio, _, text, calls, steps in sorted(under, reverse=True)[:5]:
        print(f"{ratio:8.2f} calls a step ({calls:,} and {steps:,}, {len(text):,} letters): {text[:300]}")


if __name__ == "__main__":
    main()
