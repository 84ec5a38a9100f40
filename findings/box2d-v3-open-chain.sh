#!/usr/bin/env bash
# Box2D v3 (in the wheel of pyb2d3 0.11.1): what a good engineer guesses and what happens.
#
# Input: an open chain of n points.
# Guess: n - 1 solid edges, from each point to the next, as a chain of Box2D 2.3 or planck has them.
# What happens: n - 3 solid edges: the first and the last point are ghosts, which only smooth the ends. Four points are
#   one wall, and that stops from the right of its direction only. A level's open line must become segments.
set -euo pipefail
cd "$(mktemp -d)"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check pyb2d3==0.11.1 numpy==2.3.5
home=$(venv/bin/python -I -c "import importlib.util, pathlib; print(pathlib.Path(importlib.util.find_spec('pyb2d3').origin).parents[1])")
cat > run.c <<'C'
#include "box2d/box2d.h"
#include <stdio.h>

static float height(float x, float from, float speed) // of a ball that flies at a level chain from -15 to 15
{
	b2WorldDef definition = b2DefaultWorldDef();
	definition.gravity = (b2Vec2){0.0f, 0.0f};
	b2WorldId world = b2CreateWorld(&definition);
	b2BodyDef still = b2DefaultBodyDef();
	b2ChainDef chain = b2DefaultChainDef();
	b2Vec2 points[4] = {{15.0f, 0.0f}, {5.0f, 0.0f}, {-5.0f, 0.0f}, {-15.0f, 0.0f}}; // solid from above: its right
	chain.points = points;
	chain.count = 4;
	b2CreateChain(b2CreateBody(world, &still), &chain);
	b2BodyDef moving = b2DefaultBodyDef();
	moving.type = b2_dynamicBody;
	moving.position = (b2Vec2){x, from};
	moving.linearVelocity = (b2Vec2){0.0f, speed};
	b2BodyId ball = b2CreateBody(world, &moving);
	b2ShapeDef shape = b2DefaultShapeDef();
	b2Circle circle = {{0.0f, 0.0f}, 0.5f};
	b2CreateCircleShape(ball, &shape, &circle);
	for (int step = 0; step < 120; ++step) b2World_Step(world, 1.0f / 60.0f, 4);
	float result = b2Body_GetPosition(ball).y;
	b2DestroyWorld(world);
	return result;
}

int main(void)
{
	b2Version version = b2GetVersion();
	printf("Box2D %d.%d.%d\n", version.major, version.minor, version.revision);
	float middle = height(0.0f, 3.0f, -3.0f), first = height(10.0f, 3.0f, -3.0f), last = height(-10.0f, 3.0f, -3.0f);
	float below = height(0.0f, -3.0f, 3.0f);
	printf("from above: middle edge stops at %.2f, first edge lets through to %.2f, last to %.2f\n", middle, first, last);
	printf("from below: middle edge lets through to %.2f\n", below);
	return middle > 0.4f && first < -2.0f && last < -2.0f && below > 2.0f ? 0 : 1; // 1: this has changed
}
C
gcc -O1 "-I$home/include" run.c "$(find "$home" -name libbox2d.a | head -1)" -lm -lpthread -o run
./run
