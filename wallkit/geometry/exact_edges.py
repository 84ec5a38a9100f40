"""Edges as they are, lines and circular arcs: the nearest point of each."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.bulge_arcs import circles
from wallkit.geometry.segments import foot_part

ComplexArray = NDArray[np.complex128]

_FLAT = 1e-9  # an arc of a smaller bulge bows by less than 1e-9 of its chord and counts as a line here


@dataclass(slots=True, eq=False, repr=False)
class ExactEdges:
    """Lines and arcs as complex numbers: end points, and for arcs centre, radius and the angle that is turned by.

    Attributes:
        a: (n,) start points.
        b: (n,) end points.
        centre: (n,) of arcs; 0 for lines.
        radius: (n,) of arcs; 0 for lines.
        angle: (n,) that an arc turns by; 0 for lines.
    """

    a: ComplexArray
    b: ComplexArray
    centre: ComplexArray
    radius: FloatArray
    angle: FloatArray

    @classmethod
    def of(cls, a: FloatArray, b: FloatArray, bulge: FloatArray) -> ExactEdges:
        """Take edges from a to b, (n, 2) each, with (n,) bulges."""
        round_ = np.abs(bulge) > _FLAT
        centre, radius = circles(a, b, np.where(round_, bulge, 0.0))
        turn = np.where(round_, 4 * np.arctan(bulge), 0.0)
        middle = np.where(round_, as_complex(centre), 0)
        return cls(as_complex(a), as_complex(b), middle, np.where(round_, radius, 0.0), turn)

    def take(self, index: IntArray) -> ExactEdges:
        """Give those at ``index``."""
        return ExactEdges(self.a[index], self.b[index], self.centre[index], self.radius[index], self.angle[index])

    def distance(self, point: ComplexArray) -> FloatArray:
        """Distance of each edge from its ``point``: (n,)."""
        result: FloatArray = np.abs(point - self.nearest(point))
        return result

    def nearest(self, point: ComplexArray) -> ComplexArray:
        """Give each edge's point nearest to its ``point``."""
        d = self.b - self.a
        on_line: ComplexArray = self.a + d * foot_part(((point - self.a) * d.conj()).real, np.abs(d) ** 2)
        if not self.radius.any():
            return on_line
        off = point - self.centre
        with np.errstate(divide="ignore", invalid="ignore"):
            on_circle = self.centre + off / np.abs(off) * self.radius
            turned = np.angle(off / (self.a - self.centre))
        turned = np.where(self.angle < 0, -turned, turned) % (2 * np.pi)
        end = np.where(np.abs(point - self.a) <= np.abs(point - self.b), self.a, self.b)
        on_arc = np.where((turned <= np.abs(self.angle)) & (off != 0), on_circle, end)
        result: ComplexArray = np.where(self.radius > 0, on_arc, on_line)
        return result


def as_complex(points: FloatArray) -> ComplexArray:
    """Give (n, 2) points as x + i y: (n,)."""
    return points[:, 0] + 1j * points[:, 1]
