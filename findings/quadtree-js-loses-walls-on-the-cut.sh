#!/usr/bin/env bash
# @timohausmann/quadtree-js 1.2.6: what a good engineer guesses and what happens.
#
# Input: a board of 640 by 480 with 15 upright walls, boxes of width 0 at x = 40, 80, ..., 600; and 15 level ones, boxes of
#   height 0 at y = 30, 60, ..., 450. Each is asked for with a box of 10 by 10 on its middle.
# Guess: all 30 are found, since a box without width is a box; at worst some are found twice.
# What happens: the upright one at x = 320 and the level one at y = 240 are not found, nor by any other query: a wall without
#   width on the line where a node is cut lies on neither side, and is dropped when the node is divided. As long as the
#   tree has not more than ten boxes they are there, so a small test passes.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . @timohausmann/quadtree-js@1.2.6 >/dev/null
cat > run.js <<'JS'
const Quadtree = require("@timohausmann/quadtree-js");
console.log("@timohausmann/quadtree-js", require("@timohausmann/quadtree-js/package.json").version);
const steps = Array.from({ length: 15 }, (_, k) => k + 1);
const upright = steps.map((k) => ({ x: 40 * k, y: 100, width: 0, height: 200 }));
const level = steps.map((k) => ({ x: 100, y: 30 * k, width: 200, height: 0 }));
const board = { x: 0, y: 0, width: 640, height: 480 };
const around = (wall) => ({ x: wall.x + wall.width / 2 - 5, y: wall.y + wall.height / 2 - 5, width: 10, height: 10 });
function missing(walls) {
  const tree = new Quadtree(board);
  walls.forEach((wall) => tree.insert(wall));
  const anywhere = tree.retrieve(board);
  return walls.filter((wall) => !tree.retrieve(around(wall)).includes(wall) && !anywhere.includes(wall));
}
const lost = { upright: missing(upright), level: missing(level), "ten upright": missing(upright.slice(3, 13)) };
for (const [name, walls] of Object.entries(lost)) console.log(`${name}: lost`, JSON.stringify(walls));
const only = (walls, key, place) => walls.length === 1 && walls[0][key] === place;
const asBefore = only(lost.upright, "x", 320) && only(lost.level, "y", 240) && lost["ten upright"].length === 0;
if (!asBefore) throw new Error("this has changed");
JS
node run.js
