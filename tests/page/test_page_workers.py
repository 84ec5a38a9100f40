"""No question stops the page: what is too long, too large or not wanted any more is ended, the rest goes on."""

import contextlib
import json
import os
import socket
import sys
import threading
from dataclasses import replace

import numpy as np
import pytest

from importers.errors import WallkitError
from wallkit.cli.play import reader
from wallkit.scene.wishes import USUAL
from wallkit.view.page.answers import Answers, QuestionError
from wallkit.view.page.bounds import HEAVY, LIGHT, LIGHT_CONTACTS
from wallkit.view.page.questions import Opening
from wallkit.view.page.server import PageServer
from wallkit.view.page.workers import GoneError, LostError, Worker, Workers, is_light
from wallkit.view.page.worlds import CompilingError

ROOM = b'<svg xmlns="http://www.w3.org/2000/svg" width="200" height="100"><path id="room" d="M0 0H200V100H0Z"/></svg>'
BALL = {"x": 30, "y": 30, "vx": 40, "vy": 25, "radius": 4}
FOREVER, GREEDY, FATAL = 11_111, 22_222, 33_333  # bounces that stand for what a long run would do


class Held(Answers):
    """Answers of which some runs never end, take all memory, or take the process with them."""

    compiling = 2  # times that a file is asked for in vain

    def save(self, body, document):
        if self.compiling:
            self.compiling -= 1
            raise CompilingError
        return super().save(body, document)

    def simulate(self, body, document):
        if body.get("bounces") == FOREVER:
            if "tell" in body:
                socket.create_connection(("127.0.0.1", body["tell"])).sendall(b"begun")
            threading.Event().wait()
        if body.get("bounces") == GREEDY:
            np.ones(2**30)  # 8 GiB
        if body.get("bounces") == FATAL:
            os._exit(3)
        return super().simulate(body, document)


@pytest.fixture(scope="module")
def workers():
    with contextlib.closing(Workers(reader(), replace(HEAVY, seconds=None), LIGHT, Held)) as running:
        yield running


@pytest.fixture
def room(workers):
    opening = Opening(ROOM, "room.svg", None, USUAL)
    return json.loads(workers.open(opening).content)["id"]


def run(room, bounces):
    return {"document": room, "balls": [BALL], "bounces": bounces}


def flown(reply):
    return json.loads(reply.content)["ending"]


@contextlib.contextmanager
def held(workers, room):
    """A heavy question that never ends, in a thread; its asker goes where the block ends."""
    goes, heard, said = threading.Event(), threading.Event(), []

    def gone():  # asked while the answer is waited for
        heard.set()
        return goes.is_set()

    def ask():
        try:
            workers.ask("simulate", run(room, FOREVER), gone)
        except ConnectionError as error:
            said.append(error)

    thread = threading.Thread(target=ask)
    thread.start()
    try:
        assert heard.wait(120)
        yield
    finally:
        goes.set()
        thread.join(120)
    assert [type(error) for error in said] == [GoneError]


def test_a_light_question_is_answered_while_a_heavy_one_is_held(workers, room):
    with held(workers, room):
        assert flown(workers.ask("simulate", run(room, 5))) == ["bounce limit"]
        assert workers.light.ended == 0


@pytest.mark.parametrize("change", [{"until": 10**400}, {"until": "soon"}, {"bounces": 1e9}])
@pytest.mark.parametrize("name", ["simulate", "save"])
def test_a_number_out_of_range_is_told_while_a_heavy_question_is_held(workers, room, name, change):
    with held(workers, room), pytest.raises(QuestionError, match=next(iter(change))):
        workers.ask(name, {**run(room, 5), "bounces": None, **change})


def test_a_heavy_question_ends_when_its_asker_goes_and_the_next_is_answered(workers, room):
    before = workers.heavy.ended
    with held(workers, room):
        pass
    assert workers.heavy.ended == before + 1
    assert flown(workers.ask("simulate", run(room, LIGHT_CONTACTS + 1))) == ["bounce limit"]


def test_an_asker_that_goes_while_it_waits_for_its_turn_disturbs_nobody(workers, room):
    before = workers.heavy.ended
    with held(workers, room):
        with pytest.raises(GoneError):
            workers.ask("simulate", run(room, LIGHT_CONTACTS + 1), lambda: True)
        assert workers.heavy.ended == before
    assert workers.heavy.ended == before + 1


def test_a_document_outlives_the_process_that_opened_it(workers, room):
    before = workers.ask("walls", {"document": room, "curves": "lines", "tolerance": 2.0})
    with pytest.raises(LostError):
        workers.ask("simulate", run(room, FATAL))
    again = workers.ask("walls", {"document": room, "curves": "lines", "tolerance": 2.0})
    assert json.loads(again.content) == json.loads(before.content)


def test_an_import_that_fails_leaves_the_document_as_it_was(workers, room):
    with pytest.raises(WallkitError):
        workers.ask("walls", {"document": room, "curves": "lines", "tolerance": -1})
    assert json.loads(workers.ask("walls", {"document": room}).content)["curves"] == "arcs"


def test_a_process_that_dies_is_told_of_and_replaced(workers, room):
    with pytest.raises(LostError) as told:
        workers.ask("simulate", run(room, FATAL))
    assert told.value.code == "worker-lost"
    assert told.value.fix
    assert flown(workers.ask("simulate", run(room, LIGHT_CONTACTS + 1))) == ["bounce limit"]


@pytest.mark.skipif(sys.platform != "linux", reason="no bound on address space here")
def test_an_answer_that_takes_too_much_memory_is_refused_and_the_process_goes_on(workers, room):
    before = workers.heavy.ended
    with pytest.raises(WallkitError) as told:
        workers.ask("simulate", run(room, GREEDY))
    assert (told.value.code, told.value.exit_code) == ("too-large", 3)
    assert "2 GiB" in told.value.message
    assert flown(workers.ask("simulate", run(room, LIGHT_CONTACTS + 1))) == ["bounce limit"]
    assert workers.heavy.ended == before


def test_what_waits_for_a_compiler_is_asked_again_and_others_have_their_turn(workers, room):
    replies = []
    saving = threading.Thread(target=lambda: replies.append(workers.ask("save", run(room, 5) | {"what": "replay"})))
    saving.start()
    assert flown(workers.ask("simulate", run(room, LIGHT_CONTACTS + 1))) == ["bounce limit"]
    saving.join()
    assert replies[0].download == "room.html"
    assert "<canvas" in replies[0].content


def test_closing_waits_for_a_process_that_is_just_being_followed_by_another(monkeypatch):
    beginning, closing = threading.Event(), threading.Event()
    begin = Worker._begin

    def slow(worker):
        beginning.set()
        closing.wait(10.0)  # as if the next process took its time to start
        begin(worker)

    worker = Worker(LIGHT, Held, reader())
    monkeypatch.setattr(Worker, "_begin", slow)
    renewing = threading.Thread(target=worker._renew)
    renewing.start()
    beginning.wait()
    ending = threading.Thread(target=worker.close)
    ending.start()
    closing.set()
    renewing.join()
    ending.join()
    assert worker._process.exitcode is not None


def test_an_answer_that_takes_too_long_is_refused_with_the_figure():
    with contextlib.closing(Workers(reader(), replace(HEAVY, seconds=0.0), LIGHT, Held)) as workers:
        room = json.loads(workers.open(Opening(ROOM, "room.svg", None, USUAL), bounded=False).content)["id"]
        with pytest.raises(WallkitError) as told:
            workers.ask("simulate", run(room, FOREVER))
    assert (told.value.code, told.value.exit_code) == ("too-long", 3)
    assert "0 seconds" in told.value.message
    assert told.value.fix


@pytest.mark.parametrize(
    ("body", "light"),
    [
        ({"balls": [BALL], "bounces": 24}, True),
        ({"balls": [BALL], "bounces": LIGHT_CONTACTS}, True),
        ({"balls": [BALL], "bounces": LIGHT_CONTACTS + 1}, False),
        ({"balls": [BALL] * 100, "bounces": 11}, False),
        ({"balls": [BALL], "until": 1.0}, False),
        ({"balls": [BALL], "bounces": None}, False),
        ({"balls": [BALL], "bounces": 10**400}, False),
        ({"balls": 3, "bounces": "3"}, False),
    ],
)
def test_light_is_what_is_short_whatever_it_meets(body, light):
    assert is_light(body) is light


def test_a_browser_that_closes_its_connection_ends_what_it_asked_for(workers, room):
    before = workers.heavy.ended
    with contextlib.ExitStack() as stack:
        ear = stack.enter_context(socket.create_server(("127.0.0.1", 0)))
        ear.settimeout(120)
        server = PageServer(workers)
        stack.callback(server.socket.close)  # not server_close: the workers are the module's
        threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.01}, daemon=True).start()
        stack.callback(server.shutdown)
        port = server.server_address[1]
        body = json.dumps(run(room, FOREVER) | {"tell": ear.getsockname()[1]}).encode()
        head = f"POST /api/simulate HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nX-Wallkit-Token: {server.token}\r\n"
        with socket.create_connection(("127.0.0.1", port)) as connection:
            connection.sendall(f"{head}Content-Length: {len(body)}\r\n\r\n".encode() + body)
            begun, _ = ear.accept()
            begun.close()
        # The run is held for ever: this question has its turn only if that one is ended.
        assert flown(workers.ask("simulate", run(room, LIGHT_CONTACTS + 1))) == ["bounce limit"]
    assert workers.heavy.ended == before + 1
