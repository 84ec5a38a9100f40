#!/usr/bin/env bash
# greiner-hormann 1.5.0: what a good engineer guesses and what happens.
#
# Input: the example of its manual: a square of 100 by 100 and the same one shifted by 50 each way, both closed by their
#   first point again; and both without that point.
# Guess: an intersection of 2500, a union of 17500 and a difference of 7500, as polygon-clipping has them.
# What happens: for the closed rings all three are the first square, 10000, through a few more points. The repeated point
#   is an edge without length, and only one of the two crossings is in the result. Without the repeated point all three are right.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . greiner-hormann@1.5.0 polygon-clipping@0.15.7 >/dev/null
cat > run.js <<'JS'
const fs = require("fs");
const greiner = require("greiner-hormann");
const clipping = require("polygon-clipping");
console.log("greiner-hormann", JSON.parse(fs.readFileSync("node_modules/greiner-hormann/package.json")).version);
const square = (x, y) => [[x, y], [x + 100, y], [x + 100, y + 100], [x, y + 100], [x, y]];
const open = (ring) => ring.slice(0, -1);
const area = (ring) => Math.abs(ring.reduce((sum, [x, y], k) => {
  const [u, v] = ring[(k + 1) % ring.length];
  return sum + (x * v - u * y) / 2;
}, 0));
const total = (rings) => rings.reduce((sum, ring) => sum + area(ring), 0);
const a = square(0, 0), b = square(50, 50);
let changed = false;
for (const [name, judge] of [["intersection", "intersection"], ["union", "union"], ["diff", "difference"]]) {
  const right = total(clipping[judge]([a], [b]).map((polygon) => polygon[0]));
  const closed = total(greiner[name](a, b)), opened = total(greiner[name](open(a), open(b)));
  console.log(`${name}: closed rings ${closed}, open rings ${opened}, polygon-clipping ${right}`);
  changed ||= closed !== 10000 || opened !== right;
}
if (changed) throw new Error("this has changed");
JS
node run.js
