// Numbers of a bounce: the velocity's parts along and across the wall before and after it, as a table and, where the
// clock stands exactly at it, as arrows in the drawing.
(() => {
  "use strict";
  const W = (globalThis.Wallkit ??= {});

  const PERIOD = 80; // milliseconds between changes of the text while playing
  const LONG = 90; // pixels of the longer of the two arrows
  W.FRAMES = 60; // a second, of the frames that are counted where no way has its own

  class BounceTable {
    constructor(host, player) {
      this.host = host;
      this.player = player;
      this.frames = W.FRAMES;
      this.told = { motion: null, contact: -1, units: "" };
      this.shown = 0;
      player.decorations.push((ctx, colours) => this.draw(ctx, colours));
    }

    // The contact that is told: the last one, of the ball that is followed where several fly.
    get contact() {
      const { motion, time, followed } = this.player;
      if (!motion) return -1;
      const exact = W.lastContact(motion, time);
      if (exact >= 0 && motion.time[exact] === time) return exact;
      return W.lastContact(motion, time, motion.balls > 1 ? Math.min(followed, motion.balls - 1) : -1);
    }

    refresh() {
      const now = performance.now();
      if (this.player.playing && now - this.shown < PERIOD) return;
      this.shown = now;
      const { motion, units } = this.player;
      const { contact, told } = this;
      if (told.motion === motion && told.contact === contact && told.units === units.name + units.per) return;
      this.told = { motion, contact, units: units.name + units.per };
      this.host.toggleAttribute("data-empty", contact < 0);
      if (contact < 0) for (const cell of this.host.querySelectorAll("[data-value]")) this.set(cell.dataset.value, "–");
      else this.tell(W.bounceParts(motion, contact));
    }

    tell(bounce) {
      const { units, stage } = this.player;
      for (const when of ["before", "after"]) {
        const told = bounce[when];
        for (const name of ["across", "along", "speed"]) this.set(`${name}-${when}`, signed(units.shown(told[name])));
        this.set(`angle-${when}`, degrees(told.angle));
        this.set(`slope-${when}`, degrees(90 - told.angle));
      }
      this.set("unit", `${units.name}/s`);
      this.set("normal", bounce.normal.map((part) => signed(part)).join(", "));
      const axis = stage.up ? "y upwards" : "y downwards";
      this.host.querySelector("[data-value=normal]").title = `x to the right, ${axis}, as in the drawing`;
      const name = this.player.motion.balls > 1 ? `, ${this.player.nameOf(bounce.ball)}` : "";
      this.set("when", `${W.number(bounce.time)} s${name}`);
      const [frame, part] = frameOf(bounce.time, this.frames);
      this.set("frames", `${Number(this.frames.toPrecision(4))}`);
      this.set("frame", `${frame.toLocaleString("en")} + ${part.toFixed(3)}`);
    }

    set(name, text) {
      const cell = this.host.querySelector(`[data-value=${name}]`);
      if (cell.textContent !== text) cell.textContent = text;
    }

    // Exactly at a contact: the velocity before, which ends at the ball, and after, each with its parts.
    draw(ctx, colours) {
      const { motion, time, stage } = this.player;
      const contact = motion ? W.lastContact(motion, time) : -1;
      if (contact < 0 || motion.time[contact] !== time || motion.balls > W.MANY) return;
      const bounce = W.bounceParts(motion, contact);
      const fastest = Math.max(bounce.before.speed, bounce.after.speed);
      if (!(fastest > 0)) return;
      const down = stage.up ? -1 : 1;
      const [nx, ny] = [bounce.normal[0], down * bounce.normal[1]];
      const [wx, wy] = [bounce.wall[0], down * bounce.wall[1]];
      const at = [stage.screenX(bounce.x), stage.screenY(bounce.y)];
      for (const [told, begins] of [[bounce.before, -1], [bounce.after, 1]]) {
        const [across, along] = [(begins * told.across * LONG) / fastest, (begins * told.along * LONG) / fastest];
        const tip = [at[0] + nx * across + wx * along, at[1] + ny * across + wy * along];
        this.drawParts(ctx, colours, at, tip, [at[0] + wx * along, at[1] + wy * along], told);
        if (begins < 0) W.arrow(ctx, ...tip, ...at, colours.muted, 2.2);
        else W.arrow(ctx, ...at, ...tip, colours.info, 2.2);
      }
    }

    // The parts as a right angle under the arrow: along the wall from the ball, then across it to the arrow's end.
    drawParts(ctx, colours, at, tip, corner, told) {
      const { units } = this.player;
      ctx.setLineDash([3, 4]);
      ctx.lineWidth = 1.2;
      ctx.strokeStyle = colours.muted;
      ctx.beginPath();
      ctx.moveTo(...at);
      ctx.lineTo(...corner);
      ctx.lineTo(...tip);
      ctx.stroke();
      ctx.setLineDash([]);
      const label = (a, b, value, aside) => {
        if (Math.hypot(a[0] - b[0], a[1] - b[1]) < 26) return;
        const [x, y] = [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
        W.words(ctx, W.number(units.shown(Math.abs(value)), 4), x + aside, y + 4, colours, colours.ink, "center");
      };
      label(at, corner, told.along, 0);
      label(corner, tip, told.across, 24 * Math.sign(corner[0] - at[0]));
    }
  }

  // Which frame of so many a second the time lies in, and how far in it, 0 to 1.
  const frameOf = (time, frames) => {
    const whole = Math.floor(time * frames);
    return [whole, time * frames - whole];
  };

  const signed = (value) => W.number(Math.abs(value) < 1e-12 ? 0 : value).replace("-", "−");
  const degrees = (value) => (Number.isFinite(value) ? `${value.toFixed(2)}°` : "–");

  W.BounceTable = BounceTable;
})();
