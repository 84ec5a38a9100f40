#!/usr/bin/env bash
# fit-curve 0.2.0: what a good engineer guesses and what happens.
#
# Input: a stroke of three points that runs 10 to the right and back to where it began, or back but for 1; fitted with a
#   tolerance of 0.5. And the same stroke with a point each unit.
# Guess: the curves pass each point within the tolerance, which is a squared distance: within 0.71. The stroke is cut at its turn.
# What happens: the stroke that comes back is one curve whose four points are all the start: its turn is missed by 10, and a wall is
#   gone. With a point each unit, or where it comes back to 1 beside its start, the turn is met. The first curve that is tried
#   has no length, distances along it are 0 / 0, and no comparison with that says that a point is too far away.
set -euo pipefail
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
cd "$work"
npm install --silent --no-audit --no-fund --no-save --prefix . fit-curve@0.2.0 >/dev/null
cat > run.mjs <<'JS'
import { createRequire } from "node:module";
const require = createRequire(import.meta.url);
const fitCurve = require("fit-curve");
console.log("fit-curve", require("fit-curve/package.json").version);
const there = Array.from({ length: 10 }, (_, k) => [k, 0]), back = Array.from({ length: 11 }, (_, k) => [10 - k, 0]);
function at([a, b, c, d], t) {
  const s = 1 - t;
  return [0, 1].map((i) => s * s * s * a[i] + 3 * s * s * t * b[i] + 3 * s * t * t * c[i] + t * t * t * d[i]);
}
function missed(points) {
  const curves = fitCurve(points, 0.5);
  const drawn = curves.flatMap((curve) => Array.from({ length: 1001 }, (_, k) => at(curve, k / 1000)));
  return [curves.length, Math.max(...points.map(([x, y]) => Math.min(...drawn.map((p) => Math.hypot(p[0] - x, p[1] - y)))))];
}
let changed = false;
for (const [name, points, expected] of [
  ["three points, back to the start", [[0, 0], [10, 0], [0, 0]], 10],
  ["three points, back to (0, 1)", [[0, 0], [10, 0], [0, 1]], 0],
  ["a point each unit", [...there, ...back], 0],
]) {
  const [curves, distance] = missed(points);
  console.log(`${name}: ${curves} curve(s), the worst point is ${distance.toFixed(3)} away, tolerance 0.71`);
  changed ||= Math.abs(distance - expected) > 0.71;
}
if (changed) throw new Error("this has changed");
JS
node run.mjs
