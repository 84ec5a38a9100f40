"""Walls as tables in C, which C++ reads too."""

from __future__ import annotations

from typing import TextIO

from wallkit.export.box2d import for_four, is_loop
from wallkit.export.level import Level
from wallkit.export.number_text import Rows

_HEAD = """
// A chain for each closed wall, segments for each open one; in the order of the drawing, points in metres.
typedef struct WallkitWall
{
	const char* name;
	const char* layer;
	int first; // of its points
	int count;
	bool closed;
	bool oneWay; // drawn as solid from outside alone
	float restitution;
	float tangentialRestitution;
} WallkitWall;

static const b2Vec2 wallkitPoints[] = {
"""
_MIDDLE = """};

static const WallkitWall wallkitWalls[] = {
"""
_NO_POINTS, _NO_WALLS = "\t{ 0.0f, 0.0f },\n", '\t{ "", "", 0, 0, false, false, 0.0f, 0.0f },\n'


def write_tables(level: Level, stream: TextIO, chains_of_four: bool = False) -> None:
    """Write the points and walls of a level; with ``chains_of_four`` no closed wall has fewer than four points."""
    stream.write(_HEAD)
    counts = []
    for wall in level:
        vertices = for_four(wall.vertices) if is_loop(wall) and chains_of_four else wall.vertices
        counts.append(len(vertices))
        Rows("{ %rf, %rf },", vertices, " ", "\t", "\n").write(stream)
    stream.write(_MIDDLE if counts else _NO_POINTS + _MIDDLE)
    first = 0
    for wall, count in zip(level, counts, strict=True):
        marks = (
            quoted(wall.name),
            quoted(wall.layer),
            str(first),
            str(count),
            str(is_loop(wall)).lower(),
            str(wall.one_way).lower(),
            f"{float(wall.material.restitution)!r}f",
            f"{float(wall.material.tangential_restitution)!r}f",
        )
        stream.write(f"\t{{ {', '.join(marks)} }},\n")
        first += count
    stream.write(f"{'' if counts else _NO_WALLS}}};\n\nenum {{ wallkitWallCount = {len(counts)} }};\n")


def quoted(text: str) -> str:
    """Write a text as a C string; all but plain letters as octal, which no letter behind it can lengthen."""
    plain = "".join(
        chr(byte) if 32 <= byte < 127 and chr(byte) not in '"\\?' else f"\\{byte:03o}" for byte in text.encode("utf-8")
    )
    return f'"{plain}"'
