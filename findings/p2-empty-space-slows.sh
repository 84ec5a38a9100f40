#!/usr/bin/env bash
# p2-es 1.2.3 (the maintained p2.js): what a good engineer guesses and what happens.
#
# Input: a ball of 1 m/s in an empty world without gravity.
# Guess: 1 m/s after ten seconds.
# What happens: 0.349 m/s: each body is made with damping 0.1, which takes a tenth of its speed every second (0.9 ** 10).
#   Box2D, planck, pymunk and rapier begin with none. A ball of restitution 1 seems to lose speed in its bounces.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . p2-es@1.2.3 >/dev/null
cat > run.mjs <<'JS'
import { readFileSync } from "node:fs";
import * as p2 from "p2-es";
console.log("p2-es", JSON.parse(readFileSync("node_modules/p2-es/package.json")).version);
function speed(options) {
  const world = new p2.World({ gravity: [0, 0] });
  const body = new p2.Body({ mass: 1, velocity: [1, 0], ...options });
  body.addShape(new p2.Circle({ radius: 0.5 }));
  world.addBody(body);
  for (let step = 0; step < 600; step++) world.step(1 / 60);
  return body.velocity[0];
}
const plain = speed({}), free = speed({ damping: 0 });
console.log(`after 10 s: ${plain.toFixed(4)} m/s as it is made, ${free.toFixed(4)} with damping 0; 0.9 ** 10 = ${(0.9 ** 10).toFixed(4)}`);
if (Math.abs(plain - 0.9 ** 10) > 1e-3 || Math.abs(free - 1) > 1e-6) throw new Error("this has changed");
JS
node run.mjs
