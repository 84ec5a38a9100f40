// Walls on the screen: even-odd fills, outlines, normals as ticks, problems as numbered marks.
(() => {
  "use strict";
  const W = (globalThis.Wallkit ??= {});

  const FAR = 8000; // pixels; what lies beyond is cut in double precision before the canvas rounds it to single
  const SKIP = 0.35; // pixels; points nearer than this to the one before say nothing
  const TICK = 8;
  const SPACING = 26; // pixels between ticks along a wall
  const RIM = 12; // pixels; how thick the body around a room is shown
  const MANY_TICKS = 20000;

  class WallPicture {
    constructor(walls) {
      this.vertices = W.column(walls.vertices);
      this.offsets = W.column(walls.offsets);
      this.closed = W.column(walls.closed);
      this.bulges = walls.bulges ? W.column(walls.bulges) : null;
      this.twoSided = W.column(walls.two_sided);
      this.names = walls.names;
      this.layers = walls.layers;
      this.areas = walls.areas;
      this.box = walls.box;
      this.up = walls.y_axis === "up";
      this.units = walls.units;
      this.sensors = walls.sensors ? new WallPicture(walls.sensors) : null;
      this.count = this.closed.length;
      this.edges = walls.edges;
      this.boxes = Array.from({ length: this.count }, (_, w) => this.boxOf(w));
    }

    label(wall) {
      return [this.layers[wall], this.names[wall]].filter(Boolean).join(" · ") || `wall ${wall}`;
    }

    // A box that surely holds the wall: an arc stays within half of max(1, |bulge|) chords of its ends.
    boxOf(wall) {
      const box = [Infinity, Infinity, -Infinity, -Infinity];
      let reach = 0;
      for (let i = this.offsets[wall]; i < this.offsets[wall + 1]; i++) {
        const x = this.vertices[2 * i];
        const y = this.vertices[2 * i + 1];
        if (this.bulges && this.bulges[i]) {
          const j = this.after(wall, i);
          const chord = Math.hypot(this.vertices[2 * j] - x, this.vertices[2 * j + 1] - y);
          reach = Math.max(reach, chord * Math.max(1, Math.abs(this.bulges[i])));
        }
        box[0] = Math.min(box[0], x);
        box[1] = Math.min(box[1], y);
        box[2] = Math.max(box[2], x);
        box[3] = Math.max(box[3], y);
      }
      return [box[0] - reach, box[1] - reach, box[2] + reach, box[3] + reach];
    }

    after(wall, i) {
      return i + 1 < this.offsets[wall + 1] ? i + 1 : this.offsets[wall];
    }

    onScreen(stage, [x0, y0, x1, y1]) {
      const near = 60;
      const left = stage.screenX(x0);
      const right = stage.screenX(x1);
      const [top, bottom] = stage.up ? [stage.screenY(y1), stage.screenY(y0)] : [stage.screenY(y0), stage.screenY(y1)];
      return right > -near && left < stage.width + near && bottom > -near && top < stage.height + near;
    }

    // The wall's points in pixels, arcs cut into chords that stay within a tenth of a pixel.
    points(wall, stage) {
      const points = [];
      const { vertices, bulges } = this;
      const end = this.offsets[wall + 1];
      let lastX = NaN;
      let lastY = NaN;
      for (let i = this.offsets[wall]; i < end; i++) {
        const x = stage.screenX(vertices[2 * i]);
        const y = stage.screenY(vertices[2 * i + 1]);
        const curved = bulges && bulges[i];
        if (!(Math.abs(x - lastX) < SKIP && Math.abs(y - lastY) < SKIP) || curved || i === end - 1) {
          points.push(x, y);
          [lastX, lastY] = [x, y];
        }
        if (curved && (i < end - 1 || this.closed[wall])) {
          const j = this.after(wall, i);
          const bulge = stage.up ? bulges[i] : -bulges[i];
          arc(points, x, y, stage.screenX(vertices[2 * j]), stage.screenY(vertices[2 * j + 1]), bulge);
        }
      }
      if (this.closed[wall]) points.push(points[0], points[1]);
      return points;
    }

    draw(ctx, stage, colours, { normals = true } = {}) {
      const seen = [];
      for (let w = 0; w < this.count; w++) if (this.onScreen(stage, this.boxes[w])) seen.push(w);
      const points = new Map(seen.map((w) => [w, this.points(w, stage)]));
      this.fill(ctx, stage, colours, points);
      ctx.lineCap = "round";
      ctx.lineJoin = this.edges < 2000 ? "round" : "bevel"; // round joins cost most of the time of very many
      ctx.strokeStyle = colours.outline;
      for (const closed of [1, 0]) {
        ctx.beginPath();
        for (const w of seen) if (this.closed[w] === closed) line(ctx, points.get(w), stage);
        ctx.lineWidth = closed ? 1.5 : 2.5;
        ctx.stroke();
      }
      if (normals) this.ticks(ctx, stage, colours, seen);
      this.sensors?.dash(ctx, stage, colours);
    }

    // Sensors are seen through: dashed outlines without a body.
    dash(ctx, stage, colours) {
      ctx.beginPath();
      for (let w = 0; w < this.count; w++) {
        if (this.onScreen(stage, this.boxes[w])) line(ctx, this.points(w, stage), stage);
      }
      ctx.setLineDash([5, 4]);
      ctx.lineWidth = 1.2;
      ctx.strokeStyle = colours.hidden;
      ctx.stroke();
      ctx.setLineDash([]);
      ctx.font = "12.5px system-ui, sans-serif";
      ctx.textAlign = "center";
      ctx.textBaseline = "middle";
      ctx.fillStyle = colours.muted;
      for (let w = 0; w < this.count; w++) {
        const [x0, y0, x1, y1] = this.boxes[w];
        if (this.names[w]) ctx.fillText(this.names[w], stage.screenX((x0 + x1) / 2), stage.screenY((y0 + y1) / 2));
      }
    }

    fill(ctx, stage, colours, points) {
      for (const { shade, walls, framed } of this.areas) {
        ctx.beginPath();
        if (framed) ring(ctx, this.frame(stage), stage);
        for (const w of walls) if (points.has(w)) ring(ctx, points.get(w), stage);
        ctx.fillStyle = colours[`material${shade}`];
        ctx.fill("evenodd");
      }
    }

    frame(stage) {
      const [x0, y0, x1, y1] = this.box;
      const rim = stage.up ? -RIM : RIM;
      const [left, right] = [stage.screenX(x0) - RIM, stage.screenX(x1) + RIM];
      const [low, high] = [stage.screenY(y0) - rim, stage.screenY(y1) + rim];
      return [left, low, right, low, right, high, left, high, left, low];
    }

    // At edges' middles, about SPACING pixels apart; both ways where both sides count.
    ticks(ctx, stage, colours, seen) {
      ctx.beginPath();
      let drawn = 0;
      for (const w of seen) {
        const end = this.offsets[w + 1] - (this.closed[w] ? 0 : 1);
        const back = this.closed[w] || !this.twoSided[w] ? 0 : TICK;
        let walked = 0;
        let last = -SPACING;
        for (let i = this.offsets[w]; i < end; i++) {
          const tick = this.tick(i, this.after(w, i), stage);
          const middle = walked + tick.length / 2;
          walked += tick.length;
          const wanted = Math.min(SPACING, Math.max(tick.length, SPACING / 2));
          if (!(tick.length > 0) || middle - last < wanted) continue;
          last = middle;
          if (tick.x < -TICK || tick.y < -TICK || tick.x > stage.width + TICK || tick.y > stage.height + TICK) continue;
          if (drawn++ > MANY_TICKS) break;
          ctx.moveTo(tick.x - back * tick.nx, tick.y - back * tick.ny);
          ctx.lineTo(tick.x + TICK * tick.nx, tick.y + TICK * tick.ny);
        }
      }
      ctx.lineWidth = 1;
      ctx.strokeStyle = colours.normal;
      ctx.stroke();
    }

    // The outward normal of the edge from a to b is (dy, -dx) / |d| with y up; at an arc's top for an arc.
    tick(i, j, stage) {
      const [ax, ay] = [stage.screenX(this.vertices[2 * i]), stage.screenY(this.vertices[2 * i + 1])];
      const [bx, by] = [stage.screenX(this.vertices[2 * j]), stage.screenY(this.vertices[2 * j + 1])];
      const length = Math.hypot(bx - ax, by - ay);
      const turn = stage.up ? -1 : 1;
      const nx = (turn * (by - ay)) / length;
      const ny = (-turn * (bx - ax)) / length;
      const rise = this.bulges ? (this.bulges[i] * length) / 2 : 0;
      return { x: (ax + bx) / 2 + nx * rise, y: (ay + by) / 2 + ny * rise, nx, ny, length };
    }
  }

  // Adds the points of an arc between a and b (both left out). With d = b - a and the bulge k = tan(angle / 4) the
  // centre is m + (1 - k^2) / (4 k) (-dy, dx) with y up; in pixels y points down, which turns the perpendicular.
  const arc = (points, ax, ay, bx, by, k) => {
    const [dx, dy] = [bx - ax, by - ay];
    const arm = (1 - k * k) / (4 * k);
    const [cx, cy] = [(ax + bx) / 2 + arm * dy, (ay + by) / 2 - arm * dx];
    const radius = Math.hypot(ax - cx, ay - cy);
    const span = -4 * Math.atan(k); // clockwise on the screen is positive
    const step = 2 * Math.sqrt(0.2 / Math.max(radius, 0.2));
    const count = Math.min(4096, Math.ceil(Math.abs(span) / step));
    const start = Math.atan2(ay - cy, ax - cx);
    for (let i = 1; i < count; i++) {
      const angle = start + (span * i) / count;
      points.push(cx + radius * Math.cos(angle), cy + radius * Math.sin(angle));
    }
  };

  const far = (points) => points.some((value) => Math.abs(value) > FAR);

  const line = (ctx, points, stage) => {
    if (!far(points)) return trace(ctx, points);
    for (let i = 0; i + 3 < points.length; i += 2) {
      const cut = W.cut(points[i], points[i + 1], points[i + 2], points[i + 3], stage);
      if (!cut) continue;
      ctx.moveTo(cut[0], cut[1]);
      ctx.lineTo(cut[2], cut[3]);
    }
  };

  const trace = (ctx, points) => {
    ctx.moveTo(points[0], points[1]);
    for (let i = 2; i < points.length; i += 2) ctx.lineTo(points[i], points[i + 1]);
  };

  const ring = (ctx, points, stage) => {
    const kept = far(points) ? polygon(points, stage) : points;
    if (kept.length) trace(ctx, kept);
  };

  // The part of a line that is on the screen or near it (Liang and Barsky), or null.
  W.cut = (ax, ay, bx, by, stage) => {
    let from = 0;
    let to = 1;
    const walls = [
      [ax - bx, ax + 50],
      [bx - ax, stage.width + 50 - ax],
      [ay - by, ay + 50],
      [by - ay, stage.height + 50 - ay],
    ];
    for (const [p, q] of walls) {
      if (p === 0 && q < 0) return null;
      if (p < 0) from = Math.max(from, q / p);
      if (p > 0) to = Math.min(to, q / p);
    }
    if (from > to) return null;
    const at = (part) => [ax + part * (bx - ax), ay + part * (by - ay)];
    return [...at(from), ...at(to)];
  };

  // A ring cut to the screen and a border around it (Sutherland and Hodgman).
  const polygon = (points, stage) => {
    let kept = points;
    for (const [axis, sign, limit] of [[0, -1, 100], [0, 1, stage.width + 100], [1, -1, 100], [1, 1, stage.height + 100]]) {
      const from = kept;
      kept = [];
      for (let i = 0; i + 1 < from.length; i += 2) {
        const j = i + 3 < from.length ? i + 2 : 0;
        const a = limit - sign * from[i + axis];
        const b = limit - sign * from[j + axis];
        if (a >= 0) kept.push(from[i], from[i + 1]);
        if (a >= 0 === b >= 0) continue;
        const part = a / (a - b);
        kept.push(from[i] + part * (from[j] - from[i]), from[i + 1] + part * (from[j + 1] - from[i + 1]));
      }
    }
    return kept;
  };

  // Problems as numbered pins whose tip is the place. Notes are only in the list, until somebody chooses one.
  W.drawMarks = (ctx, stage, colours, problems, chosen) => {
    ctx.textAlign = "center";
    ctx.textBaseline = "middle";
    const standing = [];
    problems.forEach((problem, index) => {
      if (problem.x === null || problem.y === null || (problem.severity === "info" && index !== chosen)) return;
      const [x, y] = [stage.screenX(problem.x), stage.screenY(problem.y)];
      if (!(x > -20 && y > -20 && x < stage.width + 20 && y < stage.height + 40)) return;
      const before = standing.filter(([a, b]) => Math.hypot(a - x, b - y) < 20).length;
      if (standing.length < 500) standing.push([x, y]);
      pin(ctx, x, y, LEANS[before % LEANS.length], colours[problem.severity], colours.paper, String(index + 1), index === chosen);
    });
  };

  // Aslant, so that a pin does not hide the wall that it stands on, most being upright or level; close ones spread.
  const LEANS = [0.7, -0.7, 2.44, -2.44];

  const pin = (ctx, x, y, angle, colour, paper, text, chosen) => {
    const [dx, dy] = [Math.sin(angle), -Math.cos(angle)];
    const [cx, cy] = [x + 27 * dx, y + 27 * dy];
    ctx.beginPath();
    ctx.moveTo(x, y);
    ctx.lineTo(cx + 4 * dy, cy - 4 * dx);
    ctx.lineTo(cx - 4 * dy, cy + 4 * dx);
    ctx.closePath();
    ctx.fillStyle = colour;
    ctx.fill();
    disc(ctx, cx, cy, chosen ? 11 : 9, colour, paper);
    if (chosen) {
      ctx.beginPath();
      ctx.arc(cx, cy, 15, 0, 2 * Math.PI);
      ctx.lineWidth = 2.5;
      ctx.strokeStyle = colour;
      ctx.stroke();
    }
    ctx.font = `600 ${text.length > 2 ? 8 : 10.5}px system-ui, sans-serif`;
    ctx.fillStyle = paper;
    ctx.fillText(text, cx, cy + 0.5);
  };

  const disc = (ctx, x, y, radius, fill, stroke) => {
    ctx.beginPath();
    ctx.arc(x, y, radius, 0, 2 * Math.PI);
    ctx.fillStyle = fill;
    ctx.fill();
    ctx.lineWidth = 1.2;
    ctx.strokeStyle = stroke;
    ctx.stroke();
  };

  W.WallPicture = WallPicture;
})();
