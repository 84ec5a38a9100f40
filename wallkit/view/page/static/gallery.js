// Gallery: the samples, and all ways in which a drawing comes to the page: drop, choose, paste.
(() => {
  "use strict";
  const W = (globalThis.Wallkit ??= {});
  const $ = (id) => document.getElementById(id);

  class Gallery {
    constructor(page) {
      this.page = page;
      this.fill();
      this.listen();
    }

    // Opens on the file that the command line named, else on the samples.
    begin() {
      if (W.data.refused) this.page.complain(W.data.refused);
      if (W.data.document) this.page.show(W.data.document);
      else this.open();
    }

    fill() {
      this.list("lesson-list", W.data.lessons);
      this.list("sample-list", W.data.samples);
    }

    list(id, samples) {
      const cards = samples.map((sample) => {
        const card = W.element("li");
        const button = W.element("button");
        button.type = "button";
        const image = new Image();
        image.src = `samples/${encodeURIComponent(sample.name)}?token=${encodeURIComponent(W.data.token)}`;
        image.alt = "";
        image.loading = "lazy";
        button.append(image, W.element("span", "name", sample.title), W.element("span", "about", sample.about));
        button.addEventListener("click", () => this.page.asked("api/sample", { name: sample.name }));
        card.append(button);
        return card;
      });
      $(id).replaceChildren(...cards);
    }

    open() {
      $("gallery").hidden = false;
      document.body.classList.add("gallery-open");
      $("samples-button").textContent = this.page.document ? "Back" : "Samples";
      $("samples-button").hidden = !this.page.document;
    }

    close() {
      $("gallery").hidden = true;
      document.body.classList.remove("gallery-open");
      $("samples-button").textContent = "Samples";
      $("samples-button").hidden = false;
    }

    listen() {
      $("samples-button").addEventListener("click", () => ($("gallery").hidden ? this.open() : this.close()));
      $("file").addEventListener("change", (event) => {
        const [file] = event.target.files;
        if (file) this.take(file.name, file);
        event.target.value = "";
      });
      document.addEventListener("dragover", (event) => {
        event.preventDefault();
        document.body.classList.add("dropping");
      });
      document.addEventListener("dragleave", (event) => {
        if (!event.relatedTarget) document.body.classList.remove("dropping");
      });
      document.addEventListener("drop", (event) => {
        event.preventDefault();
        document.body.classList.remove("dropping");
        const [file] = event.dataTransfer.files;
        const text = event.dataTransfer.getData("text/plain");
        if (file) this.take(file.name, file);
        else if (text) this.take("dropped text", new Blob([text]));
      });
      document.addEventListener("paste", (event) => {
        if (W.typing(event.target)) return;
        const [file] = event.clipboardData.files;
        const text = event.clipboardData.getData("text/plain");
        if (file) this.take(file.name, file);
        else if (text.trim()) this.take("pasted text", new Blob([text]));
      });
    }

    take(name, blob) {
      const most = W.data.limits.body;
      if (blob.size > most) this.page.complain(`${name} is larger than ${most / 2 ** 20} MiB, the most that the page takes`);
      else this.page.open(name, blob);
    }
  }

  W.Gallery = Gallery;
})();
