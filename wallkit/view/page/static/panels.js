// Panels: the same balls in a second world, beside the first: another way, restitution or gravity. Both have one clock
// and one view; the first panel has the hand.
(() => {
  "use strict";
  const W = (globalThis.Wallkit ??= {});
  const $ = (id) => document.getElementById(id);

  // A player without a clock or a bar of its own.
  class Mirror extends W.Player {
    fillRates() {}
    listen() {}
    showClock() {}
    showPlaying() {}

    load(motion) {
      this.motion = motion;
      this.stage.touch();
    }
  }

  class Panels {
    constructor(page) {
      this.page = page;
      this.on = false;
      this.frames = null;
      this.mirror = null;
      $("two-panels").addEventListener("click", () => this.open(!this.on));
    }

    open(on) {
      if (!this.mirror) this.make();
      this.on = on;
      $("two-panels").setAttribute("aria-pressed", String(on));
      document.body.classList.toggle("two-panels", on);
      for (const id of ["stage-b", "other", "caption-a", "caption-b"]) $(id).hidden = !on;
      if (!on) this.load(null);
      this.page.stage.fit();
      this.caption();
      this.page.changed();
    }

    // The second stage and its controls, once somebody wants them.
    make() {
      const { page } = this;
      $("other").append($("second-panel").content.cloneNode(true));
      for (const layer of ["back", "front"]) {
        const canvas = W.element("canvas");
        canvas.dataset.layer = layer;
        canvas.setAttribute("aria-hidden", "true");
        $("stage-b").append(canvas);
      }
      this.mirror = new Mirror(new W.Stage($("stage-b")), $("stage-b"));
      this.mirror.wake = () => page.player.wake(); // it is drawn with the first one
      this.mirror.pins = false;
      this.mirror.decorate = (ctx, colours) => this.decorate(ctx, colours);
      const fields = { way: $("way-b"), slider: $("dt-slider-b"), number: $("dt-b") };
      this.choice = new W.WayChoice(fields, () => page.changed());
      for (const id of ["restitution-b", "gravity-b"]) $(id).addEventListener("input", () => page.changed());
    }

    // What the second panel has of its own; an empty field is as in the first.
    question() {
      if (!this.on) return {};
      const other = this.choice.setting();
      if (valid("restitution-b")) other.restitution = Number($("restitution-b").value);
      if (valid("gravity-b")) other.gravity = this.gravity(this.page.player.units.drawn(Number($("gravity-b").value)));
      return { other };
    }

    // As strong as said, in the direction of the first panel's; down where that has none.
    gravity(size) {
      const [gx, gy] = this.page.controls.world().gravity ?? [0, this.page.stage.up ? -1 : 1];
      const whole = Math.hypot(gx, gy);
      return size > 0 ? [(gx / whole) * size, (gy / whole) * size] : null;
    }

    load(answer) {
      if (!this.mirror) return;
      const other = answer?.other;
      this.frames = other?.stepped ? new W.Frames(other.stepped) : null;
      this.mirror.load(other ? new W.Motion(other) : null);
      const apart = answer?.apart ?? null;
      const part = !other ? "" : apart === null ? "The panels never part." : `The panels part at ${W.number(apart)} s.`;
      $("other-facts").textContent = [part, this.frames ? `Second panel: ${this.frames.sentence}.` : ""].join(" ").trim();
      this.caption();
    }

    decorate(ctx, colours) {
      const { stage } = this.mirror;
      if (this.frames) W.drawFrames(ctx, this.mirror, this.frames, colours);
      ctx.strokeStyle = colours.ink;
      for (const { x, y, radius } of this.mirror.motion ? [] : this.page.aim.balls) {
        ctx.beginPath();
        ctx.arc(stage.screenX(x), stage.screenY(y), Math.max(radius * stage.scale, 4), 0, 2 * Math.PI);
        ctx.stroke();
      }
    }

    caption() {
      const { choice } = this.page.ways;
      $("caption-a").textContent = words(choice.setting());
      const own = [];
      if (valid("restitution-b")) own.push(`restitution ${$("restitution-b").value}`);
      if (valid("gravity-b")) own.push(`gravity ${$("gravity-b").value}`);
      $("caption-b").textContent = [words(this.choice.setting()), ...own].join(", ");
    }

    // Draws the second panel at the first one's time, from the same place.
    follow() {
      if (!this.on) return;
      const { stage, player } = this.page;
      const { mirror } = this;
      const view = ["x", "y", "scale", "up", "box"];
      if (view.some((name) => mirror.stage[name] !== stage[name])) {
        for (const name of view) mirror.stage[name] = stage[name];
        mirror.stage.dirty = true;
      }
      mirror.stage.fitted = false; // the first panel fits for both
      if (mirror.picture !== player.picture) mirror.showWalls(player.picture);
      for (const name of ["time", "normals", "ghosts", "trails"]) mirror[name] = player[name];
      if (this.theme !== W.theme() || this.normals !== player.normals) mirror.stage.dirty = true;
      [this.theme, this.normals] = [W.theme(), player.normals];
      mirror.draw();
    }
  }

  const words = ({ way, dt }) => (way === "exact" ? way : `${way}, dt ${dt} s`);
  const valid = (id) => $(id).value.trim() !== "" && $(id).validity.valid;

  W.Panels = Panels;
})();
