#!/usr/bin/env bash
# svg-points 6.0.1: what a good engineer guesses and what happens.
#
# Input: a rectangle of 100 by 50 with rx = 20, 30 and 80. SVG says that a radius is at most half of the side: from 25 on
#   upwards the right and left ends are half circles or half ellipses.
# Guess: all points between 0 and 50 in height for each of the three, and a right side that runs down.
# What happens: the first is right. The others keep their radii in both directions: with 30 the right side runs from y = 30 up to
#   20, with 80 from 80 to -30, outside of the rectangle, and the arcs cross one another. Nothing is said. Drawing programs
#   write large radii for round ends.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . svg-points@6.0.1 >/dev/null
cat > run.js <<'JS'
const fs = require("fs");
const { toPoints, toPath } = require("svg-points");
console.log("svg-points", JSON.parse(fs.readFileSync("node_modules/svg-points/package.json")).version);
const results = [20, 30, 80].map((rx) => {
  const shape = { type: "rect", x: 0, y: 0, width: 100, height: 50, rx };
  const points = toPoints(shape);
  const side = points.filter((point) => point.x === 100).map((point) => point.y);
  const heights = points.map((point) => point.y);
  const range = [Math.min(...heights), Math.max(...heights)];
  console.log(`rx ${rx}: right side from ${side[0]} to ${side[1]}, heights ${range[0]} to ${range[1]}`, toPath(shape));
  return [...side, ...range].join();
});
if (results.join(" ") !== "20,30,0,50 30,20,0,50 80,-30,-30,80") throw new Error("this has changed");
JS
node run.js
