#!/usr/bin/env bash
# dxf-parser 1.1.2 (npm): what a good engineer guesses and what happens.
#
# Input: a DXF with an ARC from 350 to 10 degrees: 20 degrees across the direction of x. DXF arcs always run counter-clockwise.
# Guess: `angleLength` of the entity is 20 degrees.
# What happens: it is -340 degrees (-5.93): the end less the start. Whoever walks from startAngle by angleLength draws the
#   other 340 degrees of the circle, clockwise. From 10 to 50 degrees it is 40, as guessed.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . dxf-parser@1.1.2 >/dev/null
cat > run.js <<'JS'
const Parser = require("dxf-parser");
console.log("dxf-parser", require("dxf-parser/package.json").version);
function degrees(start, end) {
  const arc = `0\nARC\n8\n0\n10\n0\n20\n0\n40\n5\n50\n${start}\n51\n${end}\n`;
  const [entity] = new Parser().parseSync(`0\nSECTION\n2\nENTITIES\n${arc}0\nENDSEC\n0\nEOF\n`).entities;
  return entity.angleLength * 180 / Math.PI;
}
const plain = degrees(10, 50), across = degrees(350, 10);
console.log("from 10 to 50 degrees:", plain);
console.log("from 350 to 10 degrees:", across);
if (Math.abs(plain - 40) > 1e-9 || Math.abs(across + 340) > 1e-9) throw new Error("this has changed");
JS
node run.js
