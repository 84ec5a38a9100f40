"""Scenes in files: TOML for people, JSON for programs, the same keys in both. docs/files.md describes the format.

Everything that is wrong with a file is found before anything is said, so that one look at the message is enough.
"""

from __future__ import annotations

import json
import math
import re
import tomllib
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any, Literal

import numpy as np

from importers.limits import check_input_size
from wallkit.scene import Balls, Scene, SceneError
from wallkit.walls import Material, Walls
from wallkit.walls.files import from_json, load, to_json

Kind = Literal["drawing", "walls", "scene"]

_MATERIAL = ("restitution", "tangential_restitution", "static_friction")
_IMPORT_OPTIONS = {
    "tolerance",
    "curves",
    "layers",
    "hidden",
    "snap",
    "arena",
    "sides",
    "scale",
    "flip_y",
    "outline_strokes",
}
_TOML_START = re.compile(r"(?:\s|#[^\n]*\n)*(?:\[{1,2}\s*[A-Za-z_\"]|[A-Za-z_][A-Za-z0-9_.-]*\s*=)")
_PLACE = re.compile(r" \(at (?:line (\d+), column (\d+)|end of document)\)")


@dataclass(slots=True)
class SceneFile:
    """A scene file, read.

    Attributes:
        scene: what is simulated; its balls may be none.
        until: the end that the file asks for in seconds, or None.
        bounces: the number of bounces a ball that it asks for, or None.
    """

    scene: Scene
    until: float | None = None
    bounces: int | None = None


def kind_of(data: bytes) -> Kind:
    """Tell by its content whether a file holds walls, a scene or (whatever else it is) a drawing.

    JSON that names its format is believed; TOML is a text whose first line that is no comment sets a key or opens
    a table, which no drawing's does. A saved run counts as a scene: it holds the one that it was made of.
    """
    head = data[:4096].decode("utf-8", "replace").lstrip("\ufeff")
    if head.lstrip().startswith("{"):
        named = re.search(r'"format"\s*:\s*"wallkit-(walls|scene|run)"', data.decode("utf-8", "replace"))
        return "walls" if named and named[1] == "walls" and _format_of(data) == "wallkit-walls" else "scene"
    return "scene" if _TOML_START.match(head) else "drawing"


def _format_of(data: bytes) -> str:
    try:
        return str(json.loads(data.decode("utf-8-sig")).get("format", ""))
    except (ValueError, RecursionError, AttributeError):
        return ""


def load_scene(path: str | Path) -> SceneFile:
    """Read a scene from a TOML or JSON file; names of other files in it are meant from its folder.

    Raises:
        SceneError: it cannot be read, or says what a scene cannot; the message lists every such place.
    """
    try:
        data = Path(path).read_bytes()
    except OSError as error:
        raise SceneError(f"cannot read it: {error.strerror}", code="cannot-read", file=str(path)) from error
    return read_scene(data, file=str(path), folder=Path(path).parent)


def read_scene(data: bytes, *, file: str = "", folder: Path | None = None) -> SceneFile:
    """Read a scene from the bytes of a TOML or JSON file.

    Args:
        data: the file's content.
        file: its name, for messages.
        folder: where the files that it names are; None forbids naming any (a scene from a stranger).

    Raises:
        SceneError: as :func:`load_scene`.
    """
    check_input_size(len(data), file)
    table = _parsed(data, file)
    if table.get("format") == "wallkit-run":
        table = table.get("scene", {}) if isinstance(table.get("scene"), dict) else {}
    reader = _Reader(file, folder)
    result = reader.scene_file(table)
    reader.finish()
    return result


def _parsed(data: bytes, file: str) -> dict[str, Any]:
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise SceneError("it is not UTF-8 text", code="not-a-scene", file=file) from error
    try:
        if text.lstrip().startswith("{"):
            return dict(json.loads(text, parse_constant=_no_constant))
        return tomllib.loads(text)
    except json.JSONDecodeError as error:
        raise SceneError(error.msg, code="bad-json", file=file, line=error.lineno, column=error.colno) from error
    except tomllib.TOMLDecodeError as error:
        place = _PLACE.search(str(error))
        line, column = (int(place[1]), int(place[2])) if place and place[1] else (text.count("\n") + 1, None)
        raise SceneError(_PLACE.sub("", str(error)), code="bad-toml", file=file, line=line, column=column) from error
    except RecursionError as error:
        raise SceneError("it is nested too deeply", code="not-a-scene", file=file) from error


def _no_constant(word: str) -> None:
    raise SceneError(f"{word} is not a number of JSON", code="bad-json", fix="write finite numbers")


class _Reader:
    """Turns the parsed table into a scene and collects what is wrong on the way, each with its key."""

    def __init__(self, file: str, folder: Path | None) -> None:
        self.file = file
        self.folder = folder
        self.wrong: list[str] = []

    def finish(self) -> None:
        if self.wrong:
            shown = "; ".join(self.wrong[:12]) + (f"; and {len(self.wrong) - 12} more" if len(self.wrong) > 12 else "")
            raise SceneError(shown, code="bad-scene", file=self.file, fix="docs/files.md lists the keys of a scene")

    def scene_file(self, table: dict[str, Any]) -> SceneFile:
        known = {"format", "version", "walls", "drawing", "import", "gravity", "rolling_friction", "drag", "sensors",
                 "materials", "balls", "run"}  # fmt: skip
        self.known_keys(table, known, "")
        if table.get("format", "wallkit-scene") != "wallkit-scene":
            self.wrong.append(f"format: {table['format']!r} is not 'wallkit-scene'")
        if table.get("version", 1) != 1:
            self.wrong.append(f"version: {table['version']!r} is not 1, the one that this wallkit reads")
        walls, drawn = self.walls(table)
        if walls is None:  # the rest is still checked, on no walls
            walls = Walls.from_polylines([])
        self.materials(walls, table.get("materials", []))
        gravity = self.pair(table["gravity"], "gravity") if "gravity" in table else None
        slowing = {key: self.number(table[key], key, least=0.0) for key in ("rolling_friction", "drag") if key in table}
        walls, sensors = self.sensors(walls, table["sensors"]) if "sensors" in table else (walls, None)
        balls = drawn if drawn is not None and "balls" not in table else self.balls(table.get("balls", []))
        run = self.table(table.get("run", {}), "run")
        self.known_keys(run, {"until", "bounces"}, "run.")
        until = self.number(run["until"], "run.until", least=0.0) if "until" in run else None
        bounces = self.number(run["bounces"], "run.bounces", least=0.0) if "bounces" in run else None
        scene = Scene(walls, balls, gravity, sensors=sensors, **slowing)
        return SceneFile(scene, until, None if bounces is None else int(bounces))

    # -- values

    def known_keys(self, table: dict[str, Any], known: set[str], prefix: str) -> None:
        self.wrong.extend(f"{prefix}{key}: no such key" for key in table if key not in known)

    def table(self, value: Any, key: str) -> dict[str, Any]:
        if isinstance(value, dict):
            return value
        self.wrong.append(f"{key}: not a table")
        return {}

    def rows(self, value: Any, key: str) -> list[tuple[str, dict[str, Any]]]:
        if not isinstance(value, list):
            self.wrong.append(f"{key}: not a list of tables")
            return []
        return [(f"{key}[{index}]", self.table(row, f"{key}[{index}]")) for index, row in enumerate(value)]

    def number(self, value: Any, key: str, least: float = -math.inf, most: float = math.inf) -> float:
        if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
            self.wrong.append(f"{key}: {value!r} is not a finite number")
            return max(least, 0.0)
        if not least <= value <= most:
            bound = f"from {least:g} to {most:g}" if math.isfinite(most) else f"at least {least:g}"
            self.wrong.append(f"{key}: {value!r} is not {bound}")
            return max(least, 0.0)
        return float(value)

    def pair(self, value: Any, key: str) -> tuple[float, float]:
        if not isinstance(value, list) or len(value) != 2:
            self.wrong.append(f"{key}: {value!r} is not a pair of numbers")
            return 0.0, 0.0
        return self.number(value[0], f"{key}[0]"), self.number(value[1], f"{key}[1]")

    def text(self, value: Any, key: str) -> str:
        if not isinstance(value, str):
            self.wrong.append(f"{key}: {value!r} is not text")
            return ""
        return value

    # -- parts

    def walls(self, table: dict[str, Any]) -> tuple[Walls | None, Balls | None]:
        """Give the walls, and the balls that a drawing has on its layer ``balls``."""
        sources = [key for key in ("walls", "drawing") if key in table]
        if len(sources) != 1:
            self.wrong.append("walls, drawing: give exactly one of the two")
            return None, None
        if sources == ["drawing"]:
            return self.drawing(table)
        if "import" in table:
            self.wrong.append("import: only goes with a drawing")
        value = table["walls"]
        if isinstance(value, str):
            path = self.path(value, "walls")
            return load(path) if path else None, None
        return from_json(value, self.file) if isinstance(value, dict) else self.polylines(value), None

    def drawing(self, table: dict[str, Any]) -> tuple[Walls | None, Balls | None]:
        path = self.path(table["drawing"], "drawing")
        options = self.table(table.get("import", {}), "import")
        self.known_keys(options, _IMPORT_OPTIONS, "import.")
        options = {key: value for key, value in options.items() if key in _IMPORT_OPTIONS}
        if path is None:
            return None, None
        from importers.read import read_drawing
        from wallkit.starts import drawn_balls
        from wallkit.walls.build import import_walls

        drawing = read_drawing(path)
        try:
            walls = import_walls(drawing, **{"curves": "arcs", **options})
        except TypeError:
            self.wrong.append("import: an option has a value of the wrong kind")
            return None, None
        found, problems = drawn_balls(drawing, options.get("scale", 1.0), options.get("flip_y", False))
        walls.problems.extend(problems)
        velocity = [ball.velocity or (0.0, 0.0) for ball in found]
        balls = Balls(np.array([(b.x, b.y) for b in found]).reshape(-1, 2), np.array(velocity).reshape(-1, 2),
                      np.array([ball.radius for ball in found]))  # fmt: skip
        return walls, balls

    def path(self, value: Any, key: str) -> Path | None:
        name = self.text(value, key)
        if not name:
            return None
        if self.folder is None:
            self.wrong.append(f"{key}: this scene may not name other files; put its walls into it")
            return None
        return self.folder / name

    def polylines(self, value: Any, name: str = "walls") -> Walls | None:
        before = len(self.wrong)
        rows = self.rows(value, name)
        keys = {"vertices", "bulges", "closed", "name", "layer", "sides", "material"}
        for key, row in rows:
            self.known_keys(row, keys, f"{key}.")
        if len(self.wrong) > before:
            return None
        try:
            return Walls.from_polylines(
                [row.get("vertices", ()) for _, row in rows],
                [bool(row.get("closed", True)) for _, row in rows],
                bulges=[row.get("bulges") for _, row in rows],
                sides=[row.get("sides", "both") for _, row in rows],
                material=[self.material(row.get("material", {}), f"{key}.material") for key, row in rows],
                names=[str(row.get("name", "")) for _, row in rows],
                layers=[str(row.get("layer", "")) for _, row in rows],
            )
        except (ValueError, TypeError):
            self.wrong.append(f"{name}: vertices are lists of [x, y]")
            return None

    def sensors(self, walls: Walls, value: Any) -> tuple[Walls, Walls | None]:
        """Give the walls left, and the sensors: polylines of their own, or the walls that globs name."""
        if isinstance(value, dict):
            return walls, from_json(value, self.file)
        if not isinstance(value, list) or not all(isinstance(glob, str) for glob in value):
            return walls, self.polylines(value, "sensors")
        fits = [any(fnmatchcase(word, glob) for word in (walls.layers[index], walls.names[index]) for glob in value)
                for index in range(len(walls))]  # fmt: skip
        if len(walls) and not any(fits):
            self.wrong.append(f"sensors: no wall has a name or layer like {', '.join(map(repr, value))}")
        return _chosen(walls, [not fit for fit in fits]), _chosen(walls, fits)

    def material(self, value: Any, key: str, base: Material | None = None) -> Material:
        base = base or Material()
        table = self.table(value, key)
        names = ("restitution", "tangential_restitution")
        given = {name: self.number(table[name], f"{key}.{name}", 0.0, 1.0) for name in names if name in table}
        if "static_friction" in table:
            given["static_friction"] = self.number(table["static_friction"], f"{key}.static_friction", 0.0)
        return replace(base, **given)

    def materials(self, walls: Walls, value: Any) -> None:
        """Give walls their materials by globs on layer and name; where several match, the last one wins."""
        found = list(walls.materials)
        for key, row in self.rows(value, "materials"):
            self.known_keys(row, {"layer", "wall", *_MATERIAL}, f"{key}.")
            layer, name = (
                self.text(row.get("layer", "*"), f"{key}.layer"),
                self.text(row.get("wall", "*"), f"{key}.wall"),
            )
            numbers = {word: row[word] for word in _MATERIAL if word in row}
            before = len(self.wrong)
            self.material(numbers, key)
            if len(self.wrong) > before:
                continue
            matched = False
            for index in range(len(walls)):
                if fnmatchcase(walls.layers[index], layer) and fnmatchcase(walls.names[index], name):
                    found[index] = self.material(numbers, key, found[index])
                    matched = True
            if not matched and len(walls):
                self.wrong.append(f"{key}: no wall has the name {name!r} on a layer {layer!r}")
        walls.materials = tuple(found)

    def balls(self, value: Any) -> Balls:
        rows = self.rows(value, "balls")
        position, velocity, radius = np.zeros((len(rows), 2)), np.zeros((len(rows), 2)), np.zeros(len(rows))
        for index, (key, row) in enumerate(rows):
            self.known_keys(row, {"position", "velocity", "radius"}, f"{key}.")
            position[index] = self.pair(row.get("position"), f"{key}.position")
            velocity[index] = self.pair(row.get("velocity", [0.0, 0.0]), f"{key}.velocity")
            radius[index] = self.number(row.get("radius", 0.0), f"{key}.radius", least=0.0)
        return Balls(position, velocity, radius)


def _chosen(walls: Walls, keep: list[bool]) -> Walls:
    """Give some of the walls, everything else about them as it was."""
    which = [index for index, kept in enumerate(keep) if kept]
    spans = [slice(walls.offsets[index], walls.offsets[index + 1]) for index in which]
    part = Walls.from_polylines(
        [walls.vertices[span] for span in spans],
        [bool(walls.closed[index]) for index in which],
        bulges=[walls.bulges[span] for span in spans],
        sides=[walls.sides[index] for index in which],
        material=[walls.materials[index] for index in which],
        names=[walls.names[index] for index in which],
        layers=[walls.layers[index] for index in which],
    )
    taken = ("vertices", "offsets", "closed", "bulges", "sides", "materials", "names", "layers")
    return replace(walls, depth=walls.depth[which], **{name: getattr(part, name) for name in taken})


def scene_to_json(scene: Scene, until: float | None = None, bounces: int | None = None) -> dict[str, Any]:
    """Give a scene as the ``wallkit-scene`` format, version 1, has it, walls and materials included."""
    position = np.asarray(scene.balls.position, dtype=np.float64).reshape(-1, 2)
    velocity = np.asarray(scene.balls.velocity, dtype=np.float64).reshape(-1, 2)
    radius = np.broadcast_to(np.asarray(scene.balls.radius, dtype=np.float64), len(position))
    balls = zip(position.tolist(), velocity.tolist(), radius.tolist(), strict=True)
    run = {key: value for key, value in (("until", until), ("bounces", bounces)) if value is not None}
    return {
        "format": "wallkit-scene",
        "version": 1,
        **({"gravity": list(scene.gravity)} if scene.gravity is not None else {}),
        **({"rolling_friction": scene.rolling_friction} if scene.rolling_friction is not None else {}),
        **({"drag": scene.drag} if scene.drag is not None else {}),
        **({"sensors": to_json(scene.sensors)} if scene.sensors is not None else {}),
        **({"run": run} if run else {}),
        "balls": [{"position": p, "velocity": v, "radius": r} for p, v, r in balls],
        "walls": to_json(scene.walls),
    }
