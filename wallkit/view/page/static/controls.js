// Controls that the page and the replay share: zoom buttons, light and dark, what is shown.
(() => {
  "use strict";
  const W = (globalThis.Wallkit ??= {});

  W.viewButtons = (stage) => {
    const acts = { in: () => stage.zoom(1.5), out: () => stage.zoom(1 / 1.5), fit: () => stage.fit() };
    for (const button of document.querySelectorAll("[data-view]")) {
      button.addEventListener("click", acts[button.dataset.view]);
    }
    document.querySelector("#theme").addEventListener("click", () => {
      document.documentElement.dataset.theme = W.theme() === "dark" ? "light" : "dark";
      stage.touch();
    });
  };

  // What measures and tells beside the balls: the table of a bounce, graphs, rulers, strobe ghosts.
  class Instruments {
    constructor(player) {
      this.player = player;
      this.bounce = new W.BounceTable(document.querySelector("#bounce"), player);
      this.graphs = new W.Graphs(document.querySelector("#graphs"), player);
      this.tools = new W.Tools(player);
      for (const box of document.querySelectorAll("[data-graph][type=checkbox]")) {
        box.addEventListener("change", () => this.choose(box.dataset.graph, box.checked));
      }
      document.querySelector("#strobe-every").addEventListener("input", (event) => {
        const seconds = Number(event.target.value);
        player.strobeChosen = seconds > 0;
        if (seconds > 0) player.strobeEvery = seconds;
        player.wake();
      });
    }

    // Another drawing: the angular momentum is counted about its middle until somebody says otherwise.
    begin([x0, y0, x1, y1]) {
      this.player.about = { x: (x0 + x1) / 2, y: (y0 + y1) / 2 };
      this.player.followed = 0;
      this.player.names = [];
      this.tools.clear();
    }

    choose(name, on) {
      this.graphs.choose(name, on);
      if (name === "spin") this.tools.pivot.on = on;
    }

    refresh() {
      this.bounce.refresh();
      this.graphs.refresh();
      this.tools.show();
    }
  }

  W.Instruments = Instruments;

  // The boxes "normals", "ghosts" and "paths", and their keys.
  W.showBoxes = (player) => {
    const boxes = [...document.querySelectorAll("[data-show]")];
    for (const box of boxes) {
      box.addEventListener("change", () => {
        player[box.dataset.show] = box.checked;
        player.stage.touch();
      });
    }
    document.addEventListener("keydown", (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey || W.typing(event.target)) return;
      boxes.find((box) => box.dataset.key === event.key.toLowerCase())?.click();
    });
  };
})();
