"""Make the pictures of the README and these pages: python docs/make_pictures.py, from the repository's root."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from wallkit import ImportOptions, Run, aim, simulate, step_through
from wallkit.scene.opening import Wishes, open_scene
from wallkit.view.aim_picture import aim_canvas
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


PICTURES: dict[str, Callable[[], str | bytes]] = {
    "lagoon.svg": lagoon,
    "lagoon-walls.svg": lagoon_walls,
    "pinball.svg": pinball,
    "stadium-heat.png": stadium_heat,
    "aim.svg": aimed,
    "sinai.gif": sinai_film,
    "overlap.svg": overlap,
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
