// Legend: what the shades of the walls mean, where there is something to tell.
(() => {
  "use strict";
  const W = (globalThis.Wallkit ??= {});

  W.showLegend = (entries) => {
    const list = document.getElementById("legend");
    list.hidden = !entries.length;
    list.replaceChildren(...entries.map(({ shade, words }) => {
      const item = document.createElement("li");
      const swatch = document.createElement("span");
      swatch.className = "swatch";
      swatch.style.background = `var(--material${shade})`;
      item.append(swatch, words);
      return item;
    }));
  };
})();
