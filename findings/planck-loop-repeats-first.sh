#!/usr/bin/env bash
# planck 1.4.2: what a good engineer guesses and what happens.
#
# Input: a ring of five points for a looped chain, with the first point repeated at the end, as R.U.B.E., GeoJSON and
#   most level files write a ring.
# Guess: a closed wall of five edges, as without the repetition.
# What happens: the chain has seven vertices (six without the repetition): an edge without length, and a ghost vertex
#   that is the first vertex itself. A ball without friction that slides over the repeated vertex loses speed there,
#   where over the others and without the repetition it keeps it.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . planck@1.4.2 >/dev/null
cat > run.js <<'JS'
const planck = require("planck");
console.log("planck", JSON.parse(require("fs").readFileSync("node_modules/planck/package.json")).version);
// the first vertex is in the middle of the floor; the room is 10 m wide
const ring = [[0, 0], [5, 0], [5, 6], [-5, 6], [-5, 0]].map(([x, y]) => ({ x, y }));
function slide(points) {
  const world = new planck.World({ gravity: { x: 0, y: -10 } });
  const shape = new planck.Chain(points, true);
  world.createBody().createFixture({ shape, friction: 0, restitution: 0 });
  const ball = world.createBody({ type: "dynamic", position: { x: -2, y: 0.5 }, fixedRotation: true });
  ball.createFixture({ shape: new planck.Circle(0.5), density: 1, friction: 0, restitution: 0 });
  ball.setLinearVelocity({ x: 1, y: 0 });
  for (let step = 0; step < 240; step++) world.step(1 / 60);
  return { count: shape.m_count, speed: ball.getLinearVelocity().x };
}
const once = slide(ring);
const twice = slide([...ring, ring[0]]);
console.log(`as it is: ${once.count} vertices, speed over the floor 1 -> ${once.speed}`);
console.log(`first repeated: ${twice.count} vertices, speed over the floor 1 -> ${twice.speed}`);
if (once.count !== 6 || twice.count !== 7) throw new Error("this has changed");
if (Math.abs(once.speed - 1) > 1e-6 || twice.speed > 0.99) throw new Error("this has changed");
JS
node run.js
