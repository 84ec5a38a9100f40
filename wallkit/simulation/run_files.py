"""Runs in files: contacts as CSV, JSON and NPZ, the same columns in each. docs/files.md describes them."""

from __future__ import annotations

import io
import json
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from importers.errors import WallkitError
from wallkit.scene.scene import Scene
from wallkit.simulation.run import CONTACT, FINAL, MEETING_CONTACT, ContactKind, Ending, Run, one_a_ball
from wallkit.write_file import write_whole

COLUMNS: tuple[str, ...] = CONTACT.names or ()


def columns_of(contacts: NDArray[Any]) -> tuple[str, ...]:
    """Names of the columns: ``COLUMNS``, and those of the other ball where balls meet."""
    return contacts.dtype.names or ()


def columns(run: Run) -> dict[str, list[Any]]:
    """Give the contacts as columns of plain numbers, the kind as its word."""
    words = {int(kind): kind.label for kind in ContactKind}
    table = {name: run.contacts[name].tolist() for name in columns_of(run.contacts)}
    table["kind"] = [words[kind] for kind in table["kind"]]
    return table


def to_csv(run: Run) -> str:
    """Write the contacts as CSV with a header; each number reads back to the same bits."""
    table = columns(run)
    texts = [table[name] if name == "kind" else list(map(repr, table[name])) for name in table]
    lines = [",".join(table), *map(",".join, zip(*texts, strict=True)), ""]
    return "\n".join(lines)


def to_json(run: Run, trusted: list[Any] | None = None, until: float | None = None, bounces: int | None = None) -> str:
    """Write a run as the ``wallkit-run`` format: scene, contacts by column, and how each ball ended.

    Version 2, where balls meet, has the columns of the other ball too.

    Args:
        run: what was simulated.
        trusted: up to where each ball's run is good, where that was asked for.
        until: the end that was given.
        bounces: the same in bounces a ball.
    """
    from wallkit.scene.scene_files import scene_to_json

    names = run.final.dtype.names or ()
    whole = {
        "format": "wallkit-run",
        "version": 2 if "other" in columns_of(run.contacts) else 1,
        "scene": scene_to_json(run.scene, until, bounces),
        "contacts": columns(run),
        "final": [dict(zip(names, row, strict=True)) for row in run.final.tolist()],
        "ending": [ending.label for ending in run.ending],
        "trusted_until": trusted if trusted is not None else [None] * len(run.ending),
    }
    return json.dumps(whole, ensure_ascii=False, allow_nan=False) + "\n"


def save(run: Run, path: str | Path) -> None:
    """Write a run as JSON, whole or not at all; see :func:`to_json`.

    Raises:
        FileError: the file cannot be written.
    """
    write_whole(path, to_json(run))


def load(source: str | Path | IO[bytes] | IO[str]) -> Run:
    """Read a run that :func:`save` or ``wallkit simulate --format json`` wrote: the same numbers, bit for bit.

    Raises:
        WallkitError: it cannot be read or is no run; the message says what is wrong.
    """
    from wallkit.scene.scene_files import read_scene

    name = str(source) if isinstance(source, str | Path) else str(getattr(source, "name", ""))
    try:
        data: str | bytes = Path(source).read_bytes() if isinstance(source, str | Path) else source.read()
        data = data.encode() if isinstance(data, str) else data
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise WallkitError(f"cannot read it: {reason}", code="cannot-read", file=name) from error
    fix = "give a file of run.save() or of wallkit simulate --format json"
    try:
        value = json.loads(data)
        if value["format"] != "wallkit-run":
            raise WallkitError("this is no run", code="bad-run", file=name, fix=fix)
        return _run_of(value, read_scene(data, file=name).scene)
    except (KeyError, TypeError, ValueError, IndexError, AttributeError, RecursionError, OverflowError) as error:
        raise WallkitError(f"this is no run: {error}", code="bad-run", file=name, fix=fix) from error


def _run_of(value: dict[str, Any], scene: Scene) -> Run:
    """Make a run of the parsed file and of its scene, which was checked on its own."""
    kinds = {kind.label: int(kind) for kind in ContactKind}
    table, balls = value["contacts"], len(scene.balls)
    contacts = np.zeros(len(table["time"]), dtype=MEETING_CONTACT if "other" in table else CONTACT)
    if any(len(table[column]) != len(contacts) for column in columns_of(contacts)):
        raise ValueError("its columns of contacts differ in length")
    for column in columns_of(contacts):
        contacts[column] = [kinds[word] for word in table["kind"]] if column == "kind" else table[column]
    final = np.zeros(balls, dtype=FINAL)
    for column in FINAL.names or ():
        final[column] = [row[column] for row in value["final"]]
    endings = {ending.label: ending for ending in Ending}
    ending = tuple(endings[word] for word in value["ending"])
    number = one_a_ball(contacts)["ball"]
    if len(ending) != balls or not ((number >= 0) & (number < balls)).all():
        raise ValueError(f"its contacts or endings are not those of {balls} balls")
    return Run(scene, contacts, final, ending, np.hstack([scene.balls.position, scene.balls.velocity]))


def to_npz(run: Run) -> bytes:
    """Write the contacts as an NPZ archive, one array a column (kind 0 edge, 1 vertex); no pickle.

    The archive carries no dates, so that the same run gives the same bytes.
    """
    import zipfile

    data = io.BytesIO()
    with zipfile.ZipFile(data, "w", zipfile.ZIP_DEFLATED) as archive:
        for name in columns_of(run.contacts):
            column = io.BytesIO()
            np.save(column, np.ascontiguousarray(run.contacts[name]), allow_pickle=False)
            archive.writestr(zipfile.ZipInfo(f"{name}.npy"), column.getvalue(), zipfile.ZIP_DEFLATED, 1)
    return data.getvalue()
