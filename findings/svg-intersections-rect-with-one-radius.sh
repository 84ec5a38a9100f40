#!/usr/bin/env bash
# svg-intersections 0.4.0: what a good engineer guesses and what happens.
#
# Input: a rectangle of 10 by 10 with rx = 2, with ry = 2 and with both, and level and upright lines through its middle and
#   its round corners. SVG says that a radius which is not there is that of the other direction, so the three are one shape.
# Guess: two points on each line, for each of the three.
# What happens: so it is with both radii. With rx alone the level lines meet nothing, not even the upright sides, and the upright
#   ones meet level sides only; with ry alone it is the other way round; the corners are met by neither. Nothing is said.
#   Drawing programs write one radius where both are equal.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . svg-intersections@0.4.0 >/dev/null
cat > run.js <<'JS'
const { intersect, shape } = require("svg-intersections");
console.log("svg-intersections", require("svg-intersections/package.json").version);
const level = (y) => shape("line", { x1: -5, y1: y, x2: 15, y2: y });
const upright = (x) => shape("line", { x1: x, y1: -5, x2: x, y2: 15 });
const points = (radii, line) => intersect(shape("rect", { x: 0, y: 0, width: 10, height: 10, ...radii }), line).points;
// A circle of radius 2 about (2, 2) is cut one unit beside its centre at 2 - sqrt(3).
const corner = points({ rx: 2, ry: 2 }, level(1)).map((p) => p.x).sort((a, b) => a - b);
console.log("both radii, level line at 1: x =", corner.map((x) => x.toFixed(4)).join(", "));
const counts = [{ rx: 2, ry: 2 }, { rx: 2 }, { ry: 2 }].map((radii) => {
  const found = [level, upright].map((line) => [1, 5, 9].map((place) => points(radii, line(place)).length));
  console.log(`${JSON.stringify(radii)}: on level lines ${found[0]}, on upright ones ${found[1]}`);
  return found.join(";");
});
const right = Math.abs(corner[0] - (2 - Math.sqrt(3))) < 1e-9 && counts[0] === "2,2,2;2,2,2";
if (!right || counts[1] !== "0,0,0;0,2,0" || counts[2] !== "0,2,0;0,0,0") throw new Error("this has changed");
JS
node run.js
