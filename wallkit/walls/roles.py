"""Roles: what the words of an object, of the groups and of the layer around it make of a path. One place decides.

The nearest word counts: that of a clone, of the object itself, of the groups around it from the innermost out, of its
layer; what a scene file says of materials comes last. Of one level, data go before the note, the note before the label.
A path that nothing speaks of is a wall.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from difflib import get_close_matches
from typing import Literal, NamedTuple, cast

from importers.drawing import DrawnPath, Level
from importers.problems import Problem
from wallkit.walls.fields import MOST_RESTITUTION, Material, Sides
from wallkit.walls.tags import KNOWN, MATERIAL_KEYS, ROLES, Tags, is_no, read_data, read_label, read_note

Role = Literal["wall", "ball", "sensor", "target", "spawn", "ignore"]
"""A ball is a circle, with a line from its centre as its velocity; sensors and targets report a ball and bounce none;
a spawn is a place; what is ignored is left out."""

BALLS_LAYER = "balls"
"""A layer or group of this name says ``ball`` of what is in it."""
_NOTE = "note"
_KEPT_BACK = (_NOTE, "text")  # what readers put among the tags of a path that is no word of its author


class Said(NamedTuple):
    """What is said about one path.

    Attributes:
        role: what it is.
        name: its own, or that of its role (``sensor:goal``), without words.
        layer: its layer's name without words.
        groups: names of the groups around it without words, outermost first.
        tags: all words that count, by key.
    """

    role: Role
    name: str
    layer: str
    groups: tuple[str, ...]
    tags: Tags


def said_of(path: DrawnPath) -> Said:
    """Tell what is said about a path."""
    if is_silent(path):
        return Said("wall", plain_name(path.name), plain_name(path.layer), _groups_of(path), {})
    tags = tags_of(path)
    role = next((role for role in ROLES if role in tags), "wall")
    if role == "wall":
        tags.pop("wall", None)
    name = plain_name(path.name)
    return Said(cast(Role, role), tags.get(role, "") or name, plain_name(path.layer), _groups_of(path), tags)


def role_of(path: DrawnPath) -> Role:
    """Tell what a path is."""
    return "wall" if is_silent(path) else said_of(path).role


def is_one_way(path: DrawnPath) -> bool:
    """Tell whether words make a wall of it that is solid from one side alone."""
    return sides_of(tags_of(path)) == "outward"


def is_silent(path: DrawnPath) -> bool:
    """Tell whether none of its levels has a word, as of nearly all paths; without levels its tags may be words."""
    for level in path.levels:  # a loop, for every path is asked several times
        if not _is_silent(level):
            return False
    return bool(path.levels) or (not path.tags and all(map(_is_plain, (path.layer, *path.groups, path.name))))


def _is_silent(level: Level) -> bool:
    return not level.tags and not level.note and _is_plain(level.name)


def _is_plain(name: str) -> bool:
    return not name or (name != BALLS_LAYER and "#" not in name and "[" not in name)


def plain_name(label: str) -> str:
    """Give a name without the words in it."""
    return read_label(label)[0]


def tags_of(path: DrawnPath) -> dict[str, str]:
    """Give the words that count for a path: each key by its nearest level, and one role at most."""
    tags: dict[str, str] = {}
    if is_silent(path):
        return tags
    for level in levels_of(path):
        words = _words_of(level)
        if not words:
            continue
        role = next((role for role in ROLES if role in words and not is_no(words[role])), "")
        if role:
            for other in ROLES:
                tags.pop(other, None)
        tags |= {key: value for key, value in words.items() if key not in ROLES or key == role}
        for key in ROLES:
            if key in words and is_no(words[key]):
                tags.pop(key, None)
        if "one-way" in words or "sides" in words:  # two words for one thing: those of this level alone
            for key in ("one-way", "sides"):
                if key not in words:
                    tags.pop(key, None)
    return tags


def _words_of(level: Level) -> dict[str, str]:
    if _is_silent(level):
        return {}
    words = dict(read_label(level.name)[1]) | dict(read_note(level.note)) | read_data(level.tags)
    if level.kind != "object" and plain_name(level.name) == BALLS_LAYER and not any(role in words for role in ROLES):
        words["ball"] = ""
    return words


def levels_of(path: DrawnPath) -> tuple[Level, ...]:
    """Give what each level says, the nearest last; made of what there is where a reader gives none."""
    if path.levels:
        return path.levels
    own = {key: value for key, value in path.tags.items() if key not in _KEPT_BACK}
    return (
        Level("layer", path.layer),
        *(Level("group", name) for name in path.groups),
        Level("object", path.name, own, path.tags.get(_NOTE, "")),
    )


def _groups_of(path: DrawnPath) -> tuple[str, ...]:
    return tuple(map(plain_name, path.groups))


def material_of(tags: Tags) -> Material:
    """Give the material that words ask for; what is no value is told by :func:`tag_problems` and not used."""
    given = {key: _number(key, tags[key]) for key in MATERIAL_KEYS if key in tags}
    return Material(**{key: value for key, value in given.items() if value is not None})


def material_keys_of(tags: Tags) -> set[str]:
    """Give the keys of the material that words set."""
    return {key for key in MATERIAL_KEYS if key in tags and _number(key, tags[key]) is not None}


def sides_of(tags: Tags) -> Sides | None:
    """Give the sides that words ask for, None where they ask for none."""
    if "one-way" in tags:
        return "both" if is_no(tags["one-way"]) else "outward"
    return cast(Sides, tags["sides"]) if tags.get("sides") in ("both", "outward") else None


def _number(key: str, text: str) -> float | None:
    most = MOST_RESTITUTION if key == "restitution" else 1.0
    try:
        value = float(text)
    except ValueError:
        return None
    return value if math.isfinite(value) and 0.0 <= value <= most else None


def tag_problems(paths: Iterable[DrawnPath]) -> list[Problem]:
    """Tell every word that nothing is made of, and every value that is none: one problem each, at its first path."""
    unknown: dict[str, list[DrawnPath]] = {}
    wrong: dict[tuple[str, str], list[DrawnPath]] = {}
    for path in paths:
        for key, value in tags_of(path).items():
            if key not in KNOWN:
                unknown.setdefault(key, []).append(path)
            elif (key in MATERIAL_KEYS and _number(key, value) is None) or (
                key == "sides" and value not in ("both", "outward")
            ):
                wrong.setdefault((key, value), []).append(path)
    return [
        *(
            _problem(paths, "bad-tag", "warning", _wrong_words(*pair), _may_be(pair[0]))
            for pair, paths in wrong.items()
        ),
        *(_problem(paths, "unknown-tag", "info", _unknown_words(key), _meant(key)) for key, paths in unknown.items()),
    ]


def _wrong_words(key: str, value: str) -> str:
    return f"{key}={value} is not used" if value else f"{key} without a value is not used"


def _may_be(key: str) -> str:
    if key == "sides":
        return "give both or outward"
    return f"give a number from 0 to {MOST_RESTITUTION if key == 'restitution' else 1:g}"


def _unknown_words(key: str) -> str:
    return f"the word {key!r} means nothing here; it is kept in the wall's tags"


def _meant(key: str) -> str:
    near = get_close_matches(key, KNOWN, 1)
    return f"did you mean {near[0]}?" if near else f"known words are: {', '.join(KNOWN)}"


def _problem(paths: list[DrawnPath], code: str, severity: Literal["warning", "info"], words: str, fix: str) -> Problem:
    first = paths[0]
    count = "" if len(paths) == 1 else f"{len(paths)} times: "
    x, y = first.subpaths[0].segments[0][1:3] if first.subpaths and first.subpaths[0].segments else (None, None)
    return Problem(code, severity, count + words, fix, first.layer, first.name, first.line, None, x, y)
