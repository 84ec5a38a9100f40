#!/usr/bin/env bash
# poly-bool 1.0.0 (npm): what a good engineer guesses and what happens.
#
# Input: a square a of 10 by 10 and in it a square b of 2 by 2, and the operations 'sub' and 'rsub' "between a and b".
# Guess: 'sub' is a without b, a square with a hole and an area of 96; 'rsub', the reverse, is nothing.
# What happens: 'sub' is b without a, nothing, and 'rsub' is the square with the hole. The example of the manual shows it, for
#   two squares of one size, where it is easy not to see. Cutting holes out of a plate leaves no plate, without a word.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . poly-bool@1.0.0 polygon-clipping@0.15.7 >/dev/null
cat > run.js <<'JS'
const polybool = require("poly-bool");
const clipping = require("polygon-clipping");
console.log("poly-bool", require("poly-bool/package.json").version);
const square = (low, high) => [[low, low], [high, low], [high, high], [low, high]];
const area = (rings) => Math.abs(rings.flatMap((ring) => ring.map(([x, y], k) => {
  const [u, v] = ring[(k + 1) % ring.length];
  return (x * v - u * y) / 2;
})).reduce((sum, part) => sum + part, 0));
const a = square(0, 10), b = square(4, 6);
const found = ["sub", "rsub"].map((operation) => polybool([a], [b], operation));
const judge = [clipping.difference([a], [b]), clipping.difference([b], [a])].map((result) => area(result.flat()));
console.log(`sub: ${found[0].length} rings, area ${area(found[0])}; a without b has ${judge[0]}`);
console.log(`rsub: ${found[1].length} rings, area ${area(found[1])}; b without a has ${judge[1]}`);
if (area(found[0]) !== judge[1] || area(found[1]) !== judge[0] || judge[0] !== 96) throw new Error("this has changed");
JS
node run.js
