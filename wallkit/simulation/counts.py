"""What is left of any number of balls: whole numbers, which add up to the same in any order."""

from __future__ import annotations

import hashlib
import io
import json
import zipfile
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from importers.errors import WallkitError
from wallkit.simulation.run import Ending
from wallkit.simulation.survey import SurveyTotals

TICKS_PER_SECOND = 2**20
"""Times are counted in these, each rounded once, so that a sum does not depend on its order."""
_ARRAYS = ("endings", "edge_hits", "vertex_hits", "crossings")
_NUMBERS = ("balls", "bounces", "ticks")
_FORMAT, _VERSION = "wallkit-counts", 1


@dataclass(eq=False, repr=False)
class Counts:
    """What a survey of any number of balls counted; two of one scene add up.

    Attributes:
        balls: how many flew.
        bounces: of all.
        ticks: time of all balls together, each rounded to whole 2^-20 s.
        endings: (8,) int64, balls by how they ended, see :class:`wallkit.simulation.run.Ending`.
        edge_hits: (E,) int64, bounces by edge, in the order of all walls' edges.
        vertex_hits: (V,) int64, bounces off vertices, which discs alone meet.
        crossings: (S, 2) int64, how often balls entered each sensor, and left it.
    """

    balls: int
    bounces: int
    ticks: int
    endings: NDArray[np.int64]
    edge_hits: NDArray[np.int64]
    vertex_hits: NDArray[np.int64]
    crossings: NDArray[np.int64]

    @staticmethod
    def of(totals: SurveyTotals) -> Counts:
        """Count what a survey ``by_edge`` left of its balls."""
        if totals.edge_hits is None or totals.vertex_hits is None:
            raise WallkitError("the survey did not count by edge", code="bad-argument", fix="give by_edge=True")
        return Counts(
            balls=len(totals.bounces),
            bounces=int(totals.bounces.sum()),
            ticks=ticks_of(totals.time),
            endings=np.bincount(totals.ending, minlength=len(Ending)).astype(np.int64),
            edge_hits=totals.edge_hits,
            vertex_hits=totals.vertex_hits,
            crossings=totals.crossings,
        )

    def __add__(self, other: Counts) -> Counts:
        return Counts(
            self.balls + other.balls,
            self.bounces + other.bounces,
            self.ticks + other.ticks,
            self.endings + other.endings,
            self.edge_hits + other.edge_hits,
            self.vertex_hits + other.vertex_hits,
            self.crossings + other.crossings,
        )

    def __repr__(self) -> str:
        parts = [f"{self.balls:,} balls", f"{self.bounces:,} bounces in {self.seconds:.6g} s of all together"]
        parts += [f"{label} {count:,}" for label, count in self.ended()]
        return f"<Counts: {', '.join(parts)}>"

    @property
    def seconds(self) -> float:
        """Time of all balls together."""
        return self.ticks / TICKS_PER_SECOND

    def ended(self) -> list[tuple[str, int]]:
        """How many balls ended how, the most first."""
        order = np.argsort(-self.endings, kind="stable").tolist()
        return [(Ending(code).label, int(self.endings[code])) for code in order if self.endings[code]]

    def digest(self) -> str:
        """64 hexadecimal digits that are equal where all counts are."""
        return hashlib.sha256(json.dumps(self.to_json()).encode()).hexdigest()

    def to_json(self) -> dict[str, Any]:
        """Give all counts as numbers and lists."""
        return {name: getattr(self, name) for name in _NUMBERS} | {
            name: getattr(self, name).tolist() for name in _ARRAYS
        }

    @staticmethod
    def of_json(value: dict[str, Any]) -> Counts:
        """Read what :meth:`to_json` gave."""
        endings, edges, vertices, crossings = (np.array(value[name], dtype=np.int64) for name in _ARRAYS)
        balls, bounces, ticks = (int(value[name]) for name in _NUMBERS)
        return Counts(balls, bounces, ticks, endings, edges, vertices, crossings.reshape(-1, 2))

    def to_npz(self) -> bytes:
        """Write one array a count, and ``about`` as JSON text; no pickle, and no date: equal counts, equal bytes."""
        about = {"format": _FORMAT, "version": _VERSION, **{name: getattr(self, name) for name in _NUMBERS}}
        arrays = {name: getattr(self, name) for name in _ARRAYS} | {"about": np.array(json.dumps(about))}
        data = io.BytesIO()
        with zipfile.ZipFile(data, "w", zipfile.ZIP_DEFLATED) as archive:
            for name, array in arrays.items():
                column = io.BytesIO()
                np.save(column, array, allow_pickle=False)
                archive.writestr(zipfile.ZipInfo(f"{name}.npy"), column.getvalue(), zipfile.ZIP_DEFLATED)
        return data.getvalue()

    def save(self, path: str | Path) -> None:
        """Write the counts as NPZ, whole or not at all.

        Raises:
            WallkitError: the file cannot be written.
        """
        from wallkit.write_file import write_whole

        write_whole(path, self.to_npz())

    @staticmethod
    def load(source: str | Path | IO[bytes]) -> Counts:
        """Read what :meth:`save` or ``wallkit survey -o`` wrote.

        Raises:
            WallkitError: it cannot be read, or holds no counts.
        """
        name = str(source) if isinstance(source, str | Path) else ""
        try:
            with np.load(source, allow_pickle=False) as archive:
                about = json.loads(str(archive["about"]))
                if about.pop("format") != _FORMAT:
                    raise ValueError("another format")
                return Counts.of_json(about | {key: archive[key] for key in _ARRAYS})
        except (OSError, ValueError, TypeError, KeyError, AttributeError, zipfile.BadZipFile) as error:
            fix = "give a file of wallkit survey -o totals.npz"
            raise WallkitError(f"these are no counts: {error}", code="bad-counts", file=name, fix=fix) from error


def ticks_of(time: NDArray[np.float64]) -> int:
    """Add times up, each rounded to whole ticks of 2^-20 s, as a whole number of any size."""
    ticks = np.rint(time * float(TICKS_PER_SECOND))
    if len(ticks) == 0 or float(ticks.max()) * len(ticks) < 2.0**62:
        return int(ticks.astype(np.int64).sum())
    return sum(map(int, ticks.tolist()))
