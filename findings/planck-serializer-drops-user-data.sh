#!/usr/bin/env bash
# planck 1.4.2: what a good engineer guesses and what happens.
#
# Input: a world with `userData` on a body and a fixture (a wall's name), written by Serializer.toJson and read again by
#   Serializer.fromJson.
# Guess: it comes back, since fromJson gives bodies the userData that a JSON text has.
# What happens: toJson leaves it out. Names of walls survive being loaded, and are gone after planck's own save.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . planck@1.4.2 >/dev/null
cat > run.js <<'JS'
const planck = require("planck");
console.log("planck", JSON.parse(require("fs").readFileSync("node_modules/planck/package.json")).version);
const world = new planck.World();
const body = world.createBody({ userData: { name: "floor" } });
body.createFixture({ shape: new planck.Edge({ x: 0, y: 0 }, { x: 9, y: 0 }), userData: { name: "edge" } });
const said = planck.Serializer.toJson(world);
const again = planck.Serializer.fromJson(said);
console.log("read back after its own save:", again.getBodyList().getUserData());
const text = JSON.stringify(said, (key, value) => (value && value.refType === undefined && value.type === "static"
  ? { ...value, userData: { name: "floor" } } : value));
const given = planck.Serializer.fromJson(JSON.parse(text));
console.log("read from a text that has it:", given.getBodyList().getUserData());
if (JSON.stringify(said).includes("floor") || again.getBodyList().getUserData()) throw new Error("this has changed");
if (given.getBodyList().getUserData()?.name !== "floor") throw new Error("this has changed");
JS
node run.js
