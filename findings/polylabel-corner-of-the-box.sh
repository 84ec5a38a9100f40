#!/usr/bin/env bash
# polylabel 2.1.0: what a good engineer guesses and what happens.
#
# Input: a triangle of 1 by 1 that stands on its tip, and a corridor of 100 by 1 and one of 100 by 1.01, with the default
#   precision of 1.
# Guess: a point inside, at worst a coarse one: the search begins at the centroid, and that alone is 0.298, 0.5 and 0.505
#   from the walls. polylabel 1.1 returns it.
# What happens: where the narrower side of the box is not more than the precision, nothing is searched and the lower left
#   corner of the box is returned, with the distance 0. Of the triangle it lies outside. A ball placed at "the most distant
#   internal point" starts in a wall, or beyond it.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . polylabel@2.1.0 >/dev/null
cat > run.mjs <<'JS'
import { readFileSync } from "node:fs";
import polylabel from "polylabel";
console.log("polylabel", JSON.parse(readFileSync("node_modules/polylabel/package.json")).version);
const triangle = [[0.5, 0], [1, 1], [0, 1], [0.5, 0]];
const corridor = (width) => [[0, 0], [100, 0], [100, width], [0, width], [0, 0]];
// Twice the area of each triangle from the point to an edge: all of one sign where the point lies inside a convex ring.
const inside = ([x, y], ring) => ring.slice(1).every(([bx, by], k) => {
  const [ax, ay] = ring[k];
  return (bx - ax) * (y - ay) - (by - ay) * (x - ax) > 0;
});
const result = (name, ring) => {
  const point = polylabel([ring]);
  console.log(`${name}: [${[...point]}], distance ${point.distance}, inside ${inside(point, ring)}`);
  return point;
};
const tip = result("triangle", triangle);
const narrow = result("corridor of 1", corridor(1));
const wider = result("corridor of 1.01", corridor(1.01));
const corner = (point) => point[0] === 0 && point[1] === 0 && point.distance === 0;
if (!corner(tip) || inside(tip, triangle) || !corner(narrow) || wider.distance < 0.5) throw new Error("this has changed");
JS
node run.mjs
