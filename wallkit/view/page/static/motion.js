// The exact motion of balls, drawn from contacts: the state at any time is the state after the last contact,
// carried on in closed form. Nothing here computes a collision; the library has done that.
(() => {
  "use strict";
  const W = (globalThis.Wallkit ??= {});
  const TYPES = { f8: Float64Array, f4: Float32Array, i4: Int32Array, u1: Uint8Array };

  // A column travels as little-endian numbers in base64; every browser of today runs on such machines.
  W.column = ({ type, data }) => {
    const text = atob(data);
    const bytes = new Uint8Array(text.length);
    for (let i = 0; i < bytes.length; i++) bytes[i] = text.charCodeAt(i);
    return new TYPES[type](bytes.buffer);
  };

  const SLIDE = 2; // the kind of contact from which on a ball keeps to the wall (wallkit.Kind)
  const BALL = 6; // that of two balls that meet
  const FLY_ON = ["left the scene", "swings for ever"];

  // How many entries of the rising `times` are at most t (or below t); `at` maps a place to an index into times.
  const countUpTo = (t, length, at, below = false) => {
    let low = 0;
    let high = length;
    while (low < high) {
      const middle = (low + high) >>> 1;
      const value = at(middle);
      if (below ? value < t : value <= t) low = middle + 1;
      else high = middle;
    }
    return low;
  };

  // A run as the server or the replay gives it (see payload.py): contacts in order of time, all balls together.
  class Motion {
    constructor(run) {
      this.balls = run.balls;
      this.gravity = run.gravity?.some((part) => part !== 0) ? run.gravity : null;
      this.friction = run.rolling_friction;
      this.drag = run.drag;
      this.start = columns(run.start);
      this.end = columns(run.end);
      this.ending = run.ending;
      this.trusted = run.trusted;
      this.leftOut = run.left_out;
      this.duration = run.duration;
      this.radius = W.column(run.radius);
      this.lowest = W.column(run.lowest);
      this.mass = run.mass ? W.column(run.mass) : null; // over the mean of all, where balls meet
      Object.assign(this, columns(run.contacts)); // time, ball, x, y, vx, vy, nx, ny, wall, kind
      [this.originX, this.originY] = run.origin;
      this.count = this.time.length;
      this.sortByBall();
      this.countBounces();
    }

    // bounced[k]: how many of the first k contacts are bounces, for each of two balls that meet one; a slide that begins
    // or ends is none.
    countBounces() {
      this.bounced = new Int32Array(this.count + 1);
      for (let i = 0; i < this.count; i++) this.bounced[i + 1] = this.bounced[i] + (this.kind[i] < SLIDE || this.kind[i] === BALL);
    }

    // Lists each ball's contacts: ball b has ofBall[first[b]] to ofBall[first[b + 1] - 1].
    sortByBall() {
      this.first = new Int32Array(this.balls + 1);
      for (const ball of this.ball) this.first[ball + 1]++;
      for (let b = 0; b < this.balls; b++) this.first[b + 1] += this.first[b];
      const place = this.first.slice();
      this.ofBall = new Int32Array(this.count);
      for (let i = 0; i < this.count; i++) this.ofBall[place[this.ball[i]]++] = i;
    }

    contactX(i) {
      return this.originX + this.x[i];
    }

    contactY(i) {
      return this.originY + this.y[i];
    }

    // The number of this ball's contacts up to and with t.
    passedOf(ball, t) {
      const first = this.first[ball];
      return countUpTo(t, this.first[ball + 1] - first, (k) => this.time[this.ofBall[first + k]]);
    }

    // The number of all balls' contacts up to and with t.
    passed(t) {
      return countUpTo(t, this.count, (k) => this.time[k]);
    }

    // The number of all balls' bounces up to and with t.
    bounces(t) {
      return this.bounced[this.passed(t)];
    }

    // The flight number k of a ball: from its contact k - 1 (0: its start) to its contact k (or its end).
    flight(ball, k, into) {
      const first = this.first[ball];
      const last = this.first[ball + 1] - first;
      if (k > 0) {
        const i = this.ofBall[first + k - 1];
        into.time = this.time[i];
        into.x = this.contactX(i);
        into.y = this.contactY(i);
        into.vx = this.vx[i];
        into.vy = this.vy[i];
        into.contact = i;
      } else {
        into.time = 0;
        into.x = this.start.x[ball];
        into.y = this.start.y[ball];
        into.vx = this.start.vx[ball];
        into.vy = this.start.vy[ball];
        into.contact = -1;
      }
      into.until = k < last ? this.time[this.ofBall[first + k]] : this.endOf(ball);
      this.pull(into);
      return into;
    }

    // The acceleration of a flight, drag aside: gravity, or the part of it along the wall on which the ball slides, less
    // rolling friction. Where a ball glides along an arc, or pivots about a vertex, `bend` is the signed radius of its
    // centre's circle, else 0.
    pull(into) {
      [into.ax, into.ay] = this.gravity ?? [0, 0];
      into.bend = into.contact < 0 || !this.bend ? 0 : this.bend[into.contact];
      if (into.bend !== 0) return;
      if (!this.gravity || into.contact < 0 || this.kind[into.contact] !== SLIDE) return;
      const [nx, ny] = [this.nx[into.contact], this.ny[into.contact]];
      [into.ax, into.ay] = W.pullAlong(this.friction, into.vx, into.vy, nx, ny, into.ax, into.ay);
    }

    // A ball that left the scene flies on, one that swings for ever swings on; every other one stands where its run ended.
    endOf(ball) {
      return FLY_ON.includes(this.ending[ball]) ? Infinity : this.end.time[ball];
    }

    // Position and velocity at t, from the contact before t.
    state(ball, t, into = {}) {
      this.flight(ball, this.passedOf(ball, t), into);
      into.over = t > into.until;
      return this.carry(into, Math.max(0, Math.min(t, into.until) - into.time));
    }

    // Carries a state on: p + v dt + a dt^2 / 2 and v + a dt, or with drag as `eased` says. Without gravity rolling
    // friction f slows down by f until the ball stands, and the path is straight.
    carry(state, dt) {
      if (state.bend) {
        const [nx, ny] = [this.nx[state.contact], this.ny[state.contact]];
        if (this.friction || this.drag)
          return W.swingSlowed(state, state.bend, nx, ny, state.ax, state.ay, this.friction, this.drag, dt);
        return W.swing(state, state.bend, nx, ny, state.ax, state.ay, dt);
      }
      const speed = Math.hypot(state.vx, state.vy);
      // how much of v is gone through, and of a, and what is left of v
      let [kept, way, second] = W.eased(this.drag, dt);
      if (this.friction && !this.gravity && speed > 0) {
        const rolling = Math.min(dt, speed / this.friction);
        way = rolling * (1 - (0.5 * this.friction * rolling) / speed);
        kept = 1 - (this.friction * rolling) / speed;
      }
      state.x += way * state.vx + second * state.ax;
      state.y += way * state.vy + second * state.ay;
      state.vx = kept * state.vx + way * state.ax;
      state.vy = kept * state.vy + way * state.ay;
      return state;
    }

    // Energy per mass in (units/s)^2: v^2 / 2 - g . x, the height counted from the lowest place the ball can reach.
    energy(ball, t) {
      const s = this.state(ball, t);
      const [gx, gy] = this.gravity ?? [0, 0];
      return (s.vx * s.vx + s.vy * s.vy) / 2 - gx * s.x - gy * s.y + this.lowest[ball];
    }

    // The time of the next contact after t, of any ball; null without one.
    next(t) {
      const k = this.passed(t);
      return k < this.count ? this.time[k] : null;
    }

    // The time of the last contact before t; 0 without one.
    previous(t) {
      const k = countUpTo(t, this.count, (i) => this.time[i], true);
      return k > 0 ? this.time[k - 1] : 0;
    }
  }

  const columns = (table) =>
    Object.fromEntries(Object.entries(table).map(([name, packed]) => [name, W.column(packed)]));

  W.Motion = Motion;
})();
