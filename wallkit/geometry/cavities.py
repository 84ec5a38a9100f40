"""Triangles for what is on one side of a segment that has taken the place of edges."""

from __future__ import annotations

import numpy as np

from wallkit.geometry.orientation import in_circle, side_of

Triangle = tuple[int, int, int]
Place = tuple[float, float]

_MANY = 48  # corners: arrays are quicker from there on
_ROUNDING = 2.0**-48  # of the product of two lengths: more than cross and dot products are off


def filled(at: list[Place], a: int, b: int, chain: list[int]) -> list[Triangle]:
    """Triangulate the polygon from a to b, left of that segment, and on along a chain of points back to a.

    All of it is seen from crossed edges, and edges may hang in it: then points come again in the chain. The triangle at
    the segment is the one whose circle holds no other point of the chain; what is left are polygons at its two other
    sides (M. V. Anglada, An improved incremental algorithm for constructing restricted Delaunay triangulations, 1997).

    Args:
        at: the places of points.
        a: begin of the segment.
        b: its end.
        chain: points, at least one.
    """
    result: list[Triangle] = []
    waiting = [(a, b, 0, len(chain))]
    while waiting:
        a, b, begin, end = waiting.pop()
        if begin == end:
            continue
        part = chain[begin:end]
        k = _seeing_most(at, a, b, part)
        if part.count(part[k]) > 1:
            k = _facing(at, a, b, part, part[k])
        k += begin
        c = chain[k]
        result.append((a, b, c))
        waiting += [(c, b, begin, k), (a, c, k + 1, end)]
    return result


def _seeing_most(at: list[Place], a: int, b: int, chain: list[int]) -> int:
    """The point left of the line from a to b whose circle through both holds no other one that is."""
    if len(chain) == 1:
        return 0
    best, rows = _first_guess(at, a, b, chain) if len(chain) >= _MANY else (-1, range(len(chain)))
    for k in rows:
        if side_of(at[a], at[b], at[chain[k]]) <= 0:
            continue
        if best < 0 or in_circle(at[a], at[b], at[chain[best]], at[chain[k]]) > 0:
            best = k
    return best


def _first_guess(at: list[Place], a: int, b: int, chain: list[int]) -> tuple[int, list[int]]:
    """The one that sees a and b under the largest angle, of the least cotangent, and those that may be in its circle.

    Sure is where the two angles on one side of a chord differ by more than rounding: (cot w - cot c) of all others.
    """
    places = np.array([at[point] for point in chain])
    u, v = np.array(at[a]) - places, np.array(at[b]) - places
    cross, dot = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0], (u * v).sum(axis=1)
    size = np.sqrt((u * u).sum(axis=1) * (v * v).sum(axis=1))
    clear = np.flatnonzero(cross > _ROUNDING * size)
    if not len(clear):
        return -1, list(range(len(chain)))
    best = int(clear[(dot[clear] / cross[clear]).argmin()])
    beyond = dot * cross[best] - dot[best] * cross > 4 * _ROUNDING * size * size[best]
    rows: list[int] = np.flatnonzero(~beyond | (cross <= _ROUNDING * size)).tolist()
    return best, [k for k in rows if k != best]


def _facing(at: list[Place], a: int, b: int, chain: list[int], c: int) -> int:
    """Of the places in the chain where a point comes, that at which the triangle from a to b to it is inside."""
    around = [b, *chain, a]
    places = [k for k, point in enumerate(chain) if point == c]
    return next((k for k in places if _within(at, c, around[k + 2], around[k], a, b)), places[0])


def _within(at: list[Place], c: int, following: int, before: int, a: int, b: int) -> bool:
    """Whether the angle at c from a to b is within that from the point following to the one before, y up."""
    starts = a == following or (a != before and _between(at, c, following, before, a))
    return starts and (b == before or (b != following and _between(at, c, following, before, b)))


def _between(at: list[Place], c: int, first: int, last: int, x: int) -> bool:
    """Whether x is seen from c between two points, counter-clockwise from the first; all around if they are one."""
    if first == last:
        return True
    if side_of(at[c], at[first], at[last]) > 0:
        return side_of(at[c], at[first], at[x]) >= 0 and side_of(at[c], at[x], at[last]) >= 0
    return not (side_of(at[c], at[last], at[x]) > 0 and side_of(at[c], at[x], at[first]) > 0)
