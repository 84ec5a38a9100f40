// Six balls in each level of planck's Serializer JSON; their places at the end, and what the chains are.
const fs = require("fs");
const planck = require("planck");

const results = JSON.parse(process.argv[2]).map((game) => {
  const world = planck.Serializer.fromJson(JSON.parse(fs.readFileSync(game.file, "utf8")));
  const chains = [];
  for (let body = world.getBodyList(); body; body = body.getNext()) {
    for (let fixture = body.getFixtureList(); fixture; fixture = fixture.getNext()) {
      const shape = fixture.getShape();
      chains.push({
        count: shape.m_count,
        loop: shape.m_isLoop,
        points: shape.m_vertices.map((vertex) => [vertex.x, vertex.y]),
        restitution: fixture.getRestitution(),
        userData: fixture.getUserData(),
      });
    }
  }
  const balls = game.velocities.map(([vx, vy]) => {
    const ball = world.createBody({ type: "dynamic", position: { x: game.x, y: game.y }, bullet: true });
    ball.setLinearVelocity({ x: vx, y: vy });
    const circle = new planck.Circle(game.radius);
    ball.createFixture({ shape: circle, density: 1, friction: 0, restitution: 0, filterGroupIndex: -1 });
    return ball;
  });
  for (let step = 0; step < game.seconds * 60; step++) world.step(1 / 60);
  return { chains, places: balls.map((ball) => [ball.getPosition().x, ball.getPosition().y]) };
});
console.log(JSON.stringify(results));
