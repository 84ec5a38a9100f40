"""From a drawing to walls: what was read, what is doubtful, what a repair changes."""

import wallkit

walls = wallkit.import_walls("samples/leaky-room.svg", curves="arcs")
print(walls)
for problem in walls.problems:
    print(" ", problem.severity, problem.code, "at", (problem.x, problem.y), "-", problem.fix)

for gap in wallkit.free_space(walls).leaks(radius=0.1):
    print(f"  a ball of radius 0.1 gets out through a gap {gap.width:.3g} wide between {gap.a} and {gap.b}")

closed = wallkit.import_walls("samples/leaky-room.svg", curves="arcs", snap=0.6)
print("with snap:", closed, "-", len(wallkit.free_space(closed).leaks(radius=0.1)), "leaks")
closed.save("walls.json")
