"""Compiled kernels, interpreted ones and NumPy cut cubics into the same lines, and find the same near boxes."""

import numpy as np
import pytest

from importers.errors import LimitError
from wallkit.geometry.box_tree import BoxTree
from wallkit.walls import near_boxes
from wallkit.walls.importing import chords_by_kernels, curves_to_lines
from wallkit.walls.near_boxes import NearBoxes


def cubics(seed, count):
    """Loops and cusps, straight ones, ends that meet, places that repeat, points, arcs of circles, small ones."""
    random = np.random.default_rng(seed)
    found, number = random.uniform(0, 100, (count, 4, 2)), np.arange(count)
    found[number % 5 == 0] = np.round(found[number % 5 == 0] / 25)
    found[number % 7 == 1, 3] = found[number % 7 == 1, 0]
    found[number % 11 == 2] *= 1e-3
    for part in (1, 2):
        found[number % 13 == 4, part] = (found[:, 0] + part * (found[:, 3] - found[:, 0]) / 3)[number % 13 == 4]
    found[number % 17 == 5] = found[number % 17 == 5, :1]
    quarter = np.array([[1, 0], [1, 0.5522847498], [0.5522847498, 1], [0, 1]])
    found[number % 19 == 6] = quarter * random.uniform(1, 99, (np.count_nonzero(number % 19 == 6), 1, 1))
    return found


def cut(some, tolerance, kernels):
    chords = curves_to_lines._chords(some, tolerance, kernels)
    return chords.counts.tobytes(), chords.points.tobytes(), chords.error


@pytest.mark.parametrize("tolerance", [0.003, 0.1, 3.0])
def test_compiled_kernels_cut_where_numpy_cuts(tolerance):
    some = cubics(1, 5000)  # two blocks
    assert cut(some, tolerance, True) == cut(some, tolerance, False)


def test_interpreted_kernels_cut_the_same(monkeypatch):
    some = cubics(2, 40)
    wanted = cut(some, 0.1, False)
    monkeypatch.setattr(chords_by_kernels, "compiled", lambda kernel: kernel)
    assert cut(some, 0.1, True) == wanted


@pytest.mark.parametrize("kernels", [False, True])
def test_a_tolerance_that_takes_too_many_vertices_is_refused(kernels):
    with pytest.raises(LimitError, match="2,000,000"):
        cut(cubics(3, 300), 1e-13, kernels)


def test_few_curves_wait_for_no_kernels(monkeypatch):
    monkeypatch.setattr(curves_to_lines, "at_hand", lambda task: pytest.fail("kernels were asked for"))
    curves_to_lines._cubic_chords(cubics(4, 200), 0.1)


@pytest.mark.parametrize("count", [17, 300, 5000])
def test_a_kernel_finds_the_near_boxes_that_numpy_finds(count):
    random = np.random.default_rng(count)
    low = np.round(random.uniform(0, 100, (2, count)), 1)
    high = low + np.round(random.uniform(0, 40, (2, count)) * (random.random(count) < 0.1), 1)
    wanted = BoxTree(low, high)._answers(np.arange(count), low, high)
    for one, other in zip(NearBoxes(low, high).by_kernel(low, high), wanted, strict=True):
        assert np.array_equal(one, other)


def test_a_large_tree_is_asked_by_the_kernel_alike_about_others_and_about_itself(monkeypatch):
    monkeypatch.setattr(near_boxes, "at_hand", lambda task: True)
    low = np.random.default_rng(2).uniform(0, 1000, (2, 1 << 14))
    plain, tree = BoxTree(low, low + 5), NearBoxes(low, low + 5)
    asked = low[:, :300] + 2
    for one, other in (
        (plain.among(9000, 9900), tree.among(9000, 9900)),
        (plain.query(asked, asked), tree.query(asked, asked)),
    ):
        assert [part.tolist() for part in one] == [part.tolist() for part in other]


def test_an_interpreted_kernel_finds_the_same_boxes(monkeypatch):
    monkeypatch.setattr(near_boxes, "compiled", lambda kernel: kernel)
    low = np.random.default_rng(1).uniform(0, 9, (2, 60))
    found = NearBoxes(low, low + 1).by_kernel(low, low + 1)
    assert [one.tolist() for one in found] == [
        one.tolist() for one in BoxTree(low, low + 1)._answers(np.arange(60), low, low + 1)
    ]
