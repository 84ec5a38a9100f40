"""Pages to hand out: a folder with one page a scene, each with its run, and a first page that leads to them.

No page needs a server, nor another file of the folder: any web server shows them, and so does a browser from a disk.
"""

from __future__ import annotations

import base64
import re
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path

from importers.errors import WallkitError
from wallkit.scene.lesson import Lesson
from wallkit.simulation.run import Run
from wallkit.view.page import look
from wallkit.view.replay import policy, replay_page
from wallkit.view.run_picture import run_thumbnail
from wallkit.write_file import write_whole

INDEX = "index.html"
SHORT = 50  # letters of a sentence that is followed by another one


@dataclass(frozen=True, slots=True)
class Exhibit:
    """One page of the folder.

    Attributes:
        name: of the file that it was made of; gives the page its own name.
        run: what it plays.
        lesson: its text and questions, or None.
    """

    name: str
    run: Run
    lesson: Lesson | None = None

    @property
    def title(self) -> str:
        """What people see above it."""
        return self.lesson.title if self.lesson is not None else self.name

    @property
    def about(self) -> str:
        """A sentence or two for its card: those with which the lesson begins."""
        words = " ".join(self.lesson.text.split()) if self.lesson is not None else ""
        first, *rest = re.split(r"(?<=[.!?])\s", words, maxsplit=2)
        return f"{first} {rest[0]}" if rest and len(first) < SHORT else first


def write_pages(folder: Path, exhibits: Sequence[Exhibit], title: str = "") -> list[Path]:
    """Write the folder's first page and one page an exhibit, and give their paths; other files in it stay.

    Args:
        folder: made where it does not exist.
        exhibits: in the order in which one leads to the next.
        title: of the first page; ``"Lessons"`` or ``"Levels"`` by default.

    Raises:
        WallkitError: the folder cannot be written.
    """
    names = page_names([exhibit.name for exhibit in exhibits])
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise WallkitError(
            f"cannot make the folder: {error.strerror}", code="cannot-write", file=str(folder)
        ) from error
    title = title or ("Lessons" if all(exhibit.lesson is not None for exhibit in exhibits) else "Levels")
    pages = {INDEX: index_html(exhibits, names, title)}
    for index, exhibit in enumerate(exhibits):
        links = _links(title, names, index)
        pages[names[index]] = replay_page(exhibit.run, exhibit.title, lesson=exhibit.lesson, links=links)
    for name, text in pages.items():
        write_whole(str(folder / name), text)
    return [folder / name for name in pages]


def page_names(names: Sequence[str]) -> list[str]:
    """Give each page a file name of letters, digits and hyphens that no other has."""
    taken = {INDEX}
    found = []
    for name in names:
        stem = re.sub(r"[^a-z0-9]+", "-", Path(name).stem.lower()).strip("-")[:60] or "page"
        page = next(page for count in range(1, len(names) + 2)
                    if (page := f"{stem}{f'-{count}' if count > 1 else ''}.html") not in taken)  # fmt: skip
        taken.add(page)
        found.append(page)
    return found


def index_html(exhibits: Sequence[Exhibit], names: Sequence[str], title: str) -> str:
    """Write the first page: a card for each page."""
    style = look.theme_css() + "".join(look.part(name) for name in ("look.css", "cards.css", "exported.css"))
    cards = "\n".join(_card(exhibit, name) for exhibit, name in zip(exhibits, names, strict=True))
    return look.filled(
        "exported.html", {"title": escape(title), "policy": policy(style), "style": style, "cards": cards}
    )


def _card(exhibit: Exhibit, name: str) -> str:
    picture = base64.b64encode(run_thumbnail(exhibit.run).encode("utf-8")).decode("ascii")
    return (
        f'<li><a href="{name}"><img src="data:image/svg+xml;base64,{picture}" alt="">'
        f'<span class="name">{escape(exhibit.title)}</span><span class="about">{escape(exhibit.about)}</span></a></li>'
    )


def _links(title: str, names: Sequence[str], index: int) -> str:
    """Write the ways to the first page, to the page before and to the next one."""
    links = [f'<a class="button" href="{INDEX}">{escape(title)}</a>']
    if index > 0:
        links.append(f'<a class="button" rel="prev" href="{names[index - 1]}" aria-label="Page before">\u2039</a>')
    if index + 1 < len(names):
        links.append(f'<a class="button" rel="next" href="{names[index + 1]}" aria-label="Next page">\u203a</a>')
    return f'<nav aria-label="Pages">{"".join(links)}</nav>'
