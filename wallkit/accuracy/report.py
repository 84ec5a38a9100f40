"""The report: speed against error, promise against truth, and what each modelled thing costs."""

from __future__ import annotations

import os
import platform
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, field
from datetime import date
from importlib import metadata
from pathlib import Path
from typing import Any

from wallkit.accuracy.contest import BOUNCES, Contest, Effort, Subject, contest
from wallkit.accuracy.costs import Cost, costs
from wallkit.accuracy.departure import Departure, departures
from wallkit.version import __version__

_PACKAGES = ("numpy", "llvmlite", "pymunk", "box2d", "billiards", "pooltool-billiards", "mpmath")
Told = Callable[[str], None]


@dataclass(slots=True)
class Report:
    """What was measured, and on what.

    Attributes:
        machine: what ran it: words by key.
        contests: one a scene.
        departures: the horizon's table; empty for a drawing of one's own.
        costs: the table of costs; the same.
    """

    machine: dict[str, str]
    contests: list[Contest] = field(default_factory=list)
    departures: list[Departure] = field(default_factory=list)
    costs: list[Cost] = field(default_factory=list)

    def to_json(self) -> dict[str, Any]:
        """Give everything as the ``wallkit-report`` format, version 1."""
        return {
            "format": "wallkit-report",
            "version": 1,
            "machine": self.machine,
            "error_after_bounces": BOUNCES,
            "scenes": [found.to_json() for found in self.contests],
            "horizon": [{**asdict(row), "ratio": row.ratio} for row in self.departures],
            "costs": [asdict(row) for row in self.costs],
        }

    def foot(self) -> str:
        """Give machine and versions in one line."""
        return " · ".join(f"{key} {value}" if key != "machine" else value for key, value in self.machine.items())


def measure(subjects: Sequence[Subject], effort: Effort, *, tables: bool, told: Told | None = None) -> Report:
    """Run everything.

    Args:
        subjects: the scenes.
        effort: how much is done.
        tables: the horizon's and the costs' tables too.
        told: is told what is being done.

    Raises:
        PrecisionError: the reference cannot be had.
    """
    report = Report(machine())
    for number, subject in enumerate(subjects, 1):
        label = f"{number} of {len(subjects)}, {subject.name}"
        report.contests.append(contest(subject, effort, _prefixed(told, label)))
    if tables:
        if told:
            told("costs")
        report.costs.extend(costs(100_000 if effort.runs < 5 else 300_000, effort.runs))
        if told:
            told("horizon")
        report.departures.extend(departures(effort.bounces * 3, effort.draws))
    return report


def _prefixed(told: Told | None, label: str) -> Told | None:
    if told is None:
        return None
    return lambda words: told(f"{label}: {words}")


def machine() -> dict[str, str]:
    """Say what runs this: processor, system, versions, date."""
    found = {
        "machine": f"{_processor()}, {os.cpu_count()} cores",
        "system": f"{platform.system()} {platform.release().split('-')[0]}",
        "Python": platform.python_version(),
        "wallkit": __version__,
    }
    for name in _PACKAGES:
        try:
            found[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            continue
    found["on"] = date.today().isoformat()
    return found


def _processor() -> str:
    try:
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace").splitlines():
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    except OSError:
        pass  # not Linux
    return platform.processor() or platform.machine()
