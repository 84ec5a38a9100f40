"""Chaos: two balls that start a billionth apart in a stadium, and the bounce up to which the answer holds."""

import numpy as np

import wallkit

corners = [(-50, -50), (-50, 50), (50, 50), (50, -50)]
stadium = wallkit.Walls.from_polylines([corners], bulges=[[-1, 0, -1, 0]])
pair = wallkit.Balls([(3, -7), (3, -7)], [(80, 31), (80, 31 + 1e-9)])
run = wallkit.simulate(wallkit.Scene(stadium, pair), until=30)
for time in (1.0, 3.0, 10.0, 30.0):
    first, second = run.position(time)
    print(f"after {time:4g} s they are {np.hypot(*(second - first)):.3g} apart")
print(run.trusted_until()[0].sentence())
