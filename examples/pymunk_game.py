"""A pinball of sixty lines in pymunk, in walls that come from a drawing.

wallkit export samples/pinball.toml -o level.py
python examples/pymunk_game.py level.py                  says what was hit
python examples/pymunk_game.py level.py --show           the same in a window (pip install pygame)
"""

import argparse
import collections
import importlib.util

import pymunk

FRAME, STEPS = 1 / 60, 8  # seconds; steps a frame, so that the ball moves by less than its radius in each
RADIUS, GRAVITY = 8.0, 400.0  # px, px/s^2 downwards


def load_level(path):
    spec = importlib.util.spec_from_file_location("level", path)
    level = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(level)
    return level


def add_ball(space, position, velocity):
    body = pymunk.Body(1.0, pymunk.moment_for_circle(1.0, 0.0, RADIUS))
    body.position, body.velocity = position, velocity
    ball = pymunk.Circle(body, RADIUS)
    ball.elasticity, ball.friction, ball.collision_type = 1.0, 0.0, 1  # 1: the wall's restitution is the pair's
    space.add(body, ball)
    return body


def play(space, ball, hits, frames, draw=lambda: True):
    def count(arbiter, space, data):
        for shape in arbiter.shapes:
            if hasattr(shape, "wall"):
                hits[shape.wall["name"] or "a wall"] += 1

    space.on_collision(1, None, begin=count)
    for _ in range(frames):
        for _ in range(STEPS):
            space.step(FRAME / STEPS)
        if not draw():
            break


def window(space, walls):
    import pygame
    import pymunk.pygame_util

    points = [point for wall in walls for point in wall["points"]]
    screen = pygame.display.set_mode([int(max(column)) + 20 for column in zip(*points, strict=True)])
    options, clock = pymunk.pygame_util.DrawOptions(screen), pygame.time.Clock()

    def draw():
        screen.fill("white")
        space.debug_draw(options)
        pygame.display.flip()
        clock.tick(60)
        return not any(event.type == pygame.QUIT for event in pygame.event.get())

    return draw


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="A ball in the walls of a level that wallkit exported.")
    parser.add_argument("level")
    parser.add_argument("--ball", type=float, nargs=2, default=(404.0, 640.0), metavar=("X", "Y"))
    parser.add_argument("--velocity", type=float, nargs=2, default=(0.0, -1100.0), metavar=("VX", "VY"))
    parser.add_argument("--frames", type=int, default=600)
    parser.add_argument("--show", action="store_true")
    given = parser.parse_args()
    level, space, hits = load_level(given.level), pymunk.Space(), collections.Counter()
    space.gravity = 0.0, GRAVITY
    level.add_walls(space)
    ball = add_ball(space, given.ball, given.velocity)
    play(space, ball, hits, given.frames, *([window(space, level.WALLS)] if given.show else []))
    print(", ".join(f"{name}: {count}" for name, count in hits.most_common()) or "nothing was hit")
    print(f"the ball is at ({ball.position.x:.1f}, {ball.position.y:.1f})")
