"""The samples and lessons that travel with wallkit: drawings and scenes, each with a line on what it shows."""

from __future__ import annotations

import re
import tomllib
from dataclasses import dataclass
from functools import cache
from pathlib import Path

_PACKAGE = Path(__file__).resolve().parents[1]
# In a wheel they lie inside the package; in a checkout at its top level, where people look for them.
_FOLDERS = (_PACKAGE / "samples_data", _PACKAGE.parent / "samples")
_LESSONS = ("mirror-law", "restitution", "frames", "parabolas", "chaos", "counting-pi")
_ENDINGS = (".ai", ".svg", ".txt", ".toml", ".json", ".pdf")
_COMMENT = re.compile(r"<!--\s*(.*?)\s*-->|\A((?:#[^\n]*\n)+)", re.DOTALL)
_ABOUT = {  # of files whose format has no place for a comment that people would see
    "lagoon.ai": "Shores, islands and guides on several layers, in the text format of Illustrator 8.",
    "pasted-text.txt": "Five lines of path operators, as one would paste them.",
}


@dataclass(frozen=True, slots=True)
class Sample:
    """A file that comes with wallkit.

    Attributes:
        name: its file name.
        title: the name as a heading.
        about: what it shows, a sentence or two.
        path: where it lies.
    """

    name: str
    title: str
    about: str
    path: Path


@cache
def samples() -> tuple[Sample, ...]:
    """List the samples by name; empty where an installation left them out."""
    folder = _folder()
    if folder is None:
        return ()
    return tuple(_sample(path) for path in sorted(folder.iterdir()) if path.suffix in _ENDINGS)


@cache
def lessons() -> tuple[Sample, ...]:
    """List the lessons, in the order in which a class would take them; empty where an installation left them out."""
    folder = _folder()
    if folder is None:
        return ()
    return tuple(_sample(folder / "lessons" / f"{name}.toml") for name in _LESSONS)


def shown() -> tuple[Sample, ...]:
    """Give all that the page's gallery shows: lessons, then samples; no two have one name."""
    return (*lessons(), *samples())


def _folder() -> Path | None:
    return next((folder for folder in _FOLDERS if folder.is_dir()), None)


def _sample(path: Path) -> Sample:
    data = path.read_bytes()
    about = _ABOUT.get(path.name) or _first_comment(data[:4096].decode("utf-8", "replace"))
    if path.parent.name == "lessons":
        title: str = tomllib.loads(data.decode("utf-8"))["lesson"]["title"]
        return Sample(path.name, title, about, path)
    title = path.stem.replace("-", " ").capitalize()
    return Sample(path.name, title if path.suffix != ".toml" else f"{title} (scene)", about, path)


def _first_comment(text: str) -> str:
    found = _COMMENT.search(text)
    words = " ".join((found[1] or found[2].replace("#", " ")).split()) if found else ""
    sentences = [part for part in re.split(r"(?<=[.!?])\s+", words) if not part.startswith("wallkit ")]  # a command
    return " ".join(sentences[:2])
