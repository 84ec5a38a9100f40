"""Measure the drawings in tests/importers/svg with a browser, and write expected.json beside them.

    python tests/importers/measure_svg_with_chromium.py [--chromium COMMAND]

The numbers in the tests come from this and from nothing of ours. Each drawing is put into a page, and the
browser is asked for the matrix of every shape to the px of the outermost svg (getScreenCTM), for points along it
(getPointAtLength), for its local box (getBBox) and for its computed paint. "paint" says whether fill and stroke put
any colour on the screen, which a canvas tells by filling a pixel with it. What a `use` shows cannot be asked
directly, so each `use` is first replaced by a copy of what it shows, as SVG 2 (5.6) describes. Drawings without a
size get that of their viewBox, so that one user unit is one px.
"""

import argparse
import html
import json
import re
import subprocess
import tempfile
from pathlib import Path

HERE = Path(__file__).parent / "svg"

SCRIPT = r"""
const NS = 'http://www.w3.org/2000/svg', XLINK = 'http://www.w3.org/1999/xlink';
const SHAPES = 'path,rect,circle,ellipse,line,polyline,polygon';
const NEVER = 'defs,clipPath,mask,pattern,marker,symbol,linearGradient,radialGradient,text,title,filter';
function unfold(root) {
  for (let n = 0, use; n < 1000 && (use = root.querySelector('use')); n++) {
    const href = use.getAttribute('href') ?? use.getAttributeNS(XLINK, 'href') ?? '';
    const target = href[0] == '#' ? root.querySelector('#' + CSS.escape(href.slice(1))) : null;
    const outer = document.createElementNS(NS, 'g');
    for (const a of use.attributes)
      if (!['x', 'y', 'width', 'height', 'href', 'xlink:href'].includes(a.name)) outer.setAttribute(a.name, a.value);
    const [x, y] = [use.x.animVal.value, use.y.animVal.value];
    use.replaceWith(outer);
    if (!target || target.contains(outer) || /^(clipPath|mask|pattern|marker)$/.test(target.localName)) continue;
    const inner = document.createElementNS(NS, 'g');
    inner.setAttribute('transform', `translate(${x},${y})`);
    let copy = target.cloneNode(true);
    if (target.localName == 'symbol') {
      const svg = document.createElementNS(NS, 'svg');
      for (const a of copy.attributes) svg.setAttribute(a.name, a.value);
      svg.append(...copy.childNodes);
      copy = svg;
    }
    for (const name of ['width', 'height'])
      if (copy.localName == 'svg' && (use.hasAttribute(name) || target.localName == 'symbol'))
        copy.setAttribute(name, use.getAttribute(name) ?? '100%');
    copy.removeAttribute('id');
    inner.append(copy);
    outer.append(inner);
  }
}
const pixel = document.createElement('canvas').getContext('2d', {willReadFrequently: true});
function coloured(paint) {  // does a pixel filled with it have any opacity
  pixel.clearRect(0, 0, 1, 1);
  pixel.fillStyle = '#000';
  pixel.fillStyle = paint;
  pixel.fillRect(0, 0, 1, 1);
  return pixel.getImageData(0, 0, 1, 1).data[3] > 0;
}
function seen(root, paint, opacity) {
  if (paint == 'none' || !(opacity > 0)) return false;
  const [, address, instead] = paint.match(/^url\("(.*?)"\) ?(.*)$/) ?? [, '', paint];
  const server = address[0] == '#' ? root.querySelector('#' + CSS.escape(address.slice(1))) : null;
  if (!/^(linearGradient|radialGradient|pattern)$/.test(server?.localName))
    return !['', 'none'].includes(instead) && coloured(instead);
  let holder = server;  // of the stops, or of the tile
  for (let n = 0; n < 9 && holder && !holder.firstElementChild; n++)
    holder = root.querySelector('#' + CSS.escape((holder.href.baseVal || '').slice(1) || '-'));
  if (server.localName == 'pattern') return Boolean(holder?.firstElementChild);
  return [...(holder?.children ?? [])].some(stop => {
    const style = getComputedStyle(stop);
    return style.stopOpacity > 0 && coloured(style.stopColor);
  });
}
function painted(root, div, el) {
  for (let n = el; n != div; n = n.parentElement)
    if (getComputedStyle(n).display != 'contents' && !(getComputedStyle(n).opacity > 0)) return '';
  const style = getComputedStyle(el), found = [];
  if (el.localName != 'line' && seen(root, style.fill, style.fillOpacity)) found.push('fill');
  if (parseFloat(style.strokeWidth) > 0 && seen(root, style.stroke, style.strokeOpacity)) found.push('stroke');
  return found.join(' ');
}
function measure(text) {
  const root = document.importNode(new DOMParser().parseFromString(text, 'image/svg+xml').documentElement, true);
  const div = document.createElement('div');
  div.style = 'position:absolute;left:0;top:0';
  document.body.append(div);
  div.append(root);
  const box = (root.getAttribute('viewBox') || '').trim().split(/[\s,]+/).map(Number);
  if (box.length == 4 && box.every(isFinite))
    for (const [name, size] of [['width', box[2]], ['height', box[3]]])
      if (/^$|%\s*$/.test(root.getAttribute(name) ?? '')) root.setAttribute(name, size);
  unfold(root);
  const frame = root.getBoundingClientRect(), shapes = [];
  for (const el of root.querySelectorAll(SHAPES)) {
    if (!el.checkVisibility({visibilityProperty: true}) || getComputedStyle(el).display == 'contents') continue;
    let around = el;
    while (around != div && getComputedStyle(around).display != 'none') around = around.parentElement;
    if (around != div) continue;
    if (el.closest(NEVER) || el.parentElement.closest(SHAPES)) continue;
    const local = el.getBBox(), m = el.getScreenCTM(), tag = el.localName;
    if (!m || ((tag == 'rect' || tag == 'ellipse') && !(local.width > 0 && local.height > 0))) continue;
    let length = 0;
    try { length = el.getTotalLength(); el.getPointAtLength(0); } catch { continue; }
    const points = [];
    for (let i = 0; i <= 4000; i++) {
      const p = el.getPointAtLength(length * i / 4000);
      points.push([m.a * p.x + m.c * p.y + m.e - frame.left, m.b * p.x + m.d * p.y + m.f - frame.top]);
    }
    const xs = points.map(p => p[0]), ys = points.map(p => p[1]);
    const round = v => Math.round(v * 1e4) / 1e4;
    shapes.push({
      tag,
      paint: painted(root, div, el),
      box: [Math.min(...xs), Math.min(...ys), Math.max(...xs), Math.max(...ys)].map(round),
      points: [0, 1, 2, 3, 4].map(i => points[i * 900 + 100].map(round)),
    });
  }
  div.remove();
  return shapes;
}
"""


def measure(files: list[Path], chromium: str) -> dict[str, object]:
    calls = ",\n".join(f"{json.dumps(file.stem)}: {json.dumps(file.read_text('utf-8'))}" for file in files)
    calls = calls.replace("</", "<\\/")
    page = f"""<!doctype html><meta charset="utf-8"><body style="margin:0"><script>{SCRIPT}
const found = {{}};
for (const [name, text] of Object.entries({{{calls}}}))
  found[name] = measure(text);
const out = document.createElement('pre');
out.id = 'out';
out.textContent = JSON.stringify(found);
document.body.append(out);
</script>"""
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder) / "page.html"
        place.write_text(page, encoding="utf-8")
        options = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--window-size=1600,1600"]
        command = [chromium, *options, f"--user-data-dir={folder}/profile", "--dump-dom", place.as_uri()]
        shown = subprocess.run(command, capture_output=True, text=True, timeout=300, check=True).stdout
    match = re.search(r'<pre id="out">(.*?)</pre>', shown, re.DOTALL)
    if match is None:
        raise SystemExit("the browser gave no numbers")
    return json.loads(html.unescape(match[1]))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--chromium", default="chromium")
    arguments = parser.parse_args()
    found = measure(sorted(HERE.glob("*.svg")), arguments.chromium)
    lines = []
    for name, shapes in found.items():
        rows = ",\n".join("  " + json.dumps(shape) for shape in shapes)
        lines.append(f"{json.dumps(name)}: [\n{rows}\n]" if shapes else f"{json.dumps(name)}: []")
    (HERE / "expected.json").write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")
    print(f"{len(found)} drawings, {sum(len(shapes) for shapes in found.values())} shapes")


if __name__ == "__main__":
    main()
