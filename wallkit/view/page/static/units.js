// Units: what lengths are shown in. The drawing keeps its own; a person may say that so many of them are a metre, and
// every number on the page follows, while the library goes on in the drawing's units.
(() => {
  "use strict";
  const W = (globalThis.Wallkit ??= {});

  class Units {
    constructor() {
      this.own = "";
      this.metre = null; // so many of the drawing's units are a metre, or null
    }

    get name() {
      return this.metre ? "m" : this.own || "units";
    }

    // So many of the drawing's units are one of those shown.
    get per() {
      return this.metre ?? 1;
    }

    // A length of the drawing as a number that is shown, and back; `power` 2 for areas and energies per mass.
    shown(value, power = 1) {
      return value / this.per ** power;
    }

    drawn(value, power = 1) {
      return value * this.per ** power;
    }

    // With its unit, such as "1.25 m" or "31 px²/s".
    text(value, power = 1, rate = "") {
      const square = power === 2 && !rate.includes("²") ? "²" : "";
      return `${W.number(this.shown(value, power))} ${this.name}${square}${rate}`;
    }
  }

  // The largest of 1, 2, 5 times a power of ten that is not longer.
  W.roundLength = (length) => {
    const power = 10 ** Math.floor(Math.log10(length));
    return [5, 2, 1].map((step) => step * power).find((step) => step <= length * (1 + 1e-9)) ?? power;
  };

  // A bar of a round length at the stage's foot, as in pictures.
  W.scaleBar = (ctx, stage, units, colours) => {
    const wanted = Math.min(stage.width / 6, 160) / stage.scale;
    const length = W.roundLength(units.shown(wanted));
    const [x, y] = [14, stage.height - 16];
    const end = x + units.drawn(length) * stage.scale;
    ctx.lineWidth = 1.5;
    ctx.strokeStyle = colours.muted;
    ctx.beginPath();
    ctx.moveTo(x, y - 4);
    ctx.lineTo(x, y + 4);
    ctx.moveTo(x, y);
    ctx.lineTo(end, y);
    ctx.moveTo(end, y - 4);
    ctx.lineTo(end, y + 4);
    ctx.stroke();
    W.words(ctx, `${Number(length.toPrecision(1))} ${units.name}`, end + 8, y + 4, colours, colours.muted);
  };

  // Text on the drawing, with a rim of paper so that it can be read over lines.
  W.words = (ctx, text, x, y, colours, colour = colours.ink, align = "left") => {
    ctx.font = "13px system-ui, -apple-system, 'Segoe UI', sans-serif";
    ctx.textAlign = align;
    ctx.lineWidth = 3;
    ctx.lineJoin = "round";
    ctx.strokeStyle = colours.paper;
    ctx.strokeText(text, x, y);
    ctx.fillStyle = colour;
    ctx.fillText(text, x, y);
    ctx.textAlign = "left";
  };

  W.Units = Units;
})();
