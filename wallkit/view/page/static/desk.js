// Desk: how the page asks the library. Every request carries the token; of requests that overtake one another
// only the latest counts.
(() => {
  "use strict";
  const W = (globalThis.Wallkit ??= {});

  class Refused extends Error {}

  // Posts JSON (or a file's bytes) and gives the answer; a refusal is an error with the library's own words.
  W.ask = async (path, body) => {
    const raw = body instanceof Blob;
    const response = await fetch(path, {
      method: "POST",
      headers: { "X-Wallkit-Token": W.data.token, "Content-Type": raw ? "application/octet-stream" : "application/json" },
      body: raw ? body : JSON.stringify(body ?? {}),
      cache: "no-store",
    }).catch(() => {
      throw new Refused("wallkit does not answer: is the command still running?");
    });
    const json = response.headers.get("Content-Type")?.startsWith("application/json");
    if (json && !response.headers.has("Content-Disposition")) {
      const answer = await response.json();
      if (answer.error) throw new Refused(answer.error);
      return answer;
    }
    if (!response.ok) throw new Refused(await response.text());
    return response;
  };

  // A lane has one request on its way and one that waits: the latest. Older ones are forgotten.
  class Lane {
    constructor(path, answered, refused) {
      Object.assign(this, { path, answered, refused, waiting: null, busy: false });
    }

    ask(body) {
      this.waiting = { body };
      if (!this.busy) this.go();
    }

    forget() {
      this.waiting = null;
      this.stale = this.busy;
    }

    async go() {
      this.busy = true;
      while (this.waiting) {
        const { body } = this.waiting;
        this.waiting = null;
        this.stale = false;
        try {
          const answer = await W.ask(this.path, body);
          if (!this.stale && !this.waiting) this.answered(answer, body);
        } catch (error) {
          if (!(error instanceof Refused)) throw error;
          if (!this.stale && !this.waiting) this.refused(error.message, body);
        }
      }
      this.busy = false;
    }
  }

  W.Refused = Refused;
  W.Lane = Lane;
})();
