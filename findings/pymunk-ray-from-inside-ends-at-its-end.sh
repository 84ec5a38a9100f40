#!/usr/bin/env bash
# pymunk 7.3.1: what a good engineer guesses and what happens.
#
# Input: a square from (0, 0) to (10, 10), and rays to (20, 5): from (-5, 5), from (5, 5) in the square, and from (0, 5) on a line.
# Guess: a hit has the point at which it is, so that point = start + alpha (end - start). From within there is no hit, or one where
#   the ray starts, at alpha = 0.
# What happens: from outside it is so. From within, and from on the line, alpha is 0 but the point is the end of the ray, 15 and 20
#   units away from where alpha says; the normal is that of the ray, or (0, 0). What is placed at the hit's point flies off.
set -euo pipefail
cd "$(mktemp -d)"
python3 -m venv venv && venv/bin/pip install -q pymunk==7.3.1
cat > run.py <<'PY'
import pymunk

print("pymunk", pymunk.version)
square, line = pymunk.Space(), pymunk.Space()
square.add(pymunk.Poly(square.static_body, [(0, 0), (10, 0), (10, 10), (0, 10)]))
line.add(pymunk.Segment(line.static_body, (0, 0), (0, 10), 0))
everything = pymunk.ShapeFilter()


def hit(space, start):
    """Alpha, point, and the point that alpha says."""
    end = pymunk.Vec2d(20, 5)
    found = space.segment_query_first(start, end, 0, everything)
    said = pymunk.Vec2d(*start).interpolate_to(end, found.alpha)
    print(start, "alpha", found.alpha, "point", found.point, "normal", found.normal, "by alpha", said)
    return found.alpha, found.point, said


alpha, point, said = hit(square, (-5, 5))
assert alpha == 0.2 and point == said == (0, 5)
for space, start in ((square, (5, 5)), (line, (0, 5))):
    alpha, point, said = hit(space, start)
    assert alpha == 0 and point == (20, 5) and said == start
PY
venv/bin/python run.py
