#!/usr/bin/env bash
# planck 1.4.2 and @dimforge/rapier2d-compat 0.21.0: what a good engineer guesses and what happens.
#
# Input: a ball of 100, 240 and 1000 m/s in an empty world without gravity and damping, for one second of 60 steps.
# Guess: it is 100, 240 and 1000 m further on, with the speed it was given; what fast balls are in danger of is a wall.
# What happens: planck's ball is 120 m further on for the last two, and its velocity says 120: no step may be longer than 2 m,
#   as in Box2D. rapier's goes 240 m and then 400 instead of 1000, however short the steps are. Nothing is said. In a level in
#   pixels, whose balls fly at 500 to 900 px/s, all of them have one speed. Steps half as long double planck's limit; in
#   rapier it is 400 times the world's `lengthUnit`, 1 unless told otherwise.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . planck@1.4.2 @dimforge/rapier2d-compat@0.21.0 >/dev/null
cat > run.mjs <<'JS'
import { readFileSync } from "node:fs";
import RAPIER from "@dimforge/rapier2d-compat";
import planck from "planck";
const version = (name) => JSON.parse(readFileSync(`node_modules/${name}/package.json`)).version;
console.log("planck", version("planck"), "rapier2d-compat", version("@dimforge/rapier2d-compat"));
await RAPIER.init();
function inPlanck(speed, steps = 60) {
  const world = new planck.World({ gravity: { x: 0, y: 0 } });
  const ball = world.createBody({ type: "dynamic", linearVelocity: { x: speed, y: 0 } });
  ball.createFixture(new planck.Circle(0.5), { density: 1 });
  for (let k = 0; k < steps; k++) world.step(1 / steps);
  return [ball.getPosition().x, ball.getLinearVelocity().x];
}
function inRapier(speed, unit = 1, steps = 60) {
  const world = new RAPIER.World({ x: 0, y: 0 });
  world.lengthUnit = unit;
  world.timestep = 1 / steps;
  const ball = world.createRigidBody(RAPIER.RigidBodyDesc.dynamic().setLinvel(speed, 0));
  world.createCollider(RAPIER.ColliderDesc.ball(0.5), ball);
  for (let k = 0; k < steps; k++) world.step();
  return [ball.translation().x, ball.linvel().x];
}
const text = ([place, speed]) => `at ${place.toFixed(2)} with ${speed.toFixed(2)} m/s`;
const near = ([place, speed], limit) => Math.abs(place - limit) < 0.01 && Math.abs(speed - limit) < 0.01;
let changed = false;
for (const [speed, limits] of [[100, [100, 100]], [240, [120, 240]], [1000, [120, 400]]]) {
  const balls = [inPlanck(speed), inRapier(speed)];
  console.log(`${speed} m/s: planck ${text(balls[0])}, rapier ${text(balls[1])}`);
  changed ||= !balls.every((ball, k) => near(ball, limits[k]));
}
const others = [[inPlanck(1000, 120), 240], [inRapier(1000, 1, 240), 400], [inRapier(1000, 100), 1000]];
console.log(`1000 m/s: planck in 120 steps ${text(others[0][0])}`);
console.log(`1000 m/s: rapier in 240 steps ${text(others[1][0])}, with a length unit of 100 ${text(others[2][0])}`);
if (changed || !others.every(([ball, limit]) => near(ball, limit))) throw new Error("this has changed");
JS
node run.mjs
