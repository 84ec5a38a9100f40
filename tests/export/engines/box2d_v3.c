// A game for the tests: six balls in the level of level.h, their places at the end as JSON.
// Arguments: x, y, radius, speed, seconds.
#include "level.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

int main(int count, char** arguments)
{
	(void)count;
	float x = (float)atof(arguments[1]), y = (float)atof(arguments[2]), radius = (float)atof(arguments[3]);
	double speed = atof(arguments[4]), seconds = atof(arguments[5]);
	b2WorldDef definition = b2DefaultWorldDef();
	definition.gravity = (b2Vec2){0.0f, 0.0f};
	definition.restitutionThreshold = 0.0f;
	b2WorldId world = b2CreateWorld(&definition);
	wallkitAddWalls(world);
	b2BodyId balls[6];
	for (int k = 0; k < 6; ++k)
	{
		b2BodyDef body = b2DefaultBodyDef();
		body.type = b2_dynamicBody;
		body.isBullet = true;
		body.enableSleep = false;
		body.position = (b2Vec2){x, y};
		double angle = 0.3 + k * 3.14159265358979323846 / 3;
		body.linearVelocity = (b2Vec2){(float)(speed * cos(angle)), (float)(speed * sin(angle))};
		balls[k] = b2CreateBody(world, &body);
		b2ShapeDef shape = b2DefaultShapeDef();
		shape.material.friction = 0.0f;
		shape.material.restitution = 0.0f;
		shape.filter.groupIndex = -1;
		b2Circle circle = {{0.0f, 0.0f}, radius};
		b2CreateCircleShape(balls[k], &shape, &circle);
	}
	for (int step = 0; step < (int)(seconds * 60); ++step)
	{
		b2World_Step(world, 1.0f / 60.0f, 4);
	}
	for (int k = 0; k < 6; ++k)
	{
		b2Vec2 place = b2Body_GetPosition(balls[k]);
		printf("%s[%.9g, %.9g]", k ? ", " : "[", place.x, place.y);
	}
	printf("]\n");
	return 0;
}
