"""Thumbnails: what a card of the page's gallery shows."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from importers.errors import WallkitError
from wallkit.scene.opening import open_scene
from wallkit.scene.wishes import Wishes
from wallkit.view.picture import draw_walls, started
from wallkit.view.run_picture import draw_starts, scene_box


def thumbnail(path: Path) -> str:
    """Give the small picture of a file, as an SVG document: its walls, and its balls where they start."""
    try:
        scene = open_scene(path, Wishes(may_be_empty=True)).scene
    except WallkitError:  # a sample of errors has no picture
        return '<svg xmlns="http://www.w3.org/2000/svg" width="1" height="1"/>'
    canvas, frame = started(scene_box(scene), scene.walls.y_axis == "up", title="", width=420)
    canvas.height = frame.height + 2 * frame.top
    draw_walls(canvas, scene.walls, frame, normals=False, free=np.asarray(scene.balls.position))
    draw_starts(canvas, scene, frame)
    return canvas.to_svg()
