"""Worker: the process that answers. It may be ended at any moment; what must outlive it the server keeps."""

from __future__ import annotations

import json
import os
import pickle
import signal
import threading
from collections import OrderedDict
from collections.abc import Callable
from multiprocessing import parent_process
from multiprocessing.connection import Connection

from importers.errors import LimitError, WallkitError
from wallkit.view.page.answers import Answers, Download, QuestionError
from wallkit.view.page.bounds import hold_memory, in_words
from wallkit.view.page.documents import MOST_DOCUMENTS, Document, Reader
from wallkit.view.page.questions import Kept, Question, Reply
from wallkit.view.page.worlds import CompilingError

Make = Callable[[Reader], Answers]


def work(pipe: Connection, make: Make, reader: Reader, memory: int) -> None:
    """Answer question after question, until the pipe ends; this is all that a worker does."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl+C is the server's
    threading.Thread(target=_end_with_the_server, daemon=True).start()
    answers, documents = make(reader), Documents()
    hold_memory(memory)
    pipe.send(None)  # started
    warm = False
    while True:
        if not warm and not pipe.poll():  # while nobody asks, so that no run waits for a compiler
            import wallkit.simulation.simulate  # noqa: F401

            warm = True
        try:
            question = pipe.recv()
        except (EOFError, OSError):
            return
        pipe.send(reply_to(question, answers, documents, memory))


def _end_with_the_server() -> None:
    server = parent_process()
    if server is not None:
        server.join()
        os._exit(0)


class Documents:
    """The documents that this worker knows, by edition; what it forgot is sent to it again."""

    def __init__(self) -> None:
        self._known: OrderedDict[str, Document] = OrderedDict()

    def put(self, edition: str, document: Document) -> None:
        """Remember a document."""
        self._known[edition] = document
        self._known.move_to_end(edition)
        while len(self._known) > MOST_DOCUMENTS:
            self._known.popitem(last=False)

    def find(self, question: Question) -> Document | None:
        """Give the document that a question is about, or None where its edition is not known here."""
        if question.document is not None:
            self.put(question.edition, pickle.loads(question.document))  # packed by another worker of this server
        return self._known.get(question.edition)


def reply_to(question: Question, answers: Answers, documents: Documents, memory: int) -> Reply:
    """Answer one question; whatever goes wrong becomes a reply, too."""
    try:
        return _replied(question, answers, documents)
    except WallkitError as error:
        return Reply(error=plain(error))
    except CompilingError:
        return Reply(compiling=True)
    except MemoryError:
        return Reply(error=too_large(memory))
    except Exception as error:  # whatever it is, the page hears of it and the worker goes on
        return Reply(internal=f"{type(error).__name__}: {error}")


def _replied(question: Question, answers: Answers, documents: Documents) -> Reply:
    if question.opening is not None:
        return _shown(answers.open(question.opening, question.watched), answers, documents)
    if question.name == "sample":
        return _shown(answers.sample(question.body), answers, documents)
    document = documents.find(question)
    if document is None:
        return Reply(missing=True)
    if question.name == "walls":
        return _shown(answers.walls(question.body, document), answers, documents)
    if question.name == "saved" and question.data is not None:
        return _shown(answers.saved(question.data, document), answers, documents)
    if question.name == "document":
        return Reply(_text(answers.document_table(document)))
    if question.name == "check":
        return Reply(_text(answers.check(document)))
    if question.name == "settle":
        return Reply(_text(answers.settle(question.body, document)))
    if question.name == "simulate":
        return Reply(_text(answers.simulate(question.body, document)))
    if question.name == "aim":
        return Reply(_text(answers.aim(question.body, document)))
    if question.name == "save":
        saved: Download = answers.save(question.body, document)
        return Reply(saved.content, saved.media, saved.name)
    raise QuestionError(f"there is no question {question.name}", code="bad-request")


def _shown(document: Document, answers: Answers, documents: Documents) -> Reply:
    documents.put(document.edition, document)
    kept = Kept(
        document.key, document.edition, document.version, pickle.dumps(document, protocol=pickle.HIGHEST_PROTOCOL)
    )
    return Reply(_text(answers.document_table(document)), document=kept)


def _text(table: object) -> str:
    return json.dumps(table, allow_nan=False, separators=(",", ":"))


def plain(error: WallkitError) -> WallkitError:
    """Give an error of the one class that every process can unpack; what it says and how it ends stays."""
    same = WallkitError(
        error.message, code=error.code, fix=error.fix, file=error.file, line=error.line, column=error.column
    )
    same.exit_code = error.exit_code
    return same


def too_large(memory: int) -> WallkitError:
    """Make the error for an answer that took too much memory."""
    fix = "give a coarser tolerance, a shorter run or fewer balls, or use the command line"
    return plain(LimitError(f"the answer takes more than {in_words(memory)}", code="too-large", fix=fix))
