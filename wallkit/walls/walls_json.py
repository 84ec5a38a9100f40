"""Walls as a file: the stable ``wallkit-walls`` JSON, which reads back bit for bit."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import IO, Any

import numpy as np

from importers.problems import Problem
from wallkit.walls.solid import Solid
from wallkit.walls.walls import ARRAYS, Marker, Material, Origin, Wall, Walls, WallsError
from wallkit.write_file import write_whole

FORMAT, VERSION = "wallkit-walls", 1


def to_json(walls: Walls) -> dict[str, Any]:
    """Give walls as the ``wallkit-walls`` format, version 1 (docs/walls.md; schema in wallkit/schemas)."""
    result: dict[str, Any] = {
        "format": FORMAT,
        "version": VERSION,
        "units": walls.units,
        "y_axis": walls.y_axis,
        "tolerance": walls.tolerance,
        "measured_error": walls.measured_error,
    }
    if walls.measured_normal_error is not None:
        result["measured_normal_error"] = walls.measured_normal_error
    result["source"] = {"file": walls.source_file, "sha256": walls.source_sha256}
    if walls.solid is not None:
        result["solid"] = walls.solid.to_json()
    if walls.markers:
        result["markers"] = [marker.to_json() for marker in walls.markers]
    if walls.sensors is not None:
        result["sensors"] = [_wall_json(wall) for wall in walls.sensors]
    result["walls"] = [_wall_json(wall) for wall in walls]
    result["problems"] = [problem_json(problem) for problem in walls.problems]
    return result


def problem_json(problem: Problem) -> dict[str, Any]:
    """Give a problem as JSON; the line that its column points into only where there is one."""
    return problem.to_json() | ({"excerpt": problem.excerpt} if problem.excerpt else {})


def _wall_json(wall: Wall) -> dict[str, Any]:
    result: dict[str, Any] = {
        "name": wall.name,
        "layer": wall.layer,
        "closed": wall.closed,
        "depth": wall.depth,
        "sides": wall.sides,
        **wall.origin.to_json(),
        "material": _material_json(wall.material),
        "vertices": wall.vertices.tolist(),
    }
    if wall.bulges.any():
        result["bulges"] = wall.bulges.tolist()
    result["normals"] = wall.normals.tolist()
    return result


def _material_json(material: Material) -> dict[str, float]:
    found = {"restitution": material.restitution, "tangential_restitution": material.tangential_restitution}
    return found | ({"static_friction": material.static_friction} if material.static_friction else {})


def dumps(walls: Walls) -> str:
    """Write walls as JSON text: one wall a line, so that people can look into it and diff it."""
    whole = to_json(walls)
    lists = {
        key: [_compact(entry) for entry in whole.pop(key)] for key in ("sensors", "walls", "problems") if key in whole
    }
    head = [f"{json.dumps(key)}: {_compact(value)}" for key, value in whole.items()]
    tail = [f"{json.dumps(key)}: [" + ",".join(f"\n  {line}" for line in lines) + "]" for key, lines in lists.items()]
    return "{" + ",\n ".join(head + tail) + "}\n"


def _compact(value: Any) -> str:
    return json.dumps(value, ensure_ascii=False, allow_nan=False)


def save(walls: Walls, path: str | Path) -> None:
    """Write walls under ``path`` (whole or not at all; ``"-"`` is standard output) as JSON.

    Raises:
        FileError: the file cannot be written.
    """
    write_whole(path, dumps(walls))


def load(source: str | Path | IO[bytes] | IO[str]) -> Walls:
    """Read walls that :func:`save` wrote, the same bits.

    Raises:
        WallsError: it is not such a file; the message says what is wrong where.
    """
    name = str(source) if isinstance(source, str | Path) else str(getattr(source, "name", ""))
    try:
        data = Path(source).read_bytes() if isinstance(source, str | Path) else source.read()
    except OSError as error:
        raise WallsError(f"cannot read: {error.strerror}", code="cannot-read", file=name) from error
    return loads(data, name)


def loads(text: str | bytes, file: str = "") -> Walls:
    """Read walls from JSON text; see :func:`load`."""
    try:
        value = json.loads(text)
    except (ValueError, RecursionError) as error:
        line, column = getattr(error, "lineno", None), getattr(error, "colno", None)
        raise WallsError(f"not JSON: {error}", code="bad-walls", file=file, line=line, column=column) from error
    return from_json(value, file)


def from_json(value: Any, file: str = "") -> Walls:
    """Make walls of the ``wallkit-walls`` format, as parsed JSON.

    Raises:
        WallsError: a part is missing or of the wrong kind; the message names it.
    """
    try:
        return _from_json(value)
    except WallsError as error:
        error.file = error.file or file
        raise
    except (KeyError, TypeError, ValueError, AttributeError, IndexError, OverflowError) as error:
        what = f"{error.args[0]!r} is missing" if isinstance(error, KeyError) else str(error)
        raise WallsError(f"not walls: {what}", code="bad-walls", file=file, fix="see docs/walls.md") from error


def _from_json(value: Any) -> Walls:
    if not isinstance(value, dict) or value.get("format") != FORMAT:
        raise WallsError("not walls", code="bad-walls", fix=f'the first key must be "format": "{FORMAT}"')
    if value.get("version") != VERSION:
        fix = "read it with a newer wallkit"
        raise WallsError(f"version {value.get('version')!r} of the format is not known", code="bad-walls", fix=fix)
    walls = _walls_of(value["walls"])
    walls.units, walls.y_axis = str(value.get("units", "")), "down" if value.get("y_axis") == "down" else "up"
    walls.tolerance, walls.measured_error = float(value.get("tolerance", 0)), float(value.get("measured_error", 0))
    normal_error = value.get("measured_normal_error")
    walls.measured_normal_error = None if normal_error is None else float(normal_error)
    source = value.get("source", {})
    walls.source_file, walls.source_sha256 = str(source.get("file", "")), str(source.get("sha256", ""))
    walls.problems = [Problem.of_json(problem) for problem in value.get("problems", [])]
    solid = value.get("solid")
    walls.solid = None if solid is None else Solid(solid["room"], solid["how"], solid["why"])
    walls.markers = tuple(Marker.of_json(marker) for marker in value.get("markers", []))
    if "sensors" in value:
        walls.sensors = sensors_like(walls, _walls_of(value["sensors"]))
    return walls


def sensors_like(walls: Walls, sensors: Walls) -> Walls:
    """Give sensors the units, axes, tolerance and source of the walls that they belong to."""
    return replace(
        Walls.from_polylines([]),
        **{name: getattr(sensors, name) for name in ARRAYS},
        **{name: getattr(walls, name) for name in ("units", "y_axis", "tolerance", "source_file", "source_sha256")},
    )


def _walls_of(entries: list[dict[str, Any]]) -> Walls:
    walls = Walls.from_polylines(
        [entry["vertices"] for entry in entries],
        [bool(entry["closed"]) for entry in entries],
        bulges=[entry.get("bulges") for entry in entries],
        sides=[_sides(entry.get("sides", "both")) for entry in entries],
        material=[Material(**{k: float(v) for k, v in entry.get("material", {}).items()}) for entry in entries],
        names=[str(entry.get("name", "")) for entry in entries],
        layers=[str(entry.get("layer", "")) for entry in entries],
        origins=[Origin.of_json(entry) for entry in entries],
    )
    walls.depth = np.array([int(entry.get("depth", 0)) for entry in entries], dtype=np.int64)
    return walls


def _sides(word: Any) -> Any:
    if word not in ("both", "outward"):
        raise WallsError(f"sides is {word!r}", code="bad-walls", fix='give "both" or "outward"')
    return word
