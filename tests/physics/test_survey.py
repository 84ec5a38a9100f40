"""Surveys: totals that add up, balls drawn by number, memory that does not grow."""

import numpy as np

import wallkit
from wallkit.streams import RandomBalls, survey_stream

ROOM = wallkit.Walls.from_polylines(
    [[[0.0, 0.0], [40.0, 0.0], [40.0, 30.0], [0.0, 30.0]], [[18.0, 13.0], [22.0, 13.0], [22.0, 17.0], [18.0, 17.0]]]
)


def test_totals_add_up():
    draw = RandomBalls((2.0, 2.0, 12.0, 28.0), speed=9.0, radius=0.5, seed=4)
    scene = wallkit.Scene(ROOM, draw(0, 500))
    totals = wallkit.survey(scene, until=20.0)
    assert totals.hits.sum() == totals.bounces.sum() > 0
    assert (totals.time == 20.0).all()
    np.testing.assert_allclose(np.hypot(*totals.velocity.T), 9.0, rtol=1e-15)


def test_a_ball_is_drawn_from_its_number_alone():
    draw = RandomBalls((2.0, 2.0, 12.0, 28.0), seed=4)
    all_at_once, later = draw(0, 100), draw(60, 40)
    np.testing.assert_array_equal(all_at_once.position[60:], later.position)
    np.testing.assert_array_equal(all_at_once.velocity[60:], later.velocity)
    assert not np.array_equal(draw(0, 5).position, RandomBalls((2.0, 2.0, 12.0, 28.0), seed=5)(0, 5).position)


def test_chunks_of_a_stream_change_no_bit():
    draw = RandomBalls((2.0, 2.0, 12.0, 28.0), speed=9.0, seed=1)
    scene = wallkit.Scene(ROOM)
    (whole,) = survey_stream(scene, draw, 3000, until=5.0, chunk=3000)
    parts = list(survey_stream(scene, draw, 3000, until=5.0, chunk=700))
    assert [len(part.bounces) for part in parts] == [700, 700, 700, 700, 200]
    np.testing.assert_array_equal(np.concatenate([part.position for part in parts]), whole.position)
    np.testing.assert_array_equal(sum(part.hits for part in parts), whole.hits)
