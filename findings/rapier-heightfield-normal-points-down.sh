#!/usr/bin/env bash
# @dimforge/rapier2d-compat 0.21.0: what a good engineer guesses and what happens.
#
# Input: a hill, once as a heightfield of heights 0, 1, 0 and once as a polyline through the same points; a ray and a ball that fall
#   on each slope from above, and a ray from below.
# Guess: castRayAndGetNormal gives the normal on the side of the ray, as for the polyline: upwards for rays from above.
# What happens: the polyline does, and castShape of the ball does for both. The normal that a ray gets from the heightfield points
#   downwards from whichever side it comes, (0.196, -0.981) for the left slope: into the ground. A shot reflected by it is the same,
#   for a reflection does not know the sign, but what is placed along the normal stands below the ground, and a slope is
#   taken for a ceiling.
set -euo pipefail
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
cd "$work"
npm install --silent --no-audit --no-fund --no-save --prefix . @dimforge/rapier2d-compat@0.21.0 >/dev/null
cat > run.mjs <<'JS'
import RAPIER from "@dimforge/rapier2d-compat";
import { readFileSync } from "node:fs";
console.log("rapier2d-compat", JSON.parse(readFileSync("node_modules/@dimforge/rapier2d-compat/package.json")).version);
await RAPIER.init();
const grounds = {
  polyline: RAPIER.ColliderDesc.polyline(new Float32Array([-5, 0, 0, 1, 5, 0])),
  heightfield: RAPIER.ColliderDesc.heightfield(new Float32Array([0, 1, 0]), { x: 10, y: 1 }),
};
const show = ({ x, y }) => `(${x.toFixed(3)}, ${y.toFixed(3)})`;
let changed = false;
for (const [name, ground] of Object.entries(grounds)) {
  const world = new RAPIER.World({ x: 0, y: 0 });
  world.createCollider(ground);
  world.step();
  for (const x of [-3, 1]) {
    const ray = (y) => world.castRayAndGetNormal(new RAPIER.Ray({ x, y }, { x: 0, y: -Math.sign(y) }), 100, true).normal;
    const ball = world.castShape({ x, y: 10 }, 0, { x: 0, y: -1 }, new RAPIER.Ball(0.5), 0, 100, true).normal1;
    const above = ray(10), below = ray(-10);
    console.log(`${name} at x = ${x}: a ray from above ${show(above)}, from below ${show(below)}; a ball from above ${show(ball)}`);
    changed ||= above.y > 0 !== (name === "polyline") || below.y > 0 || ball.y < 0;
  }
}
if (changed) throw new Error("this has changed");
JS
node run.mjs
