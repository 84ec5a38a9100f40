#!/usr/bin/env bash
# svgdom 0.1.25, the document under svg.js outside a browser: what a good engineer guesses and what happens.
#
# Input: a wide and a high ellipse about (20, 30), and a circle.
# Guess: getBBox() of rx = 10, ry = 5 is (10, 25, 20, 10), as in any browser.
# What happens: the ellipse counts as a circle of its first radius: 20 by 20 about the same middle, and 10 by 10 where it is 10 by
#   20. Layouts, centres and exports made on a server differ from those of the page. Nothing is said.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . svgdom@0.1.25 >/dev/null
cat > run.mjs <<'JS'
import fs from "fs";
import { createSVGWindow } from "svgdom";
console.log("svgdom", JSON.parse(fs.readFileSync("node_modules/svgdom/package.json")).version);
const document = createSVGWindow().document;
function box(tag, attributes) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  document.documentElement.appendChild(element);
  const { x, y, width, height } = element.getBBox();
  console.log(tag, attributes, "->", [x, y, width, height].join(", "));
  return [x, y, width, height].join();
}
const wide = box("ellipse", { cx: 20, cy: 30, rx: 10, ry: 5 });
const high = box("ellipse", { cx: 20, cy: 30, rx: 5, ry: 10 });
const round = box("circle", { cx: 20, cy: 30, r: 10 });
if (wide !== "10,20,20,20" || high !== "15,25,10,10" || round !== "10,20,20,20") throw new Error("this has changed");
JS
node run.mjs
