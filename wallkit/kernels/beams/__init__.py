"""Beams: intervals of directions from one point, split at vertices and mirrored at walls, in a triangulated room."""
