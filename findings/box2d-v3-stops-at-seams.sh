#!/usr/bin/env bash
# Box2D v3 (in the wheel of pyb2d3 0.11.1): what a good engineer guesses and what happens.
#
# Input: a box without friction that slides at 6 m/s over a level floor, made of 40 segments or of one chain through the
#   same points.
# Guess: it slides on over both: no friction and no edge stands out.
# What happens: over the chain it does; over the segments it stops at the first seam that its corner comes to. Only a chain knows its neighbours.
set -euo pipefail
cd "$(mktemp -d)"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check pyb2d3==0.11.1 numpy==2.3.5
home=$(venv/bin/python -I -c "import importlib.util, pathlib; print(pathlib.Path(importlib.util.find_spec('pyb2d3').origin).parents[1])")
cat > run.c <<'C'
#include "box2d/box2d.h"
#include <stdio.h>

static float slide(int chained, float* place) // the speed along the floor after two seconds
{
	b2WorldDef definition = b2DefaultWorldDef();
	definition.gravity = (b2Vec2){0.0f, -10.0f};
	b2WorldId world = b2CreateWorld(&definition);
	b2BodyDef still = b2DefaultBodyDef();
	b2BodyId floor = b2CreateBody(world, &still);
	b2Vec2 points[43]; // from right to left, so that a chain is solid from above
	for (int i = 0; i < 43; ++i) points[i] = (b2Vec2){41.0f - i, 0.0f};
	if (chained)
	{
		b2ChainDef chain = b2DefaultChainDef();
		b2SurfaceMaterial material = b2DefaultSurfaceMaterial();
		material.friction = 0.0f;
		chain.points = points;
		chain.count = 43;
		chain.materials = &material;
		chain.materialCount = 1;
		b2CreateChain(floor, &chain);
	}
	for (int i = 1; !chained && i < 41; ++i)
	{
		b2ShapeDef shape = b2DefaultShapeDef();
		shape.material.friction = 0.0f;
		b2Segment segment = {points[i], points[i + 1]};
		b2CreateSegmentShape(floor, &shape, &segment);
	}
	b2BodyDef moving = b2DefaultBodyDef();
	moving.type = b2_dynamicBody;
	moving.position = (b2Vec2){0.3f, 0.5f};
	moving.linearVelocity = (b2Vec2){6.0f, 0.0f};
	b2BodyId body = b2CreateBody(world, &moving);
	b2ShapeDef shape = b2DefaultShapeDef();
	shape.material.friction = 0.0f;
	b2Polygon box = b2MakeBox(0.5f, 0.5f);
	b2CreatePolygonShape(body, &shape, &box);
	for (int step = 0; step < 120; ++step) b2World_Step(world, 1.0f / 60.0f, 4);
	float speed = b2Body_GetLinearVelocity(body).x;
	*place = b2Body_GetPosition(body).x;
	b2DestroyWorld(world);
	return speed;
}

int main(void)
{
	b2Version version = b2GetVersion();
	printf("Box2D %d.%d.%d\n", version.major, version.minor, version.revision);
	float x, y, chained = slide(1, &x), apart = slide(0, &y);
	printf("chain: 6 m/s -> %.2f m/s at x = %.2f\nsegments: 6 m/s -> %.2f m/s at x = %.2f\n", chained, x, apart, y);
	return chained > 5.9f && apart < 0.5f ? 0 : 1; // 1: this has changed
}
C
gcc -O1 "-I$home/include" run.c "$(find "$home" -name libbox2d.a | head -1)" -lm -lpthread -o run
./run
