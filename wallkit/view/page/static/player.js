// Player: the clock, the transport bar and everything that moves. Each frame is drawn from the exact state at its
// own time, so nothing depends on how many frames there are.
(() => {
  "use strict";
  const W = (globalThis.Wallkit ??= {});

  const RATES = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];
  const SEGMENTS = 4000; // flights drawn behind all balls together
  const TRAIL = 80; // flights behind one ball
  const MANY = 20; // balls; of more than these each shows only a little of where it was
  const TRAIL_OF_MANY = 7;
  const STROBES = 1200; // ghosts at equal times of all balls together
  const FRAMES = 600; // draw times that are kept

  class Player {
    constructor(stage, bar) {
      this.stage = stage;
      this.bar = bar;
      this.picture = null;
      this.motion = null;
      this.time = 0;
      this.rate = 1;
      this.playing = false;
      this.normals = true;
      this.ghosts = true;
      this.trails = true;
      this.pins = true;
      this.strobe = false; // ghosts at equal times too, so many seconds apart
      this.strobeEvery = 0.1;
      this.units = new W.Units();
      this.about = { x: 0, y: 0 }; // the point of the angular momentum
      this.followed = 0; // the ball whose numbers are told where there are several
      this.names = []; // of the balls, where a person named them
      this.problems = [];
      this.chosen = -1;
      this.frameTimes = []; // milliseconds that each frame took to draw, for tests and for the curious
      this.onframe = () => {};
      this.decorate = () => {}; // draws what a page has beside the balls
      this.decorations = []; // and these draw over it
      this.standing = () => []; // balls at their start, before any flies
      this.part = (name) => bar.querySelector(`[data-part=${name}]`);
      stage.changed = () => this.wake();
      this.fillRates();
      this.listen();
      matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => stage.touch());
    }

    fillRates() {
      const select = this.part("rate");
      for (const rate of RATES) select.add(new Option(`× ${rate}`, String(rate), rate === 1, rate === 1));
    }

    listen() {
      this.part("play").addEventListener("click", () => this.toggle());
      this.part("restart").addEventListener("click", () => this.seek(0));
      this.part("back").addEventListener("click", () => this.step(-1));
      this.part("step").addEventListener("click", () => this.step(1));
      this.part("rate").addEventListener("change", (event) => this.setRate(Number(event.target.value)));
      this.part("scrub").addEventListener("input", (event) => {
        this.seek(Number(event.target.value) * this.shownDuration());
      });
      document.addEventListener("keydown", (event) => this.key(event));
    }

    // Keys work wherever the focus is, except where they already mean something.
    key(event) {
      if (event.ctrlKey || event.metaKey || event.altKey || W.typing(event.target)) return;
      const onButton = event.target.closest?.("button, summary, a, select, [type=checkbox], [type=radio]");
      const act = {
        " ": onButton ? null : () => this.toggle(),
        k: () => this.toggle(),
        ".": () => this.step(1),
        ",": () => this.step(-1),
        r: () => this.seek(0),
        R: () => this.seek(0),
        "[": () => this.setRate(this.neighbour(-1)),
        "]": () => this.setRate(this.neighbour(1)),
      }[event.key];
      if (!act) return;
      event.preventDefault();
      act();
    }

    neighbour(by) {
      const index = RATES.indexOf(this.rate) + by;
      return RATES[Math.min(RATES.length - 1, Math.max(0, index))];
    }

    setRate(rate) {
      this.rate = rate;
      this.part("rate").value = String(rate);
    }

    // The rate at which the fastest ball crosses the picture in about three seconds.
    suitRate() {
      const { start, gravity, end } = this.motion;
      let speed = 0;
      for (let b = 0; b < this.motion.balls; b++) speed = Math.max(speed, Math.hypot(start.vx[b], start.vy[b]), Math.hypot(end.vx[b], end.vy[b]));
      const [x0, y0, x1, y1] = this.stage.box;
      const size = Math.hypot(x1 - x0, y1 - y0) || 1;
      if (gravity) speed = Math.max(speed, Math.sqrt(2 * Math.hypot(...gravity) * size) / 2);
      const wanted = speed > 0 ? size / speed / 3 : 1;
      if (!this.strobeChosen) this.setStrobe(W.roundLength(wanted / 4));
      this.setRate(RATES.reduce((best, rate) => (Math.abs(Math.log(rate / wanted)) < Math.abs(Math.log(best / wanted)) ? rate : best)));
    }

    setStrobe(seconds) {
      this.strobeEvery = seconds;
      const field = document.getElementById("strobe-every");
      if (field && document.activeElement !== field) field.value = String(seconds);
    }

    nameOf(ball) {
      const named = !this.motion || this.motion.balls === this.names.length; // a fan's balls have no names
      return (named && this.names[ball]) || `ball ${ball + 1}`;
    }

    showWalls(picture, problems = []) {
      this.picture = picture;
      this.units.own = picture.units;
      this.problems = problems;
      this.chosen = -1;
      this.stage.touch();
    }

    load(motion) {
      this.motion = motion;
      this.bar.toggleAttribute("data-empty", !motion);
      for (const name of ["play", "restart", "back", "step", "scrub"]) this.part(name).disabled = !motion;
      if (!motion) this.pause();
      if (motion) this.time = Math.min(this.time, this.shownDuration());
      this.stage.touch();
    }

    shownDuration() {
      return this.motion ? this.motion.duration : 0;
    }

    toggle() {
      if (this.playing) return this.pause();
      if (!this.motion) return;
      if (this.time >= this.shownDuration()) this.time = 0;
      this.playing = true;
      this.lastFrame = null;
      this.showPlaying();
      this.wake();
    }

    play() {
      if (!this.playing) this.toggle();
    }

    pause() {
      this.playing = false;
      this.showPlaying();
      this.wake();
    }

    showPlaying() {
      const button = this.part("play");
      button.toggleAttribute("data-playing", this.playing);
      button.setAttribute("aria-label", this.playing ? "Pause" : "Play");
      button.title = `${this.playing ? "Pause" : "Play"} (space)`;
    }

    seek(time) {
      this.time = Math.min(Math.max(time, 0), this.shownDuration());
      this.wake();
    }

    // To the next contact of any ball (or the one before), exactly at its time.
    step(by) {
      if (!this.motion) return;
      this.pause();
      const time = by > 0 ? this.motion.next(this.time) : this.motion.previous(this.time);
      this.seek(time ?? this.shownDuration());
    }

    wake() {
      if (this.asked) return;
      this.asked = true;
      requestAnimationFrame((now) => {
        this.asked = false;
        this.frame(now);
      });
    }

    frame(now) {
      if (this.playing) {
        if (this.lastFrame !== null) this.time += (Math.min(now - this.lastFrame, 250) / 1000) * this.rate;
        this.lastFrame = now;
        if (this.time >= this.shownDuration()) {
          this.time = this.shownDuration();
          if (!this.more?.()) this.pause();
        }
      }
      const began = performance.now();
      this.draw();
      if (this.frameTimes.push(performance.now() - began) > FRAMES) this.frameTimes.shift();
      this.showClock();
      this.onframe();
      if (this.playing) this.wake();
    }

    draw() {
      const { stage } = this;
      const colours = W.colours();
      if (stage.dirty) {
        stage.dirty = false;
        const back = stage.context(stage.back);
        this.picture?.draw(back, stage, colours, { normals: this.normals });
        if (this.picture) W.scaleBar(back, stage, this.units, colours);
      }
      const ctx = stage.context(stage.front);
      ctx.lineJoin = ctx.lineCap = "round";
      if (this.pins) W.drawMarks(ctx, stage, colours, this.problems, this.chosen);
      if (this.motion) this.drawMotion(ctx, colours);
      this.decorate(ctx, colours);
      for (const draw of this.decorations) draw(ctx, colours);
    }

    drawMotion(ctx, colours) {
      const { motion } = this;
      const many = motion.balls > MANY;
      const flights = Math.max(1, Math.min(many ? TRAIL_OF_MANY : TRAIL, Math.floor(SEGMENTS / motion.balls)));
      const ghosts = many ? 1 : 8;
      for (let b = 0; b < motion.balls; b++) {
        ctx.strokeStyle = this.colourOf(b, colours);
        if (this.strobe) this.drawStrobe(ctx, b, colours);
        if (this.trails) this.drawTrail(ctx, b, flights);
        if (this.ghosts) this.drawGhosts(ctx, b, ghosts);
      }
      ctx.globalAlpha = 1;
      for (let b = 0; b < motion.balls; b++) this.drawBall(ctx, b, colours);
      if (!many) this.drawContact(ctx, colours);
    }

    colourOf(ball, colours) {
      return W.colourOf(ball, this.motion.balls, colours);
    }

    // The last flights: straight lines, or parabolas drawn as the quadratic curves that they are. They fade in
    // bands, since one stroke has one opacity.
    drawTrail(ctx, ball, flights) {
      const last = this.motion.passedOf(ball, this.time);
      const from = Math.max(0, last - flights);
      const many = this.motion.balls > MANY;
      const bands = many ? 3 : 8;
      ctx.lineWidth = many ? 1 : 1.6;
      const size = Math.ceil((last + 1 - from) / bands);
      for (let k = from; k <= last; k += size) {
        const age = (last - Math.min(k + size - 1, last)) / Math.max(1, flights);
        ctx.globalAlpha = (many ? 0.5 : 0.9) * (1 - 0.85 * age);
        ctx.beginPath();
        for (let i = k; i < Math.min(k + size, last + 1); i++) this.traceFlight(ctx, ball, i);
        ctx.stroke();
      }
    }

    traceFlight(ctx, ball, k) {
      const { motion, stage } = this;
      const f = motion.flight(ball, k, FLIGHT);
      W.traceFlight(ctx, stage, motion, f, Math.min(f.until, this.time) - f.time);
    }

    drawGhosts(ctx, ball, ghosts) {
      const { motion, stage } = this;
      const radius = this.shownRadius(ball);
      const last = motion.passedOf(ball, this.time);
      ctx.lineWidth = 1;
      for (let k = Math.max(1, last - ghosts + 1); k <= last; k++) {
        const i = motion.ofBall[motion.first[ball] + k - 1];
        ctx.globalAlpha = 0.7 * (1 - (last - k) / ghosts);
        ctx.beginPath();
        ctx.arc(stage.screenX(motion.contactX(i)), stage.screenY(motion.contactY(i)), radius, 0, 2 * Math.PI);
        ctx.stroke();
      }
    }

    // The ball at whole multiples of a time: of these the last, each exactly where it was.
    drawStrobe(ctx, ball, colours) {
      const { motion, stage, strobeEvery } = this;
      if (!(strobeEvery > 0)) return;
      const radius = this.shownRadius(ball);
      const last = Math.floor(Math.min(this.time, motion.endOf(ball)) / strobeEvery);
      const most = Math.max(4, Math.min(60, Math.floor(STROBES / motion.balls)));
      ctx.fillStyle = this.colourOf(ball, colours);
      for (let k = Math.max(0, last - most + 1); k <= last; k++) {
        const s = motion.state(ball, k * strobeEvery, STATE);
        ctx.globalAlpha = 0.5 * (1 - (0.85 * (last - k)) / most);
        ctx.beginPath();
        ctx.arc(stage.screenX(s.x), stage.screenY(s.y), radius, 0, 2 * Math.PI);
        ctx.fill();
      }
      ctx.globalAlpha = 1;
    }

    // A point is shown as a small disc; a ball as large as it is.
    shownRadius(ball) {
      return Math.max(this.motion.radius[ball] * this.stage.scale, this.motion.balls > MANY ? 2.5 : 3.5);
    }

    drawBall(ctx, ball, colours) {
      const { motion, stage } = this;
      const s = motion.state(ball, this.time, STATE);
      const [x, y] = [stage.screenX(s.x), stage.screenY(s.y)];
      const radius = this.shownRadius(ball);
      ctx.globalAlpha = s.over && motion.ending[ball] === "bounce limit" ? 0.35 : 1;
      ctx.beginPath();
      ctx.arc(x, y, radius, 0, 2 * Math.PI);
      ctx.fillStyle = motion.balls === 1 ? colours.paper : this.colourOf(ball, colours);
      ctx.fill();
      ctx.lineWidth = motion.balls > MANY ? 0.8 : 2;
      ctx.strokeStyle = colours.ink;
      ctx.stroke();
      if (motion.balls > 1 || s.over) return;
      const speed = Math.hypot(s.vx, s.vy);
      if (!(speed > 0)) return;
      const [dx, dy] = [s.vx / speed, stage.up ? -s.vy / speed : s.vy / speed];
      W.arrow(ctx, x + dx * radius, y + dy * radius, x + dx * (radius + 20), y + dy * (radius + 20), colours.ink);
    }

    // Exactly at a contact: its normal, so that the law of reflection can be seen.
    drawContact(ctx, colours) {
      const { motion, stage } = this;
      const i = W.lastContact(motion, this.time);
      if (i < 0 || motion.time[i] !== this.time) return;
      const nx = motion.nx[i];
      const ny = stage.up ? -motion.ny[i] : motion.ny[i];
      const radius = motion.radius[motion.ball[i]] * stage.scale;
      const [x, y] = [stage.screenX(motion.contactX(i)) - nx * radius, stage.screenY(motion.contactY(i)) - ny * radius];
      W.arrow(ctx, x, y, x + nx * (2 * radius + 34), y + ny * (2 * radius + 34), colours.normal);
      ctx.beginPath();
      ctx.arc(x, y, 4, 0, 2 * Math.PI);
      ctx.fillStyle = colours.normal;
      ctx.fill();
    }

    showClock() {
      const duration = this.shownDuration();
      const scrub = this.part("scrub");
      if (document.activeElement !== scrub || this.playing) scrub.value = duration > 0 ? this.time / duration : 0;
      const text = `${W.number(this.time)} s of ${W.number(duration)} s`;
      scrub.setAttribute("aria-valuetext", text);
      scrub.style.setProperty("--done", `${duration > 0 ? (100 * this.time) / duration : 0}%`);
      this.part("clock").textContent = this.motion ? `${W.number(this.time)} s` : "";
    }
  }

  const STATE = {};
  const FLIGHT = {};

  // Adds a flight's path: from p with v for `span` seconds. The control point of the parabola is p + v span / 2.
  W.traceFlight = (ctx, stage, motion, f, span) => {
    if (!(span > 0)) return;
    if (f.bend) {
      traceSwing(ctx, stage, motion, f, span);
      return;
    }
    const far = Number.isFinite(span) ? span : (4 * (stage.width + stage.height)) / stage.scale / Math.max(Math.hypot(f.vx, f.vy), 1e-300);
    const [ax, ay] = [stage.screenX(f.x), stage.screenY(f.y)];
    const end = motion.carry({ ...f }, far);
    const [bx, by] = [stage.screenX(end.x), stage.screenY(end.y)];
    if (f.ax !== 0 || f.ay !== 0) {
      ctx.moveTo(ax, ay);
      ctx.quadraticCurveTo(stage.screenX(f.x + 0.5 * far * f.vx), stage.screenY(f.y + 0.5 * far * f.vy), bx, by);
      return;
    }
    const cut = W.cut(ax, ay, bx, by, stage);
    if (!cut) return;
    ctx.moveTo(cut[0], cut[1]);
    ctx.lineTo(cut[2], cut[3]);
  };

  // Adds the path of a ball on a circle, as chords of a few degrees; of one that goes to and fro, the first turns.
  const traceSwing = (ctx, stage, motion, f, span) => {
    const rho = Math.abs(f.bend);
    const rate = Math.max(Math.hypot(f.vx, f.vy) / rho, Math.sqrt(Math.hypot(f.ax, f.ay) / rho));
    const pieces = Math.min(Math.max(4, Math.ceil(12 * rate * span)), 200);
    const step = Math.min(span / pieces, 1 / (12 * rate));
    ctx.moveTo(stage.screenX(f.x), stage.screenY(f.y));
    for (let k = 1; k <= pieces; k++) {
      const at = motion.carry({ ...f }, k * step);
      ctx.lineTo(stage.screenX(at.x), stage.screenY(at.y));
    }
  };

  // A ball's colour: one of several along the ramp, as in films.
  W.colourOf = (ball, balls, { info, ramp }) => (balls === 1 ? info : ramp[Math.round((ball * (ramp.length - 1)) / (balls - 1))]);

  W.arrow = (ctx, ax, ay, bx, by, colour, width = 2) => {
    const length = Math.hypot(bx - ax, by - ay);
    if (!(length > 0)) return;
    const [dx, dy] = [(bx - ax) / length, (by - ay) / length];
    const head = Math.min(9, length);
    ctx.beginPath();
    ctx.moveTo(ax, ay);
    ctx.lineTo(bx - dx * head * 0.7, by - dy * head * 0.7);
    ctx.lineWidth = width;
    ctx.strokeStyle = colour;
    ctx.stroke();
    ctx.beginPath();
    ctx.moveTo(bx, by);
    ctx.lineTo(bx - head * dx + head * 0.45 * dy, by - head * dy - head * 0.45 * dx);
    ctx.lineTo(bx - head * dx - head * 0.45 * dy, by - head * dy + head * 0.45 * dx);
    ctx.closePath();
    ctx.fillStyle = colour;
    ctx.fill();
  };

  // A number for people: about five figures, no digits that say nothing.
  W.number = (value, figures = 5) => {
    if (!Number.isFinite(value)) return "–";
    const size = Math.abs(value);
    if (size !== 0 && (size >= 1e7 || size < 1e-4)) return value.toExponential(2).replace("e+", "e");
    const decimals = Math.max(0, Math.min(4, figures - 1 - Math.floor(Math.log10(Math.max(size, 1)))));
    return value.toFixed(Math.min(decimals, 3));
  };

  W.typing = (element) =>
    element instanceof HTMLElement && (element.isContentEditable || element.matches("input:not([type=range], [type=checkbox], [type=radio], [type=button]), textarea"));

  // Light or dark as the reader prefers, or as the page was told.
  W.theme = () => {
    const told = document.documentElement.dataset.theme;
    return told || (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");
  };
  W.colours = () => W.data.colours[W.theme()];

  W.MANY = MANY;
  W.Player = Player;
})();
