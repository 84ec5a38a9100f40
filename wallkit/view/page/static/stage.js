// Stage: where a place in the drawing lands on the screen, and how wheel, fingers and keys change that.
(() => {
  "use strict";
  const W = (globalThis.Wallkit ??= {});

  const MAX_ZOOM = 5000; // times the fitting scale; beyond it single-precision rasters show
  const MARGIN = 28;
  const BUTTONS = 58; // pixels that the zoom buttons take, at the right or, on a phone, at the top
  const PHONE = 640;

  // Two canvases, one above the other: `back` (walls) is drawn anew only when the view changes.
  class Stage {
    constructor(host) {
      this.host = host;
      this.back = host.querySelector("canvas[data-layer=back]");
      this.front = host.querySelector("canvas[data-layer=front]");
      this.box = [0, 0, 1, 1];
      this.up = true;
      this.fitted = true;
      this.scale = 1;
      this.x = 0; // the place of the drawing at the middle of the screen
      this.y = 0;
      this.width = 1;
      this.height = 1;
      this.dirty = true;
      this.changed = () => {};
      this.grab = () => null; // given a press, returns {move, end} when it is not a pan
      this.tap = () => {};
      this.pointers = new Map();
      new ResizeObserver(() => this.resize()).observe(host);
      this.listen();
      this.resize();
    }

    resize() {
      const { width, height } = this.host.getBoundingClientRect();
      this.ratio = Math.min(globalThis.devicePixelRatio || 1, 2);
      this.width = Math.max(1, width);
      this.height = Math.max(1, height);
      for (const canvas of [this.back, this.front]) {
        canvas.width = Math.round(this.width * this.ratio);
        canvas.height = Math.round(this.height * this.ratio);
      }
      if (this.fitted) this.fit();
      else this.touch();
    }

    touch() {
      this.dirty = true;
      this.changed();
    }

    // Shows a box of the drawing as large as it fits.
    show(box, up) {
      this.box = box;
      this.up = up;
      this.fit();
    }

    // Pixels at the right and at the top that a fitting drawing leaves to the buttons.
    get reserved() {
      return this.width < PHONE ? [0, BUTTONS - MARGIN] : [BUTTONS - MARGIN, 0];
    }

    fitScale() {
      const [x0, y0, x1, y1] = this.box;
      const [right, top] = this.reserved;
      const least = Math.max(x1 - x0, y1 - y0) * 1e-3 || 1;
      const width = Math.max(this.width - right - 2 * MARGIN, 20);
      const height = Math.max(this.height - top - 2 * MARGIN, 20);
      return Math.min(width / Math.max(x1 - x0, least), height / Math.max(y1 - y0, least));
    }

    fit() {
      const [x0, y0, x1, y1] = this.box;
      this.scale = this.fitScale();
      const [right, top] = this.reserved;
      this.x = (x0 + x1) / 2 + right / 2 / this.scale;
      this.y = (y0 + y1) / 2 + ((this.up ? 1 : -1) * top) / 2 / this.scale;
      this.fitted = true;
      this.touch();
    }

    screenX(x) {
      return this.width / 2 + (x - this.x) * this.scale;
    }

    screenY(y) {
      return this.height / 2 + (this.up ? this.y - y : y - this.y) * this.scale;
    }

    drawingX(sx) {
      return this.x + (sx - this.width / 2) / this.scale;
    }

    drawingY(sy) {
      const rise = (sy - this.height / 2) / this.scale;
      return this.up ? this.y - rise : this.y + rise;
    }

    zoom(factor, sx = this.width / 2, sy = this.height / 2) {
      const x = this.drawingX(sx);
      const y = this.drawingY(sy);
      const fit = this.fitScale();
      this.scale = Math.min(Math.max(this.scale * factor, fit / 8), fit * MAX_ZOOM);
      this.x += x - this.drawingX(sx);
      this.y += y - this.drawingY(sy);
      this.fitted = false;
      this.touch();
    }

    pan(dx, dy) {
      this.x -= dx / this.scale;
      this.y += (this.up ? dy : -dy) / this.scale;
      this.fitted = false;
      this.touch();
    }

    // Goes to a place, close enough to see it; at once where motion is not wanted.
    goTo(x, y, zoom = 8) {
      const scale = Math.max(this.scale, this.fitScale() * zoom);
      const from = [this.x, this.y, Math.log(this.scale)];
      const to = [x, y, Math.log(scale)];
      const began = performance.now();
      const length = W.stillness() ? 0 : 350;
      this.fitted = false;
      this.journey = to;
      const go = (now) => {
        if (this.journey !== to) return; // somebody went elsewhere meanwhile
        const part = length ? Math.min(1, Math.max(0, (now - began) / length)) : 1;
        const eased = part * part * (3 - 2 * part);
        [this.x, this.y] = [0, 1].map((i) => from[i] + (to[i] - from[i]) * eased);
        this.scale = Math.exp(from[2] + (to[2] - from[2]) * eased);
        this.touch();
        if (part < 1) requestAnimationFrame(go);
      };
      go(began);
    }

    place(event) {
      const box = this.front.getBoundingClientRect();
      return { x: event.clientX - box.left, y: event.clientY - box.top };
    }

    listen() {
      const canvas = this.front;
      canvas.addEventListener("wheel", (event) => {
        event.preventDefault();
        this.journey = null;
        const lines = event.deltaMode === 1 ? 16 : 1;
        const { x, y } = this.place(event);
        this.zoom(Math.exp(-event.deltaY * lines * (event.ctrlKey ? 0.01 : 0.0015)), x, y);
      }, { passive: false });
      canvas.addEventListener("pointerdown", (event) => this.press(event));
      canvas.addEventListener("pointermove", (event) => this.move(event));
      for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, (event) => this.release(event));
      canvas.addEventListener("keydown", (event) => this.key(event));
    }

    press(event) {
      if (event.button > 1) return;
      this.journey = null;
      this.front.setPointerCapture(event.pointerId);
      const place = this.place(event);
      this.pointers.set(event.pointerId, { ...place, startX: place.x, startY: place.y, moved: false });
      if (this.pointers.size === 1) this.held = this.grab(place, event);
      else if (this.held) {
        this.held.end(place, true);
        this.held = null;
      }
    }

    move(event) {
      const pointer = this.pointers.get(event.pointerId);
      const place = this.place(event);
      if (!pointer) return;
      const others = [...this.pointers.values()].filter((other) => other !== pointer);
      const { x, y } = pointer;
      [pointer.x, pointer.y] = [place.x, place.y];
      if (!pointer.moved && Math.hypot(place.x - pointer.startX, place.y - pointer.startY) < 4) return;
      pointer.moved = true;
      if (this.held) this.held.move(place);
      else if (!others.length) this.pan(place.x - x, place.y - y);
      else this.pinch(others[0], { x, y }, place);
    }

    // Two fingers: what was under each stays under it, as far as one scale allows.
    pinch(other, before, after) {
      const was = Math.hypot(before.x - other.x, before.y - other.y);
      const is = Math.hypot(after.x - other.x, after.y - other.y);
      this.pan((after.x - before.x) / 2, (after.y - before.y) / 2);
      if (was > 0 && is > 0) this.zoom(is / was, (after.x + other.x) / 2, (after.y + other.y) / 2);
    }

    release(event) {
      const pointer = this.pointers.get(event.pointerId);
      if (!pointer) return;
      this.pointers.delete(event.pointerId);
      const cancelled = event.type === "pointercancel";
      if (this.held) {
        this.held.end(this.place(event), cancelled || !pointer.moved);
        this.held = null;
      } else if (!pointer.moved && !cancelled && !this.pointers.size) this.tap(this.place(event));
    }

    key(event) {
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      const step = event.shiftKey ? 120 : 40;
      const act = {
        ArrowLeft: () => this.pan(step, 0),
        ArrowRight: () => this.pan(-step, 0),
        ArrowUp: () => this.pan(0, step),
        ArrowDown: () => this.pan(0, -step),
        "+": () => this.zoom(1.25),
        "=": () => this.zoom(1.25),
        "-": () => this.zoom(0.8),
        0: () => this.fit(),
      }[event.key];
      if (!act) return;
      event.preventDefault();
      this.journey = null;
      act();
    }

    context(canvas) {
      const ctx = canvas.getContext("2d");
      ctx.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
      ctx.clearRect(0, 0, this.width, this.height);
      return ctx;
    }
  }

  W.stillness = () => matchMedia("(prefers-reduced-motion: reduce)").matches;
  W.Stage = Stage;
})();
