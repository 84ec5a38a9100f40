"""A game's loop: frames of a sixtieth of a second, exact within each, with a sensor for a goal and a kick."""

import wallkit

room = wallkit.Walls.from_polylines([[(0, 0), (0, 300), (400, 300), (400, 0)]], material=wallkit.Material(0.9))
goal = wallkit.Walls.from_polylines([[(300, 0), (300, 300)]], closed=False, names=["goal"])
ball = wallkit.Balls([(60, 200)], [(180, 40)], radius=8)
world = wallkit.World(wallkit.Scene(room, ball, gravity=(0, -300), sensors=goal))

for frame in range(180):
    for contact in world.step(1 / 60):
        if contact["kind"] >= wallkit.ContactKind.ENTER:
            print(f"frame {frame}: through the goal at {contact['time']:.4f} s")
    if frame == 90:
        world.place(0, velocity=(-150, 250))
x, y = world.position[0]
print(f"after {world.time:g} s the ball is at ({x:.1f}, {y:.1f})")
