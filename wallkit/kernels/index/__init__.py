"""The grid over the walls, and how a flight walks through it."""
