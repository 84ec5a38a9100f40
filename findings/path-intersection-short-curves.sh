#!/usr/bin/env bash
# path-intersection 4.2.1: what a good engineer guesses and what happens.
#
# Input: a circle of radius 1, 5 or 50 as two arcs and a level line at half its radius; and an arch, a Bezier curve 4 or 100
#   wide and 3/4 as high, with a level line at half its width.
# Guess: two points each, approximate as the manual says: in the circle at 0.866 radii to both sides, whatever the radius.
# What happens: a curve is cut into one straight line for each 5 units of its length, at least one. In the circle of radius 1
#   the points are 0.134 to the right and 0.711 to the left, and the line through the small arch meets nothing. In a
#   drawing in metres the curves are missed, in the same one in pixels they are met.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . path-intersection@4.2.1 >/dev/null
cat > run.mjs <<'JS'
import { readFileSync } from "node:fs";
import intersect from "path-intersection";
console.log("path-intersection", JSON.parse(readFileSync("node_modules/path-intersection/package.json")).version);
const circle = (r) => `M${-r} 0A${r} ${r} 0 1 1 ${r} 0A${r} ${r} 0 1 1 ${-r} 0Z`;
const arch = (w) => `M0 0C0 ${w} ${w} ${w} ${w} 0`;
const level = (from, to, y) => `M${from} ${y}L${to} ${y}`;
const exact = Math.sqrt(0.75);
const error = (r) => {
  const found = intersect(circle(r), level(-2 * r, 2 * r, r / 2)).map((point) => point.x / r);
  console.log(`circle of radius ${r}: at`, found.map((x) => x.toFixed(4)).join(" and "), "radii, exact", `±${exact.toFixed(4)}`);
  return Math.max(...found.map((x) => Math.abs(Math.abs(x) - exact)));
};
const errors = [1, 5, 50].map(error);
const met = [4, 100].map((w) => intersect(arch(w), level(-w, 2 * w, w / 2)).length);
console.log(`points on the arch of width 4: ${met[0]}, of width 100: ${met[1]}`);
if (errors[0] < 0.5 || errors[1] < 0.1 || errors[2] > 0.01 || met[0] !== 0 || met[1] !== 2) throw new Error("this has changed");
JS
node run.mjs
