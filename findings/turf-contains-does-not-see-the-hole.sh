#!/usr/bin/env bash
# @turf/turf 7.4.0: what a good engineer guesses and what happens.
#
# Input: a floor of 10 by 10 with a hole of 6 by 6 in its middle, and squares: one of 8 by 8 that covers the hole, one as large as
#   the floor, one that lies in the hole, one that hangs over its edge, and one on the floor beside it.
# Guess: booleanContains is true for the last one only, as in shapely: no other one lies on the floor with all its points.
# What happens: it is true for the two that cover the hole as well, and so is booleanWithin: the sides of the square are looked
#   at, and they run over the floor; that the hole lies within them is not asked. difference() knows what sticks out.
#   A lid over a pit counts as a part of the floor, and rings are nested wrongly.
set -euo pipefail
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
cd "$work"
npm install --silent --no-audit --no-fund --no-save --prefix . @turf/turf@7.4.0 >/dev/null
cat > run.mjs <<'JS'
import * as turf from "@turf/turf";
import { readFileSync } from "node:fs";
console.log("@turf/turf", JSON.parse(readFileSync("node_modules/@turf/turf/package.json")).version);
const square = (x, y, side) => [[x, y], [x + side, y], [x + side, y + side], [x, y + side], [x, y]];
const floor = turf.polygon([square(0, 0, 10), square(2, 2, 6)]);
let changed = false;
for (const [name, ring, told, right] of [
  ["covers the hole", square(1, 1, 8), true, false],
  ["as large as the floor", square(0, 0, 10), true, false],
  ["in the hole", square(4, 4, 2), false, false],
  ["over the hole's edge", square(1, 4, 2), false, false],
  ["on the floor", square(0.5, 0.5, 1), true, true],
]) {
  const lid = turf.polygon([ring]);
  const contains = turf.booleanContains(floor, lid), within = turf.booleanWithin(lid, floor);
  const sticksOut = turf.difference(turf.featureCollection([lid, floor])) !== null;
  console.log(`${name}: contains ${contains}, within ${within}, right ${right}; difference() is empty: ${!sticksOut}`);
  changed ||= contains !== told || within !== told || sticksOut === right;
}
if (changed) throw new Error("this has changed");
JS
node run.mjs
