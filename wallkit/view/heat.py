"""Heat maps: how long balls are where, on a grid of square cells."""

from __future__ import annotations

import numpy as np

from wallkit.geometry.arrays import FloatArray
from wallkit.view.frame import Frame
from wallkit.view.theme import RAMP_STEPS
from wallkit.view.tracks import Tracks

_CELLS = 96  # along the longer side
_SAMPLES = 4_000_000  # at most, over all stretches


def heat_rows(flight: Tracks, frame: Frame) -> tuple[float, list[list[int]]]:
    """Give the size of a cell in pixels and its rows of ramp steps, from the top; -1 where no ball came.

    Each stretch is sampled at even times, about three times a cell's width apart at its mean speed, and each sample
    counts with its share of the stretch's time. The ramp goes with the root of the time, or a few cells at a
    resting place would leave all others dark.
    """
    size = max(frame.width, frame.height) / _CELLS
    columns, lines = max(1, round(frame.width / size)), max(1, round(frame.height / size))
    time = spent(flight, frame, size, (lines, columns))
    most = float(time.max())
    steps = np.where(time > 0, np.sqrt(time / most) * (RAMP_STEPS - 1) if most > 0 else 0.0, -1.0)
    return size, np.round(steps).astype(int).tolist()


def spent(flight: Tracks, frame: Frame, size: float, shape: tuple[int, int]) -> FloatArray:
    """Give the ball-seconds spent in each cell, rows from the top of the screen."""
    duration = flight.until - flight.time
    longest = np.hypot(*flight.velocity.T) * duration + np.hypot(*flight.pull.T) * duration**2 / 2
    length = longest * frame.scale  # of the way at most, up and down again included
    count = np.clip(np.ceil(3 * length / size), 1, 4 * _CELLS * 3)
    count[~np.isfinite(count)] = 1
    count = np.maximum(1, count * min(1.0, _SAMPLES / max(1.0, float(count.sum())))).astype(np.int64)
    stretch = np.repeat(np.arange(len(count)), count)
    place = np.arange(len(stretch)) - np.repeat(np.cumsum(count) - count, count)
    share = (place + 0.5) / count[stretch]
    s = share * duration[stretch]
    felt = s if flight.drag == 0.0 else -np.expm1(-flight.drag * s) / flight.drag  # the time that the way is worth
    at = (
        flight.position[stretch]
        + flight.velocity[stretch] * felt[:, None]
        + flight.pull[stretch] * (s * s / 2)[:, None]
    )
    pixels = (frame.points(at) - (frame.left, frame.top)) / size
    good = np.isfinite(pixels).all(axis=1)
    column, line = np.floor(pixels[good]).astype(np.int64).T
    weight = (duration / count)[stretch][good]
    keep = (column >= 0) & (column < shape[1]) & (line >= 0) & (line < shape[0])
    cells: FloatArray = np.bincount(line[keep] * shape[1] + column[keep], weight[keep], shape[0] * shape[1]).astype(
        np.float64
    )
    return cells.reshape(shape)
