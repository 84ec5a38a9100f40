"""`wallkit check --balls N`: what many balls find out about a level, in words, as a page, as JSON."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from wallkit.levels.check_level import LevelCheck
    from wallkit.levels.starts import Starts
    from wallkit.scene.opening import OpenedScene
    from wallkit.scene.wishes import Wishes
    from wallkit.walls.import_options import ImportOptions

BOUNCES = 2000
"""Of a ball, unless somebody says otherwise: enough to tell a trap from a slow ball."""


@dataclass(frozen=True, slots=True)
class Wanted:
    """The options of ``check`` that are about balls, as they are given."""

    balls: str | None
    start: str | None
    target: str | None
    until: float | None
    bounces: int | None
    speed: float | None
    gravity: str | None
    seed: int | None
    out: str | None
    executor: str
    workers: int | None
    checkpoint: str | None

    @property
    def many(self) -> int | None:
        """How many balls; None where none are asked for."""
        from wallkit.cli.survey import how_many

        return None if self.balls is None else how_many(self.balls)

    def check(self) -> None:
        """Refuse what goes with balls alone, and a page that is none.

        Raises:
            UsageError: --balls is missing, or the page's name ends otherwise.
        """
        from wallkit.scene.wishes import UsageError

        asked = {"--from": self.start, "--to": self.target, "--until": self.until, "--bounces": self.bounces,
                 "--speed": self.speed, "-o": self.out, "--checkpoint": self.checkpoint,
                 "--seed": self.seed}  # fmt: skip
        alone = [name for name, value in asked.items() if value is not None]
        if self.many is None and alone:
            fix = "say how many balls fly, such as --balls 10000"
            raise UsageError(f"{', '.join(alone)}: only with --balls", code="usage", fix=fix)
        if self.out is not None and not self.out.lower().endswith((".html", ".htm")):
            fix = "give a name that ends on .html; --preview draws a picture"
            raise UsageError("the report is a page", code="unknown-ending", fix=fix, file=self.out)

    def wishes(self, importing: ImportOptions) -> Wishes:
        """What is asked of the scene."""
        from wallkit.cli.scene_input import gravity_or_none
        from wallkit.scene.wishes import Wishes

        gravity = gravity_or_none(self.gravity)
        return Wishes(importing=importing, put_ball=False, gravity=gravity, until=self.until, bounces=self.bounces)


@dataclass(frozen=True, slots=True)
class Flown:
    """A check, and what was assumed for it."""

    check: LevelCheck
    starts: Starts
    assumed: list[str]


def fly_balls(opened: OpenedScene, radius: float | None, wanted: Wanted) -> Flown:
    """Fly the balls."""
    from wallkit.cli.progress import progress_bar
    from wallkit.cli.survey import place_given
    from wallkit.levels.check_level import check_level
    from wallkit.levels.starts import starts_of
    from wallkit.levels.targets import given_target

    starts = starts_of(opened, place_given(wanted.start), speed=wanted.speed, radius=radius, seed=wanted.seed or 0)
    until, bounces, assumed = opened.until, opened.bounces, list(starts.assumed)
    if any("--bounces" in words for words in opened.assumed):  # nobody said when balls end
        bounces = BOUNCES
        assumed.append(f"{BOUNCES} bounces a ball (--bounces, --until)")
    many = wanted.many
    assert many is not None
    target = None if wanted.target is None else given_target(wanted.target)
    with progress_bar("checking") as report:
        check = check_level(
            opened.scene, starts.draw, many, until, bounces, target=target,
            executor=wanted.executor, workers=wanted.workers, checkpoint=wanted.checkpoint, progress=report,
        )  # fmt: skip
    return Flown(check, starts, assumed)


def lines(flown: Flown, out: str | None) -> list[str]:
    """Say what the balls found out, a line each."""
    from wallkit.cli.messages import plain

    rows = [*rows_of(flown), *([("wrote", plain(out))] if out not in (None, "-") else [])]
    return [f"{flown.check.balls:,} balls", *(f"  {word:<9}{words}" for word, words in rows)]


def rows_of(flown: Flown) -> list[tuple[str, str]]:
    """Say what the balls found out: (a word, the rest)."""
    from wallkit.levels.check_counts import Fate
    from wallkit.levels.findings import fate_word, quantile_words, share_words

    check = flown.check
    rows = [("flown", f"{check.counts.bounces:,} bounces, radius {flown.starts.radius:g}")]
    told = [one for one in Fate if check.counts.fates[one] or (one is Fate.REACHED and check.goal is not None)]
    rows += [(fate_word(check, one), share_words(check.share(one))) for one in told]
    if check.goal is not None and check.counts.fates[Fate.REACHED]:
        rows += [("after", quantile_words(check.times(), "s")),
                 ("", quantile_words(check.times(bounces=True), "bounces"))]  # fmt: skip
    rows += [("rest at", f"({x:.6g}, {y:.6g}): {balls:,}") for x, y, balls in check.resting()[:5]]
    free, visited, by = check.coverage()
    rows.append(("places", f"{visited:,} of {free:,} squares of side {check.squares.side:.4g} seen by {by:,} balls"))
    return [*rows, *(("assumed", words) for words in flown.assumed)]


def write_page(out: str, flown: Flown, file: str) -> None:
    """Write the page of the report."""
    from wallkit.view.check_page import check_html
    from wallkit.write_file import write_whole

    write_whole(out, check_html(flown.check, rows_of(flown), "" if file == "-" else Path(file).name))
