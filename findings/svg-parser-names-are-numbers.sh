#!/usr/bin/env bash
# svg-parser 2.1.0: what a good engineer guesses and what happens.
#
# Input: groups with the names 007, 7, 1e3 and 0x10, as people number the parts of a level.
# Guess: attributes are strings, as in the file, so there are four names.
# What happens: whatever JavaScript can read as a number is one: 007 and 7 are both the number 7, 1e3 is 1000 and 0x10 is 16. Names
#   that differed are the same, and no `#007` of the same file finds its target any more. Nothing is said.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . svg-parser@2.1.0 >/dev/null
cat > run.js <<'JS'
const fs = require("fs");
const { parse } = require("svg-parser");
console.log("svg-parser", JSON.parse(fs.readFileSync("node_modules/svg-parser/package.json")).version);
const names = ["007", "7", "1e3", "0x10"];
const text = `<svg>${names.map((name) => `<g id="${name}"/>`).join("")}<use href="#007"/></svg>`;
const found = parse(text).children[0].children.map((child) => child.properties);
for (const one of found) console.log(one);
const ids = found.slice(0, 4).map((one) => one.id);
if (JSON.stringify(ids) !== "[7,7,1000,16]" || found[4].href !== "#007") throw new Error("this has changed");
JS
node run.js
