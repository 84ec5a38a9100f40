// Panel: the controls of the world and of the walls, and the list of problems.
(() => {
  "use strict";
  const W = (globalThis.Wallkit ??= {});
  const $ = (id) => document.getElementById(id);

  class Panel {
    constructor(page) {
      this.page = page;
      this.touched = new Set(); // materials that the person set; the others stay as in the file
      this.listenAim();
      this.listenWorld();
      this.listenWalls();
    }

    listenAim() {
      for (const id of ["speed", "angle", "radius", "ball-x", "ball-y"]) $(id).addEventListener("input", () => this.readAim());
    }

    readAim() {
      const { ball } = this.page.aim;
      if (!ball) return;
      const { units } = this.page.player;
      const [speed, radius] = ["speed", "radius"].map((id) => units.drawn(positive(id)));
      const [x, y] = ["ball-x", "ball-y"].map((id) => units.drawn(number(id)));
      const angle = (number("angle") * Math.PI) / 180;
      if (![speed, radius, angle, x, y].every(Number.isFinite)) return;
      Object.assign(ball, { vx: speed * Math.cos(angle), vy: speed * Math.sin(angle), radius, x, y });
      this.page.aim.suitArrow(this.page.size);
      this.page.forgetShot();
      this.page.foretell();
      this.page.player.wake();
      this.showAim();
    }

    // Angles are those of --angle: from the x axis towards the y axis of the drawing, which in SVG points down.
    showAim() {
      const { ball, seconds } = this.page.aim;
      if (!ball) return;
      const span = seconds === 1 ? "in a second" : `in ${seconds} s`;
      $("aim-hint").textContent = `Drag from the ball to aim, also in mid-flight. The arrow is how far it goes ${span}.`;
      const { units } = this.page.player;
      put("speed", units.shown(Math.hypot(ball.vx, ball.vy)));
      put("angle", (Math.atan2(ball.vy, ball.vx) * 180) / Math.PI);
      put("radius", units.shown(ball.radius));
      put("ball-x", units.shown(ball.x));
      put("ball-y", units.shown(ball.y));
    }

    spread() {
      const degrees = number("spread");
      return ((Number.isFinite(degrees) ? Math.min(Math.abs(degrees), 360) : 20) * Math.PI) / 180;
    }

    listenWorld() {
      $("gravity").addEventListener("input", () => {
        put("gravity-number", this.page.player.units.shown(strength(Number($("gravity").value), this.page.size)));
        this.worldChanged();
      });
      $("gravity-number").addEventListener("input", () => {
        const value = positive("gravity-number");
        if (!Number.isFinite(value)) return;
        $("gravity").value = inverse(this.page.player.units.drawn(value), this.page.size);
        this.worldChanged();
      });
      for (const id of ["friction", "drag"]) $(id).addEventListener("input", () => positive(id) >= 0 && this.worldChanged());
      $("metre").addEventListener("input", () => this.measureIn(positive("metre")));
      $("gravity-way").addEventListener("change", () => this.worldChanged());
      for (const id of ["restitution", "tangential"]) {
        $(id).addEventListener("input", () => {
          this.touched.add(id);
          this.worldChanged();
        });
      }
    }

    // So many of the drawing's units are a metre; NaN or 0: lengths are told in the drawing's own units.
    measureIn(metre) {
      const { player, readOut } = this.page;
      const friction = player.units.drawn(positive("friction"));
      const gravity = player.units.drawn(positive("gravity-number"));
      player.units.metre = metre > 0 ? metre : null;
      if (friction >= 0) put("friction", player.units.shown(friction));
      if (gravity >= 0) put("gravity-number", player.units.shown(gravity));
      this.showAim();
      this.showUnits();
      player.stage.touch();
      readOut.refresh(true);
    }

    showUnits() {
      const { units } = this.page.player;
      for (const label of document.querySelectorAll("[data-rate]")) label.dataset.unit = units.name + label.dataset.rate;
      $("own-unit").textContent = units.own || "units";
      $("metre-row").hidden = units.own === "m";
    }

    worldChanged() {
      this.showSliders();
      this.page.changed();
    }

    showSliders() {
      for (const id of ["gravity", "restitution", "tangential"]) {
        $(id).style.setProperty("--done", `${100 * Number($(id).value)}%`);
      }
      for (const id of ["restitution", "tangential"]) {
        const made = this.touched.has(id) ? null : this.page.document?.materials; // a bumper's is beyond the slider
        const value = made ? made[id === "restitution" ? id : "tangential_restitution"] : Number($(id).value);
        document.querySelector(`output[for=${id}]`).textContent = made?.mixed ? "mixed" : value.toFixed(2);
      }
    }

    // What acts, in the drawing's axes, as the server takes it.
    world() {
      const { units } = this.page.player;
      return {
        gravity: this.gravity(units.drawn(positive("gravity-number"))),
        rolling_friction: positive("friction") > 0 ? units.drawn(positive("friction")) : null,
        drag: positive("drag") > 0 ? positive("drag") : null,
        restitution: this.touched.has("restitution") ? Number($("restitution").value) : null,
        tangential_restitution: this.touched.has("tangential") ? Number($("tangential").value) : null,
      };
    }

    // As in the file, to the last bit, until somebody changes it.
    gravity(size) {
      if (!(size > 0)) return null;
      const [gx, gy] = this.fileGravity;
      const known = Math.hypot(gx, gy);
      const up = this.page.stage.up ? 1 : -1;
      const way = $("gravity-way").value;
      if (way === "file") return size === known ? [gx, gy] : [(gx / known) * size, (gy / known) * size];
      return { down: [0, -up], up: [0, up], left: [-1, 0], right: [1, 0] }[way].map((part) => part * size);
    }

    listenWalls() {
      for (const radio of document.querySelectorAll("[name=curves]")) {
        radio.addEventListener("change", () => this.importAgain());
      }
      $("tolerance").addEventListener("change", () => this.importAgain());
    }

    importAgain() {
      const { page } = this;
      const tolerance = number("tolerance");
      const curves = document.querySelector("[name=curves]:checked").value;
      page.importing.ask({ document: page.document.id, curves, tolerance: tolerance > 0 ? tolerance : null });
    }

    show(made, again) {
      $("file-name").textContent = $("file-name").title = document.title = made.name;
      $("file-facts").textContent = made.facts;
      $("walls-facts").textContent = made.exactness;
      $("walls-section").hidden = !made.drawn;
      if (made.drawn) {
        put("tolerance", made.tolerance);
        for (const radio of document.querySelectorAll("[name=curves]")) radio.checked = radio.value === made.curves;
      }
      if (!again) {
        $("metre").value = "";
        this.page.player.units.metre = null;
        this.showWorld(made);
        this.page.balls.show();
      }
      this.showUnits();
      this.showAim();
      this.showSliders();
      this.list(made.problems);
      $("assumed").hidden = !made.assumed.length;
      $("assumed").querySelector("ul").replaceChildren(...made.assumed.map((words) => element("li", "", words)));
    }

    showWorld(made) {
      this.touched.clear();
      $("restitution").value = made.materials.restitution;
      $("tangential").value = made.materials.tangential_restitution;
      const [gx, gy] = made.gravity ?? [0, 0];
      const size = Math.hypot(gx, gy);
      put("gravity-number", this.page.player.units.shown(size));
      put("friction", this.page.player.units.shown(made.rolling_friction ?? 0));
      put("drag", made.drag ?? 0);
      $("gravity").value = inverse(size, this.page.size);
      this.fileGravity = [gx, gy];
      const up = made.walls.y_axis === "up" ? 1 : -1;
      const name = gx === 0 ? (gy * up > 0 ? "up" : "down") : gy === 0 ? (gx > 0 ? "right" : "left") : "file";
      const select = $("gravity-way");
      select.querySelector("[value=file]")?.remove();
      if (name === "file") select.add(new Option("as in the file", "file"));
      select.value = size > 0 ? name : "down";
    }

    list(problems) {
      $("problem-count").textContent = String(problems.length);
      const items = problems.map((problem, index) => this.item(problem, index));
      if (!items.length) items.push(element("li", "note", "Nothing was found."));
      $("problems").replaceChildren(...items);
    }

    item(problem, index) {
      const item = element("li", problem.severity);
      const button = element("button");
      button.type = "button";
      const place = problem.x === null ? "" : ` at (${short(problem.x)}, ${short(problem.y)})`;
      const named = [problem.layer, problem.name].filter(Boolean).join(" · ");
      const head = element("span", "", problem.message + (named ? ` (${named})` : ""));
      const fix = element("span", "fix", [problem.fix, place.trim()].filter(Boolean).join(" — "));
      const mark = element("span", "number", String(index + 1));
      mark.setAttribute("aria-label", problem.severity);
      button.append(mark, head, fix);
      button.title = problem.text;
      button.addEventListener("click", () => this.choose(index, true));
      item.append(button);
      return item;
    }

    // Marks a problem in the list and in the picture, and goes to it when asked.
    choose(index, go) {
      const { page } = this;
      [...$("problems").children].forEach((item, i) => item.setAttribute("aria-current", String(i === index)));
      if (!go) $("problems").children[index].scrollIntoView({ block: "nearest" });
      page.player.chosen = index;
      const problem = page.document.problems[index];
      if (go && problem.x !== null) page.stage.goTo(problem.x, problem.y);
      else page.player.wake();
    }
  }

  const element = (name, className = "", text = "") => {
    const made = document.createElement(name);
    if (className) made.className = className;
    made.textContent = text;
    return made;
  };

  const short = (value) => String(Number(value.toPrecision(6)));
  // A field shows six figures of a number; as long as nobody changes them, it means the number itself.
  const exact = new Map();
  const number = (id) => {
    const text = $(id).value.trim();
    const known = exact.get(id);
    if (known?.text === text) return known.value;
    return text === "" ? NaN : Number(text);
  };
  const positive = (id) => (number(id) >= 0 ? number(id) : NaN);
  const put = (id, value) => {
    if (document.activeElement === $(id)) return;
    $(id).value = String(Number(Number(value).toPrecision(6)));
    exact.set(id, { text: $(id).value, value: Number(value) });
  };

  // The slider is finer near 0: at its end a ball falls through the picture in less than a second.
  const strength = (part, size) => 4 * size * part * part;
  const inverse = (value, size) => Math.min(1, Math.sqrt(value / (4 * size)));

  W.element = element;
  W.Panel = Panel;
})();
