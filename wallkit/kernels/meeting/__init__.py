"""Discs that meet: one queue of events for all of them."""
