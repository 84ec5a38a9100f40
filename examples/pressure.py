"""Statistics: a thousand balls in a room with a pillar, and how often each wall is hit."""

import wallkit

room = [(-50, -30), (-50, 30), (50, 30), (50, -30)]
pillar = [(-10, 0), (0, -10), (10, 0), (0, 10)]
walls = wallkit.Walls.from_polylines([room, pillar], names=["room", "pillar"])
draw = wallkit.RandomBalls((-45, -25, -15, 25), speed=10, seed=1)
totals = wallkit.survey(wallkit.Scene(walls, draw(0, 1000)), until=20.0)
for name, hits in zip(walls.names, totals.hits, strict=True):
    print(f"{name}: {hits} bounces")
