#!/usr/bin/env bash
# detect-collisions 10.10.2025: what a good engineer guesses and what happens.
#
# Input: a ball of radius 4 that is 0.1 to 4 units deep in the upright leg of an L; and in a lone leg, the same place without
#   the other arm.
# Guess: `overlap` of the response is the depth for both, as `overlapV`, the way out, has it.
# What happens: the leg says 0.1, 2, 3 and 4; the L says 1 for each: for a concave polygon `overlap` is the length of the unit
#   vector. `overlapV` is right for both. Who moves a ball out by `overlapN` times `overlap`, or sorts contacts by depth, is
#   right for convex walls only.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . detect-collisions@10.10.2025 >/dev/null
cat > run.js <<'JS'
const fs = require("fs");
const { System } = require("detect-collisions");
console.log("detect-collisions", JSON.parse(fs.readFileSync("node_modules/detect-collisions/package.json")).version);
const points = (pairs) => pairs.map(([x, y]) => ({ x, y }));
const leg = points([[0, 0], [10, 0], [10, 40], [0, 40]]);
const ell = points([[0, 0], [40, 0], [40, 10], [10, 10], [10, 40], [0, 40]]);
function response(wall, x) {
  const system = new System();
  const ball = system.createCircle({ x, y: 30 }, 4);
  system.checkCollision(ball, system.createPolygon({ x: 0, y: 0 }, wall));
  return { overlap: system.response.overlap, way: Math.hypot(system.response.overlapV.x, system.response.overlapV.y) };
}
let changed = false;
for (const depth of [0.1, 2, 3, 4]) {
  const [convex, concave] = [leg, ell].map((wall) => response(wall, 14 - depth));
  console.log(`depth ${depth}: leg ${convex.overlap.toFixed(3)}, L ${concave.overlap.toFixed(3)}, overlapV of both`,
    convex.way.toFixed(3), concave.way.toFixed(3));
  const asBefore = [[convex.overlap, depth], [convex.way, depth], [concave.way, depth], [concave.overlap, 1]];
  changed ||= asBefore.some(([value, before]) => Math.abs(value - before) > 1e-9);
}
if (changed) throw new Error("this has changed");
JS
node run.js
