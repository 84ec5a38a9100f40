"""The index: square cells that list what a ball in them can meet, the crowded ones divided into smaller cells.

At a contact the centre is at the distance r from what it touches: on one of two lines beside an edge, or on the
arc around a corner that lies between the normals of its edges. An entry is in every cell which that locus crosses
or passes within a margin of (for radii from r to R: within the band between the two). The margin is far above the
rounding of a position and of a cell's border, so a contact is always listed in the cell in which the centre is at
that time: the walk through the cells may stop at the first cell that contains its best contact.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.kernels.index.cell_chains import chains_in_cells
from wallkit.kernels.index.cell_entries import ALL_OCTANTS, Table, describe, enter, sort
from wallkit.kernels.index.empty_rectangles import clear, clear_ahead, clear_departures
from wallkit.kernels.intrinsics import AT_ONCE
from wallkit.kernels.records import BLOCK, CELL, OCTANTS, QUADRANTS, Block, Grid, Model
from wallkit.simulation.aligned_arrays import keep_freed_memory, on_cache_lines
from wallkit.simulation.by_kernels import Kernels

MARGIN = 2.0**-16
"""Of the side of a cell: far above the rounding of its border, which is given by a number below 2^30 (2^-23)."""
ROUNDING = 2.0**-39
"""Of the largest coordinate, added to the margin: far above the rounding of a position, and four times what a point
under gravity may be off (``FALLING_TOLERANCE``)."""
SMALLEST = 2.0**-28
"""Side of the smallest cells, in parts of the largest coordinate: what ROUNDING adds to them is 2^-11 of their side."""
FINE, COARSE, PER_EDGE = 0.2, 0.6, 0.8
"""Side of the cells before any is divided, measured: 0.8 of the mean length of an edge, so that a cell that lists
something lists one or two. In units of sqrt(area / edges) it is at least 0.2 (25 cells an edge; more fall out of the
cache), and at most 0.6 (where edges are long and many meet)."""
ONCE, MANY = 0.8, 1_000
"""Side, in the same units, of the cells among so many edges or more for few flights without gravity: in curves and
mazes of 3,000 lines and more that are half as many cells to make as at 0.6, and flights are as quick. Under gravity the
way along a wall is gone cell by cell, and rounded at each of their borders."""
WORTH_SMALL_CELLS = 12.0
"""Flights an edge from which on the smaller cells pay, measured: they are 0.8 to 1.8 us an edge more to make in a curve
of 10,000 lines, 0.1 us in a maze, and a flight among them takes some 60 ns less, and 4 ns."""
WORTH_DEPARTURES = 1.0
"""Flights an edge from which on departures pay: they are some 90 ns an edge to make, and save 80 ns a flight (points
in a curve of 10,000 lines)."""
MOST_CELLS = 2.0**18
"""Beyond this many, which a cache may hold, there are at most two an edge: no slower to fly among, quicker to make."""
WORTH_OCTANTS = 0.25
"""Part of the octants in which cells that list something must be clear, if octants are to be told apart: half of them
where cells are small beside discs, few where they are not. Quarters need less memory."""
SPARSE = 0.25
"""Part of the cells that may list something for departures to be worth making, and clearings to lie octant by octant
for long."""
WORTH_PACKING, WORTH_PACKING_SPARSE = 2.0**17, 2.0**19
"""Cells from which on memory is asked less often where clearings lie with their cells: earlier if many of these list
something, for then both are read."""
CROWDED = 16
"""A cell with more entries is divided."""
MOST_BITS = 7
"""A cell is divided into at most 2^7 by 2^7: more would be empty, mostly."""
GROWTH, AT_LEAST = 64, 1 << 12
"""Entries there may be, in all, for each one to be entered, and at the least. Divided cells list long edges over and
over, and cells around a vertex at which a thousand edges meet are crowded however small they are."""


@dataclass(eq=False, repr=False)
class _Level:
    """Cells of blocks, and the ids that they list; ``divided`` cells are the ``parts`` of the next level."""

    blocks: NDArray[Any]
    numbers: NDArray[np.int32]
    """(cells + 1, 4) see ``Cell``."""
    ids: NDArray[np.uint32]
    octants: NDArray[np.uint8]
    """By cell, see ``Table``; for the first level alone, and for discs alone."""
    divided: IntArray = field(default_factory=lambda: np.empty(0, dtype=np.int64))
    parts: NDArray[Any] = field(default_factory=lambda: np.empty(0, dtype=BLOCK))

    def of_blocks(self, cells: IntArray, *names: str) -> tuple[NDArray[Any], ...]:
        """Give numbers of the block that each cell is in."""
        which = np.searchsorted(self.blocks["first"], cells, side="right") - 1
        return tuple(self.blocks[name][which] for name in names)


def build_grid(
    model: Model,
    fans: NDArray[Any],
    box: FloatArray,
    radii: tuple[float, float],
    extent: float,
    *,
    machine_code: bool = False,
    flights: float = 0.0,
) -> tuple[Grid, NDArray[Any], NDArray[np.uint32], NDArray[np.int16]]:
    """Sort edges and corners into cells.

    Args:
        model: with one cell that lists all there is to enter.
        fans: ``Fan`` by vertex.
        box: (2, 2) lowest and highest corner of a box that no edge reaches beyond.
        radii: smallest and largest distance of a centre at a contact.
        extent: largest absolute coordinate of a centre.
        machine_code: use compiled kernels; the same cells come of both.
        flights: so many are to come, an edge: many pay for small cells, of which there are more to make, and which
            list fewer entries to look at.

    Returns:
        The grid, its cells (``CELL``), the ids that they list, and the clearings (see ``Model``).
    """
    keep_freed_memory()
    work = _Work(model, fans, radii, extent, machine_code)
    finest = SMALLEST * extent
    level: _Level | None = _first_level(work, model, box, flights >= WORTH_SMALL_CELLS)
    levels = []
    while level is not None:
        levels.append(level)
        level = _next_level(work, level, finest)
    top = levels[0].blocks[0]
    unit = min(float(level.blocks["side"].min()) for level in levels)
    shift = int(math.log2(top["side"] / unit))
    ids = np.concatenate([*(level.ids for level in levels), np.zeros(AT_ONCE, dtype=np.uint32)])
    size = int(top["columns"]), int(top["rows"])
    octants, *kinds = work.octants(levels[0], flights)
    grid = Grid(float(top["x0"]), float(top["y0"]), unit, 1.0 / unit, shift, *size, *kinds)
    cells = _joined(work, levels, grid.packed)
    clearings = cells.view(np.int16) if grid.packed else work.clearings(grid)
    work.clear(grid, octants, clearings)
    if grid.departs:
        work.depart(model, levels[0], grid, clearings)
    return grid, cells, ids, np.asarray(clearings, dtype=np.int16)


def _joined(work: _Work, levels: list[_Level], packed: int) -> NDArray[Any]:
    """Put the cells of all levels one after the other, and what divided cells say in place of where ids begin.

    The ids that a divided cell listed stay where they are: nobody asks for them.
    """
    joined = on_cache_lines(sum(len(level.numbers) - 1 for level in levels) << packed, CELL)
    rows, cells, ids = joined.view(np.uint32).reshape(-1, 4 << packed), 0, 0
    farthest = max(1, sum(len(level.ids) for level in levels))
    for level in levels:
        first, cells = cells, cells + len(level.numbers) - 1
        work.describe(level, ids, farthest, rows[first:cells])
        ids += len(level.ids)
        if len(level.divided):
            divided = first + level.divided
            rows[divided, :4] = 0
            rows[divided, 0] = (cells + level.parts["first"]) << packed
            rows[divided, 1] = np.log2(level.parts["columns"]).astype(np.int64)
    return joined


class _Work(Kernels):
    """Kernels, compiled or not, and what they are given in every call."""

    def __init__(
        self, model: Model, fans: NDArray[Any], radii: tuple[float, float], extent: float, machine_code: bool
    ) -> None:
        super().__init__(machine_code)
        self.budget = GROWTH * len(model.ids) + AT_LEAST
        self.distance, self._spread = sum(radii) / 2, (radii[1] - radii[0]) / 2
        self._rounding = extent * ROUNDING
        corners = (model.corners, fans) if len(fans) else (None, None)
        shared = model.lines, model.arcs, *corners
        self._shared = self.given(shared)
        self._falls = model.gravity is not None

    def reach(self, side: Any) -> Any:
        """How far beyond its locus an entry goes."""
        return self._spread + side * MARGIN + self._rounding

    def enter(
        self, blocks: NDArray[Any], source: NDArray[np.uint32], room: int, octants: bool
    ) -> tuple[Table, IntArray]:
        """Enter what blocks speak of, and note as many entries as there is room for: (the table, entries by block)."""
        cells = int((blocks["columns"] * blocks["rows"]).sum())
        entered, found = self.zeros(len(blocks), np.int64), self.zeros(octants * cells, np.uint8)
        counted, ids = self.room(room, np.uint32), self.room(room, np.uint32)
        table = Table(self.zeros(4 * cells + 4, np.int32), found, counted, ids)
        asked = self.given((blocks, source))
        self.run(enter, *asked, *self._shared, self.distance, table, entered)
        return table, np.asarray(entered)

    def sort(
        self, blocks: NDArray[Any], source: NDArray[np.uint32], table: Table, entered: IntArray, top: bool
    ) -> _Level:
        """Make a level of what was entered; where that is more than was noted it is entered again."""
        count = int(entered.sum())
        if count > len(table.ids):
            table, _entered = self.enter(blocks, source, count, len(table.octants) > 0)
        ids = self.room(count, np.uint32)
        self.run(sort, table, ids)
        # A straight flight asks how far the next entries are in parts of cells alone: elsewhere it has clearings.
        if self._falls or not top:
            self.run(clear, self.given(blocks), table.numbers, top)
        numbers = np.asarray(table.numbers, dtype=np.int32).reshape(-1, 4)
        return _Level(blocks, numbers, np.asarray(ids, dtype=np.uint32), np.asarray(table.octants, dtype=np.uint8))

    def describe(self, level: _Level, ids: int, farthest: int, rows: NDArray[np.uint32]) -> None:
        """Write the cells of a level as ``Cell`` has them into the first four columns; ``ids`` come before theirs."""
        numbers = level.numbers.ravel()
        if self.machine_code:
            self.run(describe, numbers, ids, farthest, rows.reshape(-1), 0, rows.shape[1])
            return
        cells = [0] * (len(numbers) - 4)
        self.run(describe, numbers.tolist(), ids, farthest, cells, 0, 4)
        rows[:, :4] = np.array(cells, dtype=np.uint32).reshape(-1, 4)

    def octants(self, top: _Level, flights: float) -> tuple[NDArray[np.uint8], int, int, int]:
        """Find in which octants flights may meet something in the cells of the first level: (their bits, octants, ...).

        The others are what ``Grid`` says of them. Few cells list something where walls are far apart: there flights are
        long, and departures pay.
        """
        octants, count, cells = top.octants, OCTANTS, len(top.numbers) - 1
        if len(octants):
            # By how many bits are set: none where nothing is listed, for no edge is along all octants.
            sizes = np.bincount(octants, minlength=1 << OCTANTS)
            listing, clear = cells - int(sizes[0]), OCTANTS * cells - int(sizes @ _BITS) - OCTANTS * int(sizes[0])
            if clear < WORTH_OCTANTS * OCTANTS * listing:
                octants, count = octants | (octants >> np.uint8(4)), QUADRANTS
        else:
            lists = top.numbers[1:, 0] != top.numbers[:-1, 0]
            listing, count = int(np.count_nonzero(lists)), QUADRANTS
            octants = lists * np.uint8(ALL_OCTANTS)
        sparse = listing < SPARSE * cells
        packed = self.machine_code and cells > (WORTH_PACKING_SPARSE if sparse else WORTH_PACKING)
        departs = flights >= WORTH_DEPARTURES and sparse and not packed and self.distance == 0.0
        return octants, count, int(departs), int(packed)

    def clearings(self, grid: Grid) -> Any:
        """Make room for clearings and departures by octant."""
        return self.zeros((grid.octants + OCTANTS * grid.departs) * grid.columns * grid.rows, np.int16)

    def clear(self, grid: Grid, octants: NDArray[np.uint8], clearings: Any) -> None:
        """Find the clearings ahead of each cell of the first level, in each octant."""
        above = self.zeros(grid.columns, np.int16)
        self.run(clear_ahead, self.given(octants), grid, above, clearings)

    def depart(self, model: Model, top: _Level, grid: Grid, clearings: Any) -> None:
        """Find the clearings of balls that leave a wall."""
        (lines, arcs, _corners, _fans), edges, cells = self._shared, len(model.lines), grid.columns * grid.rows
        chain, listing = self.room(edges, np.int32), self.room(cells, np.int32)
        chains, along = self.zeros(4 * cells, np.int32), self.room(edges, np.uint16)
        listed = self.given((model.edge_wall, top.numbers.ravel(), top.ids))
        count = self.run(chains_in_cells, lines, arcs, *listed, along, chain, listing, chains)
        self.run(clear_departures, listing, count, chains, grid, clearings)


def _first_level(work: _Work, model: Model, box: FloatArray, fine: bool) -> _Level:
    """Enter all that the model's one cell lists; where that comes to too many entries, into larger cells."""
    first, arcs, corners, end = model.cells[0].tolist()
    width, height = (box[1] - box[0]).tolist()
    length = _mean_length(model)
    side = _side(width, height, corners, length, fine, model.gravity is not None)
    while True:
        beyond = work.distance + work.reach(side)
        low, high = box[0] - beyond, box[1] + beyond
        columns, rows = (int(n) + 1 for n in np.floor((high - low) / side))
        span, most = (first, arcs, corners, end), work.budget // 2
        block = Block(low[0], low[1], side, 1.0 / side, work.reach(side), columns, rows, 0, *span, most)
        blocks = np.array([block], dtype=BLOCK)
        edges, turns = _expected(work.distance, corners, end - corners, length, side)
        table, entered = work.enter(blocks, model.ids, min(most, 2 * (edges + turns)), work.distance > 0.0)
        if entered[0] <= most:
            work.budget -= int(entered[0])
            return work.sort(blocks, model.ids, table, entered, top=True)
        side *= 2.0


def _expected(distance: float, edges: int, corners: int, length: float, side: float) -> tuple[int, int]:
    """Estimate how many entries edges come to, and corners: a path of length l crosses 1 + 4 l / (pi side) cells.

    A disc has a path on either side of an edge, and one around each corner, half a circle at most.
    """
    cells = 4.0 / (math.pi * side)
    along = edges * (2 if distance > 0.0 else 1) * (1.0 + cells * length)
    return math.ceil(along), math.ceil(corners * (1.0 + cells * math.pi * distance))


def _side(width: float, height: float, count: int, length: float, fine: bool, falls: bool) -> float:
    longest, even = max(width, height), math.sqrt(width * height / count)
    side = ONCE * even if count >= MANY and not falls else COARSE * even
    if fine:
        side = max(FINE * even, min(COARSE * even, PER_EDGE * length))
    least = math.sqrt(width * height / max(MOST_CELLS, 2.0 * count))
    return max(side, least, longest / (4.0 * count + 64.0), longest * 2.0**-20)


def _mean_length(model: Model) -> float:
    """Mean length of edges, of arcs that of their chords."""
    lengths = model.lines["length"]
    return float(lengths.sum()) / max(int(np.count_nonzero(lengths)), 1)


def _next_level(work: _Work, level: _Level, finest: float) -> _Level | None:
    """Divide the crowded cells of a level, those that it helps, as far as the budget goes; None without any."""
    counts = np.diff(level.numbers[:, 0])
    cells = np.flatnonzero(counts > CROWDED)
    cells = cells[level.of_blocks(cells, "side")[0] >= 2.0 * finest]
    if not len(cells):
        return None
    blocks = _parts(work, level, cells, finest)
    table, entered = work.enter(blocks, level.ids, min(int(blocks["most"].sum()), work.budget), False)
    growth = np.where(entered > blocks["most"], np.inf, entered / counts[cells])
    order = np.argsort(growth, kind="stable")
    fits = np.cumsum(entered[order]) <= work.budget // 2
    kept = np.sort(order[fits & np.isfinite(growth[order])])
    if not len(kept):
        return None
    if len(kept) < len(cells):
        blocks = blocks[kept]
        blocks["first"] = _starts(blocks["columns"] * blocks["rows"])
        table, entered = work.enter(blocks, level.ids, int(entered[kept].sum()), False)
    work.budget -= int(entered.sum())
    level.divided, level.parts = cells[kept], blocks
    return work.sort(blocks, level.ids, table, entered, top=False)


def _parts(work: _Work, level: _Level, cells: IntArray, finest: float) -> NDArray[Any]:
    """Make a block of each cell, with a quarter as many parts as it has entries, or as many."""
    numbers = level.numbers
    x0, y0, side, first, columns = level.of_blocks(cells, "x0", "y0", "side", "first", "columns")
    entries = numbers[cells + 1, 0] - numbers[cells, 0]
    room = np.floor(np.log2(side / finest))
    bits = np.clip(np.floor(np.log2(entries) / 2), 1, np.minimum(room, MOST_BITS)).astype(np.int64)
    row, column = np.divmod(cells - first, columns)
    blocks = np.zeros(len(cells), dtype=BLOCK)
    blocks["x0"], blocks["y0"] = x0 + column * side, y0 + row * side
    blocks["side"] = np.ldexp(side, -bits)
    blocks["per_side"] = 1.0 / blocks["side"]
    blocks["reach"] = work.reach(blocks["side"])
    blocks["columns"] = blocks["rows"] = 1 << bits
    blocks["first"] = _starts(1 << 2 * bits)
    for part, name in enumerate(("start", "arcs", "corners")):
        blocks[name] = numbers[cells, part]
    blocks["end"] = numbers[cells + 1, 0]
    blocks["most"] = 2 * entries << bits
    return blocks


_BITS = np.unpackbits(np.arange(1 << OCTANTS, dtype=np.uint8)[:, None], axis=1).sum(axis=1)
"""By number: how many of its bits are set."""


def _starts(sizes: IntArray) -> IntArray:
    starts: IntArray = np.cumsum(sizes) - sizes
    return starts
