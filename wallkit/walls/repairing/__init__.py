"""Passes that mend walls: loose ends, overlaps, slivers."""
