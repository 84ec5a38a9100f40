"""JSON Schemas of the stable formats, as package data."""
