#!/usr/bin/env bash
# svg-pathdata 7.2.0: what a good engineer guesses and what happens.
#
# Input: sanitize(), which removes what has no length: a loop that leaves a point and comes back to it, as an absolute and as
#   a relative cubic curve; a closed square whose last side is drawn before the `z`; and, with a tolerance of 0.5, a line of
#   five steps of 0.4.
# Guess: both loops stay, they are 35 units long; the square stays closed; the line may lose points, but ends where it ended.
# What happens: the absolute loop stays, the relative one is gone. The square loses its `z`, so that it is an open line, whose
#   ends meet without a join. The line is gone, every step of it being short, and only its start is left.
set -euo pipefail
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
cd "$work"
npm install --silent --no-audit --no-fund --no-save --prefix . svg-pathdata@7.2.0 >/dev/null
cat > run.mjs <<'JS'
import { readFileSync } from "node:fs";
import { SVGPathData } from "svg-pathdata";
console.log("svg-pathdata", JSON.parse(readFileSync("node_modules/svg-pathdata/package.json")).version);
let changed = false;
for (const [name, data, tolerance, expected] of [
  ["absolute loop", "M10 10C30 30 -10 30 10 10l5 5", 0, "M10 10C30 30 -10 30 10 10l5 5"],
  ["relative loop", "M10 10c20 20 -20 20 0 0l5 5", 0, "M10 10l5 5"],
  ["closed square", "M0 0H10V10H0V0z", 0, "M0 0H10V10H0V0"],
  ["closed by z alone", "M0 0H10V10H0z", 0, "M0 0H10V10H0z"],
  ["five steps of 0.4", "M0 0L0.4 0L0.8 0L1.2 0L1.6 0L2 0", 0.5, "M0 0"],
]) {
  const text = new SVGPathData(data).sanitize(tolerance).encode();
  console.log(`${name}: ${data} becomes ${text}`);
  changed ||= text !== expected;
}
if (changed) throw new Error("this has changed");
JS
node run.mjs
