// Sheet: on a small screen the drawing has it all, and the panel is a sheet that a button opens below the drawing.
(() => {
  "use strict";
  const W = (globalThis.Wallkit ??= {});
  const $ = (id) => document.getElementById(id);

  const SMALL = "(max-width: 860px)"; // the same as in sheet.css

  // `quick` is what stays at hand in the bar while the sheet is shut.
  W.sheet = (label, quick = []) => {
    const button = $("sheet-button");
    const homes = quick.map((element) => [element, element.parentNode, element.nextElementSibling]);
    const small = matchMedia(SMALL);
    const open = (on) => {
      document.body.classList.toggle("sheet-open", on);
      button.setAttribute("aria-expanded", String(on));
      button.textContent = on ? "Close" : label;
    };
    const arrange = () => {
      if (small.matches) $("sheet-bar").prepend(...quick);
      else for (const [element, home, before] of homes) home.insertBefore(element, before);
    };
    button.addEventListener("click", () => open(!document.body.classList.contains("sheet-open")));
    $("panel").addEventListener("keydown", (event) => {
      if (event.key !== "Escape" || !small.matches) return;
      open(false);
      button.focus();
    });
    small.addEventListener("change", arrange);
    arrange();
    open(false);
  };
})();
