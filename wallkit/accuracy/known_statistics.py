"""Known answers of long runs: mean free path, Lyapunov exponents, uniform contacts. Fixed seeds, argued errors."""

from __future__ import annotations

import math
from functools import partial

import numpy as np

from wallkit.accuracy import scenes
from wallkit.accuracy.cases import Verdict, add, case, fly
from wallkit.geometry.arrays import FloatArray
from wallkit.scene.scene import Balls, Scene
from wallkit.simulation import horizon
from wallkit.walls import Walls


def _batch_error(values: FloatArray, weights: FloatArray, batches: int = 40) -> tuple[float, float]:
    """Mean of values / weights and its standard error from batches, which are long against all correlation."""
    pieces = [piece.sum() for piece in np.array_split(values, batches)]
    spans = [piece.sum() for piece in np.array_split(weights, batches)]
    means = np.array(pieces) / np.array(spans)
    return float(np.sum(pieces) / np.sum(spans)), float(means.std(ddof=1) / math.sqrt(batches))


def _outcome(expected: float, got: float, error: float, known: float = 0.0) -> Verdict:
    # 4.5 standard errors: one case in 100,000 fails by chance, and with fixed seeds none does twice
    return Verdict(
        f"{expected:.5g}", f"{got:.5g} +- {error:.2g}", abs(got - expected), 4.5 * error + known, "4.5 standard errors"
    )


def _mean_free_path(walls: Walls, area: float, perimeter: float, radius: float, bounces: int) -> Verdict:
    """Pi A / P of what the ball's centre can reach (Santalo)."""
    contacts = fly(walls, (0.31, 0.17), (math.cos(1.0), math.sin(1.0)), radius, bounces=bounces).contacts
    flights = np.diff(contacts["time"])
    got, error = _batch_error(flights, np.ones(len(flights)))
    return _outcome(math.pi * area / perimeter, got, error)


add(
    "mean free path, stadium",
    "statistics",
    "pi A / P of a stadium (R = 1, straight 2): 2.18181",
    partial(_mean_free_path, scenes.stadium(2.0, 1.0), math.pi + 4.0, math.tau + 4.0, 0.0, 40_000),
)
add(
    "mean free path, disc in a stadium",
    "statistics",
    "the domain eroded by r = 0.25",
    partial(
        _mean_free_path,
        scenes.stadium(2.0, 1.0),
        math.pi * 0.75**2 + 2 * 2 * 0.75,
        math.tau * 0.75 + 4.0,
        0.25,
        40_000,
    ),
)


def _lyapunov(walls: Walls, expected: float, known: float, start: tuple[float, float], bounces: int) -> Verdict:
    """Mean growth of a small error per time, at speed 1."""
    run = fly(walls, start, (math.cos(0.6), math.sin(0.6)), bounces=bounces)
    logs = horizon.growth(run.scene, run.contacts)[100:]
    got, error = _batch_error(logs, np.diff(run.contacts["time"])[99:])
    return _outcome(expected, got, error, known)


add(
    "Lyapunov exponent, stadium 2",
    "statistics",
    "R = 1, straight 2: 0.4304(3) per time",
    partial(_lyapunov, scenes.stadium(2.0, 1.0), 0.4304, 0.0006, (0.31, 0.17), 600_000),
    slow=True,
)
add(
    "Lyapunov exponent, stadium 1",
    "statistics",
    "R = 1, straight 1: 0.4603(3) per time",
    partial(_lyapunov, scenes.stadium(1.0, 1.0), 0.4603, 0.0006, (0.31, 0.17), 600_000),
    slow=True,
)
add(
    "Lyapunov exponent, Sinai",
    "statistics",
    "square of side 1, pillar of radius 1/4: 1.715(6) per time",
    partial(_lyapunov, scenes.sinai(1.0, 0.25), 1.715, 0.012, (0.4, 0.35), 600_000),
    slow=True,
)


@case("uniform contacts", "an ergodic table is hit uniformly in arc length and sine of the angle")
def uniform_contacts() -> Verdict:
    """Kolmogorov's distance from uniform of sin(angle), over every 20th contact of a stadium (straight 1)."""
    run = fly(scenes.stadium(1.0, 1.0), (0.31, 0.17), (math.cos(0.6), math.sin(0.6)), bounces=60_000)
    contacts = run.contacts[::20]
    sine = contacts["nx"] * contacts["vy"] - contacts["ny"] * contacts["vx"]
    order = np.sort((sine + 1) / 2)
    steps = np.arange(len(order)) / len(order)
    distance = float(max((order - steps).max(), (steps + 1 / len(order) - order).max()))
    # Kolmogorov: P(sqrt(n) D > 2.2) = 2 exp(-2 * 2.2^2) = 1.2e-4 if the contacts were independent
    return Verdict("uniform", f"D = {distance:.4f}", distance, 2.2 / math.sqrt(len(order)), "Kolmogorov, one in 8,000")


def scattered(walls: Walls, count: int, seed: int, radius: float = 0.0) -> Scene:
    """Balls that start near the middle in random directions, at speed 1."""
    random = np.random.default_rng(seed)
    turns = random.uniform(0, math.tau, count)
    velocity = np.stack([np.cos(turns), np.sin(turns)], axis=1)
    return Scene(walls, Balls(random.uniform(-0.05, 0.05, (count, 2)), velocity, radius))
