// Balls: the list of them, each with a name and a colour; they are added, removed, chosen, and placed by numbers.
(() => {
  "use strict";
  const W = (globalThis.Wallkit ??= {});
  const $ = (id) => document.getElementById(id);

  const LISTED = 50; // rows; what more there are is said
  const MOST = 1000; // balls, as the library takes them from the page
  const WAYS = 16; // directions in which a free spot beside a ball is looked for
  const APART = [3, 5, 8, 12, 18]; // radii from it
  const TURN = (40 * Math.PI) / 180; // a new ball flies so much aside of the one before

  class BallList {
    constructor(page) {
      this.page = page;
      this.aim = page.aim;
      this.player = page.player;
      this.list = $("ball-list");
      this.aim.picked = () => this.picked();
      this.player.standing = () => this.aim.balls;
      this.player.decorations.push((ctx, colours) => this.drawNames(ctx, colours));
      $("add-ball").addEventListener("click", () => this.add());
    }

    // Another ball was chosen, on the drawing or in the list.
    picked() {
      this.player.followed = this.aim.chosen;
      this.page.controls.showAim();
      this.page.foretell();
      this.show();
      this.player.wake();
    }

    choose(index) {
      this.aim.chosen = index;
      this.picked();
    }

    show() {
      const { balls } = this.aim;
      this.player.names = balls.map((ball) => ball.name);
      $("ball-count").textContent = balls.length.toLocaleString("en");
      const focus = document.activeElement?.dataset?.row;
      this.list.replaceChildren(...balls.slice(0, LISTED).map((ball, index) => this.row(ball, index)));
      $("more-balls").hidden = balls.length <= LISTED;
      $("more-balls").textContent = `and ${(balls.length - LISTED).toLocaleString("en")} more`;
      $("add-ball").disabled = balls.length >= MOST;
      if (focus) this.list.querySelector(`[data-row="${focus}"]`)?.focus();
      this.paint();
    }

    row(ball, index) {
      const item = W.element("li");
      const name = this.aim.balls[index].name || `ball ${index + 1}`;
      const pick = document.createElement("input");
      Object.assign(pick, { type: "radio", name: "ball", checked: index === this.aim.chosen });
      pick.addEventListener("change", () => this.choose(index));
      const swatch = W.element("canvas", "swatch");
      [swatch.width, swatch.height] = [32, 32];
      swatch.setAttribute("aria-hidden", "true");
      const field = document.createElement("input");
      Object.assign(field, { type: "text", value: name, maxLength: 40 });
      field.setAttribute("aria-label", `Name of ball ${index + 1}`);
      field.addEventListener("input", () => this.rename(index, field.value));
      const remove = W.element("button", "", "×");
      Object.assign(remove, { type: "button", disabled: this.aim.balls.length < 2 });
      remove.addEventListener("click", () => this.remove(index));
      [pick, field, remove].forEach((part, which) => (part.dataset.row = `${index} ${which}`));
      item.append(pick, swatch, field, remove);
      labelled(item, name);
      return item;
    }

    // The colours of the swatches: those in flight.
    paint() {
      const colours = W.colours();
      [...this.list.querySelectorAll("canvas")].forEach((swatch, index) => {
        const ctx = swatch.getContext("2d");
        ctx.beginPath();
        ctx.arc(16, 16, 13, 0, 2 * Math.PI);
        ctx.fillStyle = W.colourOf(index, this.aim.balls.length, colours);
        ctx.fill();
        ctx.lineWidth = 2;
        ctx.strokeStyle = colours.ink;
        ctx.stroke();
      });
    }

    rename(index, name) {
      this.aim.balls[index].name = name.trim();
      this.player.names[index] = name.trim();
      labelled(this.list.children[index], name.trim() || `ball ${index + 1}`);
      this.player.wake();
    }

    // A ball beside the chosen one, as large and as fast.
    add() {
      const { ball, balls } = this.aim;
      if (!ball || balls.length >= MOST) return;
      const [c, s] = [Math.cos(TURN), Math.sin(TURN)];
      const { name: _name, ...like } = ball;
      const made = { ...like, ...this.freeSpot(ball), vx: c * ball.vx - s * ball.vy, vy: s * ball.vx + c * ball.vy };
      this.aim.set([...balls, made], balls.length);
      this.changed();
    }

    remove(index) {
      const { balls, chosen } = this.aim;
      if (balls.length < 2) return;
      this.aim.set(balls.filter((_, at) => at !== index), Math.max(0, chosen > index ? chosen - 1 : Math.min(chosen, balls.length - 2)));
      this.changed();
      this.list.querySelectorAll("[type=radio]")[this.aim.chosen]?.focus();
    }

    changed() {
      this.player.followed = this.aim.chosen;
      this.page.aimed();
      this.show();
    }

    // A place near a ball that is as far from walls and other balls as a ball of its radius needs, and on the same side
    // of all walls; the nearest. Where there is none: beside it all the same, and the library says what is wrong.
    freeSpot(ball) {
      const { stage } = this.player;
      const unit = Math.max(ball.radius, 4 / stage.scale);
      const walls = this.lines();
      for (const apart of APART) {
        for (let k = 0; k < WAYS; k++) {
          const way = (2 * Math.PI * k) / WAYS;
          const place = { x: ball.x + apart * unit * Math.cos(way), y: ball.y + apart * unit * Math.sin(way) };
          if (this.free(place, ball, walls)) return place;
        }
      }
      return { x: ball.x + APART[0] * unit, y: ball.y };
    }

    // The walls as lines in pixels: [ax, ay, bx, by], ...
    lines() {
      const { picture, stage } = this.player;
      const lines = [];
      for (let w = 0; w < (picture?.count ?? 0); w++) {
        const points = picture.points(w, stage);
        for (let i = 0; i + 3 < points.length; i += 2) lines.push(points.slice(i, i + 4));
      }
      return lines;
    }

    free({ x, y }, ball, walls) {
      const { stage } = this.player;
      if (this.aim.balls.some((other) => Math.hypot(other.x - x, other.y - y) <= (other.radius + ball.radius) * 1.01)) return false;
      const [px, py, qx, qy] = [stage.screenX(x), stage.screenY(y), stage.screenX(ball.x), stage.screenY(ball.y)];
      const room = ball.radius * stage.scale + 1;
      return walls.every(([ax, ay, bx, by]) => distance(px, py, ax, ay, bx, by) > room && !cross(px, py, qx, qy, ax, ay, bx, by));
    }

    // Names stand beside the balls, at their start and in flight, where there are several but not very many.
    drawNames(ctx, colours) {
      const { player } = this;
      const { motion, stage, time } = player;
      const count = motion?.balls ?? this.aim.balls.length;
      if (count !== this.aim.balls.length || count < 2 || count > W.MANY) return;
      for (let b = 0; b < count; b++) {
        const { x, y } = motion ? W.stateAt(motion, b, time) : this.aim.balls[b];
        const reach = Math.max(this.aim.balls[b].radius * stage.scale, 4) + 4;
        W.words(ctx, player.nameOf(b), stage.screenX(x) + reach, stage.screenY(y) - reach / 2, colours);
      }
    }
  }

  // What the controls of a row are for, by the ball's name.
  const labelled = (item, name) => {
    item.querySelector("[type=radio]").setAttribute("aria-label", `Choose ${name}`);
    item.querySelector("button").setAttribute("aria-label", `Remove ${name}`);
    item.querySelector("button").title = `Remove ${name}`;
  };

  const distance = (px, py, ax, ay, bx, by) => {
    const [dx, dy] = [bx - ax, by - ay];
    const square = dx * dx + dy * dy;
    const part = square > 0 ? Math.min(1, Math.max(0, ((px - ax) * dx + (py - ay) * dy) / square)) : 0;
    return Math.hypot(px - ax - part * dx, py - ay - part * dy);
  };

  const side = (ax, ay, bx, by, x, y) => (bx - ax) * (y - ay) - (by - ay) * (x - ax);
  const cross = (px, py, qx, qy, ax, ay, bx, by) =>
    side(px, py, qx, qy, ax, ay) * side(px, py, qx, qy, bx, by) <= 0 && side(ax, ay, bx, by, px, py) * side(ax, ay, bx, by, qx, qy) <= 0;

  W.BallList = BallList;
})();
