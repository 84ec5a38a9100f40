#!/usr/bin/env bash
# svg-path-bounding-box 1.0.4: what a good engineer guesses and what happens.
#
# Input: one quadratic curve, an arch of width 10 and height 5: M0 0 Q5 10 10 0; and the same 10 further right.
# Guess: y from 0 to 5 for both.
# What happens: 0 to 5, and 0 to 9.12. The height depends on where the arch stands; only a curve that starts where x =
#   y is right, which is why a test at the origin passes. Cubic curves are right everywhere. A wave of three arches (by
#   `T`) is told to be as high as 13.48.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . svg-path-bounding-box@1.0.4 >/dev/null
cat > run.js <<'JS'
const box = require("svg-path-bounding-box");
console.log("svg-path-bounding-box", require("svg-path-bounding-box/package.json").version);
const height = (data) => Number(box(data).y2.toFixed(2));
const here = height("M0 0Q5 10 10 0"), there = height("M10 0Q15 10 20 0");
const cubic = height("M10 0C13.3333333333 6.6666666667 16.6666666667 6.6666666667 20 0");
const wave = height("M0 0Q5 10 10 0T20 0T30 0");
console.log(`at 0: ${here}; at 10: ${there}; there as a cubic curve: ${cubic}; the wave: ${wave}`);
if ([here, there, cubic, wave].join() !== "5,9.12,5,13.48") throw new Error("this has changed");
JS
node run.js
