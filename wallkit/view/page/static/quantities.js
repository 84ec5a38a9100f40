// Quantities: what is told of a ball at a time, each from its exact state, and the parts of a bounce.
(() => {
  "use strict";
  const W = (globalThis.Wallkit ??= {});

  // Each gives a number from a state {x, y, vx, vy} of ball b, in the drawing's units; `power` is that of the length in
  // its unit. Energy and angular momentum are per mass.
  W.QUANTITIES = {
    // Against gravity, from the lowest place that the ball can reach, where its potential energy is 0 too; without
    // gravity upwards on the screen, from the lower rim of the drawing.
    height: {
      name: "Height",
      power: 1,
      rate: "",
      of: (s, b, { motion, stage }) => {
        if (motion.gravity) return (motion.lowest[b] - along(motion, s)) / Math.hypot(...motion.gravity);
        return stage.up ? s.y - stage.box[1] : stage.box[3] - s.y;
      },
    },
    speed: { name: "Speed", power: 1, rate: "/s", of: (s) => Math.hypot(s.vx, s.vy) },
    // v^2 / 2 - g . x, as Motion.energy has it; its first part alone is `part`.
    energy: {
      name: "Energy",
      power: 2,
      rate: "²/s²",
      of: (s, b, { motion }) => (s.vx * s.vx + s.vy * s.vy) / 2 + (motion.gravity ? motion.lowest[b] - along(motion, s) : 0),
      part: (s) => (s.vx * s.vx + s.vy * s.vy) / 2,
    },
    // (p - c) x v about the point c, above 0 where the ball goes round it anticlockwise on the screen.
    spin: {
      name: "Angular momentum",
      power: 2,
      rate: "²/s",
      of: (s, b, { about, stage }) => {
        const value = (s.x - about.x) * s.vy - (s.y - about.y) * s.vx;
        return stage.up ? value : -value;
      },
    },
  };

  const along = (motion, s) => motion.gravity[0] * s.x + motion.gravity[1] * s.y;

  // A ball's state that stands where its run ended.
  W.stateAt = (motion, ball, time, into = {}) => {
    const state = motion.state(ball, time, into);
    if (!state.over) return state;
    [state.x, state.y] = [motion.end.x[ball], motion.end.y[ball]];
    [state.vx, state.vy] = [motion.end.vx[ball], motion.end.vy[ball]];
    return state;
  };

  // The last contact up to t, of ball b or of any (b < 0); -1 without one.
  W.lastContact = (motion, t, ball = -1) => {
    if (ball < 0) return motion.passed(t) - 1;
    const passed = motion.passedOf(ball, t);
    return passed ? motion.ofBall[motion.first[ball] + passed - 1] : -1;
  };

  // The velocity of contact i's ball just before and after it, in parts along the normal n and along the wall, which is
  // counted in the direction that the ball has: v = (v . n) n + (v . w) w with w across n.
  W.bounceParts = (motion, i) => {
    const ball = motion.ball[i];
    let [low, high] = [motion.first[ball], motion.first[ball + 1]];
    while (low < high) {
      const middle = (low + high) >>> 1;
      if (motion.ofBall[middle] < i) low = middle + 1;
      else high = middle;
    }
    const flight = motion.flight(ball, low - motion.first[ball], {});
    const before = motion.carry(flight, Math.max(0, motion.time[i] - flight.time));
    const [nx, ny] = [motion.nx[i], motion.ny[i]];
    const way = before.vy * nx - before.vx * ny < 0 ? -1 : 1;
    return {
      ball,
      time: motion.time[i],
      x: motion.contactX(i),
      y: motion.contactY(i),
      normal: [nx, ny],
      wall: [-ny * way, nx * way],
      before: parts(before.vx, before.vy, nx, ny, way),
      after: parts(motion.vx[i], motion.vy[i], nx, ny, way),
    };
  };

  // `across` is v . n, `along` the part along the wall; `angle` is that to the normal, in degrees.
  const parts = (vx, vy, nx, ny, way) => {
    const across = vx * nx + vy * ny;
    const along = way * (vy * nx - vx * ny);
    const angle = (Math.atan2(Math.abs(along), Math.abs(across)) * 180) / Math.PI;
    return { across, along, speed: Math.hypot(vx, vy), angle: Math.hypot(vx, vy) > 0 ? angle : NaN };
  };
})();
