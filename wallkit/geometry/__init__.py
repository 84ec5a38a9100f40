"""Plane geometry of numbers and arrays: arcs, cubics, rings, triangles; it knows no walls."""
