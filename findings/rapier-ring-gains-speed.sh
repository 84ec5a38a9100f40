#!/usr/bin/env bash
# @dimforge/rapier2d-compat 0.21.0: what a good engineer guesses and what happens.
#
# Input: a round room, drawn as a closed polyline of 60 edges, and a ball of restitution 1 without friction or gravity.
# Guess: the ball keeps its speed, to some part in a thousand, as it does in a square room.
# What happens: it is twice as fast within a minute. In a room of four edges it keeps its speed to a part in a million. So
#   curves of a level want few edges, or a game that sets the ball's speed itself.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . @dimforge/rapier2d-compat@0.21.0 >/dev/null
cat > run.mjs <<'JS'
import RAPIER from "@dimforge/rapier2d-compat";
import { readFileSync } from "node:fs";
console.log("rapier2d-compat", JSON.parse(readFileSync("node_modules/@dimforge/rapier2d-compat/package.json")).version);
await RAPIER.init();
function gain(edges, turn) {
  const world = new RAPIER.World({ x: 0, y: 0 });
  const points = [];
  for (let k = 0; k <= edges; k++) {
    const angle = turn + (2 * Math.PI * (k % edges)) / edges;
    points.push(10 * Math.cos(angle), 10 * Math.sin(angle));
  }
  const wall = RAPIER.ColliderDesc.polyline(new Float32Array(points)).setRestitution(1).setFriction(0);
  world.createCollider(wall);
  const body = world.createRigidBody(
    RAPIER.RigidBodyDesc.dynamic().setTranslation(1, 0.5).setLinvel(6, 2.5).setCcdEnabled(true).lockRotations(),
  );
  world.createCollider(RAPIER.ColliderDesc.ball(0.5).setRestitution(1).setFriction(0), body);
  for (let step = 0; step < 3600; step++) world.step();
  const { x, y } = body.linvel();
  return Math.hypot(x, y) / Math.hypot(6, 2.5);
}
const round = gain(60, 0), square = gain(4, Math.PI / 4);
console.log(`speed after 60 s: ${round.toFixed(3)} times in the round room, ${square.toFixed(6)} times in the square one`);
if (!(round > 1.2) || Math.abs(square - 1) > 1e-3) throw new Error("this has changed");
JS
node run.mjs
