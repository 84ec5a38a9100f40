#!/usr/bin/env bash
# dxf 5.3.1 (npm): what a good engineer guesses and what happens.
#
# Input: a DXF with an LWPOLYLINE of one piece: a flat arc (bulge 0.05) over a chord of 1000.
# Guess: Helper.toPolylines() makes as many points as the arc needs, at equal distances, or says what its tolerance is.
# What happens: a point every five degrees of a circle's own grid, whatever the radius: 0, 63, 500, 937 and 1000 along the
#   chord. Between two of them the wall lies 4.8 units beside the arc, which is 25 high. A whole circle of radius 5 gets 73.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . dxf@5.3.1 >/dev/null
cat > run.js <<'JS'
const { Helper } = require("dxf");
console.log("dxf", JSON.parse(require("fs").readFileSync("node_modules/dxf/package.json")).version);
const polyline = "0\nLWPOLYLINE\n8\n0\n90\n2\n70\n0\n10\n0\n20\n0\n42\n0.05\n10\n1000\n20\n0\n42\n0\n";
const file = `0\nSECTION\n2\nENTITIES\n${polyline}0\nENDSEC\n0\nEOF\n`;
const points = new Helper(file).toPolylines().polylines[0].vertices;
console.log(points.map(([x, y]) => `(${x.toFixed(1)}, ${y.toFixed(2)})`).join(" "));
// sagitta 500 * 0.05 = 25, radius (500^2 + 25^2) / 50 = 5012.5, the centre above the chord
const radius = 5012.5, centre = [500, radius - 25];
let worst = 0;
for (let i = 1; i < points.length; i++) {
  const middle = [(points[i][0] + points[i - 1][0]) / 2, (points[i][1] + points[i - 1][1]) / 2];
  worst = Math.max(worst, radius - Math.hypot(middle[0] - centre[0], middle[1] - centre[1]));
}
console.log(`the lines lie up to ${worst.toFixed(2)} units beside the arc`);
if (points.length !== 5 || worst < 4) throw new Error("this has changed");
JS
node run.js
