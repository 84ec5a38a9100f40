// Desk: how the page asks the library. Every request carries the token; of requests that overtake one another
// only the latest counts, and one that nobody waits for any more is taken back: the library ends its work.
(() => {
  "use strict";
  const W = (globalThis.Wallkit ??= {});

  const GRACE = 1000; // ms in which an answer may still come before its request is taken back

  class Refused extends Error {
    constructor(words, code = "") {
      super(words);
      this.code = code;
    }
  }

  // Posts JSON (or a file's bytes) and gives the answer; a refusal is an error with the library's own words.
  // `signal` takes the request back: the error is the browser's own AbortError then.
  W.ask = async (path, body, signal) => {
    const raw = body instanceof Blob;
    const response = await fetch(path, {
      method: "POST",
      headers: { "X-Wallkit-Token": W.data.token, "Content-Type": raw ? "application/octet-stream" : "application/json" },
      body: raw ? body : JSON.stringify(body ?? {}),
      cache: "no-store",
      signal,
    }).catch((error) => {
      if (signal?.aborted) throw error;
      throw new Refused("wallkit does not answer: is the command still running?");
    });
    const json = response.headers.get("Content-Type")?.startsWith("application/json");
    if (json && !response.headers.has("Content-Disposition")) {
      const answer = await response.json();
      if (answer.error) throw new Refused(answer.error, answer.code);
      return answer;
    }
    if (!response.ok) throw new Refused(await response.text());
    return response;
  };

  W.takenBack = (error) => error.name === "AbortError";

  // A lane has one request on its way and one that waits: the latest. Older ones are forgotten. One on its way that
  // nobody wants any more has its grace, since most answers are nearly there; then it is taken back.
  class Lane {
    constructor(path, answered, refused) {
      Object.assign(this, { path, answered, refused, waiting: null, busy: false });
    }

    ask(body) {
      this.waiting = { body };
      if (this.busy) this.hurry();
      else this.go();
    }

    forget() {
      this.waiting = null;
      this.stale = this.busy;
      if (this.busy) this.hurry();
    }

    hurry() {
      const { way } = this;
      way.timer ??= setTimeout(() => way.controller.abort(), Math.max(0, way.begun + GRACE - performance.now()));
    }

    async go() {
      this.busy = true;
      while (this.waiting) {
        const { body } = this.waiting;
        this.waiting = null;
        this.stale = false;
        const way = (this.way = { begun: performance.now(), controller: new AbortController() });
        try {
          const answer = await W.ask(this.path, body, way.controller.signal);
          if (!this.stale && !this.waiting) this.answered(answer, body);
        } catch (error) {
          if (!(error instanceof Refused) && !W.takenBack(error)) throw error;
          if (!this.stale && !this.waiting) this.refused(error.message, error.code);
        } finally {
          clearTimeout(way.timer);
        }
      }
      this.busy = false;
    }
  }

  W.Refused = Refused;
  W.Lane = Lane;
})();
