// A game for the tests: six balls in the level of level.hpp, their places at the end as JSON.
// Arguments: x, y, radius, speed, seconds.
#include "level.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>

int main(int, char** arguments)
{
	float x = atof(arguments[1]), y = atof(arguments[2]), radius = atof(arguments[3]);
	double speed = atof(arguments[4]), seconds = atof(arguments[5]);
	b2World world(b2Vec2(0.0f, 0.0f));
	wallkitAddWalls(world);
	b2Body* balls[6];
	for (int k = 0; k < 6; ++k)
	{
		b2BodyDef body;
		body.type = b2_dynamicBody;
		body.bullet = true;
		body.position.Set(x, y);
		double angle = 0.3 + k * 3.14159265358979323846 / 3;
		body.linearVelocity.Set(speed * cos(angle), speed * sin(angle));
		balls[k] = world.CreateBody(&body);
		b2CircleShape circle;
		circle.m_radius = radius;
		b2FixtureDef fixture;
		fixture.shape = &circle;
		fixture.density = 1.0f;
		fixture.friction = 0.0f;
		fixture.restitution = 0.0f;
		fixture.filter.groupIndex = -1;
		balls[k]->CreateFixture(&fixture);
	}
	for (int step = 0; step < int(seconds * 60); ++step)
	{
		world.Step(1.0f / 60.0f, 8, 3);
	}
	for (int k = 0; k < 6; ++k)
	{
		b2Vec2 place = balls[k]->GetPosition();
		printf("%s[%.9g, %.9g]", k ? ", " : "[", place.x, place.y);
	}
	printf("]\n");
	return 0;
}
