#!/usr/bin/env bash
# paper 0.12.20, makerjs 0.19.2, svg-points 6.0.1, parse-svg-path 0.2.0 and svgpath2mpl 1.0.0: what a good engineer
# guesses and what happens.
#
# Input: half a circle as path data, its two flags written without blanks: `a50 50 0 01100 0`. SVG's grammar makes a
#   flag one character, and svgo writes arcs so when asked to (`noSpaceAfterFlags`).
# Guess: a library that reads SVG paths reads what the grammar allows and a minifier writes: an arc to (100, 0).
# What happens: five readers take `01100` for one number. Two tell an error of their insides, one "malformed path
#   data", and makerjs and svg-points go on with NaN and no word. svgpath reads it.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . \
  paper@0.12.20 makerjs@0.19.2 svg-points@6.0.1 parse-svg-path@0.2.0 svgpath@2.6.0 svgo@4.1.0 >/dev/null
cat > run.mjs <<'JS'
import { createRequire } from "node:module";
import { optimize } from "svgo";
import { toPoints } from "svg-points";
const require = createRequire(import.meta.url);
const paper = require("paper/dist/paper-core.js"), makerjs = require("makerjs");
paper.setup([100, 100]);
const drawn = '<svg xmlns="http://www.w3.org/2000/svg"><path d="M0 0a50 50 0 0 1 100 0z"/></svg>';
const plugins = [{ name: "convertPathData", params: { noSpaceAfterFlags: true } }];
const data = / d="([^"]*)"/.exec(optimize(drawn, { plugins }).data)[1];
console.log("svgo writes", data);
const end = (make) => {
  try {
    return String(make());
  } catch (error) {
    return `error: ${error.message}`;
  }
};
const found = {
  svgpath: end(() => require("svgpath")(data).toString()),
  paper: end(() => paper.PathItem.create(data).bounds.width),
  makerjs: end(() => makerjs.measure.modelPathLength(makerjs.importer.fromSVGPathData(data))),
  "svg-points": end(() => toPoints({ type: "path", d: data })[1].x),
  "parse-svg-path": end(() => require("parse-svg-path")(data).length),
};
for (const [name, text] of Object.entries(found)) console.log(`${name}: ${text}`);
const wrong = [/^M0 0a50 50 0 0 1 100 0z$/i, /^error: Cannot read/, /^NaN$/, /^NaN$/, /^error: malformed/];
if (!/0 ?01100 0/.test(data)) throw new Error("svgo has changed");
Object.values(found).forEach((text, i) => {
  if (!wrong[i].test(text)) throw new Error(`this has changed: ${text}`);
});
JS
node run.mjs
python3 -m venv venv
venv/bin/pip install -q svgpath2mpl==1.0.0 matplotlib==3.10.8 numpy==2.4.6
venv/bin/python - <<'PY'
from svgpath2mpl import parse_path

try:
    print("svgpath2mpl:", parse_path("M0 0a50 50 0 01100 0z"))
except ValueError as error:
    print("svgpath2mpl: ValueError:", error)
else:
    raise SystemExit("this has changed")
PY
