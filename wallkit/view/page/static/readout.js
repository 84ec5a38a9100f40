// Read-out: what is true of the balls at this moment, in words and numbers.
(() => {
  "use strict";
  const W = (globalThis.Wallkit ??= {});

  const PERIOD = 80; // milliseconds between changes of the text while playing

  class ReadOut {
    constructor(list, player) {
      this.player = player;
      this.list = list;
      this.shown = 0;
      this.part = (name) => list.querySelector(`[data-value=${name}]`);
    }

    refresh(force = false) {
      const now = performance.now();
      const { player } = this;
      const { motion, time } = player;
      if (motion) this.set("time", `${W.number(time)} s`);
      if (!force && player.playing && now - this.shown < PERIOD) return;
      this.shown = now;
      this.list.toggleAttribute("data-empty", !motion);
      if (!motion) {
        for (const part of this.list.querySelectorAll("dd")) part.textContent = "–";
        return;
      }
      const all = motion.openEnded ? "" : ` of ${motion.bounced[motion.count].toLocaleString("en")}`;
      this.set("bounces", motion.bounces(time).toLocaleString("en") + all);
      this.set("speed", this.speed(motion, time));
      this.set("energy", this.energy(motion, time));
      this.set("last", this.lastContact(motion, time));
      this.set("ending", endings(motion));
      this.horizon(motion, time);
    }

    set(name, text) {
      const element = this.part(name);
      if (element && element.textContent !== text) element.textContent = text;
    }

    // Of one ball its speed, of many the range.
    speed(motion, time) {
      let [least, most] = [Infinity, 0];
      for (let b = 0; b < motion.balls; b++) {
        const s = motion.state(b, time);
        const speed = s.over ? Math.hypot(motion.end.vx[b], motion.end.vy[b]) : Math.hypot(s.vx, s.vy);
        [least, most] = [Math.min(least, speed), Math.max(most, speed)];
      }
      const same = most - least <= 1e-9 * most;
      const { units } = this.player;
      const range = same ? [most] : [least, most];
      return `${range.map((speed) => W.number(units.shown(speed))).join(" to ")} ${units.name}/s`;
    }

    // Kinetic and potential energy of all balls per mass, and how much of the first is left.
    energy(motion, time) {
      let [now, first] = [0, 0];
      for (let b = 0; b < motion.balls; b++) {
        const mass = motion.mass ? motion.mass[b] : 1;
        now += mass * motion.energy(b, time);
        first += mass * motion.energy(b, 0);
      }
      const told = W.number(this.player.units.shown(now / motion.balls, 2));
      return first > 0 ? `${told} (${((100 * now) / first).toFixed(2)} %)` : told;
    }

    lastContact(motion, time) {
      const k = motion.passed(time);
      if (!k) return "none yet";
      const { picture } = this.player;
      const name = picture ? picture.label(motion.wall[k - 1]) : `wall ${motion.wall[k - 1]}`;
      const where = [name, `a corner of ${name}`, `slides on ${name}`, `leaves ${name}`][motion.kind[k - 1]] ?? "another ball";
      return motion.balls > 1 ? `${this.player.nameOf(motion.ball[k - 1])}: ${where}` : where;
    }

    // Where the path of the first ball stops being the path, and becomes one of many possible ones.
    horizon(motion, time) {
      const told = motion.trusted;
      const element = this.part("horizon");
      if (!element) return;
      element.closest("[data-row]").hidden = !told;
      if (!told) return;
      const beyond = !told.whole && time > told.time;
      element.toggleAttribute("data-beyond", beyond);
      this.set("horizon", beyond ? `${told.sentence} — now beyond it: one of many possible paths` : told.sentence);
    }
  }

  // The page asks for more while it plays, so that a run which reached its time goes on there.
  const endings = (motion) => {
    const counts = new Map();
    for (const ending of motion.ending) {
      const words = motion.openEnded && (motion.partial || ending === "time reached") ? "not yet" : ending;
      counts.set(words, (counts.get(words) ?? 0) + 1);
    }
    if (counts.size === 1) return [...counts.keys()][0];
    return [...counts].map(([words, count]) => `${count.toLocaleString("en")} ${words}`).join(", ");
  };

  W.ReadOut = ReadOut;
})();
