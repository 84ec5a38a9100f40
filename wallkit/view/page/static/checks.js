// Checks: what the page asks beside runs. Leaks and all else that is doubtful, and room for a ball that overlaps a wall.
(() => {
  "use strict";
  const W = (globalThis.Wallkit ??= {});
  const $ = (id) => document.getElementById(id);

  class Checks {
    constructor(page) {
      this.page = page;
      this.looking = new W.Lane("api/check", (answer, asked) => this.found(answer, asked), () => {});
      this.settling = new W.Lane("api/settle", (answer) => this.settled(answer), (words) => page.complain(words));
      $("settle").addEventListener("click", () => this.settle());
    }

    // Asked once the walls are shown, so that a large drawing opens no later; what opening found stands meanwhile.
    look() {
      this.looking.ask({ document: this.page.document.id });
    }

    found({ problems }, asked) {
      const { page } = this;
      if (asked.document !== page.document.id) return;
      page.document.problems = page.player.problems = problems;
      page.player.chosen = -1;
      page.controls.list(problems);
      page.player.wake();
    }

    // Offers to move balls beside the words of a refusal, where that would help.
    offer(code) {
      $("settle").hidden = code !== "overlap";
    }

    settle() {
      const { page } = this;
      this.settling.ask({ ...page.question(), balls: page.aim.balls });
    }

    settled({ balls }) {
      const { page } = this;
      page.aim.set(balls, page.aim.chosen);
      page.aimed();
      page.stage.front.focus({ preventScroll: true });
    }
  }

  W.Checks = Checks;
})();
