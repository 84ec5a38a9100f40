"""The quick look for overlaps before a survey: it may leave the answer to the thorough one, and misses nothing."""

import numpy as np
import pytest

from wallkit import Balls, Scene, SceneError, Walls, prepare
from wallkit.kernels.index.start_overlaps import all_clear, all_clear_in_cells
from wallkit.scene.start_overlaps import check_starts
from wallkit.simulation.modelled import Modelled
from wallkit.simulation.prepared import ball_cells

WALLS = Walls.from_polylines(
    [[[0.0, 0.0], [40.0, 0.0], [40.0, 30.0], [0.0, 30.0]], [[18.0, 13.0], [22.0, 16.0]], [[30.0, 5.0], [30.0, 5.0]]],
    closed=[True, False, False],
)


def _overlaps(scene):
    try:
        check_starts(scene)
    except SceneError:
        return True
    return False


@pytest.mark.parametrize("offset", [0.0, 1e7])
def test_the_quick_look_misses_nothing(offset):
    random = np.random.default_rng(1)
    position = random.uniform([-5.0, -5.0], [45.0, 35.0], (400, 2)) + offset
    walls = Walls.from_polylines(list(np.split(WALLS.vertices[:6] + offset, [4])), closed=[True, False])
    clear, found = 0, 0
    for ball in position:
        scene = Scene(walls, Balls(ball[None], np.ones((1, 2)), 2.0))
        modelled = Modelled(scene)
        quick = all_clear(modelled.lists.lines, modelled.model.extent, tuple(modelled.origin), ball, modelled.radii)
        assert not (quick and _overlaps(scene))
        clear, found = clear + quick, found + _overlaps(scene)
    assert clear + found == 400
    assert min(clear, found) > 50


@pytest.mark.parametrize("offset", [0.0, 1e7])
@pytest.mark.parametrize("count", [1, 3, 40])
def test_the_quick_look_among_many_edges_misses_nothing(offset, count):
    random = np.random.default_rng(count)
    middle, arm = random.uniform(0.0, 100.0, (60, 2)), random.normal(0.0, 3.0, (60, 2))
    walls = Walls.from_polylines(list(np.stack([middle - arm, middle + arm], axis=1) + offset), closed=False)
    clear, found = 0, 0
    for _ in range(200):
        position = random.uniform(-20.0, 120.0, (count, 2)) + offset
        radii = random.uniform(0.1, 4.0, count) / count
        scene = Scene(walls, Balls(position, np.ones((count, 2)), radii))
        modelled = Modelled(scene, index="none")
        given = (np.asarray(item).tolist() for item in ball_cells(position, tuple(modelled.origin.tolist()), radii))
        quick = all_clear_in_cells(modelled.lists.lines, modelled.model.extent, *given)
        assert quick == (not _overlaps(scene))
        clear, found = clear + quick, found + (not quick)
    assert min(clear, found) > 10


def test_a_survey_refuses_overlaps_and_lets_contact_be():
    position, velocity = np.full((300, 2), 9.0), np.ones((300, 2))
    prepare(Scene(WALLS, Balls(position, velocity, 9.0)))  # touches two walls
    position[123] = 29.5, 5.0  # on the edge without length
    for radius in (1.0, np.where(np.arange(300) == 123, 1.0, 0.0)):
        with pytest.raises(SceneError, match="ball 123 at"):
            prepare(Scene(WALLS, Balls(position, velocity, radius)))
    prepare(Scene(WALLS, Balls(position, velocity, np.where(np.arange(300) == 123, 0.0, 1.0))))
