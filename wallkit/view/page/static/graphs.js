// Graphs: height, speed, energy and angular momentum over time under the stage. Curves are drawn once for a stretch of
// time, ball by ball within a part of each frame; while balls fly only the hand moves.
(() => {
  "use strict";
  const W = (globalThis.Wallkit ??= {});

  const ROW = 62; // pixels
  const FOOT = 20; // of the times below
  const GUTTER = 62; // of the numbers at the left
  const RIGHT = 10;
  const PERIOD = 80; // milliseconds between changes of the text while playing
  const BUDGET = 4; // milliseconds of a frame that drawing curves may take
  const STEP = 2; // pixels between two places of a bent curve that are computed

  class Graphs {
    constructor(host, player) {
      this.host = host;
      this.player = player;
      this.canvas = host.querySelector("canvas");
      this.slider = host.querySelector(".times");
      this.hand = host.querySelector(".hand");
      this.names = []; // of the quantities that are shown
      this.span = 1; // seconds of a page; the graph turns over when the clock leaves it
      this.page = 0;
      this.drawn = null; // the page that the canvas shows: {from, span, key, rows, left, right}
      this.job = null;
      this.states = 0; // how many were computed for the last page, and how many pages were drawn: for tests
      this.pages = 0;
      this.shownAt = 0;
      this.size = { width: 0, height: 0 };
      new ResizeObserver(() => {
        this.size = host.getBoundingClientRect();
        this.player.wake();
      }).observe(host);
      this.listen();
    }

    choose(name, on) {
      this.names = Object.keys(W.QUANTITIES).filter((each) => (each === name ? on : this.names.includes(each)));
      this.host.hidden = !this.names.length;
      document.body.classList.toggle("graphs-open", this.names.length > 0);
      document.body.style.setProperty("--graphs", `${this.names.length * ROW + FOOT}px`);
      this.host.querySelector(".rows").replaceChildren(...this.names.map((each) => this.row(each)));
      this.player.stage.touch();
    }

    row(name) {
      const row = document.createElement("div");
      row.className = "row";
      row.append(document.createElement("span"), document.createElement("output"));
      row.dataset.graph = name;
      return row;
    }

    // A new shot: one page has what is known of it, and further pages are as long.
    fit() {
      const { duration } = this.player.motion ?? {};
      this.span = duration > 0 && Number.isFinite(duration) ? duration : 1;
      this.page = 0;
    }

    get from() {
      return this.page * this.span;
    }

    // The value of a quantity of a ball at a time, in the drawing's units.
    value(name, ball, time) {
      const { motion } = this.player;
      return W.QUANTITIES[name].of(W.stateAt(motion, ball, time, NOW), ball, this.player);
    }

    refresh() {
      if (this.host.hidden || !(this.size.width > 0)) return;
      const { motion, time } = this.player;
      if (motion && !this.dragged) this.turn(time);
      const key = this.wanted();
      if (key !== this.drawn?.key && key !== this.asked) {
        this.asked = key;
        this.job = this.work(key);
      }
      this.goOn();
      this.moveHand();
      this.tell();
    }

    // To the page with this time; the end of the last one belongs to it.
    turn(time) {
      const page = Math.floor(time / this.span);
      const last = this.player.playing ? page : Math.ceil(time / this.span) - 1;
      this.page = Math.max(0, time === page * this.span ? last : page);
    }

    // What the picture depends on.
    wanted() {
      const { motion, units, about, stage } = this.player;
      const { width, height } = this.size;
      this.motions ??= new WeakMap();
      if (motion && !this.motions.has(motion)) this.motions.set(motion, (this.count = (this.count ?? 0) + 1));
      const place = this.names.includes("spin") ? [about.x, about.y] : [];
      const known = motion ? [this.motions.get(motion), this.from, this.span] : [];
      return [width, height, stage.ratio, W.theme(), this.names, units.name, units.per, ...place, ...known].join();
    }

    // Goes on with the curves for a part of this frame.
    goOn() {
      if (!this.job) return;
      const end = performance.now() + BUDGET;
      while (performance.now() < end) {
        if (this.job.next().done) {
          this.job = null;
          return;
        }
      }
      this.player.wake();
    }

    *work(key) {
      const { motion, stage } = this.player;
      const { from, span } = this;
      const { width, height } = this.size;
      const page = document.createElement("canvas");
      [page.width, page.height] = [Math.round(width * stage.ratio), Math.round(height * stage.ratio)];
      const ctx = page.getContext("2d");
      ctx.setTransform(stage.ratio, 0, 0, stage.ratio, 0, 0);
      const plot = { left: GUTTER, right: Math.max(width - RIGHT, GUTTER + 1), from, span };
      this.states = 0;
      const curves = [];
      for (let b = 0; motion && b < motion.balls; b++) {
        curves.push(this.curves(b, plot));
        yield;
      }
      const rows = {};
      for (const [index, name] of this.names.entries()) {
        const row = (rows[name] = this.frame(ctx, index, name, curves, plot));
        for (const [b, curve] of curves.entries()) {
          this.stroke(ctx, row, curve, name, b, plot);
          yield;
        }
      }
      this.times(ctx, plot, height);
      [this.canvas.width, this.canvas.height] = [page.width, page.height];
      this.canvas.getContext("2d").drawImage(page, 0, 0);
      this.drawn = { key, rows, ...plot };
      this.pages++;
    }

    // A ball's quantities on a page: times, and for each name its numbers. Between two of them the curve is straight:
    // a free flight without a pull has straight ones but for drag and friction, others are taken every few pixels.
    curves(ball, { left, right, from, span }) {
      const { player } = this;
      const { motion } = player;
      const end = Math.min(from + span, motion.duration);
      const curve = new Curve(this.names, from, span / (right - left));
      const step = (STEP * span) / (right - left);
      const last = motion.passedOf(ball, end);
      for (let k = motion.passedOf(ball, from); k <= last; k++) {
        const flight = motion.flight(ball, k, FLIGHT);
        const begin = Math.max(flight.time, from);
        const until = Math.min(flight.until, end);
        if (until < begin) break;
        const bent = flight.ax !== 0 || flight.ay !== 0 || flight.bend !== 0 || motion.friction || motion.drag;
        const pieces = bent ? Math.max(1, Math.ceil((until - begin) / step)) : 1;
        for (let i = 0; i <= pieces; i++) {
          const time = i === pieces ? until : begin + ((until - begin) * i) / pieces;
          const state = motion.carry(Object.assign(NOW, flight), time - flight.time);
          curve.add(time, state, ball, player);
          this.states++;
        }
      }
      const stands = Math.max(motion.endOf(ball), from);
      if (stands < end) for (const time of [stands, end]) curve.add(time, W.stateAt(motion, ball, time, NOW), ball, player);
      return curve;
    }

    // The row's frame and range: {top, height, low, high}.
    frame(ctx, index, name, curves, { left, right }) {
      const colours = W.colours();
      const { units } = this.player;
      const quantity = W.QUANTITIES[name];
      let [low, high] = [Infinity, -Infinity];
      for (const { range } of curves) [low, high] = [Math.min(low, range[name][0]), Math.max(high, range[name][1])];
      if (!(low <= high)) [low, high] = [0, 1];
      [low, high] = [Math.min(low, 0), Math.max(high, 0)];
      if (-low < 1e-9 * high) low = 0; // rounding
      if (high - low <= 1e-12 * Math.abs(high)) high = low + 1;
      const row = { top: index * ROW + 20, height: ROW - 26, low, high };
      ctx.strokeStyle = colours.hidden;
      ctx.lineWidth = 1;
      ctx.globalAlpha = 0.5;
      ctx.beginPath();
      for (const value of new Set([low, 0, high])) {
        const y = Math.round(yOf(row, value)) + 0.5;
        ctx.moveTo(left, y);
        ctx.lineTo(right, y);
      }
      ctx.stroke();
      ctx.globalAlpha = 1;
      ctx.fillStyle = colours.muted;
      ctx.font = "11px system-ui, -apple-system, 'Segoe UI', sans-serif";
      ctx.textAlign = "right";
      const label = (value) => (value === 0 ? "0" : W.number(units.shown(value, quantity.power), 3).replace("-", "−"));
      ctx.fillText(label(high), left - 6, row.top + 8);
      ctx.fillText(label(low), left - 6, row.top + row.height + 2);
      return row;
    }

    stroke(ctx, row, curve, name, ball, plot) {
      const colours = W.colours();
      const { motion } = this.player;
      const many = motion.balls > 1;
      ctx.save();
      ctx.beginPath();
      ctx.rect(plot.left, row.top - 2, plot.right - plot.left, row.height + 4);
      ctx.clip();
      ctx.lineJoin = "round";
      ctx.strokeStyle = this.player.colourOf(ball, colours);
      ctx.lineWidth = many ? 1.2 : 1.8;
      ctx.globalAlpha = motion.balls > W.MANY ? 0.6 : 1;
      this.line(ctx, row, curve.times, curve.values[name], curve.count, plot);
      if (!many && curve.values[`${name}-part`]) {
        ctx.setLineDash([4, 3]);
        ctx.lineWidth = 1.2;
        this.line(ctx, row, curve.times, curve.values[`${name}-part`], curve.count, plot);
      }
      ctx.restore();
    }

    line(ctx, row, times, values, count, plot) {
      const scale = (plot.right - plot.left) / plot.span;
      ctx.beginPath();
      for (let i = 0; i < count; i++) ctx.lineTo(plot.left + (times[i] - plot.from) * scale, yOf(row, values[i]));
      ctx.stroke();
    }

    times(ctx, { left, right, from, span }, height) {
      const colours = W.colours();
      ctx.fillStyle = colours.muted;
      ctx.strokeStyle = colours.muted;
      ctx.lineWidth = 1;
      ctx.font = "11px system-ui, -apple-system, 'Segoe UI', sans-serif";
      ctx.textAlign = "center";
      const tick = W.roundLength((span * 90) / (right - left));
      const digits = Math.max(0, -Math.floor(Math.log10(tick)));
      for (let k = Math.ceil(from / tick); k * tick <= from + span; k++) {
        const x = left + ((k * tick - from) / span) * (right - left);
        ctx.beginPath();
        ctx.moveTo(x, height - FOOT);
        ctx.lineTo(x, height - FOOT + 4);
        ctx.stroke();
        if (x < right - 14) ctx.fillText(`${(k * tick).toFixed(Math.min(digits, 12))} s`, x, height - 5);
      }
    }

    // Where a time is on the page that is shown, in pixels.
    screenX(time) {
      const { left, right, from, span } = this.drawn;
      return left + (Math.min(Math.max((time - from) / span, 0), 1)) * (right - left);
    }

    moveHand() {
      const { motion, time } = this.player;
      this.hand.hidden = !motion || !this.drawn;
      if (!this.hand.hidden) this.hand.style.transform = `translateX(${this.screenX(time)}px)`;
    }

    // The numbers now, of the ball that is followed.
    tell() {
      const { player } = this;
      const { motion, time, units } = player;
      const now = performance.now();
      if (player.playing && now - this.shownAt < PERIOD) return;
      this.shownAt = now;
      const ball = motion ? Math.min(player.followed, motion.balls - 1) : 0;
      const said = [motion ? `${W.number(time)} s` : "–"];
      for (const row of this.host.querySelectorAll(".row")) {
        const { name, power, rate } = W.QUANTITIES[row.dataset.graph];
        const value = motion ? W.number(units.shown(this.value(row.dataset.graph, ball, time), power)).replace("-", "−") : "–";
        const whose = motion && motion.balls > 1 ? ` of ${player.nameOf(ball)}` : "";
        row.querySelector("span").textContent = `${name}${whose}, ${units.name}${rate}`;
        row.querySelector("output").textContent = value;
        said.push(`${name} ${value}`);
      }
      this.slider.setAttribute("aria-valuemax", String(player.shownDuration()));
      this.slider.setAttribute("aria-valuenow", String(time));
      this.slider.setAttribute("aria-valuetext", said.join(", "));
    }

    listen() {
      const { slider, player } = this;
      const follow = (event) => {
        const { left, right, from, span } = this.drawn;
        const x = event.clientX - this.host.getBoundingClientRect().left;
        player.seek(from + Math.min(Math.max((x - left) / (right - left), 0), 1) * span);
      };
      slider.addEventListener("pointerdown", (event) => {
        if (event.button !== 0 || !player.motion || !this.drawn) return;
        slider.setPointerCapture(event.pointerId);
        this.dragged = true;
        player.pause();
        follow(event);
      });
      slider.addEventListener("pointermove", (event) => this.dragged && follow(event));
      for (const name of ["pointerup", "pointercancel"]) {
        slider.addEventListener(name, () => {
          this.dragged = false;
          player.wake();
        });
      }
      slider.addEventListener("wheel", (event) => {
        event.preventDefault();
        this.zoom(Math.exp(Math.sign(event.deltaY) * 0.2));
      }, { passive: false });
      slider.addEventListener("keydown", (event) => this.key(event));
    }

    // Less or more time on a page; at most all that is known, at least a thousandth of it.
    zoom(factor) {
      const duration = this.player.shownDuration();
      if (!(duration > 0)) return;
      this.span = Math.min(Math.max(this.span * factor, duration / 1000), duration);
      this.player.wake();
    }

    key(event) {
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      const { player } = this;
      const step = (this.span / 200) * (event.shiftKey ? 10 : 1);
      const act = {
        ArrowLeft: () => player.seek(player.time - step),
        ArrowDown: () => player.seek(player.time - step),
        ArrowRight: () => player.seek(player.time + step),
        ArrowUp: () => player.seek(player.time + step),
        PageUp: () => player.step(1),
        PageDown: () => player.step(-1),
        Home: () => player.seek(0),
        End: () => player.seek(player.shownDuration()),
        "+": () => this.zoom(0.8),
        "=": () => this.zoom(0.8),
        "-": () => this.zoom(1.25),
      }[event.key];
      if (!act) return;
      event.preventDefault();
      event.stopPropagation();
      if (event.key.length > 1) player.pause();
      act();
    }
  }

  // A ball's numbers over time, at most four a pixel: the first and last of a pixel, and between them what is least
  // and greatest of each quantity, so that a run of a hundred thousand bounces costs no more than one of a hundred.
  class Curve {
    constructor(names, from, pixel) {
      this.names = names.flatMap((name) => (W.QUANTITIES[name].part ? [name, `${name}-part`] : [name]));
      this.from = from;
      this.pixel = pixel;
      this.column = -1;
      this.inColumn = 0;
      this.times = [];
      this.values = Object.fromEntries(this.names.map((name) => [name, []]));
      this.range = Object.fromEntries(this.names.map((name) => [name, [Infinity, -Infinity]]));
    }

    get count() {
      return this.times.length;
    }

    add(time, state, ball, player) {
      const column = Math.floor((time - this.from) / this.pixel);
      this.inColumn = column === this.column ? this.inColumn + 1 : 0;
      this.column = column;
      const full = this.inColumn >= 4;
      if (!full) this.times.push(time);
      const last = this.times.length - 1;
      this.times[last] = time;
      for (const name of this.names) {
        const part = name.endsWith("-part");
        const quantity = W.QUANTITIES[part ? name.slice(0, -5) : name];
        const value = (part ? quantity.part : quantity.of)(state, ball, player);
        const values = this.values[name];
        const range = this.range[name];
        range[0] = Math.min(range[0], value);
        range[1] = Math.max(range[1], value);
        if (full) {
          values[last - 2] = Math.min(values[last - 2], value);
          values[last - 1] = Math.max(values[last - 1], value);
        }
        values[last] = value;
      }
    }
  }

  const yOf = (row, value) => row.top + ((row.high - value) / (row.high - row.low)) * row.height;
  const FLIGHT = {};
  const NOW = {};

  W.Graphs = Graphs;
})();
