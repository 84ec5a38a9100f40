"""Replay: one run as one HTML file that needs nothing else, offline, for a class or a colleague."""

from __future__ import annotations

import base64
import hashlib
from dataclasses import replace
from html import escape
from typing import TYPE_CHECKING, cast

import numpy as np

from importers.errors import WallkitError
from wallkit.arguments import of_type, text, whole_number
from wallkit.scene.lesson import Lesson
from wallkit.simulation.run import Run, one_a_ball
from wallkit.view.frame import Box
from wallkit.view.page import look
from wallkit.view.page.payload import Table, inlined, run_table, starts, walls_table

if TYPE_CHECKING:
    from wallkit.simulation.world import Way

MAX_CONTACTS = 1_000_000
"""So many contacts are in a replay at most (about 50 MB of it); a longer run is thinned, and says so."""


def replay_html(run: Run, *, title: str = "", max_contacts: int = MAX_CONTACTS, lesson: Lesson | None = None) -> str:
    """Write a run as one self-contained HTML document: play, pause, step, scrub, ghosts, normals, zoom.

    The motion is drawn from the contacts alone: each frame shows the state after the last contact before it,
    carried on as p + v dt + g dt^2 / 2, so it is exact at any frame rate and any speed of playing.

    A run of more contacts than ``max_contacts`` is thinned: whole balls are left out, evenly, until the others fit;
    where one ball alone has too many, its path ends early. What is shown stays exact, and the page says what is not.

    Args:
        run: what is shown.
        title: the document's title; the source's name by default.
        max_contacts: the largest number of contacts to carry.
        lesson: a text with questions that stands beside it, as ``open_scene`` gives it; where it names a way to step by
            frames, these are shown over it.

    Raises:
        WallkitError: an argument is none of what may be.
    """
    of_type(run, "run", Run, "a Run", error=WallkitError, code="bad-argument")
    text(title, "title", error=WallkitError, code="bad-argument")
    may_be = "a whole number, 1 or more"
    whole_number(max_contacts, "max_contacts", may_be, error=WallkitError, code="bad-argument", least=1)
    of_type(lesson, "lesson", (Lesson, type(None)), "a Lesson or None", error=WallkitError, code="bad-argument")
    return replay_page(run, title, max_contacts, lesson)


def replay_page(
    run: Run, title: str = "", max_contacts: int = MAX_CONTACTS, lesson: Lesson | None = None, links: str = ""
) -> str:
    """Write what :func:`replay_html` says, with ``links``, which is HTML, beside its title."""
    shown, left_out = thinned(run, max_contacts)
    name = title or run.scene.walls.source_file or "wallkit replay"
    data = {
        "title": name,
        "colours": look.colours(),
        "walls": walls_table(run.scene.walls, starts(run)[:, :2], run.scene.sensors),
        "run": run_table(shown, left_out=left_out),
        "box": whole_box(run),
        "lesson": lesson.to_json() if lesson is not None else None,
        "frames": frames_table(run, lesson) if lesson is not None and lesson.way else None,
    }
    style = look.theme_css() + "".join(look.part(name) for name in (*look.SHARED_STYLES, "replay.css", "sheet.css"))
    script = "\n".join(look.part(name) for name in (*look.SHARED_SCRIPTS, "ways.js", "replay.js"))
    values = {"title": escape(name), "policy": policy(style, script), "links": links, "style": style, "script": script}
    return look.filled("replay.html", {**values, "data": inlined(data)})


def frames_table(run: Run, lesson: Lesson) -> Table:
    """Give the balls as a program that steps by frames has them, as static/ways.js reads it."""
    from wallkit.view.page.ways import stepped_of, stepped_table

    return stepped_table(run, stepped_of(run, cast("Way", lesson.way), lesson.dt))


def policy(style: str, script: str = "") -> str:
    """Give the Content-Security-Policy of a page that carries all that it needs: nothing else may run or be loaded."""
    runs = f"script-src {_hash(script)}; " if script else ""
    return f"default-src 'none'; img-src data:; {runs}style-src {_hash(style)}; base-uri 'none'; form-action 'none'"


def thinned(run: Run, most: int) -> tuple[Run, str]:
    """Leave out whole balls, then the end of the last one's path, until at most ``most`` contacts remain.

    Returns:
        The run that is left, and a sentence on what is not in it; ``""`` where all is.
    """
    if len(run.contacts) <= most:
        return run, ""
    total = int(run.bounces.sum())
    balls = len(run.final)
    stride = 2
    contacts = np.bincount(one_a_ball(run.contacts)["ball"], minlength=balls)
    while stride < balls and contacts[::stride].sum() > most:
        stride += 1
    kept = np.arange(0, balls, min(stride, balls))
    small = run.take(kept)
    words = f"{len(kept):,} of {balls:,} balls" if len(kept) < balls else ""
    if len(small.contacts) > most:
        small = _ended(small, most)
        until = f"the first {int(small.bounces.sum()):,} bounces, up to {small.final['time'].max():.6g} s"
        words = f"{words}; {until}" if words else until
    return small, f"Shown: {words}. The run has {total:,} bounces; a replay carries {most:,} contacts at most."


def _ended(run: Run, most: int) -> Run:
    """End every ball at the time of the last contact that is kept."""
    contacts = run.contacts[:most]
    end = float(contacts["time"][-1])
    state = np.hstack([run.position(end), run.velocity(end)])
    final = run.final.copy()
    late = final["time"] > end
    for index, name in enumerate(("x", "y", "vx", "vy")):
        final[name][late] = state[late, index]
    final["time"][late] = end
    return replace(run, contacts=contacts, final=final)


def whole_box(run: Run) -> Box:
    """Give the box of the walls, of where the balls start, and of the paths of those that fall."""
    from wallkit.view.frame import united, walls_box
    from wallkit.view.run_picture import run_box

    places = [(x, y, x, y) for x, y, _, _ in starts(run).tolist()]
    return run_box(run, united([*([walls_box(run.scene.walls)] if len(run.scene.walls) else []), *places]))


def _hash(text: str) -> str:
    digest = hashlib.sha256(text.encode("utf-8")).digest()
    return f"'sha256-{base64.b64encode(digest).decode('ascii')}'"
