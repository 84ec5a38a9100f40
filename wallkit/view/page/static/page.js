// The page of `wallkit play`: it holds what the person chose, asks the library for walls and contacts, and shows both.
(() => {
  "use strict";
  const W = globalThis.Wallkit;
  const $ = (id) => document.getElementById(id);

  const FAN = 100;
  const COMPUTING = "Computing…";
  const LOOK = 200; // milliseconds between two questions whether the file was saved
  const FIRST = 12; // crossings of the picture that the first request covers; more is asked for while it plays

  class Page {
    constructor() {
      this.stage = new W.Stage($("stage"));
      this.player = new W.Player(this.stage, $("transport"));
      this.readOut = new W.ReadOut($("read-out"), this.player);
      this.aim = new W.Aim(this.player);
      this.instruments = new W.Instruments(this.player);
      this.windows = new W.Windows(this);
      this.document = null;
      this.shot = null; // {balls, until, alone} of the run that is shown
      this.player.onframe = () => this.eachFrame();
      this.player.more = () => this.wantsMore();
      this.aim.changed = () => this.aimed();
      this.aim.placed = () => this.togglePlacing(false);
      this.stage.tap = (place) => this.tapped(place);
      this.foretelling = new W.Lane("api/simulate", (answer) => this.foretold(answer), (words, code) => this.unclear(words, code));
      this.flying = new W.Lane("api/simulate", (answer, asked) => this.flown(answer, asked), (words, code) => this.unflown(words, code));
      this.importing = new W.Lane("api/walls", (answer) => this.show(answer, true), (words) => this.complain(words));
      this.following = new W.Lane("api/saved", (answer) => this.followed(answer), (words) => this.unread(words));
      W.viewButtons(this.stage);
      W.showBoxes(this.player);
      this.gallery = new W.Gallery(this);
      this.controls = new W.Panel(this);
      this.balls = new W.BallList(this);
      this.ways = new W.Ways(this);
      this.panels = new W.Panels(this);
      this.checks = new W.Checks(this);
      W.sheet("Controls", [$("shots")]);
      this.listen();
    }

    listen() {
      $("shoot").addEventListener("click", () => this.shoot());
      $("fan").addEventListener("click", () => this.shootFan());
      $("place").addEventListener("click", () => this.togglePlacing());
      $("message").querySelector("button").addEventListener("click", () => ($("message").hidden = true));
      for (const button of document.querySelectorAll("[data-save]")) {
        button.addEventListener("click", () => this.save(button.dataset.save));
      }
      document.addEventListener("keydown", (event) => this.key(event));
    }

    key(event) {
      if (event.ctrlKey || event.metaKey || event.altKey || W.typing(event.target) || !this.document) return;
      if (!$("gallery").hidden) return void (event.key === "Escape" && this.gallery.close());
      const act = {
        Enter: event.target.closest?.("button, summary, a, select, label, input") ? null : () => this.shoot(),
        s: () => this.shoot(),
        f: () => this.shootFan(),
        p: () => this.togglePlacing(),
        0: () => this.stage.fit(),
        Escape: () => this.togglePlacing(false),
      }[event.key.length === 1 ? event.key.toLowerCase() : event.key];
      if (!act || (event.key === "0" && event.target === this.stage.front)) return;
      event.preventDefault();
      act();
    }

    // A document has arrived: its walls, problems and balls. `again` keeps the view, the balls and the shot.
    show(document, again = false) {
      this.document = document;
      $("message").hidden = true;
      this.gallery.close();
      const picture = new W.WallPicture(document.walls);
      this.player.showWalls(picture, document.problems);
      if (!again) {
        this.stage.show(document.box, picture.up);
        this.instruments.begin(document.box);
        this.aim.set(document.balls.map((ball) => ({ ...ball })));
        this.aim.suitArrow(this.size);
        this.forgetShot();
        this.stage.front.focus({ preventScroll: true });
      }
      this.controls.show(document, again);
      W.showLesson(document.lesson);
      if (!again) this.ways.choice.set(document.lesson?.way ?? "exact", document.lesson?.dt);
      W.showLegend(document.walls.legend);
      this.windows.show(document, again);
      if (this.shot) this.rerun();
      else this.foretell();
      this.checks.look();
      this.follow();
    }

    // A file of this machine: ask now and then whether it was saved, and show it anew from where we stand.
    follow() {
      clearTimeout(this.follower);
      if (!this.document.watched) return;
      const { id, version } = this.document;
      this.follower = setTimeout(() => this.following.ask({ document: id, version }), LOOK);
    }

    followed(answer) {
      if (answer.id !== this.document.id) return void this.follow();
      const world = (made) => JSON.stringify([made.gravity, made.rolling_friction, made.drag, made.materials]);
      const changed = world(answer) !== world(this.document);
      this.document = answer;
      if (changed) this.controls.showWorld(answer); // the file says so; else what the person chose stays
      this.show(answer, true);
    }

    unread(words) {
      this.complain(words);
      this.follow();
    }

    get size() {
      const [x0, y0, x1, y1] = this.document.box;
      return Math.hypot(x1 - x0, y1 - y0) || 1;
    }

    question() {
      return { document: this.document.id, ...this.controls.world() };
    }

    // The same with the frames to be shown, in one panel or two.
    flight() {
      return { ...this.question(), ...this.ways.question(), ...this.panels.question() };
    }

    foretell() {
      if (!this.document || !this.aim.ball) return;
      this.aim.foretell(this.foretelling, this.question());
      this.windows.find();
    }

    foretold(answer) {
      this.aim.foretold = new W.Motion(answer);
      this.say("");
      this.player.wake();
    }

    // The library cannot tell (a ball inside a wall, mostly): said quietly, since aiming goes on.
    unclear(words, code) {
      this.aim.foretold = null;
      this.say(words.split("\n")[0].replace(/^wallkit: /, ""), code);
      this.player.wake();
    }

    unflown(words, code) {
      if (code === "overlap") this.unclear(words, code);
      else this.complain(words);
    }

    say(words, code) {
      $("toast").textContent = words;
      $("toast").hidden = !words;
      this.checks.offer(code);
    }

    complain(words) {
      this.say("");
      $("message").querySelector("pre").textContent = words;
      $("message").hidden = false;
    }

    aimed() {
      this.forgetShot();
      this.controls.showAim();
      this.foretell();
    }

    forgetShot() {
      this.shot = null;
      this.asking = false;
      this.flying.forget();
      this.player.pause();
      this.player.time = 0;
      this.player.load(null);
      this.ways.load(null);
      this.panels.load(null);
      this.readOut.refresh(true);
    }

    // World or walls changed: the run that is shown is computed anew, from its start, and shown at the same time.
    changed() {
      if (this.shot) this.rerun();
      else this.foretell();
    }

    rerun() {
      this.flying.ask({ ...this.flight(), ...this.shot, again: true });
      this.sayWhenSlow();
    }

    sayWhenSlow() {
      clearTimeout(this.slow);
      this.slow = setTimeout(() => this.flying.busy && this.say(COMPUTING), 500);
    }

    shoot() {
      if (this.document && this.aim.ball) this.fly(this.aim.balls.map((ball) => ({ ...ball })));
    }

    // A hundred balls from the chosen one's place, spread evenly around its direction.
    shootFan() {
      if (!this.document || !this.aim.ball) return;
      const { ball } = this.aim;
      const speed = Math.hypot(ball.vx, ball.vy);
      const middle = Math.atan2(ball.vy, ball.vx);
      const spread = this.controls.spread();
      this.fly(Array.from({ length: FAN }, (_, i) => {
        const way = middle + spread * (i / (FAN - 1) - 0.5);
        return { ...ball, vx: speed * Math.cos(way), vy: speed * Math.sin(way) };
      }), true);
    }

    // Balls of a fan start at one place: they fly alone, where others meet.
    fly(balls, alone = false) {
      this.say("");
      this.togglePlacing(false);
      const speed = Math.max(...balls.map((ball) => Math.hypot(ball.vx, ball.vy)));
      const { gravity } = this.controls.world();
      const falling = gravity ? Math.sqrt(Math.hypot(...gravity) * this.size) : 0;
      const until = (FIRST * this.size) / Math.max(speed, falling, 1e-6 * this.size);
      this.shot = { balls, until, alone };
      this.asking = false;
      this.flying.ask({ ...this.flight(), ...this.shot });
      this.sayWhenSlow();
    }

    flown(answer, asked) {
      if ($("toast").textContent === COMPUTING) this.say("");
      const motion = new W.Motion(answer);
      motion.openEnded = true;
      motion.partial = answer.partial;
      this.asking = false;
      if (answer.partial) setTimeout(() => this.wantsMore(), 1500); // meanwhile the compiler works
      this.shot = { balls: asked.balls, until: asked.until, alone: asked.alone };
      this.ways.load(answer);
      this.panels.load(answer);
      if (asked.again) return this.player.load(motion);
      this.player.time = 0;
      this.player.load(motion);
      this.instruments.graphs.fit();
      this.player.suitRate();
      this.player.play();
    }

    // While playing, more of the run is asked for in good time: the same run, to a later end.
    wantsMore() {
      const { motion } = this.player;
      if (!motion || !this.shot || !(motion.partial || motion.ending.includes("time reached"))) return false;
      if (!this.asking) {
        this.asking = true;
        const until = (motion.partial ? 1 : 2) * this.shot.until;
        this.flying.ask({ ...this.flight(), ...this.shot, until, again: true });
      }
      return true;
    }

    eachFrame() {
      const { motion } = this.player;
      if (this.player.playing && motion && !motion.partial && this.player.time > 0.6 * motion.duration) this.wantsMore();
      this.readOut.refresh();
      this.panels.follow();
      this.instruments.refresh();
    }

    tapped(place) {
      const problems = this.player.pins && this.document ? this.document.problems : [];
      const hit = problems.findIndex(({ x, y, severity }, index) => {
        if (x === null || y === null || (severity === "info" && index !== this.player.chosen)) return false;
        return Math.hypot(this.stage.screenX(x) - place.x, this.stage.screenY(y) - place.y) < 36;
      });
      if (hit >= 0) this.controls.choose(hit, false);
    }

    togglePlacing(on = !this.aim.placing) {
      this.aim.setPlacing(on);
      $("place").setAttribute("aria-pressed", String(on));
      if (on) this.say("Click where the ball shall be");
      else if ($("toast").textContent.startsWith("Click")) this.say("");
    }

    async open(name, blob) {
      await this.asked(`api/open?name=${encodeURIComponent(name)}`, blob);
    }

    // Opens something; what was still being opened is given up.
    async asked(path, body) {
      this.opening?.abort();
      const opening = (this.opening = new AbortController());
      document.body.classList.add("busy");
      try {
        this.show(await W.ask(path, body, opening.signal));
      } catch (error) {
        if (error instanceof W.Refused) this.complain(error.message);
        else if (!W.takenBack(error)) throw error;
      } finally {
        if (this.opening === opening) document.body.classList.remove("busy");
      }
    }

    async save(what) {
      if (!this.document) return;
      const { motion, time } = this.player;
      const seen = ["picture", "film"].includes(what) && time > 0;
      const until = seen ? time : motion ? motion.duration : undefined;
      const { balls, alone } = this.shot ?? this.aim;
      try {
        const response = await W.ask("api/save", { ...this.flight(), balls, alone, until, what });
        const name = /filename="([^"]+)"/.exec(response.headers.get("Content-Disposition"))[1];
        const link = document.createElement("a");
        link.href = URL.createObjectURL(await response.blob());
        link.download = name;
        link.click();
        setTimeout(() => URL.revokeObjectURL(link.href), 10000);
        this.say(`${name} is saved`);
      } catch (error) {
        if (!(error instanceof W.Refused)) throw error;
        this.complain(error.message);
      }
    }
  }

  W.data = JSON.parse($("wallkit-data").textContent);
  W.page = new Page(); // for tests: .stage (screenX, screenY), .player (time, motion, frameTimes), .aim, .document
  W.page.gallery.begin();
})();
