"""Walls as tables in C, which C++ reads too."""

from __future__ import annotations

from wallkit.export.box2d import for_four, is_loop
from wallkit.export.level import Level
from wallkit.export.number_text import rows

TABLES = """
// A chain for each closed wall, segments for each open one; in the order of the drawing, points in metres.
typedef struct WallkitWall
{{
	const char* name;
	const char* layer;
	int first; // of its points
	int count;
	bool closed;
	bool oneWay; // drawn as solid from outside alone
	float restitution;
	float tangentialRestitution;
}} WallkitWall;

static const b2Vec2 wallkitPoints[] = {{
{points}
}};

static const WallkitWall wallkitWalls[] = {{
{walls}
}};

enum {{ wallkitWallCount = {count} }};
"""
_EMPTY = '\t{ "", "", 0, 0, false, false, 0.0f, 0.0f },'


def tables(level: Level, chains_of_four: bool = False) -> str:
    """Write the points and walls of a level; with ``chains_of_four`` no closed wall has fewer than four points."""
    points: list[str] = []
    walls: list[str] = []
    first = 0
    for wall in level:
        loop = is_loop(wall)
        vertices = for_four(wall.vertices) if loop and chains_of_four else wall.vertices
        points.append("\t" + rows("{ %rf, %rf },", vertices, " "))
        marks = (
            quoted(wall.name),
            quoted(wall.layer),
            str(first),
            str(len(vertices)),
            str(loop).lower(),
            str(wall.one_way).lower(),
            f"{float(wall.material.restitution)!r}f",
            f"{float(wall.material.tangential_restitution)!r}f",
        )
        walls.append(f"\t{{ {', '.join(marks)} }},")
        first += len(vertices)
    return TABLES.format(
        points="\n".join(points or ["\t{ 0.0f, 0.0f },"]), walls="\n".join(walls or [_EMPTY]), count=len(walls)
    )


def quoted(text: str) -> str:
    """Write a text as a C string; all but plain letters as octal, which no letter behind it can lengthen."""
    plain = "".join(
        chr(byte) if 32 <= byte < 127 and chr(byte) not in '"\\?' else f"\\{byte:03o}" for byte in text.encode("utf-8")
    )
    return f'"{plain}"'
