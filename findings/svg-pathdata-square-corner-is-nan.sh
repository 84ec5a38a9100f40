#!/usr/bin/env bash
# svg-pathdata 7.2.0: what a good engineer guesses and what happens.
#
# Input: the outline of a rectangle with one round and one square corner, the square one as an arc of radius 0, as programs write it
#   that give each corner its radius; and a lone arc of radius 0. SVG says that such an arc is a straight line.
# Guess: scale(), rotate(), skewX() and matrix() give the moved path, as translate() and toAbs() do; the radius stays 0 or the arc
#   becomes a line.
# What happens: "ANaN NaN NaN 0 1 45 0": the radii and the angle are no numbers, and the text is no valid path data any more. Such a
#   path is drawn up to the fault, and the sides behind that corner are missing. translate() leaves the arc as it was, and
#   aToC() makes the straight curve of it.
set -euo pipefail
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
cd "$work"
npm install --silent --no-audit --no-fund --no-save --prefix . svg-pathdata@7.2.0 >/dev/null
cat > run.mjs <<'JS'
import { readFileSync } from "node:fs";
import { SVGPathData } from "svg-pathdata";
console.log("svg-pathdata", JSON.parse(readFileSync("node_modules/svg-pathdata/package.json")).version);
const outline = "M10 0H90A0 0 0 0 1 90 0V50A10 10 0 0 1 80 60H10z", lone = "M0 0A0 50 0 0 1 100 0";
const ways = {
  "translate(5, 5)": [(path) => path.translate(5, 5), false],
  "aToC()": [(path) => path.aToC(), false],
  "scale(0.5, 0.5)": [(path) => path.scale(0.5, 0.5), true],
  "rotate(0.5)": [(path) => path.rotate(0.5), true],
  "skewX(0.5)": [(path) => path.skewX(0.5), true],
  "matrix(2, 0, 0, 2, 0, 0)": [(path) => path.matrix(2, 0, 0, 2, 0, 0), true],
};
let changed = false;
for (const [name, [move, wrong]] of Object.entries(ways)) {
  const texts = [outline, lone].map((data) => move(new SVGPathData(data)).encode());
  console.log(`${name}: ${texts.join(" and ")}`);
  changed ||= texts.some((text) => text.includes("NaN") !== wrong);
}
if (changed) throw new Error("this has changed");
JS
node run.mjs
