// The replay: one run, played from the contacts that the page carries.
(() => {
  "use strict";
  const W = globalThis.Wallkit;

  const start = () => {
    W.data = JSON.parse(document.getElementById("wallkit-data").textContent);
    const find = (selector) => document.querySelector(selector);
    const stage = new W.Stage(find("#stage"));
    const player = new W.Player(stage, find("#transport"));
    const readOut = new W.ReadOut(find("#read-out"), player);
    const picture = new W.WallPicture(W.data.walls);
    find("h1").textContent = document.title = W.data.title;
    find("#notes").textContent = W.data.run.left_out;
    find("#notes").hidden = !W.data.run.left_out;
    W.showLesson(W.data.lesson);
    document.body.classList.toggle("with-lesson", W.data.lesson !== null);
    W.showLegend(W.data.walls.legend);
    W.sheet(W.data.lesson ? "Lesson and numbers" : "Numbers");
    const frames = W.data.frames && new W.Frames(W.data.frames);
    if (frames) player.decorate = (ctx, colours) => W.drawFrames(ctx, player, frames, colours);
    W.showBoxes(player);
    W.viewButtons(stage);
    const instruments = new W.Instruments(player);
    player.onframe = () => {
      readOut.refresh();
      instruments.refresh();
    };
    player.showWalls(picture);
    stage.show(W.data.box, picture.up);
    instruments.begin(W.data.box);
    player.load(new W.Motion(W.data.run));
    instruments.graphs.fit();
    player.suitRate();
    W.replay = { stage, player, frames, instruments }; // for tests: where a place lands (stage.screenX, screenY), what the clock says
    if (!W.stillness()) player.play();
  };

  if (document.getElementById("wallkit-replay")) start();
})();
