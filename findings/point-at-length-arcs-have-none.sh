#!/usr/bin/env bash
# point-at-length 1.1.0: what a good engineer guesses and what happens.
#
# Input: a path of a line of 10, half a circle of radius 50 by the command A, and a line of 10.
# Guess: length() stands in for the browser's getTotalLength(): 20 + 50 pi = 177.08; at(88.5) is the top of the arc.
# What happens: 120, and at(88.5) is a point of a line straight through below the arc: arcs are skipped, and what
#   follows starts where the arc began. A path of arcs only has the length 0. Bezier curves are measured.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . point-at-length@1.1.0 >/dev/null
cat > run.js <<'JS'
const points = require("point-at-length");
console.log("point-at-length", require("point-at-length/package.json").version);
const path = points("M0 0L10 0A50 50 0 0 1 110 0L120 0"), arc = points("M0 0A50 50 0 0 1 100 0");
const length = path.length(), top = path.at(88.54);
console.log(`length ${length} instead of ${(20 + 50 * Math.PI).toFixed(2)}; at half of it: ${top}, not 60,-50`);
console.log(`the arc alone: ${arc.length()} instead of ${(50 * Math.PI).toFixed(2)}`);
if (length !== 120 || Math.abs(top[1]) > 1e-9 || arc.length() !== 0) throw new Error("this has changed");
JS
node run.js
