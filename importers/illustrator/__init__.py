"""Illustrator reader."""
