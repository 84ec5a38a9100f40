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
      for (const id of ["speed", "angle", "radius"]) $(id).addEventListener("input", () => this.readAim());
    }

    readAim() {
      const { ball } = this.page.aim;
      if (!ball) return;
      const speed = positive("speed");
      const angle = (number("angle") * Math.PI) / 180;
      if (!Number.isFinite(speed) || !Number.isFinite(angle) || !Number.isFinite(positive("radius"))) return;
      Object.assign(ball, { vx: speed * Math.cos(angle), vy: speed * Math.sin(angle) });
      this.page.aim.suitArrow(this.page.size);
      for (const each of this.page.aim.balls) each.radius = positive("radius");
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
      put("speed", Math.hypot(ball.vx, ball.vy));
      put("angle", (Math.atan2(ball.vy, ball.vx) * 180) / Math.PI);
      put("radius", ball.radius);
    }

    spread() {
      const degrees = number("spread");
      return ((Number.isFinite(degrees) ? Math.min(Math.abs(degrees), 360) : 20) * Math.PI) / 180;
    }

    listenWorld() {
      $("gravity").addEventListener("input", () => {
        put("gravity-number", strength(Number($("gravity").value), this.page.size));
        this.worldChanged();
      });
      $("gravity-number").addEventListener("input", () => {
        const value = positive("gravity-number");
        if (!Number.isFinite(value)) return;
        $("gravity").value = inverse(value, this.page.size);
        this.worldChanged();
      });
      $("gravity-way").addEventListener("change", () => this.worldChanged());
      for (const id of ["restitution", "tangential"]) {
        $(id).addEventListener("input", () => {
          this.touched.add(id);
          this.worldChanged();
        });
      }
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
      const value = positive("gravity-number");
      const up = this.page.stage.up ? 1 : -1;
      const ways = { down: [0, -up], up: [0, up], left: [-1, 0], right: [1, 0], file: this.fileWay };
      const way = ways[$("gravity-way").value];
      return {
        gravity: value > 0 ? way.map((part) => part * value) : null,
        restitution: this.touched.has("restitution") ? Number($("restitution").value) : null,
        tangential_restitution: this.touched.has("tangential") ? Number($("tangential").value) : null,
      };
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
      if (!again) this.showWorld(made);
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
      put("gravity-number", size);
      $("gravity").value = inverse(size, this.page.size);
      this.fileWay = size > 0 ? [gx / size, gy / size] : [0, 0];
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
  const number = (id) => ($(id).value.trim() === "" ? NaN : Number($(id).value));
  const positive = (id) => (number(id) >= 0 ? number(id) : NaN);
  const put = (id, value) => {
    if (document.activeElement !== $(id)) $(id).value = String(Number(Number(value).toPrecision(6)));
  };

  // The slider is finer near 0: at its end a ball falls through the picture in less than a second.
  const strength = (part, size) => 4 * size * part * part;
  const inverse = (value, size) => Math.min(1, Math.sqrt(value / (4 * size)));

  W.element = element;
  W.Panel = Panel;
})();
