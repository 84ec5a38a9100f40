// Aim: the balls at their start, drawn with their velocities and the path that the library predicts for the chosen
// one; a drag from a ball sets its velocity, as an arrow per second.
(() => {
  "use strict";
  const W = (globalThis.Wallkit ??= {});

  const REACH = 24; // pixels around a ball that still grab it
  const FORETOLD = 24; // bounces
  const SPANS = [1, 0.5, 2, 0.2, 5, 0.1, 10, 0.05, 20, 0.02, 50, 0.01, 100, 0.005, 0.002, 0.001, 1e-4, 1e-5, 1e-6];

  class Aim {
    constructor(player) {
      this.player = player;
      this.stage = player.stage;
      this.balls = []; // {x, y, vx, vy, radius}
      this.chosen = 0;
      this.seconds = 1;
      this.foretold = null;
      this.changed = () => {};
      this.placed = () => {};
      this.picked = () => {}; // another ball was chosen
      this.wedges = () => {}; // draws what lies under the balls
      this.aside = null; // takes the next press: a click for something else than a ball
      this.placing = false;
      this.stage.grab = (place, event) => this.grab(place, event);
      this.stage.front.addEventListener("pointermove", (event) => this.hover(event));
      player.decorate = (ctx, colours) => this.draw(ctx, colours);
    }

    get ball() {
      return this.balls[this.chosen];
    }

    // The arrow is the way in so many seconds: one, unless that is too long or too short to be drawn.
    suitArrow(size) {
      const { ball } = this;
      const speed = ball ? Math.hypot(ball.vx, ball.vy) : 0;
      const good = (seconds) => speed * seconds < 0.45 * size && speed * seconds > 0.03 * size;
      if (!(speed > 0) || good(this.seconds)) return;
      this.seconds = SPANS.find(good) ?? this.seconds;
    }

    set(balls, chosen = 0) {
      this.balls = balls;
      this.chosen = chosen;
      this.foretold = null;
    }

    setPlacing(on) {
      this.placing = on;
      this.stage.host.classList.toggle("placing", on);
    }

    // The ball that a press means: one in flight where it is now, or one at its start; {index, x, y} or null.
    near({ x, y }) {
      const { stage } = this;
      let best = null;
      let least = Infinity;
      for (const place of [...this.inFlight(), ...this.balls.map((ball, index) => ({ index, x: ball.x, y: ball.y }))]) {
        const away = Math.hypot(stage.screenX(place.x) - x, stage.screenY(place.y) - y);
        const reach = Math.max(REACH, this.balls[place.index].radius * stage.scale);
        if (away <= reach && away < least) [best, least] = [place, away];
      }
      return best;
    }

    inFlight() {
      const { motion, time } = this.player;
      if (!motion || !(time > 0) || motion.balls !== this.balls.length) return [];
      return this.balls.map((_, index) => {
        const { x, y } = motion.state(index, time);
        return { index, x, y };
      });
    }

    hover(event) {
      if (event.pointerType === "touch") return;
      this.stage.host.classList.toggle("over-ball", !this.placing && this.near(this.stage.place(event)) !== null);
    }

    // A press on a ball is an aim, from where it is; with Shift it moves the ball. In placing mode a press on a ball, too,
    // and a press elsewhere moves the chosen ball there.
    grab(place, event) {
      if (this.aside) {
        this.aside(place);
        return { move: () => {}, end: () => {} };
      }
      const found = this.near(place);
      if (this.placing || (event?.shiftKey && found)) return this.shift(place, found);
      if (!found) return null;
      const other = this.chosen !== found.index;
      this.chosen = found.index;
      const before = { ...this.ball };
      let begun = false;
      return {
        move: (to) => {
          if (!begun) Object.assign(this.ball, { x: found.x, y: found.y });
          begun = true;
          this.pull(to);
        },
        end: (_to, cancelled) => {
          if (begun && cancelled) Object.assign(this.ball, before);
          if (begun) this.changed();
          if (other) this.picked();
          else this.player.wake();
        },
      };
    }

    shift(place, found) {
      if (found && found.index !== this.chosen) {
        this.chosen = found.index;
        this.picked();
      } else if (!found) this.moveTo(place);
      return { move: (to) => this.moveTo(to), end: () => this.placed() };
    }

    pull(to) {
      this.ball.vx = (this.stage.drawingX(to.x) - this.ball.x) / this.seconds;
      this.ball.vy = (this.stage.drawingY(to.y) - this.ball.y) / this.seconds;
      this.changed();
    }

    moveTo(to) {
      if (!this.ball) return;
      this.ball.x = this.stage.drawingX(to.x);
      this.ball.y = this.stage.drawingY(to.y);
      this.changed();
    }

    foretell(lane, question) {
      if (this.ball) lane.ask({ ...question, balls: [this.ball], bounces: FORETOLD });
    }

    // Once balls fly, only their start is marked; else they stand there with arrow and foretold path.
    draw(ctx, colours) {
      const flying = this.player.motion && this.player.time > 0;
      this.wedges(ctx, colours, flying);
      if (this.foretold && !this.player.motion) this.drawForetold(ctx, colours);
      this.balls.forEach((ball, index) => {
        const [x, y] = [this.stage.screenX(ball.x), this.stage.screenY(ball.y)];
        const radius = Math.max(ball.radius * this.stage.scale, 4);
        ctx.globalAlpha = flying ? 0.55 : 1;
        ctx.beginPath();
        ctx.arc(x, y, radius, 0, 2 * Math.PI);
        ctx.lineWidth = 1.5;
        ctx.strokeStyle = colours.ink;
        if (flying) ctx.setLineDash([3, 3]);
        if (!flying) {
          ctx.fillStyle = W.colourOf(index, this.balls.length, colours);
          ctx.fill();
        }
        ctx.stroke();
        ctx.setLineDash([]);
        if (!flying && index === this.chosen && this.balls.length > 1) ring(ctx, x, y, radius + 4, colours.info);
        this.drawArrow(ctx, ball, x, y, colours);
      });
      ctx.globalAlpha = 1;
    }

    drawArrow(ctx, ball, x, y, colours) {
      const tipX = this.stage.screenX(ball.x + ball.vx * this.seconds);
      const tipY = this.stage.screenY(ball.y + ball.vy * this.seconds);
      W.arrow(ctx, x, y, tipX, tipY, colours.ink, 2.2);
    }

    drawForetold(ctx, colours) {
      const motion = this.foretold;
      ctx.strokeStyle = colours.info;
      ctx.lineWidth = 1.6;
      ctx.setLineDash([7, 5]);
      const last = motion.first[1] - motion.first[0];
      for (let k = 0; k <= last; k++) {
        ctx.globalAlpha = 0.95 - (0.75 * k) / (last + 1);
        const f = motion.flight(0, k, FLIGHT);
        ctx.beginPath();
        W.traceFlight(ctx, this.stage, motion, f, f.until - f.time);
        ctx.stroke();
      }
      ctx.setLineDash([]);
      ctx.lineWidth = 1;
      for (let i = 0; i < motion.count; i++) {
        ctx.globalAlpha = 0.8 - (0.6 * i) / motion.count;
        ctx.beginPath();
        const radius = Math.max(motion.radius[0] * this.stage.scale, 2);
        ctx.arc(this.stage.screenX(motion.contactX(i)), this.stage.screenY(motion.contactY(i)), radius, 0, 2 * Math.PI);
        ctx.stroke();
      }
      ctx.globalAlpha = 1;
    }
  }

  const ring = (ctx, x, y, radius, colour) => {
    ctx.beginPath();
    ctx.arc(x, y, radius, 0, 2 * Math.PI);
    ctx.lineWidth = 2.5;
    ctx.strokeStyle = colour;
    ctx.stroke();
  };

  const FLIGHT = {};
  W.Aim = Aim;
})();
