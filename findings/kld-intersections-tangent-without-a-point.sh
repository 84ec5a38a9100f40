#!/usr/bin/env bash
# kld-intersections 0.7.0: what a good engineer guesses and what happens.
#
# Input: a circle of radius 1000 and lines along its side, one that touches and one that cuts; and two ellipses, 100 by
#   50 and 50 by 100, about one centre.
# Guess: a line that touches has one point, (1000, 0); the ellipses have four.
# What happens: the status is "Tangent" and the list of points is empty; the ellipses have eight points, each of the
#   four twice. Who counts crossings to tell inside from outside is wrong both times.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . kld-intersections@0.7.0 >/dev/null
cat > run.js <<'JS'
const { ShapeInfo, Intersection } = require("kld-intersections");
console.log("kld-intersections", require("kld-intersections/package.json").version);
const circle = ShapeInfo.circle(0, 0, 1000);
const touch = Intersection.intersect(circle, ShapeInfo.line(1000, -1, 1000, 1));
const cut = Intersection.intersect(circle, ShapeInfo.line(999, -100, 999, 100));
const both = Intersection.intersect(ShapeInfo.ellipse(0, 0, 100, 50), ShapeInfo.ellipse(0, 0, 50, 100));
const places = new Set(both.points.map((point) => `${point.x.toFixed(6)} ${point.y.toFixed(6)}`));
console.log(`touching: ${touch.status}, ${touch.points.length} points; cutting: ${cut.points.length} points`);
console.log(`ellipses: ${both.points.length} points at ${places.size} places`);
if (touch.status !== "Tangent" || touch.points.length !== 0 || cut.points.length !== 2) {
  throw new Error("this has changed");
}
if (both.points.length !== 8 || places.size !== 4) throw new Error("this has changed");
JS
node run.js
