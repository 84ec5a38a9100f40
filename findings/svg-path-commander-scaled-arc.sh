#!/usr/bin/env bash
# svg-path-commander 2.3.3: what a good engineer guesses and what happens.
#
# Input: half a circle of radius 50 as an arc command, scaled by 1 and 0.2; and a line to 0.123456789.
# Guess: an arc command again, of radii 50 and 10, which is exact; and the line as it was.
# What happens: two Bezier curves, up to 0.15 % of the radius too wide, with numbers of four decimals: 0.1235 for the line.
#   Four decimals are the default of the option `round`, also where a path is only measured in metres.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . svg-path-commander@2.3.3 >/dev/null
cat > run.mjs <<'JS'
import { readFileSync } from "node:fs";
import SVGPathCommander from "svg-path-commander";
console.log("svg-path-commander", JSON.parse(readFileSync("node_modules/svg-path-commander/package.json")).version);
const arc = new SVGPathCommander("M0 0A50 50 0 0 1 100 0").transform({ scale: [1, 0.2] }).toString();
const line = new SVGPathCommander("M0 0L0.123456789 10").toString();
console.log("scaled arc:", arc);
console.log("line:", line);
const numbers = arc.match(/-?[\d.]+/g).map(Number);
let worst = 0;
for (let k = 0; k + 7 < numbers.length; k += 6) // each curve begins where the one before ends
  for (let t = 0; t <= 1; t += 0.01) {
    const weights = [(1 - t) ** 3, 3 * (1 - t) ** 2 * t, 3 * (1 - t) * t * t, t ** 3];
    const [x, y] = [0, 1].map((axis) => weights.reduce((sum, w, i) => sum + w * numbers[k + 2 * i + axis], 0));
    worst = Math.max(worst, Math.abs(Math.hypot(x - 50, y / 0.2) - 50) / 50);
  }
console.log(`the curves leave the ellipse by ${(100 * worst).toFixed(3)} % of its radius`);
if (arc.includes("A") || worst < 0.001 || !line.includes("0.1235")) throw new Error("this has changed");
JS
node run.mjs
