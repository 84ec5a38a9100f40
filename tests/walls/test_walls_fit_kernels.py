"""Compiled kernels, interpreted ones and NumPy fit the same arcs to the bit."""

import numpy as np
import pytest

from importers.drawing import Subpath
from wallkit.walls.importing.arc_fitting import curves_to_arcs, machine_code
from wallkit.walls.importing.segments import gather


def curves(seed, count):
    """Chains of cubics: smooth and not, with loops and cusps, straight ones, arms without length, repeated places."""
    random = np.random.default_rng(seed)
    subpaths = []
    for number in range(count):
        points = random.uniform(0, 100, (28, 2))
        if number % 3 == 0:
            points = np.round(points / 25)
        segments, at, arm = [("M", *points[0].tolist())], points[0], None
        for first, second, end in points[1:].reshape(-1, 3, 2)[: random.integers(1, 9)]:
            if arm is not None and number % 2:
                first = at + (at - arm) * random.choice([1.0, 0.5, 0.0])
            if number % 7 == 6:
                first, second = at + (end - at) / 3, at + 2 * (end - at) / 3
            segments.append(("C", *first.tolist(), *second.tolist(), *end.tolist()))
            at, arm = end, second
        subpaths.append(Subpath(segments, closed=False))
    return gather(subpaths)


def fitted(monkeypatch, segments, tolerance, kernels):
    monkeypatch.setattr(curves_to_arcs, "_KERNELS_PAY", 0)
    monkeypatch.setattr(curves_to_arcs, "at_hand", lambda task: kernels)
    pieces = curves_to_arcs.fit_arcs(segments, tolerance)
    arrays = pieces.counts, pieces.ends, pieces.bulges, np.array([pieces.error, pieces.normal_error])
    return [array.tobytes() for array in arrays]


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("tolerance", [0.01, 1.0])
def test_compiled_kernels_fit_what_numpy_fits(monkeypatch, seed, tolerance):
    segments = curves(seed, 150)
    assert fitted(monkeypatch, segments, tolerance, True) == fitted(monkeypatch, segments, tolerance, False)


def test_interpreted_kernels_fit_the_same(monkeypatch):
    segments = curves(4, 9)
    wanted = fitted(monkeypatch, segments, 0.1, False)
    monkeypatch.setattr(machine_code, "compiled", lambda kernel: kernel)
    assert fitted(monkeypatch, segments, 0.1, True) == wanted


def test_few_curves_wait_for_no_kernels(monkeypatch):
    monkeypatch.setattr(curves_to_arcs, "at_hand", lambda task: pytest.fail("kernels were asked for"))
    curves_to_arcs.fit_arcs(curves(5, 20), 0.1)
