"""What takes longest of the fit, by compiled kernels: the same bits as by NumPy, in a fraction of the time.

Kernels are called for many cubics, once they are compiled: until then, for few curves, and for arcs of ellipses, NumPy
does the same. :class:`smooth_chains.Chains` knows which of the two is to do it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.kernels.fitting.biarc_formulas import biarcs_of
from wallkit.kernels.fitting.cubic_chains import PLACES, count_sections, look, look_again, look_closely, points_at
from wallkit.kernels.fitting.equal_shares import share_out
from wallkit.kernels.fitting.leaning import LOOKS, lean_all
from wallkit.kernels.jit import compiled

if TYPE_CHECKING:
    from wallkit.walls.importing.arc_fitting.biarcs import Spans
    from wallkit.walls.importing.arc_fitting.curves import BoolArray, ComplexArray
    from wallkit.walls.importing.arc_fitting.smooth_chains import Chains


def chain_points(chains: Chains, ids: IntArray, u: FloatArray) -> tuple[ComplexArray, ComplexArray]:
    """Points and directions of chains ``ids`` at ``u``."""
    places, directions = np.empty(len(ids), dtype=np.complex128), np.empty(len(ids), dtype=np.complex128)
    compiled(points_at)(_columns(chains), ids, u, places, directions)
    return places, directions


def joined_ends(
    spans: Spans, limits: FloatArray, straight: float
) -> tuple[ComplexArray, FloatArray, FloatArray, BoolArray]:
    """Join the ends of spans by arcs, see ``fitting.biarc_formulas.biarcs_of``.

    Returns:
        (2, n) each: joints and directions there; curvatures; bulges; whether the arcs are one, whether they are sound.
    """
    shape = 2, len(spans)
    ends, bends, bulges = np.empty(shape, dtype=np.complex128), np.empty(shape), np.empty(shape)
    told = np.empty(shape, dtype=np.bool_)
    compiled(biarcs_of)(spans.p0, spans.p1, spans.t0, spans.t1, limits, straight, ends, bends, bulges, told)
    return ends, bends, bulges, told


def looked_at(
    chains: Chains, spans: Spans, limits: tuple[float, float], straight: float, fractions: FloatArray
) -> tuple[FloatArray, FloatArray, BoolArray]:
    """Join the ends of spans by arcs: largest distance and turn of each, and whether the arcs are sound."""
    distance, turn, sound = np.empty(len(spans)), np.empty(len(spans)), np.empty(len(spans), dtype=np.bool_)
    where = spans.ids, spans.low, spans.high, *_ends(spans)
    work = np.empty((2, len(fractions)))
    compiled(look)(_columns(chains), where, limits, straight, fractions, work, distance, turn, sound)
    return distance, turn, sound


@dataclass(slots=True, eq=False, repr=False)
class CloseLook:
    """What a close look at spans found, by section, see ``fitting.cubic_chains.look_closely``.

    Attributes:
        sections: those of the spans, as the kernels have them, with low and high of where was looked.
        arcs: of the spans, as the kernels have them.
        sound: (n,) whether these are.
        worst: (2, m) largest distances and turns.
        at: (2, m) at which of the fractions these are.
        around: (2, 3, m) the values before, there and after.
    """

    sections: tuple[NDArray[Any], ...]
    arcs: tuple[NDArray[Any], ...]
    sound: BoolArray
    worst: FloatArray
    at: IntArray
    around: FloatArray


def looked_closely(
    chains: Chains,
    spans: Spans,
    limits: tuple[float, float],
    straight: float,
    fractions: FloatArray,
    margin: float,
) -> CloseLook:
    """Join the ends of spans by arcs, and measure these at many places of each section."""
    count = len(spans)
    counts = np.empty(count, dtype=np.int64)
    compiled(count_sections)(_columns(chains), spans.ids, spans.low, spans.high, counts)
    total = int(counts.sum())
    sections = *np.empty((2, total), dtype=np.int64), *np.empty((4, total))
    arcs = *np.empty((2, count), dtype=np.complex128), *np.empty((2, count))
    sound = np.empty(count, dtype=np.bool_)
    seen = np.empty((2, total)), np.empty((2, total), dtype=np.int64), np.empty((2, 3, total))
    where, work = (spans.ids, spans.low, spans.high, *_ends(spans)), np.empty((2, PLACES))
    compiled(look_closely)(
        _columns(chains), where, limits, straight, fractions, margin, work, (*arcs, sound), sections, seen
    )
    return CloseLook(sections, arcs, sound, *seen)


def raise_to(chains: Chains, close: CloseLook, places: FloatArray) -> None:
    """Raise what is worst to what it is at one more place each (2, m)."""
    compiled(look_again)(_control(chains), chains.shifts, close.sections[:4], close.arcs, places, close.worst)


def lean_in_place(
    chains: Chains,
    spans: Spans,
    arc_limits: tuple[float, float, float],
    fractions: FloatArray,
    search: tuple[int, float, float],
) -> None:
    """Turn the directions at the cuts inside of stretches, in place."""
    longest = int(np.bincount(spans.stretch).max())
    half = max(longest // 2 + 1, _HALF)
    room = np.empty((2, 2 * LOOKS, half)), np.empty((4, half)), np.empty((5, half))
    work = np.empty((2, 3, LOOKS, half)), np.empty((2, half)), np.empty(longest), room
    where = spans.ids, spans.stretch, spans.low, spans.high, *_ends(spans)
    compiled(lean_all)(_columns(chains), where, arc_limits, fractions, search, work)


_HALF = 60  # spans with even numbers that are looked at together, and as many with odd ones: they stay in the cache


def shared_out(chains: Chains, old: Spans, share: FloatArray, whole: Spans, counts: IntArray) -> Spans:
    """Cut stretches ``whole`` into ``counts`` spans each, of equal shares; inner directions are left open."""
    new = whole.take(np.repeat(np.arange(len(whole)), counts))
    olds, stretches = (old.stretch, old.low, old.high, share), (whole.ids, whole.stretch)
    compiled(share_out)(_columns(chains), olds, stretches, counts, (new.low, new.high, new.p0, new.p1))
    return new


def _ends(spans: Spans) -> tuple[ComplexArray, ComplexArray, ComplexArray, ComplexArray]:
    return spans.p0, spans.p1, spans.t0, spans.t1


def _control(chains: Chains) -> ComplexArray:
    curves: Any = chains.curves  # cubics
    control: ComplexArray = curves.control
    return control


def _columns(chains: Chains) -> tuple[Any, ...]:
    ends = chains.headings, chains.leavings
    return _control(chains), chains.offsets, chains.shifts, chains.starts, chains.stops, *ends
