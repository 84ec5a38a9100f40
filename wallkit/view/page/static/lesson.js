// Lesson: the text of a scene and its questions, each with an answer to open. Everything is only ever text.
(() => {
  "use strict";
  const W = (globalThis.Wallkit ??= {});
  const $ = (id) => document.getElementById(id);

  const made = (name, text) => {
    const element = document.createElement(name);
    element.textContent = text;
    return element;
  };

  W.showLesson = (lesson) => {
    $("lesson").hidden = !lesson;
    if (!lesson) return;
    $("lesson-title").textContent = lesson.title;
    const paragraphs = lesson.text.split(/\n\s*\n/).filter((part) => part.trim());
    $("lesson-text").replaceChildren(...paragraphs.map((part) => made("p", part)));
    $("lesson-questions").previousElementSibling.hidden = !lesson.questions.length;
    $("lesson-questions").replaceChildren(...lesson.questions.map(({ question, answer }) => {
      const details = made("details", "");
      details.append(made("summary", question), made("p", answer));
      return details;
    }));
  };
})();
