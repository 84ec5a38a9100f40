#!/usr/bin/env bash
# makerjs 0.19.2: what a good engineer guesses and what happens.
#
# Input: SVG path data with several numbers behind one `H` and `V`, as the grammar allows and as minifiers leave it.
# Guess: each number is a line of its own, as with `L`: from (0, 0) to x = 10, back to 4 and on to 30, then to y = 20.
# What happens: the importer takes the first number of each `H` and `V` and drops the others without a word. The path
#   ends at x = 10 instead of 30 and its length is 30 instead of 62.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . makerjs@0.19.2 >/dev/null
cat > run.js <<'JS'
const makerjs = require("makerjs");
console.log("makerjs", require("makerjs/package.json").version);
function told(data) {
  const model = makerjs.importer.fromSVGPathData(data);
  return [makerjs.measure.modelExtents(model).high[0], makerjs.measure.modelPathLength(model)];
}
const short = told("M0 0H10 4 30V20"), long = told("M0 0H10H4H30V20");
console.log(`H10 4 30V20: up to x = ${short[0]}, length ${short[1]}; H10H4H30V20: x = ${long[0]}, length ${long[1]}`);
if (short.join() !== "10,30" || long.join() !== "30,62") throw new Error("this has changed");
JS
node run.js
