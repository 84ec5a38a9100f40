"""Make the pictures of the README and these pages: python docs/make_pictures.py, from the repository's root."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np

from wallkit import Balls, ImportOptions, Run, Scene, Walls, aim, simulate, step_through, survey
from wallkit.scene.opening import open_scene
from wallkit.scene.wishes import Wishes
from wallkit.view.aim_picture import aim_canvas
from wallkit.view.canvas import Canvas, Label, Shape
from wallkit.view.film import film
from wallkit.view.picture import walls_svg
from wallkit.view.raster import png
from wallkit.view.run_picture import run_canvas, run_svg
from wallkit.view.ways_picture import ways_canvas
from wallkit.write_file import write_whole

HERE = Path(__file__).parent
SAMPLES = HERE.parent / "samples"
IMAGES = HERE / "images"


def flown(sample: str, wishes: Wishes) -> Run:
    """Simulate a sample as the command line does."""
    opened = open_scene(SAMPLES / sample, wishes)
    return simulate(opened.scene, opened.until, opened.bounces)


def lagoon() -> str:
    """The README's first picture: a ball among islands drawn in Illustrator."""
    return run_svg(flown("lagoon.ai", Wishes(bounces=70)), title="samples/lagoon.ai, 70 bounces")


def lagoon_walls() -> str:
    """What `wallkit import --preview` shows."""
    walls = flown("lagoon.ai", Wishes(bounces=0)).scene.walls
    return walls_svg(walls, walls.problems, title="samples/lagoon.ai: walls, normals, findings")


def pinball() -> str:
    """Gravity and materials."""
    return run_svg(flown("pinball.toml", Wishes()), title="samples/pinball.toml, coloured by speed", colour="speed")


def stadium_heat() -> bytes:
    """A heat map of many balls."""
    run = flown("stadium.svg", Wishes(balls=200, radius=8, bounces=200, seed=1))
    return png(run_canvas(run, title="samples/stadium.svg: where 200 balls spend their time", heat=True), scale=1.0)


def sinai_film() -> bytes:
    """A film in which close starts part."""
    run = flown(
        "sinai.svg", Wishes(ball=[f"{90 + 0.5 * k},300" for k in range(12)], velocity="240,30", radius=6, bounces=40)
    )
    return film(run, "gif", seconds=8.0)


def overlap() -> str:
    """A ball of a game with a plain overlap test, over the exact path."""
    run = flown("room.svg", Wishes(until=4))
    return ways_canvas(
        run, step_through(run.scene, "overlap", 0.2, 4), title="samples/room.svg, as a first game"
    ).to_svg()


def aimed() -> str:
    """All shots through a room that reach a target."""
    scene = open_scene(SAMPLES / "room.svg", Wishes(importing=ImportOptions(curves="lines"))).scene
    windows = aim(scene, (720, 345), (297, 523, 10), 5)
    return aim_canvas(scene, windows, title="samples/room.svg: all shots that reach the ring within 5 bounces").to_svg()


def maxwell() -> str:
    """Speeds of 2,000 discs that all had the speed 1, before and after they met, beside Maxwell's distribution."""
    random = np.random.default_rng(5)
    places = np.array([(x, y) for x in range(50) for y in range(40)], dtype=float) + 0.5
    angle = random.uniform(0.0, 2.0 * math.pi, len(places))
    balls = Balls(places, np.stack([np.cos(angle), np.sin(angle)], axis=1), 0.3)
    box = Walls.from_polylines([[(0, 0), (0, 40), (50, 40), (50, 0)]])
    speed = np.hypot(*survey(Scene(box, balls, meeting=True), until=30.0).velocity.T)
    step, most, high = 0.1, 3.0, 1.0
    left, bottom, width, height = 56.0, 300.0, 560.0, 250.0
    picture = Canvas(640.0, 350.0, "2,000 discs of one speed, after they have met: Maxwell's distribution")
    picture.add(Label("title", left, 28.0, "2,000 discs that all had the speed 1, 30 s later", 15.0, bold=True))
    for k in range(round(most / step)):
        share = float(np.count_nonzero((speed >= k * step) & (speed < (k + 1) * step))) / len(speed) / step
        x, y = left + k * step / most * width, bottom - share / high * height
        side = step / most * width - 1.0
        bar = [("M", x, bottom), ("L", x, y), ("L", x + side, y), ("L", x + side, bottom), ("Z",)]
        picture.add(Shape("material2", bar, title=f"{k * step:.1f} to {(k + 1) * step:.1f}: {share * step:.1%}"))
    at = np.linspace(0.0, most, 121)
    curve = 2.0 * at * np.exp(-at * at)  # of the speed v in two dimensions, with the mean of v^2 = 1
    line = [
        (left + v / most * width, bottom - p / high * height) for v, p in zip(at.tolist(), curve.tolist(), strict=True)
    ]
    picture.add(Shape("arrow", [("M" if k == 0 else "L", *place) for k, place in enumerate(line)]))
    picture.add(Shape("scale", [("M", left, bottom), ("L", left + width, bottom)]))
    for v in (0.0, 1.0, 2.0, 3.0):
        picture.add(Label("note", left + v / most * width, bottom + 18.0, f"{v:g}", 12.0, "middle"))
    picture.add(Label("text", left + width, bottom + 38.0, "speed", 12.0, "end"))
    picture.add(Label("text", left + 0.46 * width, bottom - 0.62 * height, "Maxwell: 2 v exp(-v\u00b2)", 13.0))
    return picture.to_svg()


PICTURES: dict[str, Callable[[], str | bytes]] = {
    "lagoon.svg": lagoon,
    "lagoon-walls.svg": lagoon_walls,
    "pinball.svg": pinball,
    "stadium-heat.png": stadium_heat,
    "aim.svg": aimed,
    "sinai.gif": sinai_film,
    "overlap.svg": overlap,
    "maxwell.svg": maxwell,
}


def main() -> None:
    """Write every picture."""
    IMAGES.mkdir(exist_ok=True)
    for name, make in PICTURES.items():
        data = make()
        write_whole(IMAGES / name, data)
        print(f"{name}: {len(data):,} {'characters' if isinstance(data, str) else 'bytes'}")


if __name__ == "__main__":
    main()
