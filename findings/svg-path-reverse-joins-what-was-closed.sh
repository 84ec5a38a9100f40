#!/usr/bin/env bash
# svg-path-reverse 1.7.0: what a good engineer guesses and what happens.
#
# Input: a triangle that is closed, and a line drawn on from there without a new M: SVG begins a new subpath at the triangle's
#   first corner.
# Guess: the same two outlines the other way round: a line to (0, 0), and a closed triangle.
# What happens: one open line. The Z is lost, and with it the triangle's last side; the line no longer ends in (0, 0) but in the
#   corner before, so a stroke that nobody drew runs across. With a relative line it is the same.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . svg-path-reverse@1.7.0 >/dev/null
cat > run.js <<'JS'
const fs = require("fs");
const SVGPathReverse = require("svg-path-reverse");
const reverse = SVGPathReverse.reverse || SVGPathReverse.default || SVGPathReverse;
console.log("svg-path-reverse", JSON.parse(fs.readFileSync("node_modules/svg-path-reverse/package.json")).version);
const results = ["M0 0L9 0L9 9ZL-5 -5", "M0 0L9 0L9 9Zl-5 -5", "M0 0L9 0L9 9ZM0 0L-5 -5"].map((path) => {
  const found = reverse(path).replace(/ /g, "");
  console.log(path, "->", found);
  return found;
});
const joined = "M-5-5L99L90L00";
if (results[0] !== joined || results[1] !== joined) throw new Error("this has changed");
if (!results[2].includes("Z") || results[2].split("M").length !== 3) throw new Error("with an M of its own it was right");
JS
node run.js
