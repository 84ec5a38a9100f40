"""The answer beside one with forty digits and more, by other formulas (needs mpmath)."""

import numpy as np

import wallkit

corners = [(-50, -50), (-50, 50), (50, 50), (50, -50)]
stadium = wallkit.Walls.from_polylines([corners], bulges=[[-1, 0, -1, 0]])
scene = wallkit.Scene(stadium, wallkit.Balls([(3, -7)], [(80, 31)]))
run = wallkit.simulate(scene, bounces=12)
for bounce, (contact, exact) in enumerate(zip(run.contacts, wallkit.sure_events(scene, 12), strict=True), 1):
    x, y = float(exact.position[0]), float(exact.position[1])
    print(f"bounce {bounce}: off by {np.hypot(contact['x'] - x, contact['y'] - y):.2g}")
