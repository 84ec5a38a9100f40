#!/usr/bin/env bash
# matter-js 0.20.0: what a good engineer guesses and what happens.
#
# Input: Bodies.rectangle(0, 0, 100, 10, { isStatic: true, restitution: 0.8, friction: 0.1 }), as in the manual.
# Guess: the wall has a restitution of 0.8 and a friction of 0.1, since both are options of every body.
# What happens: the body has restitution 0 and friction 1. Options are set one after the other, and `isStatic` calls
#   setStatic, which puts both to its own values; Body.create and fromVertices do the same. Set after creation, they
#   stay. So no level file can say how a wall bounces: a loader has to.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . matter-js@0.20.0 >/dev/null
cat > run.js <<'JS'
const Matter = require("matter-js");
console.log("matter-js", require("matter-js/package.json").version);
const options = { isStatic: true, restitution: 0.8, friction: 0.1 };
const made = [Matter.Bodies.rectangle(0, 0, 100, 10, options), Matter.Bodies.circle(0, 0, 5, options)];
made.push(Matter.Body.create({ ...options, vertices: [{ x: 0, y: 0 }, { x: 9, y: 0 }, { x: 9, y: 9 }] }));
for (const body of made) {
  console.log(`asked for 0.8 and 0.1, got restitution ${body.restitution}, friction ${body.friction}`);
  if (body.restitution !== 0 || body.friction !== 1) throw new Error("this has changed");
  body.restitution = 0.8;
  if (body.restitution !== 0.8) throw new Error("this has changed");
}
console.log("set after creation it stays 0.8");
JS
node run.js
