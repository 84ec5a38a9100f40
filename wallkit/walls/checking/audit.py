"""The second opinion: random points of walls against the drawn curves as svgpathtools has them.

Walls come with the largest distance to the drawn curves that wallkit itself measured. Here nothing of that is used:
the curves are evaluated by svgpathtools, and each point is held to the number.

Why that is a fair test: the edge that stands for a piece of a curve ends where the piece does. The foot on the edge of
a point that runs along the piece runs, without a jump, from one end of the edge to the other, so each point of the
edge is the foot of some point of the curve, and no farther from it than the largest distance that was measured.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely

from importers.drawing import Drawing
from importers.problems import Problem
from wallkit.geometry.arrays import FloatArray, IntArray
from wallkit.geometry.bulge_arcs import edge_points
from wallkit.walls.import_options import ImportOptions
from wallkit.walls.walls import Walls

SAMPLES = 33
"""Points of a curve among which the nearest one is looked for before it is looked for exactly."""
MEASURED_SHORT = 1e-3
"""The measured error falls short of the true one by less than this part, see ``fit_arcs``."""
ROUNDING = 2.0**-40
"""Of the size of everything: places of curves and walls are known to some 2^-50 of it."""
ROUNDING_OF_ARCS = 2.0**-25
"""svgpathtools takes the angles of an arc from acos, of numbers near 1 too: then half the digits are lost. Arcs near
half an ellipse, where it loses more, are cut by the readers."""


@dataclass(frozen=True, slots=True, eq=False)
class Audit:
    """What came of it, in the walls' units.

    Attributes:
        of: the walls.
        places: (n, 2) points of the walls.
        walls: (n,) on which of them each is.
        distance: (n,) from the nearest drawn curve; inf where that is beyond what is allowed and no curve is near.
        allowed: the largest distance that the walls claim, and what rounding may add.
    """

    of: Walls
    places: FloatArray
    walls: IntArray
    distance: FloatArray
    allowed: float

    @property
    def beyond(self) -> IntArray:
        """Which points are farther from the curves than is allowed."""
        return np.flatnonzero(self.distance > self.allowed)

    @property
    def largest(self) -> float:
        """The largest distance found; 0 without a point."""
        return float(self.distance.max(initial=0.0))

    def problems(self) -> list[Problem]:
        """Tell each point that is too far from every drawn curve."""
        fix = "report it with the drawing: the walls are not where wallkit says that they are"
        problems = []
        for index in self.beyond.tolist():
            wall, (x, y), distance = int(self.walls[index]), self.places[index].tolist(), float(self.distance[index])
            far = "near no drawn curve" if math.isinf(distance) else f"{distance:.6g} from the nearest drawn curve"
            message = f"a point of this wall is {far}, and {self.of.measured_error:.6g} was measured"
            layer, name = self.of.layers[wall], self.of.names[wall]
            problems.append(Problem("off-the-curve", "error", message, fix, layer, name, x=x, y=y))
        return problems

    def to_json(self) -> dict[str, Any]:
        """Give it as ``wallkit check --json`` has it; ``largest`` is null where a point is near no curve."""
        largest = self.largest if math.isfinite(self.largest) else None
        counts = {"points": len(self.places), "beyond": len(self.beyond)}
        return {**counts, "largest": largest, "measured_error": self.of.measured_error}

    def sentence(self) -> str:
        """Say it in a line."""
        points, claimed = len(self.places), self.of.measured_error
        if len(self.beyond):
            return f"audit: {len(self.beyond)} of {points} points are off the curves by more than {claimed:.3g}"
        return (
            f"audit: {points} points of the walls are within {self.largest:.3g} of the curves as svgpathtools has them "
            f"(largest distance measured {claimed:.3g})"
        )


def audit(walls: Walls, drawing: Drawing, count: int, options: ImportOptions) -> Audit:
    """Hold points of the walls, evenly spread by chance, against the curves of the drawing.

    Args:
        walls: made of the drawing.
        drawing: in its place, see :func:`wallkit.walls.importing.placing.placed`.
        count: points; always the same ones of the same walls.
        options: with which the walls were made; scale and flip are asked.
    """
    places, owners = random_places(walls, count)
    x0, y0, x1, y1 = walls.box()
    segments = [
        one for path in drawing.to_svgpathtools() for one in path if one.start != one.end or not _is(one, "Line")
    ]
    rounding = ROUNDING_OF_ARCS if any(_is(segment, "Arc") for segment in segments) else ROUNDING
    allowed = walls.measured_error * (1 + MEASURED_SHORT) + rounding * max(abs(x0), abs(y0), abs(x1), abs(y1))
    drawn = places / (options.scale, -options.scale if options.flip_y else options.scale)
    distance = options.scale * nearest_distances(segments, drawn, allowed / options.scale)
    return Audit(walls, places, owners, distance, allowed)


def random_places(walls: Walls, count: int) -> tuple[FloatArray, IntArray]:
    """Points of the walls, as likely everywhere, and their walls: (n, 2) and (n,); none of walls without a length."""
    a, b, bulge = walls.vertices[walls.edge_starts], walls.vertices[walls.edge_ends], walls.bulges[walls.edge_starts]
    half = 2 * np.arctan(np.abs(bulge))
    length = np.hypot(*(b - a).T) / np.sinc(half / math.pi)  # the arc r A over its chord 2 r sin(A / 2)
    if not length.sum():
        return np.empty((0, 2)), np.empty(0, dtype=np.int64)
    random = np.random.default_rng(0)
    edge = random.choice(len(length), size=count, p=length / length.sum())
    wall = np.searchsorted(walls.edge_offsets, edge, side="right") - 1
    return edge_points(a[edge], b[edge], bulge[edge], random.random(count)), wall.astype(np.int64)


def nearest_distances(segments: list[Any], places: FloatArray, within: float) -> FloatArray:
    """Distance from each of (n, 2) places to the nearest of some svgpathtools segments; inf if farther than within."""
    if not segments or not len(places):
        return np.full(len(places), np.inf)
    samples = [np.array([segment.point(t) for t in np.linspace(0.0, 1.0, SAMPLES)]) for segment in segments]
    tree = shapely.STRtree([_hull(segment, points) for segment, points in zip(segments, samples, strict=True)])
    result = np.full(len(places), np.inf)
    at, near = tree.query(shapely.points(places), predicate="dwithin", distance=within)
    for place, segment in zip(at.tolist(), near.tolist(), strict=True):
        x, y = places[place].tolist()
        distance = _distance(segments[segment], samples[segment], complex(x, y))
        result[place] = min(result[place], distance)
    return result


def _is(segment: Any, kind: str) -> bool:
    return type(segment).__name__ == kind


def _hull(segment: Any, samples: np.ndarray) -> Any:
    """Give what holds a segment: the hull of its control points, or of an arc the box that svgpathtools gives."""
    if _is(segment, "Arc"):
        x0, x1, y0, y1 = segment.bbox()
        points = np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]])
    else:
        controls = np.array(segment.bpoints())
        points = np.stack([controls.real, controls.imag], axis=1)
    return shapely.convex_hull(shapely.multipoints(points))


def _distance(segment: Any, samples: np.ndarray, place: complex) -> float:
    """Distance from a place to a segment: around the nearest sample the exact least one.

    Least squares find t to some 1e-8; one step of Newton's method on the foot, (p - c(t)) . c'(t) = 0 with c'' left
    out, which the distance multiplies, takes it to rounding where the place is on the curve.
    """
    from scipy.optimize import minimize_scalar

    best = int(np.abs(samples - place).argmin())
    low, high = max(best - 1, 0) / (SAMPLES - 1), min(best + 1, SAMPLES - 1) / (SAMPLES - 1)
    t = minimize_scalar(lambda t: abs(segment.point(t) - place) ** 2, bounds=(low, high), method="bounded").x
    velocity = segment.derivative(t)
    if velocity:
        t += ((place - segment.point(t)) / velocity).real
    closer = abs(segment.point(min(max(t, low), high)) - place)
    return float(min(closer, abs(samples[best] - place)))
