#!/usr/bin/env bash
# planck 1.4.2: what a good engineer guesses and what happens.
#
# Input: a regular polygon of 24 vertices as the shape of a fixture, and a concave one of five.
# Guess: an error, as other ports of Box2D raise for more than their limit; or the polygon as it was given.
# What happens: the first twelve vertices stay, so that of the 24-gon less than half of its area is left, and the concave
#   one becomes its convex hull. Nothing is said. A level's solids must be cut into convex pieces of at most 12.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . planck@1.4.2 >/dev/null
cat > run.js <<'JS'
const planck = require("planck");
console.log("planck", JSON.parse(require("fs").readFileSync("node_modules/planck/package.json")).version);
const area = (points) => points.reduce((sum, p, k) => {
  const q = points[(k + 1) % points.length];
  return sum + (p.x * q.y - q.x * p.y) / 2;
}, 0);
const ring = Array.from({ length: 24 }, (_, k) => ({ x: Math.cos(k * Math.PI / 12), y: Math.sin(k * Math.PI / 12) }));
const arrow = [[0, 0], [4, 0], [4, 4], [2, 1], [0, 4]].map(([x, y]) => ({ x, y }));
const kept = (points) => new planck.Polygon(points).m_vertices.slice(0, new planck.Polygon(points).m_count);
const round = kept(ring), hull = kept(arrow);
console.log(`24-gon: ${round.length} vertices, area ${area(round).toFixed(4)} of ${area(ring).toFixed(4)}`);
console.log(`concave pentagon: ${hull.length} vertices, area ${area(hull)} of ${area(arrow)}`);
if (round.length !== 12 || area(round) > 0.5 * area(ring) || hull.length !== 4) throw new Error("this has changed");
JS
node run.js
