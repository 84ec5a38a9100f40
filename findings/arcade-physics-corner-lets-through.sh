#!/usr/bin/env bash
# arcade-physics 0.1.0 (Phaser's Arcade physics on its own): what a good engineer guesses and what happens.
#
# Input: a circle of radius 10 with bounce 1 that falls at 300 px/s on the corner of a static plank of 1000 by 20, its
#   centre 1 to 7 px beside the corner; and the same on a square of 200 by 200.
# Guess: it bounces from the corner as from a point: 1 px beside it nearly straight back, (-59.7, -294.0).
# What happens: on the plank it goes on downwards, (-5.9, 299.9), wherever it hits: it is reflected along the line
#   between the two centres, not from the corner. On the square it goes off sideways, (-299.8, -11.7).
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . arcade-physics@0.1.0 >/dev/null
cat > run.js <<'JS'
const { ArcadePhysics } = require("arcade-physics");
console.log("arcade-physics", require("arcade-physics/package.json").version);
function after(beside, [width, height]) {
  const physics = new ArcadePhysics({
    sys: { game: { config: { physics: {} } }, settings: { physics: {} }, scale: { width: 4000, height: 4000 } },
    gravity: { x: 0, y: 0 },
  });
  const wall = physics.add.staticBody(500, 500, width, height);
  const ball = physics.add.body(490 - beside, 390);
  ball.setCircle(10).setBounce(1, 1).setVelocity(0, 300);
  physics.add.collider(ball, wall);
  for (let step = 0; step < 60; step++) {
    physics.world.update((step * 1000) / 60, 1000 / 60);
    physics.world.postUpdate();
  }
  return [ball.velocity.x, ball.velocity.y];
}
const words = (v) => `(${v.map((x) => x.toFixed(1)).join(", ")})`;
for (const beside of [1, 3, 5, 7]) {
  const x = -beside / 10, y = -Math.sqrt(1 - x * x); // the normal, from the corner to the centre
  const exact = [-600 * y * x, 300 - 600 * y * y];
  const plank = after(beside, [1000, 20]), square = after(beside, [200, 200]);
  console.log(`${beside} px beside: exact ${words(exact)}, plank ${words(plank)}, square ${words(square)}`);
  if (Math.abs(plank[1] - 299.9) > 0.1 || square[0] > -299) throw new Error("this has changed");
}
JS
node run.js
