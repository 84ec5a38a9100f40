#!/usr/bin/env bash
# bezier-js 6.1.4: what a good engineer guesses and what happens.
#
# Input: a curve 10 wide and 7.5 high and a level line through its middle, once as a line and once as a Bezier curve along it.
# Guess: intersects() gives the same two points for both, to many digits: the line is met at t = 0.2113248654 and 0.7886751346.
# What happens: with a line it does. With a curve both are halved until their boxes are 0.5 units in all, and t is the middle
#   of what is left, as text of five decimals: "0.21101" and "0.78835", 0.006 units beside the points, the first of them twice.
#   Drawings in metres need the second argument, `curveIntersectionThreshold`; the five decimals stay.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . bezier-js@6.1.4 >/dev/null
cat > run.mjs <<'JS'
import { readFileSync } from "node:fs";
import { Bezier } from "bezier-js";
console.log("bezier-js", JSON.parse(readFileSync("node_modules/bezier-js/package.json")).version);
const curve = new Bezier(0, 0, 0, 10, 10, 10, 10, 0);
const level = new Bezier(0, 5, 3, 5, 6, 5, 10, 5);
const exact = [0.5 - Math.sqrt(1 / 12), 0.5 + Math.sqrt(1 / 12)]; // 30 t (1 - t) = 5
const worst = (ts) => Math.max(...ts.map((t) => Math.abs(curve.get(t).y - 5)));
const line = curve.intersects({ p1: { x: -5, y: 5 }, p2: { x: 15, y: 5 } });
const pairs = curve.intersects(level).map((pair) => Number(pair.split("/")[0]));
const finer = curve.intersects(level, 1e-6).map((pair) => Number(pair.split("/")[0]));
console.log("exact:     ", exact.join(" "));
console.log("with a line:", line.join(" "));
console.log(`with a curve: ${pairs.join(" ")}, up to ${worst(pairs).toFixed(4)} units away`);
console.log(`with a threshold of 1e-6: ${finer.join(" ")}, up to ${worst(finer).toExponential(1)} units away`);
if (worst(line) > 1e-9 || worst(pairs) < 1e-3 || worst(finer) < 1e-6) throw new Error("this has changed");
JS
node run.mjs
