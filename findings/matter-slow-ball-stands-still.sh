#!/usr/bin/env bash
# matter-js 0.20.0: what a good engineer guesses and what happens.
#
# Input: a ball of restitution 1 that flies head on at a wall of restitution 1, at 1.9 and at 2.1 px a step (114 and
#   126 px/s at 60 steps a second), without friction, air friction and gravity.
# Guess: both come back.
# What happens: the slower one stands still at the wall for ever, and its `velocity` still says 1.9 towards the wall. The
#   limit is `Resolver._restingThresh` of 2 px a step, whatever the length of a step is. Slow balls of a level stick
#   to its walls, and a program that reads their velocity does not notice.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . matter-js@0.20.0 >/dev/null
cat > run.js <<'JS'
const Matter = require("matter-js");
console.log("matter-js", require("matter-js/package.json").version);
function fly(speed) {
  const engine = Matter.Engine.create({ gravity: { x: 0, y: 0 } });
  const wall = Matter.Bodies.rectangle(250, 0, 100, 400, { isStatic: true });
  wall.restitution = 1; // after its creation: before, isStatic would put it to 0
  wall.friction = 0;
  const free = { restitution: 1, friction: 0, frictionAir: 0, frictionStatic: 0, inertia: Infinity };
  const ball = Matter.Bodies.circle(100, 0, 10, free);
  Matter.Composite.add(engine.world, [wall, ball]);
  Matter.Body.setVelocity(ball, { x: speed, y: 0 });
  const places = [];
  for (let step = 0; step < 600; step++) {
    Matter.Engine.update(engine, 1000 / 60);
    places.push(ball.position.x);
  }
  return { moved: Math.abs(places[599] - places[499]), velocity: ball.velocity.x };
}
const slow = fly(1.9), fast = fly(2.1);
for (const [name, found] of [["1.9 px a step", slow], ["2.1 px a step", fast]])
  console.log(`${name}: moves ${found.moved.toFixed(2)} px in the last 100 steps, velocity says ${found.velocity.toFixed(2)}`);
if (slow.moved > 1 || slow.velocity < 1.8 || fast.moved < 200 || fast.velocity > -2) throw new Error("this has changed");
JS
node run.js
