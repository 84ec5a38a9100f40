#!/usr/bin/env bash
# matter-js 0.20.0: what a good engineer guesses and what happens.
#
# Input: two convex outlines in one call of Bodies.fromVertices, a square at x = 0 to 40 and one at x = 100 to 140; and two
#   outlines with a notch each at the same places.
# Guess: one body of two parts, 140 wide, for both.
# What happens: the notched ones, which are decomposed, keep their places; the convex ones are both put with their centres on
#   the same point, so the body is 40 wide. Whether a set keeps its place depends on whether an outline is convex.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . matter-js@0.20.0 poly-decomp@0.3.0 >/dev/null
cat > run.js <<'JS'
const Matter = require("matter-js");
Matter.Common.setDecomp(require("poly-decomp"));
console.log("matter-js", require("matter-js/package.json").version);
const square = [[0, 0], [40, 0], [40, 40], [0, 40]], notched = [[0, 0], [40, 0], [40, 40], [20, 15], [0, 40]];
function width(outline) {
  const sets = [0, 100].map((along) => outline.map(([x, y]) => ({ x: x + along, y })));
  const body = Matter.Bodies.fromVertices(0, 0, sets);
  return body.bounds.max.x - body.bounds.min.x;
}
const convex = width(square), concave = width(notched);
console.log(`drawn 140 wide; convex outlines ${convex.toFixed(2)}, outlines with a notch ${concave.toFixed(2)}`);
if (convex > 60 || Math.abs(concave - 140) > 1) throw new Error("this has changed");
JS
node run.js
