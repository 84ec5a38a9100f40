"""Box2D 2.4: a C++ header with the walls and a function that adds them to a world.

Loops of 2.4 are one-sided like chains of v3: they stop on the right of their direction, which is wallkit's outward
normal. Open walls are edges, two-sided.
"""

from __future__ import annotations

from typing import TextIO

from wallkit.export.c_text import write_tables
from wallkit.export.level import Level
from wallkit.export.losses import say_friction, say_single_precision, say_two_sided

_HEAD = """// Walls for Box2D 2.4, written by wallkit export. Include it in one file:
//   b2Body* walls = wallkitAddWalls(world);
// Of a pair the larger restitution counts: leave the ball's at 0. Balls of 1 m/s and less do not bounce, and none
// moves by more than 2 m a step. Closed walls stop from outside their material only.
#pragma once

#include "box2d/box2d.h"
#include <cstdint>
"""
_TAIL = """
// Adds all walls to one static body. The user data of every fixture points to its entry of wallkitWalls.
inline b2Body* wallkitAddWalls(b2World& world)
{
	b2BodyDef bodyDef;
	b2Body* body = world.CreateBody(&bodyDef);
	for (int i = 0; i < wallkitWallCount; ++i)
	{
		const WallkitWall& wall = wallkitWalls[i];
		const b2Vec2* points = wallkitPoints + wall.first;
		b2FixtureDef fixture;
		fixture.friction = 0.0f;
		fixture.restitution = wall.restitution;
		fixture.userData.pointer = reinterpret_cast<uintptr_t>(&wall);
		if (wall.closed)
		{
			b2ChainShape chain;
			chain.CreateLoop(points, wall.count);
			fixture.shape = &chain;
			body->CreateFixture(&fixture);
			continue;
		}
		for (int k = 0; k + 1 < wall.count; ++k)
		{
			b2EdgeShape edge;
			edge.SetTwoSided(points[k], points[k + 1]);
			fixture.shape = &edge;
			body->CreateFixture(&fixture);
		}
	}
	return body;
}
"""


def write(level: Level, stream: TextIO) -> None:
    """Write a level as a C++ header."""
    say_friction(level, "tangentialRestitution")
    say_two_sided(level, "Box2D 2.4")
    say_single_precision(level, "Box2D")
    level.findings.note_where(
        "export-one-way",
        level.walls,
        lambda wall: wall.one_way and not wall.closed,
        "an open wall stops from both sides; it is kept as oneWay",
    )
    stream.write(_HEAD)
    write_tables(level, stream)
    stream.write(_TAIL)
