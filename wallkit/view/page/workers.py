"""Workers: the two processes behind the server, one for heavy questions and one for light ones.

A question that takes too long, too much memory, or whose asker went away is ended with the process that works on it;
the next process starts at once. The documents are kept here, packed, so nothing that is open is lost.
"""

from __future__ import annotations

import contextlib
import multiprocessing
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from multiprocessing import resource_tracker
from multiprocessing.connection import Connection

from importers.errors import LimitError, WallkitError
from wallkit.scene.opening import read_file
from wallkit.view.page.answers import Answers, limits_of
from wallkit.view.page.bounds import HEAVY, LIGHT, LIGHT_CONTACTS, PAUSE, TICK, Bounds
from wallkit.view.page.documents import Reader, Shelf
from wallkit.view.page.payload import Table
from wallkit.view.page.questions import Kept, Opening, Question, Reply
from wallkit.view.page.worker import Make, work
from wallkit.watch_file import Watch

Gone = Callable[[], bool]
QUESTIONS = ("sample", "walls", "saved", "check", "settle", "simulate", "aim", "save")
_ABOUT_DOCUMENTS = ("walls", "check", "settle", "simulate", "aim", "save")


class GoneError(ConnectionError):
    """Whoever asked is not there any more."""


class LostError(WallkitError):
    """The process that worked on a question ended before it answered."""

    exit_code = 3


class InternalError(WallkitError):
    """A worker raised what nobody meant."""


def still_there() -> bool:
    """Say of an asker that never goes that it is not gone."""
    return False


class Workers:
    """All that can be asked.

    Attributes:
        reader: how errors become words.
        shelf: the documents that are open.
        heavy: opens, imports, flies far and saves.
        light: flies as far as somebody aims.
    """

    def __init__(self, reader: Reader, heavy: Bounds = HEAVY, light: Bounds = LIGHT, make: Make = Answers) -> None:
        self.reader = reader
        self.shelf = Shelf()
        self.heavy = Worker(heavy, make, reader)
        self.light = Worker(light, make, reader)
        self._watches: dict[str, Watch] = {}
        self._looking = threading.Lock()

    def open(
        self, file: Opening, gone: Gone = still_there, *, bounded: bool = True, watch: Watch | None = None
    ) -> Reply:
        """Open a file; one from the command line may take its time (``bounded=False``), and may be watched.

        Raises:
            WallkitError: it cannot be opened, or not within the bounds.
            GoneError: whoever asked went away.
        """
        question = Question("open", opening=file, watched=watch is not None)
        reply = self._kept(self.heavy.ask(question, None, gone, bounded=bounded))
        if watch is not None and reply.document is not None:
            self._watches[reply.document.key] = watch
        return reply

    def saved(self, body: Table, gone: Gone = still_there) -> Reply:
        """Give a watched document anew if its file was saved since the page's version of it; else nothing.

        Raises:
            WallkitError: what was saved cannot be read; the document stays as it was.
            GoneError: whoever asked went away.
        """
        kept = self.shelf.get(body.get("document"))
        watch = self._watches.get(kept.key)
        if watch is None:
            return Reply("{}")
        with self._looking:  # several pages may show it
            if watch.changed():
                question = Question("saved", edition=kept.edition, data=read_file(watch.file))
                self._kept(self.heavy.ask(question, kept, gone))
        kept = self.shelf.get(kept.key)
        if body.get("version") == kept.version:
            return Reply("{}")
        return self._kept(self.heavy.ask(Question("document", edition=kept.edition), kept, gone))

    def ask(self, name: str, body: Table, gone: Gone = still_there) -> Reply:
        """Answer one of QUESTIONS.

        Raises:
            WallkitError: it is no question, or cannot be answered within the bounds.
            GoneError: whoever asked went away.
        """
        if name == "saved":
            return self.saved(body, gone)
        if name in ("simulate", "save"):
            limits_of(body, 1)  # a time or a number that is out of range need not wait for a turn to be told
        kept = self.shelf.get(body.get("document")) if name in _ABOUT_DOCUMENTS else None
        worker = self.light if name == "simulate" and is_light(body) else self.heavy
        return self._kept(worker.ask(Question(name, body, edition=kept.edition if kept else ""), kept, gone))

    def close(self) -> None:
        """End both processes."""
        self.heavy.close()
        self.light.close()

    def _kept(self, reply: Reply) -> Reply:
        if reply.error is not None:
            raise reply.error
        if reply.internal:
            raise InternalError(f"an internal error, please report it: {reply.internal}", code="internal")
        if reply.document is not None:
            self.shelf.put(reply.document)
        return reply


def is_light(body: Table) -> bool:
    """Tell whether a run is asked for that is short whatever it meets: LIGHT_CONTACTS in all at most."""
    balls, bounces = body.get("balls"), body.get("bounces")
    if not isinstance(balls, list) or not isinstance(bounces, int | float):
        return False
    return len(balls) * bounces <= LIGHT_CONTACTS


class Worker:
    """One process that answers one question after another.

    Attributes:
        bounds: of one answer.
        ended: how many processes were ended, or ended themselves, before they had answered.
    """

    def __init__(self, bounds: Bounds, make: Make, reader: Reader) -> None:
        self.bounds = bounds
        self.ended = 0
        self._make = make
        self._reader = reader
        self._turn = threading.Lock()
        self._life = threading.Lock()  # a process is ended and followed by another as one step, or ended for good
        self._closed = False
        self._started = False
        self._begin()

    def ask(self, question: Question, kept: Kept | None, gone: Gone, *, bounded: bool = True) -> Reply:
        """Wait for a turn and for the answer.

        Args:
            question: what is asked.
            kept: the document that it is about; sent along where the process does not know it.
            gone: tells whether whoever asked went away; asked every TICK.
            bounded: hold it to the bound on time.
        """
        while not self._turn.acquire(timeout=TICK):
            if gone():
                raise GoneError
        try:
            while (reply := self._replied(question, kept, gone, bounded=bounded)).compiling:
                self._pause()  # the compiler's time is not the question's
            return reply
        except BaseException as error:  # too long, gone, lost, Ctrl+C: a process that is still at it is ended
            self._renew()
            if self._closed:
                raise GoneError from None
            if isinstance(error, EOFError | OSError) and not isinstance(error, GoneError):
                raise _lost() from None
            raise
        finally:
            self._turn.release()

    def close(self) -> None:
        """End the process for good."""
        with self._life:
            self._closed = True
            self._process.kill()
            self._process.join()

    def _replied(self, question: Question, kept: Kept | None, gone: Gone, *, bounded: bool) -> Reply:
        self._let_start(gone)
        seconds = self.bounds.seconds if bounded else None
        end = None if seconds is None else time.monotonic() + seconds
        reply = self._answered(question, gone, end)
        if reply.missing and kept is not None:
            reply = self._answered(replace(question, document=kept.packed), gone, end)
        return reply

    def _pause(self) -> None:
        """Let the others have their turn for a while."""
        self._turn.release()
        time.sleep(PAUSE)
        self._turn.acquire()

    def _answered(self, question: Question, gone: Gone, end: float | None) -> Reply:
        self._pipe.send(question)
        self._wait(gone, end)
        reply: Reply = self._pipe.recv()
        return reply

    def _let_start(self, gone: Gone) -> None:
        """Wait for a new process first: its start is no part of the question's time."""
        if not self._started:
            self._wait(gone, None)
            self._pipe.recv()
            self._started = True

    def _wait(self, gone: Gone, end: float | None) -> None:
        while not self._pipe.poll(TICK):
            if gone():
                raise GoneError
            if end is not None and time.monotonic() > end:
                raise _too_long(self.bounds)

    def _renew(self) -> None:
        with self._life:
            if self._closed:
                return
            self.ended += 1
            self._process.kill()
            self._process.join()
            self._pipe.close()
            self._begin()

    def _begin(self) -> None:
        context = multiprocessing.get_context("spawn")  # a fork would copy the locks of the server's other threads
        self._pipe: Connection
        self._pipe, theirs = context.Pipe()
        self._started = False
        self._process = context.Process(
            target=work, args=(theirs, self._make, self._reader, self.bounds.memory), daemon=True
        )
        with _deaf_to_interrupts():
            self._process.start()
        theirs.close()


@contextlib.contextmanager
def _deaf_to_interrupts() -> Iterator[None]:
    """A terminal sends Ctrl+C to all its processes; a process that is started here never hears it."""
    if sys.platform == "win32":
        yield
        return
    resource_tracker.ensure_running()  # its own start lets SIGINT in again
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _too_long(bounds: Bounds) -> LimitError:
    return LimitError(
        f"the answer takes more than {bounds.seconds:g} seconds",
        code="too-long",
        fix="give a coarser tolerance, a shorter run or fewer balls, or use the command line",
    )


def _lost() -> LostError:
    return LostError(
        "the process that worked on this ended before it answered, most likely for want of memory",
        code="worker-lost",
        fix="ask for less, or ask again; if it happens again, please report it",
    )
