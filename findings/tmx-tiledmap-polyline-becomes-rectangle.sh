#!/usr/bin/env bash
# tmx-tiledmap 1.2.1 (npm): what a good engineer guesses and what happens.
#
# Input: a map of Tiled, version 1.10, with a polygon and a polyline.
# Guess: both come with their points, as in Tiled's own JSON, which the package promises.
# What happens: the polyline is a rectangle without width and height, and its points are gone; the polygon is right.
#   The map's version "1.10" is read as the number 1.1, so that it sorts before 1.9.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . tmx-tiledmap@1.2.1 >/dev/null
cat > run.js <<'JS'
const { tmx } = require("tmx-tiledmap");
const map = `<?xml version="1.0" encoding="UTF-8"?>
<map version="1.10" tiledversion="1.10.2" orientation="orthogonal" renderorder="right-down" width="10" height="10"
 tilewidth="16" tileheight="16" infinite="0" nextlayerid="2" nextobjectid="3">
 <objectgroup id="1" name="walls">
  <object id="1" x="100" y="50"><polygon points="0,0 10,0 10,10"/></object>
  <object id="2" x="20" y="30"><polyline points="0,0 10,5 20,0"/></object>
 </objectgroup>
</map>`;
tmx(map, []).then((read) => {
  const [polygon, polyline] = read.layers[0].objects;
  console.log("tmx-tiledmap", require("tmx-tiledmap/package.json").version, "version of the map", read.version);
  for (const object of [polygon, polyline]) console.log(object.shape, JSON.stringify(object.points));
  if (polygon.shape !== "polygon" || polyline.shape !== "rectangle" || polyline.points || read.version !== 1.1) {
    throw new Error("this has changed");
  }
});
JS
node run.js
