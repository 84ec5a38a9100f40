#!/usr/bin/env bash
# pdf-lib 1.17.1: what a good engineer guesses and what happens.
#
# Input: page.drawSvgPath() with path data as a minifier leaves it: two numbers behind one `H`, and an arc whose flags
#   are written without blanks, which SVG's grammar allows.
# Guess: the lines to x = 10 and 20, and half a circle; or an error.
# What happens: the second number of `H` and the whole arc are left out without a word: the figure in the PDF is
#   10 wide instead of 30. With blanks between the flags and an `H` for each number all is drawn.
set -euo pipefail
cd "$(mktemp -d)"
npm install --silent --no-audit --no-fund --no-save --prefix . pdf-lib@1.17.1 >/dev/null
cat > run.js <<'JS'
const { PDFDocument, PDFRawStream, decodePDFRawStream } = require("pdf-lib");
async function drawn(data) {
  const made = await PDFDocument.create();
  made.addPage([100, 100]).drawSvgPath(data);
  const page = (await PDFDocument.load(await made.save())).getPage(0);
  const content = page.node.normalizedEntries().Contents;
  const text = content.asArray().map((part) => {
    const stream = page.doc.context.lookup(part);
    return Buffer.from(stream instanceof PDFRawStream ? decodePDFRawStream(stream).decode() : stream.getContents());
  });
  const widths = [...text.join("\n").matchAll(/(\S+) \S+ [lmc]$/gm)].map((match) => Number(match[1]));
  return Math.max(...widths);
}
(async () => {
  const packed = await drawn("M0 0H10 20V5a5 5 0 0110 0z");
  const spaced = await drawn("M0 0H10H20V5a5 5 0 0 1 10 0z");
  console.log(`pdf-lib ${require("pdf-lib/package.json").version}: as packed up to x = ${packed}, spaced ${spaced}`);
  if (packed !== 10 || spaced !== 30) throw new Error("this has changed");
})();
JS
node run.js
