#!/usr/bin/env bash
# paper 0.12.20: what a good engineer guesses and what happens.
#
# Input: a square of area 100, drawn once, as one path that goes twice round, and as two subpaths; and a circle likewise. The fill
#   rule is "nonzero", the default. Each is united with a square of area 100 that is far away.
# Guess: 200 for each square: what is wound round twice is filled under "nonzero", and contains() says so too.
# What happens: two subpaths are right. The path that goes twice round is gone: the result is the far square alone. intersect() and
#   subtract() take it for nothing as well, while contains() says that its middle is inside. A pen that comes over its own line
#   again, as plotter files and traced drawings have it, leaves no wall.
set -euo pipefail
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
cd "$work"
npm install --silent --no-audit --no-fund --no-save --prefix . paper@0.12.20 >/dev/null
cat > run.mjs <<'JS'
import { createRequire } from "node:module";
const require = createRequire(import.meta.url);
const paper = require("paper/dist/paper-core");
paper.setup(new paper.Size(100, 100));
console.log("paper", paper.version);
const path = (data) => paper.PathItem.create(data);
const half = (x) => `A10 10 0 0 1 ${x} 0`, turn = half(-10) + half(10);
let changed = false;
for (const [name, data, left] of [
  ["square, once", "M0 0H10V10H0z", 1],
  ["square, twice round", "M0 0H10V10H0V0H10V10H0z", 0],
  ["square, two subpaths", "M0 0H10V10H0zM0 0H10V10H0z", 1],
  ["circle, once", `M10 0${turn}z`, 1],
  ["circle, twice round", `M10 0${turn}${turn}z`, 0],
]) {
  const far = path("M100 0h10v10h-10z"), shape = path(data);
  const joined = shape.unite(far).area - 100, inside = shape.contains([5, 5]);
  console.log(`${name} (${shape.fillRule}): area ${joined.toFixed(1)} after unite(), contains its inside: ${inside}`);
  changed ||= joined > 1 !== Boolean(left) || !inside;
}
if (changed) throw new Error("this has changed");
JS
node run.mjs
