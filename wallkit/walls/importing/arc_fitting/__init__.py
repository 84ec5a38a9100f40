"""Curves as circular arcs within a tolerance."""
