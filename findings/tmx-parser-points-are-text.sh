#!/usr/bin/env bash
# tmx-parser 1.5.0: what a good engineer guesses and what happens.
#
# Input: a map of Tiled with a polygon at x = 100 whose second point is 10 further right.
# Guess: object.x + point.x is 110, since the object's x and y are numbers.
# What happens: it is "10010". The object's place is parsed to a number, the points of its polygon stay text, so that a
#   sum joins them. What subtracts or multiplies is right by accident, and only sums put walls far away.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . tmx-parser@1.5.0 >/dev/null
cat > run.js <<'JS'
const tmx = require("tmx-parser");
console.log("tmx-parser", require("tmx-parser/package.json").version);
const map = `<?xml version="1.0" encoding="UTF-8"?>
<map version="1.10" orientation="orthogonal" width="10" height="10" tilewidth="32" tileheight="32">
 <objectgroup id="1" name="walls"><object id="1" x="100" y="50"><polygon points="0,0 10,0 10,20"/></object></objectgroup>
</map>`;
tmx.parse(map, "level.tmx", (error, parsed) => {
  if (error) throw error;
  const object = parsed.layers[0].objects[0];
  const second = object.polygon[1];
  console.log(`x of the object: ${typeof object.x}, x of its point: ${typeof second.x}`);
  console.log("their sum:", object.x + second.x, "their difference:", object.x - second.x);
  if (object.x + second.x !== "10010" || object.x - second.x !== 90) throw new Error("this has changed");
});
JS
node run.js
