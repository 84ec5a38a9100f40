"""Arcs fitted to curves, one span at a time; the same bits as what NumPy makes of all at once."""
