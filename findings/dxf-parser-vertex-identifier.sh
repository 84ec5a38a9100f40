#!/usr/bin/env bash
# dxf-parser 1.1.2 (npm): what a good engineer guesses and what happens.
#
# Input: a DXF with a closed LWPOLYLINE of three vertices, each with a vertex identifier (group 91), which the DXF reference
#   lists among the groups of a vertex.
# Guess: three vertices; a group that a reader does not use is skipped.
# What happens: one vertex, the last. The unknown group ends the list of vertices, and the next group 10 begins a new list
#   in its place. Nothing is said. Without group 91 all three are there, with their bulges.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . dxf-parser@1.1.2 >/dev/null
cat > run.js <<'JS'
const Parser = require("dxf-parser");
console.log("dxf-parser", require("dxf-parser/package.json").version);
const corners = [[0, 0, 0.5], [10, 0, 0], [10, 10, 0]];
function vertices(identifier) {
  const groups = corners.map(([x, y, bulge]) => `10\n${x}\n20\n${y}\n42\n${bulge}\n` + (identifier ? "91\n0\n" : ""));
  const polyline = `0\nLWPOLYLINE\n8\n0\n90\n3\n70\n1\n${groups.join("")}`;
  return new Parser().parseSync(`0\nSECTION\n2\nENTITIES\n${polyline}0\nENDSEC\n0\nEOF\n`).entities[0].vertices;
}
const without = vertices(false), withIdentifier = vertices(true);
console.log("without group 91:", JSON.stringify(without));
console.log("with group 91:   ", JSON.stringify(withIdentifier));
if (without.length !== 3 || withIdentifier.length !== 1 || withIdentifier[0].y !== 10) throw new Error("this has changed");
JS
node run.js
