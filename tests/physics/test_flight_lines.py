"""Points and discs among line walls, against closed forms and against themselves."""

import math

import numpy as np
import pytest

import wallkit
from wallkit.simulation.simulate import Flights

BOX = np.array([[0.0, 0.0], [400.0, 0.0], [400.0, 300.0], [0.0, 300.0]])
SPIKES = np.array(
    [
        [radius * math.cos(0.1 + k * math.pi / 5), radius * math.sin(0.1 + k * math.pi / 5)]
        for k, radius in enumerate([200.0, 90.0] * 5)
    ]
)
THIRTY = [50 * math.cos(math.radians(30)), 50 * math.sin(math.radians(30))]


def scene(polygon, position, velocity, radius=0.0, **how):
    return wallkit.Scene(wallkit.Walls.from_polylines([polygon], **how), wallkit.Balls(position, velocity, radius))


def ring(count):
    angle = 2 * np.pi * np.arange(count) / count
    size = 200 * (1 + 0.15 * np.cos(3 * angle) + 0.07 * np.sin(5 * angle))
    return np.stack([size * np.cos(angle), size * np.sin(angle)], axis=1)


def test_components_at_thirty_degrees():
    run = wallkit.simulate(
        scene(BOX, [200.0, 150.0], [50 * math.cos(math.pi / 6), 50 * math.sin(math.pi / 6)]), bounces=1
    )
    assert run.contacts["vx"][0] == -50 * math.cos(math.pi / 6)
    assert run.contacts["vy"][0] == 50 * math.sin(math.pi / 6)


@pytest.mark.parametrize("radius", [0.0, 5.0])
def test_box_unfolds(radius):
    run = wallkit.simulate(scene(BOX, [123.0, 87.0], THIRTY, radius), bounces=2000)
    for time in np.linspace(0.0, run.contacts["time"][-1], 50):
        width = np.array([400.0, 300.0]) - 2 * radius
        straight = np.array([123.0, 87.0]) - radius + np.array(THIRTY) * time
        folded = np.abs((straight + width) % (2 * width) - width) + radius
        # one rounding (1e-16) of a path of 1e5 units, once per bounce, grows linearly in a box
        np.testing.assert_allclose(run.position(time)[0], folded, atol=1e-9)


@pytest.mark.parametrize("radius", [0.0, 5.0])
@pytest.mark.parametrize("polygon", [BOX, SPIKES, ring(300)], ids=["box", "star", "curve"])
def test_compiled_and_interpreted_give_the_same_bits(polygon, radius):
    shot = scene(polygon, [3.0, 7.0] if polygon is not BOX else [123.0, 87.0], THIRTY, radius)
    one = wallkit.simulate(shot, bounces=300, mode="interpreted")
    other = wallkit.simulate(shot, bounces=300, mode="compiled")
    assert one.contacts.tobytes() == other.contacts.tobytes()


@pytest.mark.parametrize("radius", [0.0, 5.0])
@pytest.mark.parametrize("polygon", [SPIKES, ring(300)], ids=["star", "curve"])
def test_the_index_changes_no_bit(polygon, radius):
    shot = scene(polygon, [3.0, 7.0], THIRTY, radius)
    logs = []
    for index in ("brute", "grid"):
        flights = Flights(shot, mode="compiled", index=index)
        logs.append(np.concatenate(list(flights.fly(0, math.inf, 5000))))
    assert logs[0].tobytes() == logs[1].tobytes()


@pytest.mark.parametrize(("degrees", "expected"), [(2.0, 90), (7.0, 25), (0.1, 1799)])
def test_wedge_counts(degrees, expected):
    height = 1000 * math.tan(math.radians(degrees))
    walls = wallkit.Walls.from_polylines([[[1000.0, height], [0.0, 0.0], [1000.0, 0.0]]], closed=False)
    start, direction = [900.0, 5e-4 * height], [-50.0, 0.0]
    run = wallkit.simulate(wallkit.Scene(walls, wallkit.Balls(start, direction)), bounces=5000)
    # pi / 2 degrees is a whole number: as drawn, the count may be one less
    assert len(run.contacts) in ({expected - 1, expected} if math.pi / math.radians(degrees) % 1 < 1e-9 else {expected})
    assert run.ending == (wallkit.Ending.LEFT_SCENE,)
