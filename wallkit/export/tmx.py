"""Tiled maps as XML (TMX 1.10). Tiled itself saves six digits in XML: keep TMJ where Tiled will save the file."""

from __future__ import annotations

from typing import TextIO

from wallkit.export.level import Level
from wallkit.export.names import say_renamed
from wallkit.export.number_text import Rows
from wallkit.export.tiled import TILE, VERSION, TiledObject, Value, tiled_map, type_of
from wallkit.export.xml_text import clean, quoted


def write(level: Level, stream: TextIO) -> None:
    """Write a level as TMX."""
    tiled = tiled_map(level)
    say_renamed(level.walls, [clean(wall.name) for wall in level], "nothing: XML cannot hold it", level.findings)
    stream.write(
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        f'<map version="{VERSION}" tiledversion="{VERSION}.0" orientation="orthogonal" renderorder="right-down"'
        f' width="{tiled.columns}" height="{tiled.rows}" tilewidth="{TILE}" tileheight="{TILE}" infinite="0"'
        f' nextlayerid="{len(tiled.layers) + 1}" nextobjectid="{tiled.objects + 1}">\n'
    )
    for number, (name, objects) in enumerate(tiled.layers, start=1):
        stream.write(f' <objectgroup draworder="index" id="{number}" name={quoted(name)}>\n')
        for one in objects:
            _write_object(one, stream)
        stream.write(" </objectgroup>\n")
    stream.write("</map>\n")


def _write_object(one: TiledObject, stream: TextIO) -> None:
    stream.write(
        f'  <object id="{one.number}" name={quoted(one.name)} type="wall" x="{one.x!r}" y="{one.y!r}">\n'
        "   <properties>\n"
    )
    for name, value in sorted(one.properties.items()):
        stream.write(f"{_property(name, value)}\n")
    before = f'   </properties>\n   <{"polygon" if one.closed else "polyline"} points="'
    Rows("%r,%r", one.points, " ", before, '"/>\n  </object>\n').write(stream)


def _property(name: str, value: Value) -> str:
    text = str(value).lower() if isinstance(value, bool) else str(value)
    kind = type_of(value)
    return (
        f"    <property name={quoted(name)}{'' if kind == 'string' else f' type={quoted(kind)}'} value={quoted(text)}/>"
    )
