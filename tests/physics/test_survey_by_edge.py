"""Bounces by edge: each way of flying counts what the contacts of ``simulate`` say, and changes no other number."""

import numpy as np
import pytest

import wallkit

SQUARE = [(0.0, 0.0), (0.0, 10.0), (10.0, 10.0), (10.0, 0.0)]
POST = [(4.0, 5.0), (5.0, 4.0), (6.0, 5.0), (5.0, 6.0)]
MANY = [[(x, y), (x + 0.5, y + 0.3)] for x in (1.0, 4.0, 7.0) for y in (1.0, 3.0, 5.0, 7.0, 8.5)]
IN_STEP = wallkit.Walls.from_polylines([SQUARE, POST])
AS_A_WAVE = wallkit.Walls.from_polylines([SQUARE, *MANY], [True] + [False] * len(MANY))


def scene(walls, radius, gravity=None):
    draw = wallkit.RandomBalls((2.0, 1.6, 3.0, 2.6), speed=3.0, radius=radius, seed=5)
    return wallkit.Scene(walls, draw(0, 300), gravity=gravity)


def counted(contacts, walls):
    """Bounces by edge, and off vertices by wall, of the contacts of a run."""
    bounces = contacts[contacts["kind"] <= 1]
    on_edge = bounces[bounces["edge"] >= 0]
    edges = walls.edge_offsets[on_edge["wall"]] + on_edge["edge"]
    by_edge = np.bincount(edges, minlength=len(walls.edge_starts))
    return by_edge, np.bincount(bounces[bounces["edge"] < 0]["wall"], minlength=len(walls))


@pytest.mark.parametrize(
    ("walls", "radius", "gravity"),
    [(IN_STEP, 0.0, None), (IN_STEP, 0.25, None), (AS_A_WAVE, 0.1, None), (IN_STEP, 0.25, (0.0, -1.0))],
    ids=["points in step", "discs in step", "discs as a wave", "discs that fall"],
)
def test_hits_by_edge_are_those_of_the_contacts(walls, radius, gravity):
    balls = scene(walls, radius, gravity)
    contacts = wallkit.simulate(balls, bounces=12).contacts
    plain, told = wallkit.survey(balls, bounces=12), wallkit.survey(balls, bounces=12, by_edge=True)
    edges, off_vertices = counted(contacts, walls)
    np.testing.assert_array_equal(told.edge_hits, edges)
    wall_of_vertex = np.repeat(np.arange(len(walls)), np.diff(walls.offsets))
    np.testing.assert_array_equal(np.bincount(wall_of_vertex, told.vertex_hits, len(walls)), off_vertices)
    assert (told.vertex_hits.sum() > 0) == (radius > 0.0)
    for name in ("hits", "position", "velocity", "time", "bounces", "ending"):
        np.testing.assert_array_equal(getattr(told, name), getattr(plain, name))
    assert plain.edge_hits is None
    assert plain.vertex_hits is None
