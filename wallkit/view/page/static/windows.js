// Windows: the target that the person chose, and all directions that reach it, drawn as wedges around the ball.
(() => {
  "use strict";
  const W = (globalThis.Wallkit ??= {});
  const $ = (id) => document.getElementById(id);

  const LENGTH = 120; // pixels of a wedge; the widest is longer
  const THIN = 0.8; // pixels that a wedge is wide at its end at least
  const FIRST_RADIUS = 0.015; // of the drawing's size, of a target that was clicked
  const BEND = 0.05; // radians of a wedge's rim that one line spans

  class Windows {
    constructor(page) {
      this.page = page;
      this.aim = page.aim;
      this.stage = page.stage;
      this.target = null; // {name, x, y, radius}
      this.found = null;
      this.asked = "";
      this.lane = new W.Lane("api/aim", (answer) => this.answered(answer), (words) => this.refused(words));
      this.aim.wedges = (ctx, colours, flying) => this.draw(ctx, colours, flying);
      $("target").addEventListener("change", () => this.choose($("target").value));
      $("target-bounces").addEventListener("input", () => this.find());
      $("pick-target").addEventListener("click", () => this.pick(!this.aim.aside));
    }

    // The targets that the level names can be chosen; one that was clicked stays as long as the drawing does.
    show(document, again) {
      const clicked = again && this.target?.clicked ? this.target : null;
      this.named = document.targets;
      const names = this.named.map(({ name, x, y }, index) => {
        const twice = this.named.some((other, at) => at !== index && other.name === name);
        return new Option(twice ? `${name} at ${Math.round(x)}, ${Math.round(y)}` : name, String(index));
      });
      $("target").replaceChildren(new Option("no target", ""), ...names);
      this.asked = "";
      if (clicked) this.set(clicked);
      else if (!again) this.set(null);
      else this.choose(this.named.findIndex(({ name }) => name === this.target?.name));
    }

    choose(index) {
      this.set(index === "" ? null : (this.named[Number(index)] ?? null));
    }

    set(target) {
      this.target = target;
      const at = this.named.indexOf(target);
      if (target?.clicked && !$("target").querySelector('[value="clicked"]')) {
        $("target").append(new Option("where you clicked", "clicked"));
      }
      $("target").value = target?.clicked ? "clicked" : at < 0 ? "" : String(at);
      this.found = null;
      this.find();
      this.page.player.wake();
    }

    pick(on) {
      this.aim.aside = on ? (place) => this.picked(place) : null;
      this.stage.host.classList.toggle("placing", on);
      $("pick-target").setAttribute("aria-pressed", String(on));
      this.page.say(on ? "Click where the target shall be" : "");
    }

    picked(place) {
      this.pick(false);
      const [x, y] = [this.stage.drawingX(place.x), this.stage.drawingY(place.y)];
      this.set({ clicked: true, x, y, radius: FIRST_RADIUS * this.page.size });
    }

    // Windows hang on where the ball is and how large, and on the world; on its speed only where something bends paths.
    find() {
      const { ball } = this.aim;
      const { target } = this;
      const bounces = Math.round(Number($("target-bounces").value));
      if (!target || !ball || !(bounces >= 0 && bounces <= 12)) {
        this.found = null;
        this.asked = "";
        this.lane.forget();
        $("windows-facts").textContent = "All directions that reach it, as wedges around the ball.";
        return;
      }
      const world = this.page.question();
      const speed = world.gravity ? Math.hypot(ball.vx, ball.vy) : 0;
      const wanted = { ...world, target: [target.x, target.y, target.radius], bounces };
      const asked = JSON.stringify([wanted, ball.x, ball.y, ball.radius, speed, this.page.document.version]);
      if (asked === this.asked) return;
      this.asked = asked;
      this.lane.ask({ ...wanted, balls: [ball] });
    }

    answered(answer) {
      this.found = answer;
      const { count, widest, total, certainty } = answer;
      const off = widest?.off.length ? `off ${widest.off.join(", ")}` : "straight";
      $("windows-facts").textContent = widest
        ? `${count} ${count === 1 ? "window" : "windows"}; the widest ${widest.width.toPrecision(3)}° at ` +
          `${widest.degrees.toFixed(3)}°, ${off}. A blind shot reaches it ${((100 * total) / (2 * Math.PI)).toPrecision(3)} ` +
          `times of 100. ${certainty[0].toUpperCase()}${certainty.slice(1)}.`
        : `No shot reaches it with so few bounces. ${certainty[0].toUpperCase()}${certainty.slice(1)}.`;
      this.page.player.wake();
    }

    refused(words) {
      this.found = null;
      $("windows-facts").textContent = words.split("\n")[0].replace(/^wallkit: /, "");
      this.page.player.wake();
    }

    draw(ctx, colours, flying) {
      const { target, found, stage } = this;
      if (!target) return;
      ctx.lineWidth = 1.8;
      ctx.strokeStyle = colours.error;
      ctx.beginPath();
      const size = Math.max(target.radius * stage.scale, 3);
      ctx.arc(stage.screenX(target.x), stage.screenY(target.y), size, 0, 2 * Math.PI);
      ctx.stroke();
      const { ball } = this.aim;
      if (!found || !ball || flying) return;
      ctx.fillStyle = colours.info;
      for (let i = 0; i < found.low.length; i++) {
        ctx.globalAlpha = Math.max(0.16, 0.5 - 0.08 * found.bounces[i]);
        this.wedge(ctx, ball, found.low[i], found.high[i], LENGTH);
      }
      if (found.widest) this.name(ctx, colours, ball, found.widest);
      ctx.globalAlpha = 1;
    }

    wedge(ctx, ball, low, high, pixels) {
      const { stage } = this;
      const [x, y] = [stage.screenX(ball.x), stage.screenY(ball.y)];
      const long = (Math.max(ball.radius * stage.scale, 4) + pixels) / stage.scale;
      const thin = Math.max(0, THIN / pixels - (high - low)) / 2;
      const steps = Math.max(1, Math.ceil((high - low) / BEND));
      ctx.beginPath();
      ctx.moveTo(x, y);
      for (let k = 0; k <= steps; k++) {
        const angle = low - thin + ((high - low + 2 * thin) * k) / steps;
        ctx.lineTo(stage.screenX(ball.x + long * Math.cos(angle)), stage.screenY(ball.y + long * Math.sin(angle)));
      }
      ctx.closePath();
      ctx.fill();
    }

    name(ctx, colours, ball, { low, high, degrees, width }) {
      const { stage } = this;
      ctx.globalAlpha = 0.55;
      this.wedge(ctx, ball, low, high, 1.3 * LENGTH);
      const away = (Math.max(ball.radius * stage.scale, 4) + 1.3 * LENGTH + 8) / stage.scale;
      const angle = (degrees * Math.PI) / 180;
      const [x, y] = [ball.x + away * Math.cos(angle), ball.y + away * Math.sin(angle)];
      const [sx, sy] = [stage.screenX(x), stage.screenY(y)];
      ctx.globalAlpha = 1;
      ctx.font = "600 13px system-ui, sans-serif";
      ctx.textAlign = sx < stage.screenX(ball.x) ? "right" : "left";
      ctx.textBaseline = "middle";
      ctx.lineWidth = 4;
      ctx.strokeStyle = colours.paper;
      const words = `${width.toPrecision(3)}° wide`;
      ctx.strokeText(words, sx, sy);
      ctx.fillStyle = colours.ink;
      ctx.fillText(words, sx, sy);
      ctx.fillStyle = colours.info;
    }
  }

  W.Windows = Windows;
})();
