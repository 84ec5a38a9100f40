"""Clearings know the way: what a flight that goes it cannot meet is not in it, and what it leaves is not either."""

import math

import numpy as np
import pytest
from alone import assert_same_bits, flown

from wallkit import Balls, Scene, Walls, survey
from wallkit.kernels.index.grid import clearing, departures_of, octant_of, per_speed
from wallkit.kernels.records import HALF, OCTANTS, QUADRANTS, WIDEST
from wallkit.scene.start_overlaps import clearances
from wallkit.simulation import build_grid
from wallkit.simulation.modelled import Modelled
from wallkit.simulation.prepared import prepare_once

LIMITS = {"until": 40.0, "bounces": 60}


def wavy(count, bulge=0.0, holes=0):
    """A wavy room, and holes in it."""
    angle = np.arange(count) * math.tau / count
    size = 200 * (1 + 0.15 * np.cos(3 * angle) + 0.07 * np.sin(5 * angle))
    rings = [np.stack([size * np.cos(angle), size * np.sin(angle)], axis=1)]
    turn = np.arange(16) * math.tau / 16
    rings += [40 * np.exp(2j * k) + 8 * np.exp(1j * turn) for k in range(holes)]
    rings[1:] = [np.stack([ring.real, ring.imag], axis=1) for ring in rings[1:]]
    return Walls.from_polylines(rings, bulges=[np.full(len(ring), bulge) for ring in rings])


def balls_inside(walls, radius, count=300, seed=5):
    rng = np.random.default_rng(seed)
    place = rng.uniform(-200, 200, (20 * count, 2))
    free = np.hypot(*place.T) < 130.0
    gap, _ = clearances(walls, place, np.full(len(place), radius + 1.0))
    place = place[free & ~(gap < radius + 0.5)][:count]
    turn = rng.uniform(0, math.tau, len(place))
    return Balls(place, 50.0 * np.stack([np.cos(turn), np.sin(turn)], axis=1), radius)


def rectangle(grid, octant, place, wide, high):
    """(x, y) of its low and of its high corner, in units."""
    low = (place >> grid.shift) << grid.shift
    size = np.array([wide, high]) << grid.shift
    back = np.array([octant & 1, (octant >> 1) & 1]) * (size - (1 << grid.shift))
    return low - back, low - back + size


def next_contacts(totals, walls, radius):
    """Where balls that are on their way meet something next: found without an index."""
    start = Scene(walls, Balls(totals.position, totals.velocity, radius))
    return flown(start, "none", until=1e3, bounces=1)[0].position


def in_units(grid, modelled, position):
    return (position - modelled.origin - [grid.x0, grid.y0]) * grid.per_unit


@pytest.mark.parametrize("bulge", [0.0, 0.01])
@pytest.mark.parametrize("radius", [5.0, 20.0])
def test_nothing_is_met_in_a_clearing(bulge, radius):
    walls = wavy(200, bulge)
    balls = balls_inside(walls, radius)
    somewhere, modelled = flown(Scene(walls, balls), until=1.3)
    grid = modelled.model.grid
    assert grid.octants == OCTANTS
    met = in_units(grid, modelled, next_contacts(somewhere, walls, radius))
    places, through = in_units(grid, modelled, somewhere.position), 0
    for place, velocity, contact in zip(places, somewhere.velocity, met, strict=True):
        octant = octant_of(*map(per_speed, velocity.tolist()))
        wide, high = clearing(modelled.model.clearings, grid, octant, *place.astype(int).tolist())
        low, high_corner = rectangle(grid, octant, place.astype(int), wide, high)
        inside = (contact > low + 1e-9) & (contact < high_corner - 1e-9)
        assert wide == 0 or not inside.all()
        through += wide > 0 and modelled.model.cells[int(place[1]) * grid.columns + int(place[0])].tolist()[3] > 0
    assert through > 0


@pytest.mark.parametrize("bulge", [0.0, 0.01, -0.01])
@pytest.mark.parametrize("holes", [0, 3])
def test_nothing_is_met_where_a_point_departs(bulge, holes):
    walls = wavy(200, bulge, holes)
    scene = Scene(walls, balls_inside(walls, 0.0))
    bounced, modelled = flown(scene, until=1e3, bounces=1)
    again, _ = flown(scene, "none", until=1e3, bounces=2)
    grid, clearings = modelled.model.grid, modelled.model.clearings
    assert (grid.octants, grid.departs) == (QUADRANTS, 1)
    places, contacts = (in_units(grid, modelled, totals.position) for totals in (bounced, again))
    departed = 0
    for place, velocity, contact in zip(places.astype(int), bounced.velocity, contacts, strict=True):
        octant = octant_of(*map(per_speed, velocity.tolist()))
        size = int(clearings[departures_of(grid, octant) + int(place[1]) * grid.columns + int(place[0])])
        low, high = rectangle(grid, octant, place, size & WIDEST, size >> HALF)
        assert size == 0 or not ((contact > low + 1e-9) & (contact < high - 1e-9)).all()
        departed += size > 0
    assert departed > 0.7 * len(places)


@pytest.mark.parametrize("radius", [0.0, 0.3, 5.0, 20.0])
@pytest.mark.parametrize(("bulge", "holes"), [(0.0, 0), (0.01, 0), (-0.02, 3), (0.0, 3)])
def test_the_same_bits_as_without_an_index(radius, bulge, holes):
    walls = wavy(150, bulge, holes)
    scene = Scene(walls, balls_inside(walls, radius))
    assert_same_bits(*(flown(scene, index, **LIMITS)[0] for index in ("grid", "none")))


@pytest.mark.parametrize("bulge", [0.0, 0.001])
def test_departures_from_cells_that_are_divided_change_no_bit(bulge):
    walls = wavy(3000, bulge, 3)
    scene = Scene(walls, balls_inside(walls, 0.0))
    few = {"until": 1e3, "bounces": 40}  # four flights an edge: few enough for large cells, where edges crowd
    once = prepare_once(scene, *few.values())
    assert once.modelled.model.grid.departs == 1
    assert once.modelled.model.grid.shift > 0
    assert_same_bits(survey(once, **few), flown(scene, "none", **few)[0])


@pytest.mark.parametrize("radius", [0.0, 5.0])
def test_interpreted_and_compiled_kernels_find_the_same_clearings(radius):
    scene = Scene(wavy(150, 0.03), Balls(np.zeros(2), [1.0, 0.0], radius))
    one, other = (Modelled(scene, machine_code=code, limits=None).model for code in (False, True))
    assert one.grid == other.grid
    assert (one.grid.octants, one.grid.departs) == ((QUADRANTS, 1) if radius == 0.0 else (OCTANTS, 0))
    assert one.clearings.tobytes() == other.clearings.tobytes()
    assert one.cells.tobytes() == other.cells.tobytes()


@pytest.mark.parametrize("radius", [0.0, 5.0])
def test_clearings_that_lie_beside_their_cells(radius, monkeypatch):
    monkeypatch.setattr(build_grid, "WORTH_PACKING", 100.0)
    monkeypatch.setattr(build_grid, "WORTH_PACKING_SPARSE", 100.0)
    walls = wavy(300, 0.01, 3)
    scene = Scene(walls, balls_inside(walls, radius))
    one, modelled = flown(scene, **LIMITS)
    assert modelled.model.grid.packed == 1
    assert_same_bits(one, flown(scene, "none", **LIMITS)[0])


def test_points_that_hit_where_two_walls_join():
    """On a lattice, where many hit a joint exactly: they touch the other wall too, and must look at it."""
    rng = np.random.default_rng(4)
    steps = rng.integers(1, 4, (40, 12, 2)).astype(float) * rng.choice([-1.0, 1.0], (40, 1, 2))
    chains = [np.cumsum(step, axis=0) + rng.integers(40, 260, 2) for step in steps]
    walls = Walls.from_polylines([[[0, 0], [300, 0], [300, 300], [0, 300]], *chains], closed=[True] + [False] * 40)
    place = rng.integers(1, 300, (4000, 2)).astype(float)
    gap, _ = clearances(walls, place, np.full(4000, 0.1))
    place = place[~(gap < 0.1)]
    octant = rng.integers(-3, 4, (len(place), 2)).astype(float)
    going = octant.any(axis=1)
    scene = Scene(walls, Balls(place[going], octant[going], 0.0))
    one, modelled = flown(scene, **LIMITS)
    assert modelled.model.grid.departs == 1
    assert_same_bits(one, flown(scene, "none", **LIMITS)[0])
