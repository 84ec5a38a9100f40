#!/usr/bin/env bash
# svg-path-bounds 1.0.2: what a good engineer guesses and what happens.
#
# Input: a path of one cubic Bezier curve from (0, 0) to (10, 0) with handles at (0, 30) and (10, 30).
# Guess: the bounds of the path: y from 0 to 22.5, the top of the curve.
# What happens: y from 0 to 30: the box holds the handles too. An arc is made into curves first and has the box of
#   their handles: a tilted ellipse that ends at x = 174.07 is told to end at 181.41. What is fitted to such a box is
#   too small.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . svg-path-bounds@1.0.2 >/dev/null
cat > run.js <<'JS'
const bounds = require("svg-path-bounds");
console.log("svg-path-bounds", require("svg-path-bounds/package.json").version);
const top = bounds("M0 0C0 30 10 30 10 0")[3];
const right = bounds("M0 0A100 20 30 1 1 50 50")[2];
const y = (t) => 3 * 30 * t * (1 - t) * (1 - t) + 3 * 30 * t * t * (1 - t);
console.log(`the curve's top is ${y(0.5)}, told ${top}; the ellipse ends at 174.07, told ${right.toFixed(2)}`);
if (top !== 30 || Math.abs(right - 181.41) > 0.01) throw new Error("this has changed");
JS
node run.js
