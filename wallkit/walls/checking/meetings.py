"""Where lines and arcs meet: the points that two edges, or the line or circle that one is on, have in common."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray
from wallkit.geometry.exact_edges import ComplexArray, ExactEdges

_SLACK = 1e-12  # of an edge: what rounding does to the part of it at which a point lies


def meetings(e: ExactEdges, f: ExactEdges) -> ComplexArray:
    """The common points of the whole lines or circles that edges are on, pair by pair: (n, 2), NaN where none.

    Of lines alone (n, 1).

    Lines: e.a + t d with t = ((f.a - e.a) x d') / (d x d'). A line and a circle: the foot of the centre, and along
    the line by sqrt(R^2 - distance^2). Two circles at a distance D: a = (R^2 - R'^2 + D^2) / (2 D) along the line
    of centres, and across it by sqrt(R^2 - a^2).
    """
    d, other = e.b - e.a, f.b - f.a
    with np.errstate(divide="ignore", invalid="ignore"):
        straight = e.a + d * (cross(f.a - e.a, other) / cross(d, other))
        if not e.radius.any() and not f.radius.any():
            return straight[:, None]
        foot, half = _on_circle(e, f.centre, f.radius)
        ahead = half * d / np.abs(d)
        back_foot, back_half = _on_circle(f, e.centre, e.radius)
        back = back_half * other / np.abs(other)
        between = f.centre - e.centre
        apart = np.abs(between)
        along = (e.radius**2 - f.radius**2 + apart**2) / (2 * apart)
        across = np.sqrt(e.radius**2 - along**2)
        middle, aside = e.centre + between / apart * along, 1j * between / apart * across
    nothing = np.full(len(d), np.nan, dtype=np.complex128)
    kinds = [(e.radius == 0) & (f.radius == 0), e.radius == 0, f.radius == 0]
    one = np.select(kinds, [straight, foot + ahead, back_foot + back], middle + aside)
    two = np.select(kinds, [nothing, foot - ahead, back_foot - back], middle - aside)
    return np.stack([one, two], axis=1)


def on_edge(e: ExactEdges, point: ComplexArray) -> NDArray[np.bool_]:
    """Tell whether points of the line or circle that an edge is on lie between the edge's ends, or on one of them."""
    part = part_of(e, point)
    inside: NDArray[np.bool_] = (part >= -_SLACK) & (part <= 1 + _SLACK)
    return inside


def part_of(e: ExactEdges, point: ComplexArray) -> FloatArray:
    """The part of an edge's length at which a point of its line or circle lies: 0 at its start, 1 at its end."""
    d = e.b - e.a
    with np.errstate(divide="ignore", invalid="ignore"):
        part: FloatArray = ((point - e.a) * d.conj()).real / np.abs(d) ** 2
        if not e.radius.any():
            return part
        turned = np.angle((point - e.centre) / (e.a - e.centre)) * np.sign(e.angle)
        turned = np.where(turned < -_SLACK, turned + 2 * np.pi, turned)
        round_ = turned / np.abs(e.angle)
    result: FloatArray = np.where(e.radius > 0, round_, part)
    return result


def cross(u: ComplexArray, v: ComplexArray) -> FloatArray:
    """The cross product of plane vectors."""
    product: FloatArray = u.real * v.imag - u.imag * v.real
    return product


def _on_circle(line: ExactEdges, centre: ComplexArray, radius: FloatArray) -> tuple[ComplexArray, FloatArray]:
    """The foot of a centre on a line, and how far from it the circle is met; NaN where it is not."""
    d = line.b - line.a
    foot = line.a + d * (((centre - line.a) * d.conj()).real / np.abs(d) ** 2)
    half: FloatArray = np.sqrt(radius**2 - np.abs(foot - centre) ** 2)
    return foot, half
