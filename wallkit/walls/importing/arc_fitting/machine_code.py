"""What takes longest of the fit, by compiled kernels: the same bits as by NumPy, in a fraction of the time.

Kernels are called for many cubics, once they are compiled: until then, for few curves, and for arcs of ellipses, NumPy
does the same. :class:`smooth_chains.Chains` knows which of the two is to do it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.kernels.fitting.biarc_formulas import biarcs_of
from wallkit.kernels.fitting.cubic_chains import PLACES, look, look_again, look_closely, points_at
from wallkit.kernels.fitting.leaning import LOOKS, lean_all
from wallkit.kernels.jit import compiled

if TYPE_CHECKING:
    from wallkit.walls.importing.arc_fitting.biarcs import Biarcs, Spans
    from wallkit.walls.importing.arc_fitting.curves import BoolArray, ComplexArray
    from wallkit.walls.importing.arc_fitting.smooth_chains import Chains, Sections


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


def measured(chains: Chains, sections: Sections, arcs: Biarcs, fractions: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Largest distance and turn of each section at fixed fractions of it."""
    distance, turn = np.empty(len(sections)), np.empty(len(sections))
    where = sections.rows, sections.curves, sections.low, sections.high
    compiled(look)(_control(chains), chains.shifts, where, _of(arcs), fractions, distance, turn)
    return distance, turn


def measured_closely(
    chains: Chains, sections: Sections, inside: tuple[FloatArray, FloatArray], arcs: Biarcs, fractions: FloatArray
) -> tuple[FloatArray, IntArray, FloatArray]:
    """Largest distance and turn (2, n) of sections, at which of the fractions (2, n), and around these (2, 3, n)."""
    count = len(sections)
    largest, at, around = np.empty((2, count)), np.empty((2, count), dtype=np.int64), np.empty((2, 3, count))
    where, work = (sections.rows, sections.curves, *inside), np.empty((2, PLACES))
    compiled(look_closely)(_control(chains), chains.shifts, where, _of(arcs), fractions, work, largest, at, around)
    return largest, at, around


def raise_to(chains: Chains, sections: Sections, arcs: Biarcs, places: FloatArray, worst: FloatArray) -> None:
    """Raise distance and turn (2, n) to what they are at one more place each (2, n)."""
    where = sections.rows, sections.curves, sections.low, sections.high
    compiled(look_again)(_control(chains), chains.shifts, where, _of(arcs), places, worst)


def leaning_angles(
    chains: Chains, spans: Spans, arcs: Biarcs, fractions: FloatArray, sweeps: int, norm: float, stride: float
) -> FloatArray:
    """Angles that directions at the ends of spans are turned by, (n,), 0 at those of stretches."""
    angle = np.zeros(len(spans))
    off, start, end = (np.empty((len(spans), LOOKS)) for _ in range(3))
    where = spans.ids, spans.stretch, spans.low, spans.high, spans.p0, spans.p1
    numbers = fractions, sweeps, norm, stride
    compiled(lean_all)(_columns(chains), where, _of(arcs), *numbers, off, start, end, np.empty((2, 2 * LOOKS)), angle)
    return angle


def _control(chains: Chains) -> ComplexArray:
    curves: Any = chains.curves  # cubics
    control: ComplexArray = curves.control
    return control


def _columns(chains: Chains) -> tuple[Any, ...]:
    ends = chains.headings, chains.leavings
    return _control(chains), chains.offsets, chains.shifts, chains.starts, chains.stops, *ends


def _of(arcs: Biarcs) -> tuple[ComplexArray, ComplexArray, FloatArray, FloatArray]:
    return arcs.joint, arcs.along, arcs.bend0, arcs.bend1
