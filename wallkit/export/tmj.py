"""Tiled maps as JSON (TMJ 1.10): numbers keep all their digits, in Tiled's own saves too (15 of them)."""

from __future__ import annotations

from typing import Any, TextIO

from wallkit.export.json_text import points, write_json
from wallkit.export.level import Level
from wallkit.export.tiled import TILE, VERSION, TiledObject, tiled_map, type_of


def write(level: Level, stream: TextIO) -> None:
    """Write a level as TMJ."""
    tiled = tiled_map(level)
    layers = [
        {
            "id": number,
            "name": name,
            "type": "objectgroup",
            "draworder": "index",
            "x": 0,
            "y": 0,
            "opacity": 1,
            "visible": True,
            "objects": [_object(one) for one in objects],
        }
        for number, (name, objects) in enumerate(tiled.layers, start=1)
    ]
    whole = {
        "type": "map",
        "version": VERSION,
        "tiledversion": f"{VERSION}.0",
        "orientation": "orthogonal",
        "renderorder": "right-down",
        "infinite": False,
        "width": tiled.columns,
        "height": tiled.rows,
        "tilewidth": TILE,
        "tileheight": TILE,
        "nextlayerid": len(layers) + 1,
        "nextobjectid": tiled.objects + 1,
        "tilesets": [],
        "layers": layers,
    }
    write_json(whole, 4, stream)


def _object(one: TiledObject) -> dict[str, Any]:
    return {
        "id": one.number,
        "name": one.name,
        "type": "wall",
        "x": one.x,
        "y": one.y,
        "width": 0,
        "height": 0,
        "rotation": 0,
        "visible": True,
        "properties": [{"name": n, "type": type_of(v), "value": v} for n, v in sorted(one.properties.items())],
        "polygon" if one.closed else "polyline": points(one.points),
    }
