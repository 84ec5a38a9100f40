// Where a ball is that glides along an arc, or pivots about a vertex: a pendulum, as in wallkit/kernels/flight/pendulum.py,
// which says why no digit is lost. Directions are from the centre of the circle; phi is given as t = tan(phi / 2).
(() => {
  "use strict";
  const W = (globalThis.Wallkit ??= {});

  // Carlson's R_F(x, y, z) by duplication.
  const carlson = (x, y, z) => {
    if ((x <= 0) + (y <= 0) + (z <= 0) > 1) return Infinity;
    let mean = (x + y + z) / 3;
    let apart = 380 * Math.max(Math.abs(mean - x), Math.abs(mean - y), Math.abs(mean - z));
    let [dx, dy] = [mean - x, mean - y];
    while (apart > mean) {
      const [rx, ry, rz] = [Math.sqrt(x), Math.sqrt(y), Math.sqrt(z)];
      const more = rx * ry + ry * rz + rz * rx;
      [x, y, z, mean] = [(x + more) / 4, (y + more) / 4, (z + more) / 4, (mean + more) / 4];
      [dx, dy, apart] = [dx / 4, dy / 4, apart / 4];
    }
    const [p, q] = [dx / mean, dy / mean];
    const r = -(p + q);
    const [e2, e3] = [p * q - r * r, p * q * r];
    return (1 - e2 / 10 + e3 / 14 + (e2 * e2) / 24 - (3 * e2 * e3) / 44) / Math.sqrt(mean);
  };

  // Sine and cosine of half the angle between the unit e and gravity.
  const half = (ex, ey, gx, gy) => {
    const pull = Math.hypot(gx, gy);
    const [cosine, sine] = [(ex * gx + ey * gy) / pull, Math.abs(ex * gy - ey * gx) / pull];
    const large = Math.sqrt(0.5 * (1 + Math.abs(cosine)));
    return cosine >= 0 ? [(0.5 * sine) / large, large] : [large, (0.5 * sine) / large];
  };

  const turned = (ex, ey, tx, ty, t) => {
    const [c, s] = [(1 - t * t) / (1 + t * t), (2 * t) / (1 + t * t)];
    return [c * ex + s * tx, c * ey + s * ty];
  };

  // Time of the turn t from e, at the speed v, to f, at u, within one quarter between the bottom and the top.
  const timeOf = (rho, gx, gy, [ex, ey], [fx, fy], t, v, u) => {
    if (!(t > 0)) return 0;
    const [s0, c0] = half(ex, ey, gx, gy);
    const [s1, c1] = half(fx, fy, gx, gy);
    const a = s1 * c1 * v + s0 * c0 * u;
    const b = s1 * c0 * u + s0 * c1 * v;
    const c = s1 * c0 * v + s0 * c1 * u;
    const rise = (t / Math.sqrt(1 + t * t)) * (s0 * c1 + c0 * s1);
    return 2 * rho * rise * carlson(a * a, b * b, c * c);
  };

  // Carries a state on for a time on the circle of signed radius `bend` (above 0 its centre lies behind the wall) whose
  // normal is (nx, ny).
  W.swing = (state, bend, nx, ny, gx, gy, span) => {
    const rho = Math.abs(bend);
    let [ex, ey] = bend > 0 ? [nx, ny] : [-nx, -ny];
    let v = state.vy * ex - state.vx * ey;
    let [dx, dy, since, first] = [0, 0, 0, true];
    for (let quarter = 0; quarter < 40; quarter++) {
      const pull = gy * ex - gx * ey;
      if (v === 0 && pull === 0) break;
      const turn = v > 0 || (v === 0 && pull > 0) ? 1 : -1;
      const [tx, ty, square] = [-turn * ey, turn * ex, v * v];
      const [along, across] = [gx * tx + gy * ty, gx * ex + gy * ey];
      const speed = (t) => Math.sqrt(Math.max(square + ((4 * rho * t) / (1 + t * t)) * (along - t * across), 0));
      const ahead = along > 0 ? across : -across;
      const atEnd = Math.abs(along) <= 2 ** -50 * Math.abs(across) || ahead <= 0;
      let t = atEnd ? 1 : Math.min(Math.abs(along) / (Math.hypot(along, across) + ahead), 1);
      const [a, h] = [square - 4 * rho * across, 2 * rho * along];
      const root = Math.sqrt(h * h - a * square); // where it turns: a t^2 + 2 h t + v^2 = 0
      const stops = h >= 0 ? (a < 0 ? -(h + root) / a : Infinity) : square / (root - h);
      const turns = stops < t;
      if (turns) t = stops;
      let f = turned(ex, ey, tx, ty, t);
      let u = turns ? 0 : speed(t);
      const time = timeOf(rho, gx, gy, [ex, ey], f, t, Math.abs(v), u);
      const ends = since + time > span;
      if (ends) {
        let [low, high] = [0, t];
        for (let step = 0; step < 60 && low < high; step++) {
          const middle = 0.5 * (low + high);
          if (middle === low || middle === high) break;
          const late = timeOf(rho, gx, gy, [ex, ey], turned(ex, ey, tx, ty, middle), middle, Math.abs(v), speed(middle));
          if (since + late > span) high = middle;
          else low = middle;
        }
        t = low;
        f = turned(ex, ey, tx, ty, t);
        u = speed(t);
      }
      const sine = (2 * t) / (1 + t * t);
      [dx, dy] = [dx + sine * (tx - t * ex), dy + sine * (ty - t * ey)];
      [ex, ey] = f;
      v = turn * u;
      if (ends) break;
      since += time;
      const lowest = ex * gx + ey * gy > 0 && Math.abs(ex * gy - ey * gx) <= 2 ** -50 * (Math.abs(gx) + Math.abs(gy));
      if (first && lowest && !turns) {
        first = false;
        const [g, top] = [Math.hypot(gx, gy), 4 * Math.hypot(gx, gy) * rho];
        const whole =
          v * v < top ? 4 * Math.sqrt(rho / g) * carlson(0, 1 - (v * v) / top, 1) : 4 * rho * carlson(0, v * v - top, v * v);
        if (Number.isFinite(whole)) since += Math.floor((span - since) / whole) * whole;
      }
    }
    [state.x, state.y] = [state.x + rho * dx, state.y + rho * dy];
    [state.vx, state.vy] = [-v * ey, v * ex];
    return state;
  };
})();
