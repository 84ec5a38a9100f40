#!/usr/bin/env bash
# @flatten-js/core 1.6.15: what a good engineer guesses and what happens.
#
# Input: a polygon of two rings, a square of 10 by 10 and in it one of 2 by 2, once with the inner ring turned the other way
#   and once turned the same way, as even-odd data (SVG, drawing programs) has it.
# Guess: contains() and area() agree about the hole, whichever it is.
# What happens: contains() says for both that the middle of the inner ring is outside; area() says 96 for the one and 104 for
#   the other, where it adds the hole. isValid() is true for both.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . @flatten-js/core@1.6.15 >/dev/null
cat > run.js <<'JS'
const Flatten = require("@flatten-js/core");
console.log("@flatten-js/core", JSON.parse(require("fs").readFileSync("node_modules/@flatten-js/core/package.json")).version);
const square = [[0, 0], [10, 0], [10, 10], [0, 10]], hole = [[2, 2], [4, 2], [4, 4], [2, 4]];
function look(inner) {
  const polygon = new Flatten.Polygon([square, inner]);
  return [polygon.contains(new Flatten.Point(3, 3)), polygon.area(), polygon.isValid()];
}
const other = look([...hole].reverse()), same = look(hole);
console.log("[contains the middle of the hole, area, valid]");
console.log("turned the other way:", other);
console.log("turned the same way: ", same);
if (String(other) !== "false,96,true" || String(same) !== "false,104,true") throw new Error("this has changed");
JS
node run.js
