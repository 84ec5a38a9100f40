// Rulers: a ruler, a protractor and the point of the angular momentum, laid on the drawing. Their handles are buttons:
// dragged, or moved by the arrow keys; they snap to corners of walls and to balls.
(() => {
  "use strict";
  const W = (globalThis.Wallkit ??= {});

  const SNAP = 10; // pixels within which a handle jumps to a corner or a ball
  const STEP = 1; // pixels of an arrow key; ten with Shift
  const WIDE = 22; // pixels of the ruler

  // Fills the path of a tool so that the drawing shines through, and sets the pen for its lines.
  const laid = (ctx, colours) => {
    ctx.globalAlpha = 0.75;
    ctx.fillStyle = colours.paper;
    ctx.fill();
    ctx.globalAlpha = 1;
    ctx.strokeStyle = colours.ink;
    ctx.lineWidth = 1.2;
  };

  // One place that can be moved. `places` are in the drawing's units.
  class Handle {
    constructor(tools, tool, index, label) {
      Object.assign(this, { tools, tool, index, label });
      this.button = document.createElement("button");
      this.button.type = "button";
      this.button.className = "handle";
      this.button.hidden = true;
      this.button.setAttribute("aria-label", label);
      this.button.title = "Drag it, or use the arrow keys; Enter: to the nearest corner";
      tools.host.append(this.button);
      this.listen();
    }

    listen() {
      const { button } = this;
      button.addEventListener("pointerdown", (event) => {
        if (event.button !== 0) return;
        button.setPointerCapture(event.pointerId);
        this.held = true;
        event.stopPropagation();
      });
      button.addEventListener("pointermove", (event) => {
        if (!this.held) return;
        const { stage } = this.tools.player;
        const { x, y } = stage.place(event);
        this.move(this.tools.snapped(stage.drawingX(x), stage.drawingY(y), event.altKey ? 0 : SNAP));
      });
      for (const name of ["pointerup", "pointercancel"]) button.addEventListener(name, () => (this.held = false));
      button.addEventListener("click", (event) => {
        const { x, y } = this.tool.places[this.index];
        if (event.detail === 0) this.move(this.tools.snapped(x, y, Infinity)); // Enter or the space bar
      });
      button.addEventListener("keydown", (event) => this.key(event));
    }

    key(event) {
      const ways = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
      const way = ways[event.key];
      if (!way || event.ctrlKey || event.metaKey || event.altKey) return;
      event.preventDefault();
      const { stage } = this.tools.player;
      const step = (STEP * (event.shiftKey ? 10 : 1)) / stage.scale;
      const { x, y } = this.tool.places[this.index];
      this.move({ x: x + way[0] * step, y: y + (stage.up ? -1 : 1) * way[1] * step });
    }

    move(to) {
      this.tool.move(this.index, to);
      this.tools.player.wake();
    }

    show() {
      const { player } = this.tools;
      const { stage, units } = player;
      const { x, y } = this.tool.places[this.index];
      const [left, top] = [stage.screenX(x), stage.screenY(y)];
      const seen = left > -20 && top > -20 && left < stage.width + 20 && top < stage.height + 20;
      this.button.hidden = !this.tool.on || !seen;
      if (this.button.hidden) return;
      this.button.style.transform = `translate(${left}px, ${top}px)`;
      const told = `${this.label}: ${W.number(units.shown(x))}, ${W.number(units.shown(y))} ${units.name}; ${this.tool.told(units, stage)}`;
      if (this.button.getAttribute("aria-label") !== told) this.button.setAttribute("aria-label", told);
    }
  }

  class Tool {
    constructor(labels) {
      this.on = false;
      this.labels = labels;
      this.places = [];
    }

    move(index, to) {
      this.places[index] = to;
    }
  }

  // Length and direction between two places.
  class Ruler extends Tool {
    constructor() {
      super(["Ruler, one end", "Ruler, other end", "Ruler, the middle"]);
    }

    lay(stage) {
      const y = stage.drawingY(0.5 * stage.height);
      this.places = [{ x: stage.drawingX(0.3 * stage.width), y }, { x: stage.drawingX(0.6 * stage.width), y }];
      this.centre();
    }

    centre() {
      const [a, b] = this.places;
      this.places[2] = { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 };
    }

    move(index, to) {
      const [a, b, middle] = this.places;
      if (index < 2) this.places[index] = to;
      else this.places = [a, b].map(({ x, y }) => ({ x: x + to.x - middle.x, y: y + to.y - middle.y }));
      this.centre();
    }

    get length() {
      const [a, b] = this.places;
      return Math.hypot(b.x - a.x, b.y - a.y);
    }

    // Degrees from the x axis towards the y axis of the drawing, as --angle counts them.
    get angle() {
      const [a, b] = this.places;
      return (Math.atan2(b.y - a.y, b.x - a.x) * 180) / Math.PI;
    }

    told(units) {
      return `${units.text(this.length)} at ${W.number(this.angle, 4)}°`;
    }

    draw(ctx, stage, units, colours) {
      const [a, b] = this.places.map(({ x, y }) => [stage.screenX(x), stage.screenY(y)]);
      const pixels = Math.hypot(b[0] - a[0], b[1] - a[1]);
      if (!(pixels > 1)) return;
      let [ux, uy] = [(b[0] - a[0]) / pixels, (b[1] - a[1]) / pixels];
      const side = ux < 0 || (ux === 0 && uy < 0) ? -1 : 1; // marks hang under the edge that measures
      const [nx, ny] = [-uy * side, ux * side];
      ctx.beginPath();
      ctx.moveTo(...a);
      ctx.lineTo(...b);
      ctx.lineTo(b[0] + nx * WIDE, b[1] + ny * WIDE);
      ctx.lineTo(a[0] + nx * WIDE, a[1] + ny * WIDE);
      ctx.closePath();
      laid(ctx, colours);
      ctx.stroke();
      this.marks(ctx, units, a, [ux, uy], [nx, ny], pixels);
      const [x, y] = [(a[0] + b[0]) / 2 + nx * (WIDE + 14), (a[1] + b[1]) / 2 + ny * (WIDE + 14)];
      W.words(ctx, this.told(units), x, y + 4, colours, colours.ink, "center");
    }

    // Marks at round lengths from the first end, every tenth longer, every fifth a little.
    marks(ctx, units, a, [ux, uy], [nx, ny], pixels) {
      const length = units.shown(this.length);
      const step = W.roundLength((length * 50) / pixels) / 10;
      const count = Math.floor(length / step + 1e-9);
      if (count > 2000) return;
      ctx.beginPath();
      for (let k = 0; k <= count; k++) {
        const at = (k * step * pixels) / length;
        const long = k % 10 === 0 ? 13 : k % 5 === 0 ? 9 : 5;
        ctx.moveTo(a[0] + ux * at, a[1] + uy * at);
        ctx.lineTo(a[0] + ux * at + nx * long, a[1] + uy * at + ny * long);
      }
      ctx.lineWidth = 1;
      ctx.stroke();
    }
  }

  // The angle at a place between two others.
  class Protractor extends Tool {
    constructor() {
      super(["Protractor, the corner", "Protractor, one arm", "Protractor, other arm"]);
    }

    lay(stage) {
      const at = (x, y) => ({ x: stage.drawingX(x * stage.width), y: stage.drawingY(y * stage.height) });
      const reach = Math.min(140, stage.width / 3) / stage.scale;
      const corner = at(0.5, 0.62);
      const up = stage.up ? 1 : -1;
      this.places = [corner, { x: corner.x + reach, y: corner.y }, { x: corner.x + 0.5 * reach, y: corner.y + up * 0.75 ** 0.5 * reach }];
    }

    move(index, to) {
      const [corner] = this.places;
      if (index > 0) this.places[index] = to;
      else this.places = this.places.map(({ x, y }) => ({ x: x + to.x - corner.x, y: y + to.y - corner.y }));
    }

    // 0 to 180 degrees: by the sine and the cosine, exact for small angles too.
    get angle() {
      const [c, a, b] = this.places;
      const [ax, ay, bx, by] = [a.x - c.x, a.y - c.y, b.x - c.x, b.y - c.y];
      return (Math.atan2(Math.abs(ax * by - ay * bx), ax * bx + ay * by) * 180) / Math.PI;
    }

    told() {
      return `${W.number(this.angle, 4)}°`;
    }

    draw(ctx, stage, units, colours) {
      const [c, a, b] = this.places.map(({ x, y }) => [stage.screenX(x), stage.screenY(y)]);
      const reach = Math.max(36, Math.min(110, Math.hypot(a[0] - c[0], a[1] - c[1]), Math.hypot(b[0] - c[0], b[1] - c[1])));
      const first = Math.atan2(a[1] - c[1], a[0] - c[0]);
      let turn = Math.atan2(b[1] - c[1], b[0] - c[0]) - first;
      turn = Math.atan2(Math.sin(turn), Math.cos(turn));
      ctx.beginPath();
      ctx.moveTo(...c);
      ctx.arc(c[0], c[1], reach, first, first + turn, turn < 0);
      ctx.closePath();
      laid(ctx, colours);
      ctx.beginPath();
      ctx.moveTo(...a);
      ctx.lineTo(...c);
      ctx.lineTo(...b);
      ctx.moveTo(c[0] + reach * Math.cos(first), c[1] + reach * Math.sin(first));
      ctx.arc(c[0], c[1], reach, first, first + turn, turn < 0);
      const degrees = Math.floor(this.angle + 1e-9);
      for (let k = 0; k <= degrees; k++) {
        const way = first + Math.sign(turn) * ((k * Math.PI) / 180);
        const inner = reach - (k % 10 === 0 ? 12 : k % 5 === 0 ? 8 : 4);
        if (reach < 80 && k % 5) continue;
        ctx.moveTo(c[0] + inner * Math.cos(way), c[1] + inner * Math.sin(way));
        ctx.lineTo(c[0] + reach * Math.cos(way), c[1] + reach * Math.sin(way));
      }
      ctx.stroke();
      const middle = first + turn / 2;
      const [x, y] = [c[0] + (reach + 22) * Math.cos(middle), c[1] + (reach + 22) * Math.sin(middle)];
      W.words(ctx, this.told(), x, y + 4, colours, colours.ink, "center");
    }
  }

  // The point about which the angular momentum is counted; there while its graph is.
  class Pivot extends Tool {
    constructor(player) {
      super(["Point of the angular momentum"]);
      this.places = [player.about];
      this.player = player;
    }

    lay() {
      this.places = [this.player.about];
    }

    move(_index, to) {
      this.places = [to];
      this.player.about = to;
    }

    told() {
      return "the angular momentum is counted about it";
    }

    draw(ctx, stage, _units, colours) {
      const [x, y] = [stage.screenX(this.places[0].x), stage.screenY(this.places[0].y)];
      ctx.beginPath();
      for (const [dx, dy] of [[7, 0], [0, 7]]) {
        ctx.moveTo(x - dx, y - dy);
        ctx.lineTo(x + dx, y + dy);
      }
      ctx.lineWidth = 2;
      ctx.strokeStyle = colours.normal;
      ctx.stroke();
    }
  }

  // All of them on one stage.
  class Tools {
    constructor(player) {
      this.player = player;
      this.host = document.querySelector("#stage .tools");
      this.ruler = new Ruler();
      this.protractor = new Protractor();
      this.pivot = new Pivot(player);
      this.all = [this.ruler, this.protractor, this.pivot];
      this.handles = this.all.flatMap((tool) => tool.labels.map((label, index) => new Handle(this, tool, index, label)));
      for (const button of document.querySelectorAll("[data-tool]")) {
        button.addEventListener("click", () => this.toggle(button));
      }
      player.decorations.push((ctx, colours) => this.draw(ctx, colours));
    }

    toggle(button) {
      const tool = this[button.dataset.tool];
      tool.on = !tool.on;
      button.setAttribute("aria-pressed", String(tool.on));
      if (tool.on) tool.lay(this.player.stage);
      this.player.wake();
    }

    // Another drawing: what was laid on the one before goes.
    clear() {
      for (const button of document.querySelectorAll("[data-tool][aria-pressed=true]")) this.toggle(button);
      this.pivot.lay();
    }

    draw(ctx, colours) {
      const { stage, units } = this.player;
      for (const tool of this.all) if (tool.on) tool.draw(ctx, stage, units, colours);
      ctx.globalAlpha = 1;
    }

    show() {
      for (const handle of this.handles) if (handle.tool.on || !handle.button.hidden) handle.show();
    }

    // The nearest corner of a wall or middle of a ball within so many pixels, or the place itself.
    snapped(x, y, pixels) {
      const { picture, stage, motion, time } = this.player;
      let [best, least] = [{ x, y }, pixels / stage.scale];
      const look = (px, py) => {
        const away = Math.hypot(px - x, py - y);
        if (away < least) [best, least] = [{ x: px, y: py }, away];
      };
      const vertices = picture?.vertices ?? [];
      for (let i = 0; i < vertices.length; i += 2) look(vertices[i], vertices[i + 1]);
      for (let b = 0; motion && b < motion.balls; b++) {
        const state = W.stateAt(motion, b, time);
        look(state.x, state.y);
      }
      for (const ball of motion ? [] : this.player.standing()) look(ball.x, ball.y);
      return best;
    }
  }

  W.Tools = Tools;
})();
