#!/usr/bin/env bash
# pdfkit 0.17.2 (npm): what a good engineer guesses and what happens.
#
# Input: a quadratic curve from (0, 0) over (50, 100) to (100, 0), by quadraticCurveTo() and by path("M0 0Q50 100 100 0").
# Guess: the parabola, made into a cubic curve with handles at two thirds of the way: (33.3, 66.7) and (66.7, 66.7); a
#   symmetric arch, 50 high.
# What happens: the PDF operator `v` is written, whose first handle is the start: a curve with handles (0, 0) and
#   (50, 100), 44.4 high and leaning to the right. Canvas and browsers draw the parabola.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . pdfkit@0.17.2 >/dev/null
cat > run.js <<'JS'
const PDFDocument = require("pdfkit");
const document = new PDFDocument({ size: [200, 200], compress: false });
const chunks = [];
document.on("data", (chunk) => chunks.push(chunk));
document.moveTo(0, 0).quadraticCurveTo(50, 100, 100, 0).stroke();
document.path("M0 0Q50 100 100 0").stroke();
document.on("end", () => {
  const content = /stream\n([\s\S]*?)endstream/.exec(Buffer.concat(chunks).toString("latin1"))[1];
  const curves = content.split("\n").filter((line) => / [vyc]$/.test(line));
  const height = (t) => 3 * (1 - t) * t * t * 100; // handles (0, 0) and (50, 100)
  console.log(`pdfkit ${require("pdfkit/package.json").version}: ${curves.join(", ")}: ${height(2 / 3).toFixed(1)} high`);
  if (curves.join() !== "50 100 100 0 v,50 100 100 0 v") throw new Error("this has changed");
});
document.end();
JS
node run.js
