"""Tiled maps as XML (TMX 1.10). Tiled itself saves six digits in XML: keep TMJ where Tiled will save the file."""

from __future__ import annotations

from wallkit.export.level import Level
from wallkit.export.names import say_renamed
from wallkit.export.number_text import rows
from wallkit.export.tiled import TILE, VERSION, TiledObject, Value, tiled_map, type_of
from wallkit.export.xml_text import clean, quoted


def write(level: Level) -> str:
    """Write a level as TMX."""
    tiled = tiled_map(level)
    say_renamed(level.walls, [clean(wall.name) for wall in level], "nothing: XML cannot hold it", level.findings)
    lines = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        f'<map version="{VERSION}" tiledversion="{VERSION}.0" orientation="orthogonal" renderorder="right-down"'
        f' width="{tiled.columns}" height="{tiled.rows}" tilewidth="{TILE}" tileheight="{TILE}" infinite="0"'
        f' nextlayerid="{len(tiled.layers) + 1}" nextobjectid="{tiled.objects + 1}">',
    ]
    for number, (name, objects) in enumerate(tiled.layers, start=1):
        lines.append(f' <objectgroup draworder="index" id="{number}" name={quoted(name)}>')
        for one in objects:
            lines += _object(one)
        lines.append(" </objectgroup>")
    return "\n".join([*lines, "</map>", ""])


def _object(one: TiledObject) -> list[str]:
    points = rows("%r,%r", one.points, " ")
    return [
        f'  <object id="{one.number}" name={quoted(one.name)} type="wall" x="{one.x!r}" y="{one.y!r}">',
        "   <properties>",
        *(_property(name, value) for name, value in sorted(one.properties.items())),
        "   </properties>",
        f'   <{"polygon" if one.closed else "polyline"} points="{points}"/>',
        "  </object>",
    ]


def _property(name: str, value: Value) -> str:
    text = str(value).lower() if isinstance(value, bool) else str(value)
    kind = type_of(value)
    return (
        f"    <property name={quoted(name)}{'' if kind == 'string' else f' type={quoted(kind)}'} value={quoted(text)}/>"
    )
