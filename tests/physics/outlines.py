"""Rings of lines and arcs as polygons of shapely, which tell whether a ball has left."""

import math

import numpy as np
import shapely


def outline(points, bulges, pieces=400):
    """The ring with its arcs cut into many chords, and how far these miss the arcs."""
    path, missed = [], 0.0
    for a, b, bulge in zip(points, np.roll(points, -1, axis=0), bulges, strict=True):
        if bulge == 0.0:
            path.append(a)
            continue
        angle = 4 * math.atan(bulge)
        chord = b - a
        left = np.array([-chord[1], chord[0]])
        centre = (a + b) / 2 + left * (1 - bulge**2) / (4 * bulge)
        radius = math.hypot(*(a - centre))
        turns = math.atan2(*(a - centre)[::-1]) + angle * np.arange(pieces) / pieces
        path.extend(centre + radius * np.stack([np.cos(turns), np.sin(turns)], axis=1))
        missed = max(missed, radius * (1 - math.cos(angle / pieces / 2)))
    return shapely.Polygon(path), missed
