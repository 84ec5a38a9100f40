"""Lessons: what a scene file says to a class, beside the scene."""

from __future__ import annotations

import reprlib
import sys
from dataclasses import dataclass
from typing import Any

FRAME_WAYS = ("stop", "full-step", "reflect-in-place", "overlap")
"""The ways of :class:`~wallkit.World` to step by frames that are wrong, and so worth showing beside the exact run."""


@dataclass(frozen=True, slots=True)
class Lesson:
    """A text for people, and questions.

    Attributes:
        title: a heading.
        text: paragraphs, with an empty line between two.
        questions: pairs of a question and its answer.
        way: how a ball is stepped that is shown beside the exact one, of :data:`FRAME_WAYS`; ``""`` for none.
        dt: seconds of its frames.
    """

    title: str
    text: str = ""
    questions: tuple[tuple[str, str], ...] = ()
    way: str = ""
    dt: float = 1 / 60

    def to_json(self) -> dict[str, Any]:
        """Give it as a scene file has it."""
        questions = [{"question": question, "answer": answer} for question, answer in self.questions]
        stepped = {"way": self.way, "dt": self.dt} if self.way else {}
        return {"title": self.title, "text": self.text, "questions": questions, **stepped}


def read_lesson(value: Any, wrong: list[str]) -> Lesson:
    """Read ``[lesson]`` of a scene file; what is wrong with it goes to ``wrong``, each with its key."""
    if not isinstance(value, dict):
        wrong.append("lesson: not a table")
        return Lesson("")
    _known(value, ("title", "text", "questions", "way", "dt"), "lesson", wrong)
    title, text = _text(value, "title", "lesson", wrong), _text(value, "text", "lesson", wrong)
    if not title:
        wrong.append("lesson.title: a lesson needs a title")
    way = _text(value, "way", "lesson", wrong)
    if way and way not in FRAME_WAYS:
        wrong.append(f"lesson.way: {way!r} is not {', '.join(FRAME_WAYS[:-1])} or {FRAME_WAYS[-1]}")
    dt = value.get("dt", 1 / 60)
    good = isinstance(dt, int | float) and not isinstance(dt, bool) and 0 < dt <= sys.float_info.max
    if not good:
        wrong.append(f"lesson.dt: {reprlib.repr(dt)} is not a finite number above 0")
    elif "dt" in value and not way:
        wrong.append("lesson.dt: only goes with lesson.way")
    return Lesson(title, text, tuple(_questions(value.get("questions", []), wrong)), way, float(dt) if good else 1 / 60)


def _questions(value: Any, wrong: list[str]) -> list[tuple[str, str]]:
    found = []
    for index, row in enumerate(value if isinstance(value, list) else [None]):
        key = f"lesson.questions[{index}]"
        if not isinstance(row, dict):
            wrong.append(f"{key}: not a table")
            continue
        _known(row, ("question", "answer"), key, wrong)
        question, answer = _text(row, "question", key, wrong), _text(row, "answer", key, wrong)
        if not (question and answer):
            wrong.append(f"{key}: needs a question and an answer")
        found.append((question, answer))
    return found


def _known(table: dict[str, Any], known: tuple[str, ...], prefix: str, wrong: list[str]) -> None:
    wrong.extend(f"{prefix}.{key}: no such key" for key in table if key not in known)


def _text(table: dict[str, Any], key: str, prefix: str, wrong: list[str]) -> str:
    value = table.get(key, "")
    if isinstance(value, str):
        return value.strip()
    wrong.append(f"{prefix}.{key}: {value!r} is not text")
    return ""
