// Frames: a ball as a program that steps by frames has it, hollow, beside the exact one.
(() => {
  "use strict";
  const W = (globalThis.Wallkit ??= {});

  const MOST = 2000; // places behind a ball that are drawn

  class Frames {
    constructor(told) {
      this.dt = told.dt;
      this.balls = told.balls;
      this.x = W.column(told.x); // frame by frame, in each ball by ball
      this.y = W.column(told.y);
      this.count = this.x.length / this.balls;
    }

    // Such a program shows the latest frame that has ended.
    at(time) {
      return Math.min(Math.floor(time / this.dt + 1e-9), this.count - 1);
    }

    draw(ctx, player, colours) {
      const { stage, motion } = player;
      const last = this.at(player.time);
      ctx.globalAlpha = 1;
      ctx.strokeStyle = ctx.fillStyle = colours.warning;
      for (let b = 0; b < this.balls; b++) {
        const place = (f) => [stage.screenX(this.x[f * this.balls + b]), stage.screenY(this.y[f * this.balls + b])];
        const radius = Math.max(motion.radius[b] * stage.scale, 3.5);
        ctx.lineWidth = 1;
        for (let f = Math.max(0, last - MOST); f < last; f++) {
          ctx.beginPath();
          ctx.arc(...place(f), 2, 0, 2 * Math.PI);
          ctx.fill();
        }
        ctx.lineWidth = 2.5;
        ctx.beginPath();
        ctx.arc(...place(last), radius, 0, 2 * Math.PI);
        ctx.stroke();
      }
    }
  }

  W.Frames = Frames;
})();
