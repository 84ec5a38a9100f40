#!/usr/bin/env bash
# d3-shape 3.2.0: what a good engineer guesses and what happens.
#
# Input: a line through (0.123456789, 12345.678912) and (1/3, 2/3), made into path data by d3.line().
# Guess: the numbers as JavaScript writes them, as d3.path() and d3-shape 3.1 do.
# What happens: M0.123,12345.679L0.333,0.667: since 3.2 a line, area or arc rounds to three digits behind the point
#   unless told otherwise by .digits(null). Two walls that meet at one point still meet; a level a few units wide loses
#   its form.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . d3-shape@3.2.0 d3-path@3.1.0 >/dev/null
cat > run.mjs <<'JS'
import { line } from "d3-shape";
import { path } from "d3-path";
const points = [[0.123456789, 12345.678912], [1 / 3, 2 / 3]];
const plain = path();
plain.moveTo(...points[0]);
plain.lineTo(...points[1]);
console.log(`d3-shape 3.2.0: ${line()(points)}; with digits(null): ${line().digits(null)(points)}; d3-path: ${plain}`);
if (line()(points) !== "M0.123,12345.679L0.333,0.667") throw new Error("this has changed");
if (line().digits(null)(points) !== String(plain)) throw new Error("this has changed");
JS
node run.mjs
