"""Box2D v3 (3.1 and later): a C header with the walls and a function that adds them to a world.

A chain is one-sided: it stops on the right of its direction, which is wallkit's outward normal in any axes. An open
chain would lose its first and last edge to ghosts, so open walls are segments, which are two-sided.
"""

from __future__ import annotations

from typing import TextIO

from wallkit.export.c_text import write_tables
from wallkit.export.level import Level
from wallkit.export.losses import say_friction, say_single_precision, say_two_sided

_HEAD = """// Walls for Box2D v3 (3.1 and later), written by wallkit export. C or C++; include it in one file:
//   b2BodyId walls = wallkitAddWalls(world);
// Of a pair the larger restitution counts: leave the ball's at 0. Balls below b2WorldDef.restitutionThreshold (1 m/s)
// do not bounce; set it to 0 for slow ones. Closed walls stop from outside their material only.
#pragma once

#include "box2d/box2d.h"
#include <stdbool.h>
"""
_TAIL = """
// Adds all walls to one static body. The user data of every shape is its entry of wallkitWalls.
static inline b2BodyId wallkitAddWalls(b2WorldId world)
{
	b2BodyDef bodyDef = b2DefaultBodyDef();
	b2BodyId body = b2CreateBody(world, &bodyDef);
	for (int i = 0; i < wallkitWallCount; ++i)
	{
		const WallkitWall* wall = wallkitWalls + i;
		const b2Vec2* points = wallkitPoints + wall->first;
		b2SurfaceMaterial material = b2DefaultSurfaceMaterial();
		material.friction = 0.0f;
		material.restitution = wall->restitution;
		if (wall->closed)
		{
			b2ChainDef chain = b2DefaultChainDef();
			chain.points = points;
			chain.count = wall->count;
			chain.isLoop = true;
			chain.materials = &material;
			chain.materialCount = 1;
			chain.userData = (void*)wall;
			b2CreateChain(body, &chain);
			continue;
		}
		for (int k = 0; k + 1 < wall->count; ++k)
		{
			b2ShapeDef shape = b2DefaultShapeDef();
			shape.material = material;
			shape.userData = (void*)wall;
			b2Segment segment = { points[k], points[k + 1] };
			b2CreateSegmentShape(body, &shape, &segment);
		}
	}
	return body;
}
"""


def write(level: Level, stream: TextIO) -> None:
    """Write a level as a C header."""
    say_friction(level, "tangentialRestitution")
    say_two_sided(level, "Box2D v3")
    say_single_precision(level, "Box2D")
    level.findings.note_where(
        "export-one-way",
        level.walls,
        lambda wall: wall.one_way and not wall.closed,
        "an open wall stops from both sides; it is kept as oneWay",
    )
    stream.write(_HEAD)
    write_tables(level, stream, chains_of_four=True)
    stream.write(_TAIL)
