"""A survey whose index is made for it alone: cells as fine as its flights pay for, and the same bits."""

import math
from dataclasses import replace

import numpy as np
import pytest

import wallkit
from wallkit.simulation import expected_flights as flights
from wallkit.simulation.modelled import Modelled
from wallkit.simulation.prepared import prepare_once

EDGES = 400
TURN = 2 * np.pi * np.arange(EDGES) / EDGES
RING = 100 * np.stack([np.cos(TURN), np.sin(TURN)], axis=1)


def scene(count, radius=0.0):
    angle = np.random.default_rng(1).uniform(0, 2 * np.pi, count)
    velocity = 50 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    walls = wallkit.Walls.from_polylines([RING, [[-40, 0], [40, 10]]], closed=[True, False])
    return wallkit.Scene(walls, wallkit.Balls(np.tile([[0.0, 50.0]], (count, 1)), velocity, radius))


@pytest.mark.parametrize("radius", [0.0, 2.0])
def test_few_flights_get_large_cells_and_the_same_bits(radius):
    few = scene(40, radius)
    once, always = prepare_once(few, 20.0, 1 << 40), wallkit.prepare(few)
    assert len(once.modelled.model.cells) < len(always.modelled.model.cells)
    one, other = wallkit.survey(few, until=20.0), wallkit.survey(always, until=20.0)
    for name in ("bounces", "position", "velocity", "hits"):
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name))


def test_many_flights_get_the_cells_of_prepare():
    many = scene(40)
    assert len(prepare_once(many, 1e5, 1 << 40).modelled.model.cells) == len(wallkit.prepare(many).modelled.model.cells)


def test_under_gravity_few_flights_go_through_the_cells_of_a_run():
    # the way along a wall is rounded at the borders of cells: a survey ends where a run does, to the bit
    falling = replace(scene(40, 2.0), gravity=(0.0, -30.0))
    once, run = prepare_once(falling, 1.0, 1 << 40).modelled.model, Modelled(falling).model
    assert once.grid == run.grid
    assert once.cells.tobytes() == run.cells.tobytes()


def expected_flights(scene, until, bounces):
    walls = scene.walls
    chords = np.hypot(*(walls.vertices[walls.edge_ends] - walls.vertices[walls.edge_starts]).T)
    length = chords.sum() + chords[-1]  # the last wall alone is open
    return flights.expected_flights(scene, walls.box(), length, until, bounces)


def test_flights_are_estimated_by_the_mean_free_path():
    counted = wallkit.survey(scene(200), until=20.0).bounces.sum()
    assert counted / 2 < expected_flights(scene(200), 20.0, 1 << 40) < counted * 2


def test_bounces_end_flights_where_time_does_not():
    assert expected_flights(scene(7), math.inf, 5) == 35
    still = wallkit.Scene(scene(1).walls, wallkit.Balls([[0.0, 50.0]], [[0.0, 0.0]], 1.0))
    assert expected_flights(still, 20.0, 5) == 0
