#!/usr/bin/env bash
# @jscad/modeling 2.13.0: what a good engineer guesses and what happens.
#
# Input: offset() with the delta -4, -6 and -8 of a square of 10 by 10, and with -1.5 of two squares of 10 by 10 that a corridor of
#   10 by 2 joins: the places where the centre of a ball of that radius can be.
# Guess: a square of area 4, then nothing; two squares of 7 by 7, area 98, since the ball does not fit into the corridor.
# What happens: 4, then 4 again, and 36: the sides pass one another, and the square that has turned inside out counts as solid,
#   the larger the more it is shrunk. The two rooms have the area 85: the corridor stays, 1 wide and turned inside out, and
#   is subtracted. The smaller the place, the less it is seen; nothing is said.
set -euo pipefail
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
cd "$work"
npm install --silent --no-audit --no-fund --no-save --prefix . @jscad/modeling@2.13.0 >/dev/null
cat > run.mjs <<'JS'
import { createRequire } from "node:module";
const require = createRequire(import.meta.url);
const { expansions, geometries, measurements, primitives } = require("@jscad/modeling");
console.log("@jscad/modeling", require("@jscad/modeling/package.json").version);
const square = primitives.rectangle({ size: [10, 10] });
const rooms = geometries.geom2.fromPoints([
  [0, 0], [10, 0], [10, 4], [20, 4], [20, 0], [30, 0], [30, 10], [20, 10], [20, 6], [10, 6], [10, 10], [0, 10],
]);
let changed = false;
for (const [name, shape, delta, right, wrong] of [
  ["square", square, -4, 4, 4],
  ["square", square, -6, 0, 4],
  ["square", square, -8, 0, 36],
  ["two rooms", rooms, -1.5, 98, 85],
]) {
  const area = measurements.measureArea(expansions.offset({ delta, corners: "edge" }, shape));
  console.log(`${name}, shrunk by ${-delta}: area ${area.toFixed(3)}, right ${right}`);
  changed ||= Math.abs(area - wrong) > 1e-6;
}
if (changed) throw new Error("this has changed");
JS
node run.mjs
