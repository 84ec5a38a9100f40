// Ways: balls stepped by frames, as games do, over the exact run. The library has stepped them; a frame is shown until the
// next one, and where a ball first is somewhere else than the exact one there is a ring.
(() => {
  "use strict";
  const W = (globalThis.Wallkit ??= {});
  const $ = (id) => document.getElementById(id);

  const TRAIL = 60; // frames behind a ball
  const MANY = 20; // balls; more show no trail
  const LEAST = 1e-5; // seconds of a frame
  const MOST = 1000;

  // The frames of one answer (see wallkit/view/page/ways.py).
  class Frames {
    constructor(table) {
      Object.assign(this, { way: table.way, dt: table.dt, balls: table.balls, parted: table.parted });
      Object.assign(this, { through: table.through, sentence: table.sentence });
      this.time = W.column(table.time);
      this.place = W.column(table.place);
    }

    // The latest frame at a time.
    at(time) {
      let low = 0;
      let high = this.time.length - 1;
      while (low < high) {
        const middle = (low + high + 1) >>> 1;
        if (this.time[middle] <= time) low = middle;
        else high = middle - 1;
      }
      return low;
    }

    x(frame, ball) {
      return this.place[2 * (frame * this.balls + ball)];
    }

    y(frame, ball) {
      return this.place[2 * (frame * this.balls + ball) + 1];
    }
  }

  // Draws frames up to a time on a player's stage: a dot each, the ball at the latest, rings and crosses.
  const drawFrames = (ctx, player, frames, colours) => {
    const { stage, time, motion } = player;
    if (!motion || frames.balls !== motion.balls) return;
    const last = frames.at(time);
    ctx.strokeStyle = ctx.fillStyle = colours.normal;
    for (let b = 0; b < frames.balls; b++) {
      if (player.trails && frames.balls <= MANY) drawTrail(ctx, stage, frames, b, last);
      ctx.globalAlpha = 1;
      disc(ctx, stage.screenX(frames.x(last, b)), stage.screenY(frames.y(last, b)), player.shownRadius(b));
      ctx.fill();
      ctx.strokeStyle = colours.paper; // so that balls that overlap can be told apart
      ctx.lineWidth = 1;
      ctx.stroke();
      ctx.strokeStyle = colours.normal;
    }
    if (frames.balls <= MANY) drawMarks(ctx, player, frames, colours);
  };

  const drawTrail = (ctx, stage, frames, ball, last) => {
    const first = Math.max(0, last - TRAIL);
    ctx.lineWidth = 1.2;
    ctx.globalAlpha = 0.7;
    ctx.beginPath();
    for (let f = first; f < last; f++) {
      const ends = [f, f + 1].flatMap((k) => [stage.screenX(frames.x(k, ball)), stage.screenY(frames.y(k, ball))]);
      const cut = W.cut(...ends, stage);
      if (!cut) continue;
      ctx.moveTo(cut[0], cut[1]);
      ctx.lineTo(cut[2], cut[3]);
    }
    ctx.stroke();
    ctx.globalAlpha = 0.9;
    for (let f = first; f <= last; f++) {
      disc(ctx, stage.screenX(frames.x(f, ball)), stage.screenY(frames.y(f, ball)), 2.2);
      ctx.fill();
    }
  };

  const drawMarks = (ctx, player, frames, colours) => {
    const { stage, time } = player;
    ctx.strokeStyle = ctx.fillStyle = colours.error;
    ctx.lineWidth = 2;
    ctx.globalAlpha = 1;
    for (const [index, { ball, time: when, place, exact }] of frames.parted.entries()) {
      if (when > time) continue;
      const [x, y] = [stage.screenX(place[0]), stage.screenY(place[1])];
      const radius = player.shownRadius(ball) + 6;
      disc(ctx, x, y, radius);
      ctx.moveTo(x, y);
      ctx.lineTo(stage.screenX(exact[0]), stage.screenY(exact[1]));
      ctx.stroke();
      if (index === 0) W.haloText(ctx, colours, `parts at ${W.number(when)} s`, x, y - radius - 8, stage.width);
    }
    for (const { time: when, place } of frames.through) {
      if (when > time) continue;
      const [x, y] = [stage.screenX(place[0]), stage.screenY(place[1])];
      ctx.beginPath();
      for (const way of [1, -1]) {
        ctx.moveTo(x - 7, y - 7 * way);
        ctx.lineTo(x + 7, y + 7 * way);
      }
      ctx.stroke();
    }
  };

  const disc = (ctx, x, y, radius) => {
    ctx.beginPath();
    ctx.arc(x, y, radius, 0, 2 * Math.PI);
  };

  // Words that can be read over any drawing, kept within the picture.
  W.haloText = (ctx, colours, words, x, y, width) => {
    ctx.font = "600 13px system-ui, sans-serif";
    ctx.textAlign = "center";
    ctx.textBaseline = "alphabetic";
    const half = ctx.measureText(words).width / 2 + 6;
    const middle = Math.min(Math.max(x, half), width - half);
    const stroke = ctx.strokeStyle;
    ctx.strokeStyle = colours.paper;
    ctx.lineWidth = 4;
    ctx.strokeText(words, middle, Math.max(y, 16));
    ctx.strokeStyle = stroke;
    ctx.lineWidth = 2;
    ctx.fillText(words, middle, Math.max(y, 16));
  };

  // A choice of a way with its step: a select, a slider from a thousandth of a second to one, and a number.
  class WayChoice {
    constructor(fields, changed) {
      Object.assign(this, fields); // way, slider, number
      this.changed = changed;
      this.way.addEventListener("change", () => this.chosen());
      this.slider.addEventListener("input", () => {
        this.number.value = String(Number((10 ** Number(this.slider.value)).toPrecision(2)));
        this.chosen();
      });
      this.number.addEventListener("input", () => {
        if (!(this.dt > 0)) return;
        this.slider.value = Math.log10(this.dt);
        this.chosen();
      });
      this.show();
    }

    get dt() {
      const value = Number(this.number.value);
      return value >= LEAST && value <= MOST ? value : NaN;
    }

    chosen() {
      this.show();
      this.changed();
    }

    show() {
      const { min, max, value } = this.slider;
      this.slider.style.setProperty("--done", `${(100 * (value - min)) / (max - min)}%`);
      this.slider.setAttribute("aria-valuetext", `${this.number.value} seconds`);
      for (const field of [this.slider, this.number]) field.disabled = this.way.value === "exact";
    }

    set(way, dt) {
      this.way.value = way;
      if (dt > 0) [this.number.value, this.slider.value] = [String(dt), Math.log10(dt)];
      this.show();
    }

    setting() {
      const way = this.way.value;
      return way === "exact" || !(this.dt > 0) ? { way: "exact" } : { way, dt: this.dt };
    }
  }

  class Ways {
    constructor(page) {
      this.page = page;
      this.frames = null;
      const fields = { way: $("way"), slider: $("dt-slider"), number: $("dt") };
      this.choice = new WayChoice(fields, () => page.changed());
      const { player } = page;
      const decorate = player.decorate;
      player.decorate = (ctx, colours) => {
        if (this.frames) drawFrames(ctx, player, this.frames, colours);
        decorate(ctx, colours);
      };
      this.told = $("way-facts").textContent;
    }

    question() {
      return this.choice.setting();
    }

    load(answer) {
      this.frames = answer?.stepped ? new Frames(answer.stepped) : null;
      $("way-facts").textContent = this.frames ? `${this.frames.sentence}.` : this.told;
      this.page.instruments.bounce.frames = this.frames ? 1 / answer.stepped.dt : W.FRAMES;
    }
  }

  Object.assign(W, { Frames, WayChoice, Ways, drawFrames });
})();
