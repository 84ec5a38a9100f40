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
