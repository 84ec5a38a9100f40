"""Make the pictures of the page for the README: ``python docs/make_screenshots.py`` writes docs/images/page-*.png.

Needs the extra ``test`` (playwright) and a Chromium on the PATH. Each picture is the page itself, in a state that a
person reaches with a few clicks.
"""

from __future__ import annotations

import shutil
import sys
import threading
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from playwright.sync_api import sync_playwright

from wallkit.cli.play import reader
from wallkit.view.page.server import PageServer
from wallkit.view.page.workers import Workers

IMAGES = Path(__file__).parent / "images"
NAMES = ("chromium", "chromium-browser", "google-chrome")
ARGUMENTS = ["--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run",
             "--disable-background-networking", "--disable-component-update", "--disable-sync"]  # fmt: skip
DESKTOP, PHONE = (1280, 800), (390, 844)


@dataclass(frozen=True)
class Shot:
    """One picture: its name, the window, light or dark, and how to get there."""

    name: str
    size: tuple[int, int]
    scheme: str
    act: Callable[[Any], None]


def opened(page: Any, sample: str) -> None:
    """Open a sample and wait for the foretold path."""
    page.get_by_role("button", name=sample, exact=False).first.click()
    wait(page, "Wallkit.page.document && Wallkit.page.aim.foretold && !Wallkit.page.foretelling.busy")


def flying(page: Any, button: str, after: float) -> None:
    """Shoot, and stop the clock at a given part of what is known of the run."""
    page.locator(button).click()
    wait(page, "Wallkit.page.player.motion && !Wallkit.page.flying.busy")
    page.evaluate(
        """(part) => { const {player} = Wallkit.page; player.pause(); player.seek(part * player.motion.duration);
        document.activeElement.blur(); }""",
        after,
    )


def wait(page: Any, condition: str) -> None:
    """Wait until something holds in the page."""
    page.evaluate(
        f"new Promise((done) => {{ const look = () => ({condition}) ? done() : setTimeout(look, 20); look(); }})"
    )


def gallery(page: Any) -> None:
    """Wait for the pictures of the samples that are in sight; others load when they come into it."""
    seen = "[...document.images].filter((image) => image.getBoundingClientRect().top < innerHeight)"
    wait(page, f"{seen}.every((image) => image.complete)")


def aiming(page: Any) -> None:
    """Aim in the lagoon, by a drag from the ball."""
    opened(page, "Lagoon")
    box = page.locator("#stage").bounding_box()
    x, y = page.evaluate("(({stage, aim}) => [stage.screenX(aim.ball.x), stage.screenY(aim.ball.y)])(Wallkit.page)")
    page.mouse.move(box["x"] + x, box["y"] + y)
    page.mouse.down()
    page.mouse.move(box["x"] + x + 90, box["y"] + y - 120, steps=5)
    page.mouse.up()
    wait(page, "!Wallkit.page.foretelling.busy")


def fan(page: Any) -> None:
    """A hundred balls, close together at first, in Sinai's table."""
    opened(page, "Sinai")
    page.locator("#spread").fill("8")
    flying(page, "#fan", 0.13)


def stepping(page: Any) -> None:
    """Stand exactly at a bounce, the normal drawn."""
    opened(page, "Stadium")
    flying(page, "#shoot", 0.115)
    page.keyboard.press(".")
    wait(page, "!Wallkit.page.player.asked")


def graphs(page: Any) -> None:
    """Stand at a bounce under gravity, in metres, with graphs, strobe ghosts and a protractor."""
    opened(page, "Lagoon")
    page.locator("#metre").fill("100")
    page.locator("#gravity-number").fill("1.5")
    wait(page, "!Wallkit.page.foretelling.busy")
    flying(page, "#shoot", 0.17)
    for name in ("height", "speed", "energy"):
        page.locator(f"[data-graph={name}]").check()
    page.locator("[data-show=strobe]").check()
    page.keyboard.press(".")
    page.evaluate("document.activeElement.blur(); document.querySelector('#bounce').scrollIntoView({block: 'center'})")
    wait(page, "Wallkit.page.instruments.graphs.drawn && !Wallkit.page.instruments.graphs.job")
    wait(page, "!Wallkit.page.player.asked")


def problems(page: Any) -> None:
    """Go to a problem in the list."""
    opened(page, "Leaky room")
    wait(page, "!Wallkit.page.checks.looking.busy")
    page.locator("#problems button").last.click()
    wait(page, "!Wallkit.page.player.asked")


def phone(page: Any) -> None:
    """The same on a phone."""
    opened(page, "Mushroom")
    flying(page, "#shoot", 0.5)


def ways(page: Any) -> None:
    """A ball of a game beside the exact one."""
    opened(page, "Sinai")
    page.locator("#two-panels").click()
    page.select_option("#way-b", "overlap")
    page.locator("#dt-b").fill("0.2")
    flying(page, "#shoot", 0.1)
    page.evaluate("Wallkit.page.player.seek(2.3)")
    page.locator("#other").scroll_into_view_if_needed()
    wait(page, "!Wallkit.page.player.asked")


def lesson(page: Any) -> None:
    """The lesson of frames: its text beside the ball that flies through a wall."""
    opened(page, "The frame that flies through")
    flying(page, "#shoot", 0.0)
    page.evaluate("Wallkit.page.player.seek(0.27)")
    wait(page, "!Wallkit.page.player.asked")


SHOTS = (
    Shot("page-gallery", DESKTOP, "light", gallery),
    Shot("page-aim", DESKTOP, "light", aiming),
    Shot("page-fan", DESKTOP, "dark", fan),
    Shot("page-bounce", DESKTOP, "light", stepping),
    Shot("page-graphs", DESKTOP, "light", graphs),
    Shot("page-problem", DESKTOP, "dark", problems),
    Shot("page-ways", DESKTOP, "light", ways),
    Shot("page-lesson", DESKTOP, "light", lesson),
    Shot("page-phone", PHONE, "light", phone),
)


def main() -> int:
    """Make all pictures, or those named as arguments."""
    found = next(filter(None, map(shutil.which, NAMES)), None)
    if not found:
        print(f"no browser: none of {', '.join(NAMES)} is on the PATH", file=sys.stderr)
        return 2
    IMAGES.mkdir(exist_ok=True)
    with PageServer(Workers(reader())) as server, sync_playwright() as driver:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        browser = driver.chromium.launch(executable_path=found, args=ARGUMENTS)
        for shot in SHOTS:
            if sys.argv[1:] and shot.name not in sys.argv[1:]:
                continue
            width, height = shot.size
            page = browser.new_page(
                viewport={"width": width, "height": height}, color_scheme=shot.scheme, reduced_motion="reduce"
            )
            page.goto(server.url)
            shot.act(page)
            page.screenshot(path=IMAGES / f"{shot.name}.png")
            page.close()
            print(IMAGES / f"{shot.name}.png")
        browser.close()
        server.shutdown()
    return 0


if __name__ == "__main__":
    sys.exit(main())
