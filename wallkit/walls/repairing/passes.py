"""Repair: named passes that can each be left out, say what they changed and moved, and change nothing twice.

The order, and why: ends are snapped before they are joined; joined walls can be duplicates of others; without
duplicates the crossings are real ones; crossings of a wall with itself are resolved before walls are united, since
a union needs valid rings; both can leave slivers; the fewest vertices remain to be simplified at the end.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

from importers.problems import Problem
from wallkit.walls.checking.self_check import straight_edges, validate
from wallkit.walls.crossings import find_touches
from wallkit.walls.orient import is_arena, oriented
from wallkit.walls.repairing.areas import remove_slivers, resolve_crossings, unite
from wallkit.walls.repairing.ends import drop_duplicates, drop_zero_length, join_ends, simplify
from wallkit.walls.repairing.loose_walls import LooseWall, from_lines, to_lines
from wallkit.walls.repairing.repairs import Repairs
from wallkit.walls.repairing.snapping import snap_ends
from wallkit.walls.walls import Walls


@dataclass(frozen=True, slots=True)
class Change:
    """What one pass did.

    Attributes:
        step: the pass.
        count: how many things it changed.
        moved: how far at most anything moved, in the drawing's units.
        what: in words.
        at: a place where, or None.
    """

    step: str
    count: int
    moved: float
    what: str
    at: tuple[float, float] | None = None

    def to_problem(self) -> Problem:
        """Tell the change as an info problem."""
        x, y = self.at if self.at is not None else (None, None)
        message = f"{self.what}; moved by at most {self.moved:.3g}" if self.moved else self.what
        return Problem(f"repaired-{self.step}", "info", message, "look at the picture whether it is meant so", x=x, y=y)


@dataclass(frozen=True, slots=True, eq=False)
class Repaired:
    """Repaired walls, what was changed, and every violation that is left.

    Attributes:
        walls: nested and turned anew.
        changes: one a pass that changed anything.
        violations: of the self-check; empty means valid.
    """

    walls: Walls
    changes: list[Change] = field(default_factory=list)
    violations: list[Problem] = field(default_factory=list)


def repair(
    walls: Walls,
    repairs: Repairs,
    *,
    arena: bool | None = None,
    even_odd: Sequence[bool] = (),
    file_lines: Sequence[int | None] = (),
) -> Repaired:
    """Run the passes that ``repairs`` asks for, then check.

    Args:
        walls: any walls. Arcs stay arcs but for walls that are resolved or united: these become lines within a
            tenth of the tolerance.
        repairs: the passes.
        arena: the outermost closed walls are rooms; None asks the depths that the walls have.
        even_odd: one a wall: its self-crossings part material from none by the even-odd rule; nonzero if not
            given.
        file_lines: one a wall: its line in the file, for the report.

    Returns:
        The walls (their ``problems`` as before), the changes, and the violations left. Repairing the result
        again changes nothing.
    """
    room = is_arena(walls) if arena is None else arena
    lines = to_lines(walls, even_odd, file_lines)
    changes: list[Change] = []
    for step in _passes(repairs, walls.tolerance, room):
        lines, change = step(lines)
        if change.count:
            changes.append(change)
    result = from_lines(walls, lines)
    edges = straight_edges(result)
    touches = find_touches(edges)
    result = oriented(result, room, edges, touches)
    moved = max((change.moved for change in changes if change.step == "simplify"), default=0.0)
    result = replace(result, measured_error=walls.measured_error + moved)
    origin = [line.file_line for line in lines]
    return Repaired(result, changes, validate(result, lines=origin, edges=edges, touches=touches))


Pass = Callable[[list[LooseWall]], tuple[list[LooseWall], Change]]


def _passes(repairs: Repairs, tolerance: float, arena: bool) -> list[Pass]:
    """The passes asked for, in order."""

    def told(step: str, work: Callable[[list[LooseWall]], tuple[list[LooseWall], int, float, str, object]]) -> Pass:
        def run(lines: list[LooseWall]) -> tuple[list[LooseWall], Change]:
            result, count, moved, what, at = work(lines)
            place = None if at is None else (float(at[0]), float(at[1]))  # type: ignore[index]
            return result, Change(step, count, moved, what, place)

        return run

    passes = [told("zero-length", drop_zero_length)]
    if repairs.snap:
        passes.append(told("snap", lambda lines: snap_ends(lines, repairs.snap)))
    if repairs.join or repairs.snap:
        passes.append(told("join", join_ends))
    if repairs.drop_duplicates:
        passes.append(told("duplicates", drop_duplicates))
    if repairs.resolve:
        passes.append(told("resolve", lambda lines: resolve_crossings(lines, tolerance)))
    if repairs.union:
        passes.append(told("union", lambda lines: unite(lines, tolerance, arena)))
    if repairs.min_width:
        passes.append(told("slivers", lambda lines: remove_slivers(lines, repairs.min_width, tolerance)))
    if repairs.simplify:
        passes.append(told("simplify", lambda lines: simplify(lines, repairs.simplify)))
    return passes
