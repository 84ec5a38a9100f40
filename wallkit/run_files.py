"""Runs in files: contacts as CSV, JSON and NPZ, the same columns in each. docs/files.md describes them."""

from __future__ import annotations

import io
import json
import zipfile
from typing import Any

import numpy as np

from wallkit.run import CONTACT, Kind, Run
from wallkit.scene_files import scene_to_json

COLUMNS: tuple[str, ...] = CONTACT.names or ()


def columns(run: Run) -> dict[str, list[Any]]:
    """Give the contacts as columns of plain numbers, the kind as its word."""
    words = {int(kind): kind.label for kind in Kind}
    table = {name: run.contacts[name].tolist() for name in COLUMNS}
    table["kind"] = [words[kind] for kind in table["kind"]]
    return table


def to_csv(run: Run) -> str:
    """Write the contacts as CSV with a header; each number reads back to the same bits."""
    table = columns(run)
    texts = [table[name] if name == "kind" else list(map(repr, table[name])) for name in COLUMNS]
    lines = [",".join(COLUMNS), *map(",".join, zip(*texts, strict=True)), ""]
    return "\n".join(lines)


def to_json(run: Run, trusted: list[Any] | None = None, until: float | None = None, bounces: int | None = None) -> str:
    """Write a run as the ``wallkit-run`` format, version 1: scene, contacts by column, and how each ball ended.

    Args:
        run: what was simulated.
        trusted: up to where each ball's run is good, where that was asked for.
        until: the end that was given.
        bounces: the same in bounces a ball.
    """
    names = run.final.dtype.names or ()
    whole = {
        "format": "wallkit-run",
        "version": 1,
        "scene": scene_to_json(run.scene, until, bounces),
        "contacts": columns(run),
        "final": [dict(zip(names, row, strict=True)) for row in run.final.tolist()],
        "ending": [ending.label for ending in run.ending],
        "trusted_until": trusted if trusted is not None else [None] * len(run.ending),
    }
    return json.dumps(whole, ensure_ascii=False, allow_nan=False) + "\n"


def to_npz(run: Run) -> bytes:
    """Write the contacts as an NPZ archive, one array a column (kind 0 edge, 1 vertex); no pickle.

    The archive carries no dates, so that the same run gives the same bytes.
    """
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w", zipfile.ZIP_DEFLATED) as archive:
        for name in COLUMNS:
            column = io.BytesIO()
            np.save(column, np.ascontiguousarray(run.contacts[name]), allow_pickle=False)
            archive.writestr(zipfile.ZipInfo(f"{name}.npy"), column.getvalue(), zipfile.ZIP_DEFLATED, 1)
    return data.getvalue()
