"""What is solid: one decision for a drawing, with how it was made and why.

The fill of a path says what it is: a filled shape is solid, and an outline around filled shapes is the room that they
stand in. Only the outermost walls have to be asked about, since every wall inside another turns free into solid and
back. So each filled shape has a vote: at even depth it is solid when the outermost walls are solid, at odd depth when
they are rooms. Two kinds of filled shapes say nothing, for their paint may be a floor: those that other filled shapes
are painted upon, and those that a ball is drawn in. Where all votes agree they decide; else the balls do, all of them,
by the same count: a ball is free at even depth when the outermost walls are solid. Where they are as many for as
against, the shapes with balls in them vote too, and most votes decide. Whoever then stands in material is a finding
(``ball-in-material``).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, get_args

import numpy as np

from importers.drawing import DrawnPath
from wallkit import arguments
from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.globs import fits
from wallkit.walls.fields import WallsError

if TYPE_CHECKING:
    from wallkit.walls.edge_tree import Edges
    from wallkit.walls.import_options import ImportOptions

How = Literal["asked", "paint", "balls", "start", "default"]


@dataclass(frozen=True, slots=True)
class Solid:
    """Whether the outermost closed walls are rooms, and how that was decided.

    Attributes:
        room: they are rooms: free inside, material outside.
        how: ``"asked"`` by an option; ``"paint"``, the fills of shapes; ``"balls"``, those that are drawn or given;
            ``"start"``, the place where a ball was put since none was given; ``"default"``, nothing spoke: solid.
        why: the reason in words.

    Raises:
        WallsError: ``room`` is no truth value, ``how`` none of these words, or ``why`` no text.
    """

    room: bool
    how: How
    why: str

    def __post_init__(self) -> None:
        arguments.flag(self.room, "solid.room", error=WallsError, code="bad-walls")
        arguments.word(self.how, "solid.how", get_args(How), error=WallsError, code="bad-walls")
        arguments.text(self.why, "solid.why", error=WallsError, code="bad-walls")

    def sentence(self) -> str:
        """Say it with the option that says otherwise."""
        what, other = ("a room", "--solid") if self.room else ("solid", "--arena")
        return f"the outermost walls are {what}, since {self.why} ({other})"

    def to_json(self) -> dict[str, Any]:
        """Give it as the ``wallkit-walls`` format has it."""
        return {"room": self.room, "how": self.how, "why": self.why}


class Nested(NamedTuple):
    """Polylines with their nesting, as far as the decision asks.

    Attributes:
        edges: straight edges of all.
        depth: (W,) closed ones around each.
        parent: (W,) the smallest of these, or -1.
        paths: W, the drawn path of each.
    """

    edges: Edges
    depth: IntArray
    parent: IntArray
    paths: Sequence[DrawnPath]


def decide(nested: Nested, options: ImportOptions, balls: FloatArray) -> Solid:
    """Decide whether the outermost closed walls are rooms or solid.

    Args:
        nested: the walls, turned any way.
        options: ``arena``, ``solid`` and ``room`` are asked before anything else.
        balls: (n, 2) centres of all balls, drawn or given.

    Raises:
        WallsError: no closed wall has the name of ``room``, or those that have are rooms and solids.
    """
    if options.solid or options.arena:
        return Solid(options.arena, "asked", "that was asked for")
    if options.room:
        return _named(nested, options.room)
    around, inner = walls_around(nested.edges, balls)
    home = innermost(around, inner, nested.depth, len(balls))
    odd = np.append(nested.depth + 1, 0)[home] % 2 == 1  # the -1 of no wall finds the 0 at the end
    painted = _by_paint(nested, home, agreed=True)
    if painted:
        return painted
    if len(balls) and 2 * odd.sum() != len(balls):
        room = bool(2 * odd.sum() > len(balls))
        return Solid(room, "balls", _counted(int(odd.sum()), len(balls), room))
    return _by_paint(nested, home[:0], agreed=False) or Solid(False, "default", "no ball and no paint says otherwise")


def walls_around(edges: Edges, points: FloatArray) -> tuple[IntArray, IntArray]:
    """For (n, 2) points, list which closed walls are around which: (point, wall) pairs, by points.

    A wall is around a point when the ray straight up meets it an odd number of times; half-open in x, so that a
    vertex on the ray counts once.
    """
    nothing = np.empty(0, dtype=np.int64)
    if not len(points) or not len(edges):
        return nothing, nothing
    x, y = points.T
    top = np.maximum(y, float(edges.vertices[:, 1].max()) + 1)
    source, edge = edges.tree.meeting(np.stack([x, y]), np.stack([x, top]))
    p, a, b = points[source], edges.a[edge], edges.b[edge]
    spans = (np.minimum(a[:, 0], b[:, 0]) <= p[:, 0]) & (p[:, 0] < np.maximum(a[:, 0], b[:, 0]))
    with np.errstate(divide="ignore", invalid="ignore"):
        height = a[:, 1] + (p[:, 0] - a[:, 0]) * (b[:, 1] - a[:, 1]) / (b[:, 0] - a[:, 0])
    above = spans & (height > p[:, 1]) & edges.closed[edges.wall[edge]]
    count = len(edges.closed)
    keys, times = np.unique(source[above] * count + edges.wall[edge[above]], return_counts=True)
    around = keys[times % 2 == 1]
    return around // count, around % count


def innermost(around: IntArray, wall: IntArray, depth: IntArray, balls: int) -> IntArray:
    """Give for each ball the deepest wall around it, or -1."""
    home = np.full(balls, -1, dtype=np.int64)
    order = np.argsort(depth[wall], kind="stable")
    home[around[order]] = wall[order]  # the last one written is the deepest
    return home


def _by_paint(nested: Nested, home: IntArray, agreed: bool) -> Solid | None:
    """Let filled shapes vote; None where there is no majority, or not one of all of them when ``agreed`` is asked."""
    closed = nested.edges.closed
    filled = np.array([path.fill is not None for path in nested.paths], dtype=np.bool_) & closed
    owner = np.unique(np.array([id(path) for path in nested.paths], dtype=np.int64), return_inverse=True)[1].reshape(-1)
    inside = nested.parent >= 0
    same = inside & (owner == owner[nested.parent])  # a ring of a compound path: its outermost ring has the vote
    floor = np.zeros(len(closed), dtype=np.bool_)
    floor[nested.parent[filled & inside & ~same]] = True
    floor[home[home >= 0]] = True
    votes = filled & ~same & ~floor
    for_room, for_solid = votes & (nested.depth % 2 == 1), votes & (nested.depth % 2 == 0)
    if for_room.sum() == for_solid.sum() or (agreed and for_room.any() and for_solid.any()):
        return None
    room = bool(for_room.sum() > for_solid.sum())
    decisive = for_room if room else for_solid
    count = int(decisive.sum())
    name = nested.paths[int(np.flatnonzero(decisive)[0])].name
    which = f"the shape {name!r} is" if count == 1 and name else f"{count} {'shape is' if count == 1 else 'shapes are'}"
    return Solid(room, "paint", f"{which} filled" + (" and in it" if room else ""))


def _named(nested: Nested, name: str) -> Solid:
    from wallkit.walls.roles import plain_name

    closed = np.flatnonzero(nested.edges.closed).tolist()
    named = [
        index
        for index in closed
        if any(fits(called, name) for called in (nested.paths[index].name, plain_name(nested.paths[index].name)))
    ]
    if not named:
        known = ", ".join(sorted({repr(nested.paths[index].name) for index in closed if nested.paths[index].name}))
        raise WallsError(
            f"no closed wall has the name {name!r}", code="no-such-wall", fix=f"the names are: {known[:500] or 'none'}"
        )
    odd = nested.depth[named] % 2 == 1
    if odd.any() and not odd.all():
        raise WallsError(
            f"of the walls named {name!r} one is inside another: not all can be rooms",
            code="no-such-wall",
            fix="name one of them",
        )
    return Solid(not odd.any(), "asked", f"the wall {name!r} was said to be a room")


def _counted(inside: int, all_: int, room: bool) -> str:
    count = inside if room else all_ - inside
    whole = "the ball is" if all_ == 1 else "all balls are"
    words = whole if count == all_ else f"{count} of {all_} balls are"
    return f"{words} {'in it' if room else 'free so'}"
