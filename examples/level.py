"""A level for a game engine: a drawing becomes a Tiled map, and what the format cannot say is told."""

from pathlib import Path

import wallkit

walls = wallkit.open_scene("samples/pinball.svg").scene.walls
for problem in walls.export("pinball.tmj", grid=0.5):
    print(problem.code, "-", problem.message)
Path("pinball.svg").write_text(walls.to_svg(title="pinball"), encoding="utf-8")
print("wrote pinball.tmj and pinball.svg,", Path("pinball.tmj").stat().st_size, "bytes")
