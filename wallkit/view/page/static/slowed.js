// What rolling friction and drag do to a ball under gravity, as in wallkit/kernels/flight/slowed_contact.py and
// wallkit/kernels/impact/drag_motion.py, which say why no digit is lost.
(() => {
  "use strict";
  const W = (globalThis.Wallkit ??= {});
  const WEIGHTS = [-1 / 302400, 8 / 945, -2187 / 4480, 65536 / 14175, -9765625 / 798336, 17496 / 1925];

  // What is left of a velocity after a time, its free time f and the second one s: p + v f + a s, v e^(-k t) + a f.
  W.eased = (drag, t) => {
    if (!drag) return [1, t, 0.5 * t * t];
    const x = drag * t;
    const [left, free] = [Math.exp(-x), -Math.expm1(-x) / drag];
    if (x >= 0.5) return [left, free, (t - free) / drag];
    let [term, total] = [0.5, 0.5];
    for (let n = 1; n < 18; n++) {
      term *= -x / (n + 2);
      total += term;
    }
    return [left, free, t * t * total];
  };

  // Acceleration, drag aside, of a ball on a straight wall of unit normal n: gravity along it, less friction.
  W.pullAlong = (friction, vx, vy, nx, ny, gx, gy) => {
    let [tx, ty] = [-ny, nx];
    let along = tx * gx + ty * gy;
    if ((tx * vx + ty * vy || along) < 0) [tx, ty, along] = [-tx, -ty, -along];
    const most = 2 ** -48 * (Math.abs(gx) + Math.abs(gy));
    if (friction && Math.abs(along) <= most) along = 0;
    const pull = along - ((friction ?? 0) / Math.hypot(gx, gy)) * Math.abs(gx * nx + gy * ny);
    return [pull * tx, pull * ty];
  };

  // Carries a state on, one way, on the circle of signed radius `bend` (above 0 its centre lies behind the wall).
  W.swingSlowed = (state, bend, nx, ny, gx, gy, friction, drag, span) => {
    const [rho, away, g] = [Math.abs(bend), Math.sign(bend), Math.hypot(gx, gy)];
    const [ex, ey] = bend > 0 ? [nx, ny] : [-nx, -ny];
    const [mu, k] = [(away * (friction ?? 0)) / g, drag ?? 0];
    const v = state.vy * ex - state.vx * ey;
    const turn = v > 0 || (v === 0 && gy * ex - gx * ey > 0) ? 1 : -1;
    const [tx, ty] = [-turn * ey, turn * ex];
    const [along, across] = [gx * tx + gy * ty, gx * ex + gy * ey];
    const faster = (angle, w) =>
      ((along + mu * across) * Math.cos(angle) + (mu * along - across) * Math.sin(angle)) / rho + w * (mu * w - k);
    // The change of the angle and of its speed in a step, by the midpoint rule in `count` parts.
    const midpoint = (angle, w, step, count) => {
      const part = step / count;
      let [a0, b0, a, b] = [0, 0, part * w, part * faster(angle, w)];
      for (let i = 1; i < count; i++) {
        const [now, speed] = [angle + a, w + b];
        [a, a0, b, b0] = [a0 + 2 * part * speed, a, b0 + 2 * part * faster(now, speed), b];
      }
      return [0.5 * (a + a0 + part * (w + b)), 0.5 * (b + b0 + part * faster(angle + a, w + b))];
    };
    let [angle, w] = [0, Math.abs(v) / rho];
    for (let leap = 0; leap < 100000 && span > 0; leap++) {
      const step = Math.min(span, 0.25 / ((1 + Math.abs(mu)) * (Math.abs(w) + Math.sqrt(g / rho)) + k));
      let [more, rise] = [0, 0];
      WEIGHTS.forEach((weight, i) => {
        const [a, b] = midpoint(angle, w, step, 2 * i + 2);
        [more, rise] = [more + weight * a, rise + weight * b];
      });
      if (w + rise < 0 && w > 0) break; // it turns here, to rounding: a contact comes
      [angle, w, span] = [angle + more, w + rise, span - step];
    }
    const [c, s] = [Math.cos(angle), Math.sin(angle)];
    const [sine, versed] = [rho * s, 2 * rho * Math.sin(angle / 2) ** 2];
    [state.x, state.y] = [state.x + sine * tx - versed * ex, state.y + sine * ty - versed * ey];
    [state.vx, state.vy] = [rho * w * (c * tx - s * ex), rho * w * (c * ty - s * ey)];
    return state;
  };
})();
