"""The index: every place of contact is in a cell that lists it, clearings are clear, and crowds cost no more."""

import math

import numpy as np
import pytest
from alone import assert_same_bits
from hypothesis import given, settings
from hypothesis import strategies as st

from wallkit import Balls, Scene, Walls, survey
from wallkit.kernels.index.grid import clearing, home, leaf, moves_to_next
from wallkit.kernels.records import WIDEST
from wallkit.simulation.build_grid import AT_LEAST, CROWDED, GROWTH
from wallkit.simulation.modelled import Modelled
from wallkit.simulation.prepared import PreparedScene

ROOM = np.array([[0.0, 0.0], [400.0, 0.0], [400.0, 300.0], [0.0, 300.0]])


def ring(centre, radius, count, jag=0.0, seed=0):
    """A ring of so many edges, its vertices moved in and out by a part of the radius."""
    angle = 2 * np.pi * np.arange(count) / count
    away = radius * (1.0 + jag * np.random.default_rng(seed).uniform(-1, 1, count))
    return np.asarray(centre) + away[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def modelled(walls, radius=0.0, *, index="grid", machine_code=False, fine=False, gravity=None):
    scene = Scene(walls, Balls([[1.0, 1.0]], [[1.0, 1.0]], radius), gravity=gravity)
    limits = None if fine else (0.0, 0)
    return Modelled(scene, index=index, machine_code=machine_code, limits=limits)


def entries(model):
    """(cells,) how many entries each cell has that is not divided."""
    counts = model.cells["end"].astype(np.int64) - model.cells["first"]
    return counts[counts >= 0]


def listed(model, x, y):
    """Edges and vertices that the cell at a place lists."""
    c = home(model, model.grid, x, y)
    cell = model.cells[c]
    return model.ids[cell.first : cell.corners], model.ids[cell.corners : cell.end]


spots = st.lists(
    st.tuples(
        st.floats(60.0, 340.0), st.floats(60.0, 240.0), st.sampled_from([1e-4, 0.02, 1.0, 20.0]),
        st.integers(3, 60), st.sampled_from([0.0, 0.3]),
    ),
    min_size=1, max_size=4,
)  # fmt: skip


def clustered(drawn, bulge=0.0):
    rings = [ring((x, y), size, count, jag, seed) for seed, (x, y, size, count, jag) in enumerate(drawn)]
    return Walls.from_polylines([ROOM, *rings], bulges=[np.zeros(4), *(np.full(len(r), bulge) for r in rings)])


@settings(max_examples=10)
@given(spots, st.sampled_from([0.0, 0.01, 5.0]), st.sampled_from([0.0, 0.4, -1.7]))
def test_places_of_contact_are_in_cells_that_list_them(drawn, radius, bulge):
    scene = modelled(clustered(drawn, bulge), radius)
    model = scene.lists
    for edge, line in enumerate(model.lines):
        for part in (0.0, 0.3, 0.5, 1.0):
            for side in (radius, -radius):
                x, y = line.ax + part * (line.bx - line.ax), line.ay + part * (line.by - line.ay)
                nx, ny = line.nx, line.ny
                if model.arcs is not None and model.arcs[edge].radius > 0.0:
                    arc = model.arcs[edge]
                    angle = 4 * part * math.atan(abs(bulge))
                    nx = (arc.sx * math.cos(angle) - arc.sy * math.sin(angle)) / arc.radius
                    ny = (arc.sy * math.cos(angle) + arc.sx * math.sin(angle)) / arc.radius
                    x, y = arc.ax - arc.sx + arc.radius * nx, arc.ay - arc.sy + arc.radius * ny
                assert edge in listed(model, x + side * nx, y + side * ny)[0]


@settings(max_examples=20)
@given(spots, st.sampled_from([0.01, 5.0]))
def test_arcs_about_corners_are_in_cells_that_list_them(drawn, radius):
    walls = clustered(drawn)
    model = modelled(walls, radius).lists
    for wall, ends in enumerate(walls.offsets[1:]):
        for vertex in range(walls.offsets[wall], ends):
            before = vertex - 1 if vertex > walls.offsets[wall] else ends - 1
            one, two = model.lines[before], model.lines[vertex]
            turn = math.copysign(1.0, one.nx * two.ny - one.ny * two.nx)
            for part in (0.01, 0.5, 0.99):
                nx, ny = ((1 - part) * a + part * b for a, b in ((one.nx, two.nx), (one.ny, two.ny)))
                scale = turn * radius / math.hypot(nx, ny)
                corner = model.corners[vertex]
                assert vertex in listed(model, corner.x + scale * nx, corner.y + scale * ny)[1]


@settings(max_examples=25)
@given(spots, st.sampled_from([0.0, 1.0]), st.sampled_from([None, (0.0, -1.0)]))
def test_nothing_is_listed_in_a_clearing(drawn, radius, gravity):
    model = modelled(clustered(drawn), radius, gravity=gravity).lists
    grid, cells = model.grid, model.cells
    corners = {}  # of each cell, in units
    for row in range(grid.rows):
        for column in range(grid.columns):
            _visit(cells, grid, column << grid.shift, row << grid.shift, grid.shift, corners)
    taken = [box for c, box in corners.items() if cells[c].end > cells[c].first]
    low, high = np.array([box[:2] for box in taken]), np.array([box[2:] for box in taken])
    for c, (x, y, end_x, _end_y) in corners.items():
        reach = (moves_to_next(cells[c]) - 1) * (end_x - x)
        if cells[c].end == cells[c].first:
            beside = (high <= np.array([x, y]) - reach) | (low >= np.array([end_x, _end_y]) + reach)
            assert beside.any(axis=1).all()
        else:
            assert moves_to_next(cells[c]) == 1


@settings(max_examples=20)
@given(spots, st.booleans())
def test_a_clearing_ahead_is_empty_and_cannot_grow_both_ways(drawn, fine):
    """For points; for discs see ``test_index_octants``, theirs may hold what they cannot meet."""
    model = modelled(clustered(drawn), machine_code=True, fine=fine).model
    columns, rows = model.grid.columns, model.grid.rows
    cells = model.cells[: columns * rows]
    taken = cells["end"] != cells["first"]
    below = np.zeros((rows + 1, columns + 1), dtype=np.int64)  # how many are taken below and to the left
    below[1:, 1:] = taken.reshape(rows, columns).cumsum(axis=0).cumsum(axis=1)

    def free(left, right, low, high):
        left, right, low, high = max(left, 0), min(right, columns), max(low, 0), min(high, rows)
        return below[high, right] - below[high, left] - below[low, right] + below[low, left] == 0

    random = np.random.default_rng(1)
    for way, column, row in zip(*(random.integers(0, n, 300) for n in (4, columns, rows)), strict=True):
        shift = model.grid.shift
        wide, high = clearing(model.clearings, model.grid, int(way), int(column) << shift, int(row) << shift)

        def box(wide, high, way=way, column=column, row=row):
            left, low = (column + 1 - wide if way & 1 else column), (row + 1 - high if way & 2 else row)
            return left, left + wide, low, low + high

        assert (wide == 0) == (high == 0) == taken.reshape(rows, columns)[row, column]
        assert free(*box(wide, high))
        assert {wide, high} & {0, WIDEST} or not free(*box(wide + 1, high + 1))


def test_an_empty_room_around_a_spot_is_one_clearing():
    """Where balls fall: straight flights have rectangles ahead for it."""
    model = modelled(Walls.from_polylines([ROOM, ring((200.0, 150.0), 1.0, 1000)]), gravity=(0.0, -1.0)).model
    half = min(model.grid.columns, model.grid.rows) // 2
    moves = model.cells["first"][model.cells["first"] == model.cells["end"]]
    assert 0.4 * half < moves.max() < half


def _visit(cells, grid, x, y, shift, corners):
    """Note the cells of the part of the grid that begins at (x, y) and is 2^shift wide."""
    c, side = leaf(cells, grid, x, y)
    if side == shift:
        corners[c] = x, y, x + (1 << side), y + (1 << side)
        return
    half = 1 << (shift - 1)
    for dx, dy in ((0, 0), (half, 0), (0, half), (half, half)):
        _visit(cells, grid, x + dx, y + dy, shift - 1, corners)


def starts(walls, count, radius, seed):
    """Balls along the room's left side, most of them aimed at the vertices of what stands in it."""
    rng = np.random.default_rng(seed)
    position = np.stack([rng.uniform(7, 20, count), rng.uniform(20, 280, count)], axis=1)
    aim = walls.vertices[rng.integers(4, len(walls.vertices), count)] + rng.normal(0, radius + 0.01, (count, 2))
    way = aim - position
    return Balls(position, 50.0 * way / np.hypot(*way.T)[:, None], radius)


def totals(scene, index):
    return survey(PreparedScene(scene, Modelled(scene, index=index, machine_code=True), None), until=20.0, threads=1)


@settings(max_examples=15)
@given(spots, st.sampled_from([0.0, 0.01, 5.0]), st.sampled_from([0.0, 0.4]), st.sampled_from([None, (0.0, -9.81)]))
def test_the_same_bits_as_without_an_index(drawn, radius, bulge, gravity):
    walls = clustered(drawn, bulge)
    scene = Scene(walls, starts(walls, 6, radius, 3), gravity=gravity)
    one, other = totals(scene, "none"), totals(scene, "grid")
    assert_same_bits(one, other)


def test_interpreted_and_compiled_kernels_make_the_same_index():
    walls = clustered([(100.0, 100.0, 0.02, 60, 0.3), (200.0, 90.0, 20.0, 40, 0.0)], 0.4)
    for radius, fine in ((0.0, False), (5.0, False), (5.0, True)):
        one, other = (modelled(walls, radius, machine_code=code, fine=fine).model for code in (False, True))
        assert one.grid == other.grid
        assert one.cells.tobytes() == other.cells.tobytes()
        assert one.ids.tobytes() == other.ids.tobytes()
        assert one.clearings.tobytes() == other.clearings.tobytes()


@pytest.mark.parametrize("radius", [0.0, 1e-6, 1e-3])
def test_a_spot_in_a_spot_is_divided_until_no_cell_is_crowded(radius):
    rings = [ROOM, *(ring((150.0 + size, 150.0), size, 1000) for size in (1e-4, 1e-2, 1.0))]
    model = modelled(Walls.from_polylines(rings), radius).model
    assert entries(model).max() <= CROWDED
    assert model.grid.shift > 10


def hostile():
    angle = 2 * np.pi * np.arange(1000) / 1000
    star = [np.array([[200.0, 150.0], [200.0 + 140 * math.cos(a), 150.0 + 140 * math.sin(a)]]) for a in angle]
    lines = [np.array([[10.0, 10.0 + 1e-9 * k], [390.0, 10.0 + 1e-9 * k]]) for k in range(1000)]
    same = [np.array([[100.0, 100.0], [100.001, 100.0]])] * 1000
    return {
        "a thousand edges meet": star,
        "parallel, closer than anything": lines,
        "far apart": [np.array([[10.0, 10.0 + 0.28 * k], [390.0, 10.0 + 0.28 * k]]) for k in range(1000)],
        "a thousand times the same": same,
    }


@pytest.mark.parametrize("name", hostile())
@pytest.mark.parametrize("radius", [0.0, 2.0])
def test_no_scene_makes_the_index_grow_without_end(name, radius):
    lines = hostile()[name]
    walls = Walls.from_polylines([ROOM, *lines], closed=[True] + [False] * len(lines))
    bare, model = (modelled(walls, radius, index=index, machine_code=True).model for index in ("none", "grid"))
    assert len(model.ids) <= GROWTH * len(bare.ids) + AT_LEAST
    assert len(model.cells) <= 4 * len(model.ids) + AT_LEAST


def test_a_large_ball_over_tiny_edges_keeps_to_the_budget():
    walls = Walls.from_polylines([ROOM, ring((200.0, 150.0), 3.0, 2000, jag=0.1)])
    bare, model = (modelled(walls, 5.0, index=index, machine_code=True).model for index in ("none", "grid"))
    assert len(model.ids) <= GROWTH * len(bare.ids) + AT_LEAST
    assert np.median(entries(model)) <= CROWDED


@pytest.mark.parametrize("far", [1e6, 1e12, 1e150, 1e308])
@pytest.mark.parametrize("bulge", [0.0, 0.4])
def test_balls_may_come_from_anywhere(far, bulge):
    walls = clustered([(100.0, 100.0, 0.02, 60, 0.3), (200.0, 90.0, 20.0, 40, 0.0)], bulge)
    position = far * np.array([[1.0, 1.0], [-1.0, 0.5], [0.0, -1.0], [1e-9, 1.0]])
    velocity = -position / np.abs(position).max(axis=1, keepdims=True)
    for radius in (0.0, 1.0):
        scene = Scene(walls, Balls(position, velocity, radius))
        with_index, without = totals(scene, "grid"), totals(scene, "none")
        assert_same_bits(with_index, without)


@pytest.mark.parametrize("wave", [False, True])
def test_no_walk_is_endless_where_paths_run_through_corners_of_cells(wave):
    """Rounding may say that a path through a corner goes round it, back and forth: one of these did."""
    turns = np.arange(2_000) * math.tau / 2_000
    spokes = [np.array([(0.0, 0.0), (math.cos(t), math.sin(t))]) for t in turns]
    walls = Walls.from_polylines([ring((0.0, 0.0), 100.0, 64), *spokes], closed=[True] + [False] * len(spokes))
    for centre in ((0.0, 0.0), (0.3, 0.1)):
        position = 50.0 * np.stack([np.cos(turns[:1000] * 2), np.sin(turns[:1000] * 2)], axis=1)
        scene = Scene(walls, Balls(position, centre - position, 0.5))
        for part in [slice(0, 1000)] if wave else [slice(first, first + 50) for first in range(0, 1000, 50)]:
            balls = Balls(position[part], (centre - position)[part], 0.5)
            totals = survey(Scene(scene.walls, balls), until=3.0, check=False)
            assert (totals.bounces > 0).all()
            assert (np.hypot(*totals.position.T) < 100.0).all()
