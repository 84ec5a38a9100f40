#!/usr/bin/env bash
# ezdxf 1.4.5: what a good engineer guesses and what happens.
#
# Input: a square of four lines; the square and a triangle; both with one lone line far away, with a lone chain of two lines, and
#   with two lone lines. edgeminer.find_all_loops "returns all closed loops" of the edges.
# Guess: the square, or the square and the triangle; a loose line is no part of any loop and changes nothing.
# What happens: one loose line, or one loose chain, and the answer is empty: the loops that were found are thrown away. A second
#   loose line brings them back. A room with one stray stroke in its layer has no walls, and nothing is said;
#   find_all_simple_chains finds the rings each time.
set -euo pipefail
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check ezdxf==1.4.5 numpy==2.3.5
venv/bin/python -I - <<'PYTHON'
import sys

import ezdxf
from ezdxf import edgeminer, edgesmith

space = ezdxf.new().modelspace()


def lines(*points):
    return [space.add_line(start, end) for start, end in zip(points, points[1:])]


square = lines((0, 0), (10, 0), (10, 10), (0, 10), (0, 0))
triangle = lines((20, 0), (30, 0), (30, 10), (20, 0))
lone, other = lines((50, 0), (60, 0)), lines((70, 0), (80, 0))
chain = lines((50, 0), (60, 0), (60, 10))
DRAWINGS = {
    "square": (square, [4], 1),
    "square and a lone line": (square + lone, [], 1),
    "square and triangle": (square + triangle, [3, 4], 2),
    "and a lone line": (square + triangle + lone, [], 2),
    "and a lone chain of two": (square + triangle + chain, [], 2),
    "and two lone lines": (square + triangle + lone + other, [3, 4], 2),
}
print("ezdxf", ezdxf.__version__)
changed = False
for name, (drawn, expected, rings) in DRAWINGS.items():
    deposit = edgeminer.Deposit(list(edgesmith.edges_from_entities_2d(drawn)))
    loops = sorted(len(loop) for loop in edgeminer.find_all_loops(deposit))
    closed = [edgeminer.is_loop(chain) for chain in edgeminer.find_all_simple_chains(deposit)].count(True)
    print(f"{name}: loops of {loops} edges; rings among the simple chains: {closed}")
    changed |= loops != expected or closed != rings
sys.exit(int(changed))  # 1: this has changed
PYTHON
