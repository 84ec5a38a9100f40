#!/usr/bin/env bash
# Box2D 2.4 (box2d-wasm 7.0.0): what a good engineer guesses and what happens.
#
# Input: a room as a looped chain of four points, counter-clockwise or clockwise, and a ball inside it.
# Guess: the ball stays in the room either way, as with every 2.x before it and with planck.
# What happens: chains have one side since 2.4, the right of their direction: the counter-clockwise room lets the ball out.
#   A file of walls whose rings turn as GeoJSON asks holds balls in 2.3 and loses them in 2.4.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . box2d-wasm@7.0.0 >/dev/null
cat > run.js <<'JS'
const start = require("box2d-wasm");
console.log("box2d-wasm", JSON.parse(require("fs").readFileSync("node_modules/box2d-wasm/package.json")).version);
const room = [[-5, -5], [5, -5], [5, 5], [-5, 5]]; // counter-clockwise, y up
(async () => {
  const binary = require("fs").readFileSync("node_modules/box2d-wasm/dist/umd/Box2D.simd.wasm"); // else Node tries to fetch it
  const b2 = await start({ wasmBinary: binary });
  const farthest = (points) => {
    const world = new b2.b2World(new b2.b2Vec2(0, 0));
    const [array] = b2.tuplesToVec2Array(points);
    const chain = new b2.b2ChainShape();
    chain.CreateLoop(array, points.length);
    world.CreateBody(new b2.b2BodyDef()).CreateFixture(chain, 0);
    const definition = new b2.b2BodyDef();
    definition.set_type(b2.b2_dynamicBody);
    const ball = world.CreateBody(definition);
    const circle = new b2.b2CircleShape();
    circle.set_m_radius(0.5);
    ball.CreateFixture(circle, 1);
    ball.SetLinearVelocity(new b2.b2Vec2(4, 0));
    for (let step = 0; step < 240; step++) world.Step(1 / 60, 8, 3);
    return ball.GetPosition().get_x();
  };
  const ccw = farthest(room), cw = farthest([...room].reverse());
  console.log(`walls at x = 5; after 4 s the ball is at ${ccw.toFixed(2)} (counter-clockwise), ${cw.toFixed(2)} (clockwise)`);
  if (ccw < 10 || cw > 5) throw new Error("this has changed");
})().catch((error) => { console.error(error); process.exit(1); });
JS
node run.js
