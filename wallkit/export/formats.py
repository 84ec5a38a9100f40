"""The formats by name, those of other packages among them, and which of them an ending means."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from dataclasses import dataclass
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path
from typing import TYPE_CHECKING, Any

from wallkit.export.options import ExportError

if TYPE_CHECKING:
    from typing import TextIO

    from wallkit.export.level import Level, YAxis

GROUP = "wallkit.exporters"


@dataclass(frozen=True, slots=True)
class Format:
    """One target of an export.

    Attributes:
        name: as ``--format`` takes it.
        endings: of files that mean it; the first is the usual one.
        title: what it is, for people.
        y_axis: of the target.
        arcs: it keeps arcs.
        metres: it counts in metres.
        module: in this package, whose ``write`` writes the text of a level; ``""`` for one of another package.
        loader: name of a file in ``loaders`` that an engine needs beside the level; or ``""``.
        entry_point: of another package.
    """

    name: str
    endings: tuple[str, ...]
    title: str
    y_axis: YAxis = "down"
    arcs: bool = False
    metres: bool = False
    module: str = ""
    loader: str = ""
    entry_point: EntryPoint | None = None

    def write(self, level: Level, stream: TextIO) -> None:
        """Write the level as the text of a file; what could not be said is in its findings then."""
        importlib.import_module(f"wallkit.export.{self.module}").write(level, stream)

    def foreign(self) -> Callable[..., Any]:
        """Load the function of another package.

        Raises:
            ExportError: it cannot be imported.
        """
        assert self.entry_point is not None
        try:
            function: Callable[..., Any] = self.entry_point.load()
        except Exception as error:
            raise ExportError(
                f"the format {self.name!r} of {self.title} cannot be loaded: {error}",
                code="bad-exporter",
                fix="repair or remove that package",
            ) from error
        return function


_OWN = (
    Format("tmj", (".tmj",), "Tiled map, JSON (version 1.10)", module="tmj"),
    Format("tmx", (".tmx",), "Tiled map, XML (version 1.10)", module="tmx"),
    Format("tscn", (".tscn",), "Godot 4 scene", module="godot4"),
    Format("tscn3", (".godot3.tscn",), "Godot 3 scene", module="godot3"),
    Format("planck", (".planck.json",), "planck.js, its Serializer's JSON", "up", metres=True, module="planck"),
    Format("rube", (".rube.json",), "R.U.B.E. JSON for Box2D", "up", metres=True, module="rube"),
    Format("box2d-v3", (".h",), "Box2D v3, a C header", "up", metres=True, module="box2d_v3"),
    Format("box2d-v24", (".hpp",), "Box2D 2.4, a C++ header", "up", metres=True, module="box2d_v24"),
    Format("pymunk", (".py",), "pymunk, a Python module", module="pymunk"),
    Format("matter", (".matter.json",), "matter.js", module="matter", loader="wallkit-matter.mjs"),
    Format("phaser", (".phaser.json",), "Phaser 3 and 4 (PhysicsEditor)", module="phaser", loader="wallkit-phaser.mjs"),
    Format("rapier", (".rapier.json",), "Rapier", "up", metres=True, module="rapier", loader="wallkit-rapier.mjs"),
    Format("unity", (".unity.json",), "Unity", "up", module="unity", loader="WallkitLevel.cs"),
    Format("dxf", (".dxf",), "DXF R2010, arcs as bulges", "up", arcs=True, module="dxf"),
    Format("geojson", (".geojson",), "GeoJSON", "up", module="geojson"),
    Format("wkt", (".wkt",), "well-known text", "up", module="wkt"),
    Format("svg", (".svg",), "SVG paths", arcs=True, module="svg"),
    Format("svg-layers", (".layers.svg",), "SVG with Inkscape's layers", arcs=True, module="svg_layers"),
)


def formats() -> dict[str, Format]:
    """Give all formats by name: wallkit's own, then those of other packages (entry points ``wallkit.exporters``).

    The name of an entry point is the format's, and its ending. A name that wallkit has itself is wallkit's.
    """
    result = {known.name: known for known in _OWN}
    for point in sorted(entry_points(group=GROUP), key=lambda point: point.name):
        package = point.dist.name if point.dist else point.value
        result.setdefault(point.name, Format(point.name, (f".{point.name}",), package, entry_point=point))
    return result


def find_format(path: str | Path, name: str | None = None) -> Format:
    """Find a format by its name, or by the ending of a file; the longest ending that fits wins.

    Raises:
        ExportError: there is none, or the ending is no answer; the message lists what there is.
    """
    known = formats()
    if name is not None:
        if name in known:
            return known[name]
        fix = f"the formats are {', '.join(known)}"
        raise ExportError(f"{name!r} is no format of an export", code="unknown-format", fix=fix)
    file = Path(path).name.lower()
    fitting = [(len(ending), each) for each in known.values() for ending in each.endings if file.endswith(ending)]
    if fitting:
        return max(fitting, key=lambda pair: pair[0])[1]
    endings = ", ".join(each.endings[0] for each in known.values())
    raise ExportError(
        f"the ending of {Path(path).name!r} does not tell the format" if file != "-" else "no format is given",
        code="unknown-ending",
        fix=f"give --format, or an ending of these: {endings}",
    )


def known_ending(path: str | Path) -> bool:
    """Tell whether a file's ending means a format."""
    file = Path(path).name.lower()
    return any(file.endswith(ending) for each in formats().values() for ending in each.endings)
