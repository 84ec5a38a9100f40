#!/usr/bin/env bash
# svg-intersections 0.4.0: what a good engineer guesses and what happens.
#
# Input: one square as a path with `L`, with `H` and `V`, and with `h` and `v`; each cut by a level and by an upright line.
# Guess: "all SVG shape types": two points for each of the six.
# What happens: with `L` two. With `H` and `V` only what `Z` draws is met: one point on the level line, none on the upright
#   one, and nothing is said. With `h` and `v` an error names the command. Drawing programs and minifiers write the sides of a
#   room with these commands, and a ball would leave through three of the four walls.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . svg-intersections@0.4.0 >/dev/null
cat > run.js <<'JS'
const { intersect, shape } = require("svg-intersections");
console.log("svg-intersections", require("svg-intersections/package.json").version);
const level = shape("line", { x1: -5, y1: 5, x2: 15, y2: 5 });
const upright = shape("line", { x1: 3, y1: -5, x2: 3, y2: 15 });
const count = (d) => [level, upright].map((line) => {
  try {
    return intersect(shape("path", { d }), line).points.length;
  } catch (error) {
    return error.message;
  }
});
const met = ["M0 0L10 0L10 10L0 10Z", "M0 0H10V10H0Z", "M0 0h10v10h-10z"].map((d) => {
  const points = count(d);
  console.log(`${d}: ${points.join(", ")}`);
  return points.join();
});
if (met[0] !== "2,2" || met[1] !== "1,0" || !met[2].includes("Unsupported")) throw new Error("this has changed");
JS
node run.js
