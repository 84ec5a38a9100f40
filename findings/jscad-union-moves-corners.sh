#!/usr/bin/env bash
# @jscad/modeling 2.13.0: what a good engineer guesses and what happens.
#
# Input: two squares of 10 by 10, the second moved by 5, joined by union(); the same of 1 by 1 and 1000 by 1000. All corners are
#   halves or whole numbers, which a float holds exactly.
# Guess: a rectangle whose corners are those of the squares: x from -5 to 10, y from -5 to 5.
# What happens: -5.00004 to 9.99999 and -5.00004 to 5.00004: even corners that no other edge comes near are moved, by 4e-5 here, by
#   5e-6 and 6e-4 for the others, so by more the larger the shape is. Two walls that touch do not touch any more, or overlap, after
#   one of them was joined with a third.
set -euo pipefail
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
cd "$work"
npm install --silent --no-audit --no-fund --no-save --prefix . @jscad/modeling@2.13.0 >/dev/null
cat > run.mjs <<'JS'
import { createRequire } from "node:module";
const require = createRequire(import.meta.url);
const { booleans, geometries, primitives } = require("@jscad/modeling");
console.log("@jscad/modeling", require("@jscad/modeling/package.json").version);
let changed = false;
for (const size of [1, 10, 1000]) {
  const square = (x) => primitives.rectangle({ size: [size, size], center: [x, 0] });
  const [ring] = geometries.geom2.toOutlines(booleans.union(square(0), square(size / 2)));
  const beside = ([x, y]) => [Math.min(Math.abs(x + size / 2), Math.abs(x - size)), Math.abs(Math.abs(y) - size / 2)];
  const off = Math.max(...ring.flatMap(beside));
  const corners = ring.map((point) => point.map((x) => x.toFixed(6)).join(" ")).join(", ");
  console.log(`squares of ${size}: ${corners}; off by ${off.toExponential(1)}`);
  changed ||= !(off > 3e-7 * size && off < 3e-5 * size);
}
if (changed) throw new Error("this has changed");
JS
node run.mjs
