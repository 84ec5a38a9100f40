"""Readers of vector files: each turns a file into a plain :class:`importers.drawing.Drawing`.

Nothing here knows of walls, balls or screens. Use it through ``wallkit`` (``wallkit.read_drawing``): the
name ``importers`` is common, and a folder of that name beside a user's script would shadow this package.
"""
