#!/usr/bin/env bash
# matter-js 0.20.0 with poly-decomp 0.3.0: what a good engineer guesses and what happens.
#
# Input: a square plate of 100 by 100 with a hole of 20 by 20, as one ring that goes in and out along a cut (a keyhole),
#   the usual way to give a shape with a hole to a program that knows none.
# Guess: Bodies.fromVertices decomposes it into convex parts with an area of 9600 in all.
# What happens: 7200. Before it decomposes the ring, it removes every vertex within 0.01 of another one
#   (`removeDuplicatePoints`), the two ends of the cut among them, and what is left is another shape. With `false` for
#   that argument the area is 9600.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . matter-js@0.20.0 poly-decomp@0.3.0 >/dev/null
cat > run.js <<'JS'
const Matter = require("matter-js");
Matter.Common.setDecomp(require("poly-decomp"));
console.log("matter-js", require("matter-js/package.json").version);
const ring = [
  [0, 0], [100, 0], [100, 100], [0, 100], [0, 0], // around the plate, back to where it began
  [40, 40], [40, 60], [60, 60], [60, 40], [40, 40], // the other way round the hole
].map(([x, y]) => ({ x, y }));
function area(...more) {
  const body = Matter.Bodies.fromVertices(0, 0, [ring], {}, false, ...more);
  const parts = body.parts.length > 1 ? body.parts.slice(1) : body.parts;
  return parts.reduce((sum, part) => sum + Math.abs(Matter.Vertices.area(part.vertices, true)), 0);
}
const usual = area(), kept = area(0, 10, false);
console.log(`area 9600 as drawn; ${usual.toFixed(0)} as it is, ${kept.toFixed(0)} without removeDuplicatePoints`);
if (Math.abs(usual - 9600) < 100 || Math.abs(kept - 9600) > 1) throw new Error("this has changed");
JS
node run.js
