"""The server against what a foreign page or a careless program could send: figure 8 of the limits."""

import contextlib
import http.client
import json
import socket
import threading
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from wallkit.cli.play import reader
from wallkit.scene.samples import samples
from wallkit.view.page.answers import MOST_BALLS, MOST_CONTACTS
from wallkit.view.page.server import MAX_BODY, PAGE_SCRIPTS, PAGE_STYLES, PageServer
from wallkit.view.page.workers import Workers

ROOM = b"""<svg xmlns="http://www.w3.org/2000/svg" width="200" height="100">
<path id="room" d="M0 0H200V100H0Z"/><circle id="pin" cx="100" cy="50" r="10"/></svg>"""


@pytest.fixture(scope="module")
def server():
    with PageServer(Workers(reader())) as running:
        threading.Thread(target=running.serve_forever, kwargs={"poll_interval": 0.01}, daemon=True).start()
        yield running
        running.shutdown()


@pytest.fixture
def ask(server):
    """Send one request as it is given; headers are a list, so that any may be missing or doubled."""
    port = server.server_address[1]

    def send(method, path, headers=None, body=None, host=f"127.0.0.1:{port}", token=True):
        with contextlib.closing(http.client.HTTPConnection("127.0.0.1", port, timeout=120)) as connection:
            connection.putrequest(method, path, skip_host=True, skip_accept_encoding=True)
            all_headers = [("Host", host)] if host else []
            all_headers += [("X-Wallkit-Token", server.token)] if token else []
            for name, value in [*all_headers, *(headers or [])]:
                connection.putheader(name, value)
            connection.endheaders()
            if body:
                connection.send(body)
            with connection.getresponse() as answer:
                return answer, answer.read()

    return send


@pytest.fixture
def post(ask):
    def send(path, body):
        data = body if isinstance(body, bytes) else json.dumps(body).encode()
        answer, content = ask("POST", path, [("Content-Length", str(len(data)))], data)
        return answer.status, json.loads(content) if "json" in answer.headers["Content-Type"] else content

    return send


@pytest.fixture
def room(post):
    status, document = post("/api/open?name=room.svg", ROOM)
    assert status == 200
    return document


def ball(**changes):
    return {"x": 30, "y": 30, "vx": 40, "vy": 25, "radius": 4} | changes


def test_it_listens_on_this_machine_alone(server):
    assert server.server_address[0] == "127.0.0.1"
    assert server.url.startswith("http://127.0.0.1:")
    assert len(server.token) >= 32


def test_the_page_and_all_its_parts(ask, server):
    assert ask("GET", f"/?token={server.token}", token=False)[0].status == 200
    for name in (*PAGE_SCRIPTS, *PAGE_STYLES):
        answer, content = ask("GET", f"/static/{name}")
        assert (answer.status, bool(content)) == (200, True)
    for sample in samples():
        answer, content = ask("GET", f"/samples/{sample.name}")
        assert (answer.status, content[:4]) == (200, b"<svg")


@pytest.mark.parametrize("host", ["evil.example", "127.0.0.1", "127.0.0.1:1", "127.0.0.1.evil.example:80", ""])
@pytest.mark.parametrize(("method", "path"), [("GET", "/"), ("POST", "/api/simulate")])
def test_a_foreign_or_missing_host_is_misdirected(ask, host, method, path):
    assert ask(method, path, host=host)[0].status == 421


def test_a_doubled_host_is_misdirected(ask, server):
    port = server.server_address[1]
    assert ask("GET", "/", [("Host", f"127.0.0.1:{port}")])[0].status == 421
    assert ask("GET", "/", [("Host", "evil.example")])[0].status == 421


def test_an_absolute_address_is_misdirected(ask):
    assert ask("GET", "http://evil.example/")[0].status == 421


@pytest.mark.parametrize("origin", ["http://evil.example", "null", "https://127.0.0.1", "http://127.0.0.1:1"])
def test_a_foreign_origin_is_forbidden(ask, origin):
    answer, _ = ask("POST", "/api/simulate", [("Origin", origin), ("Content-Length", "2")], b"{}")
    assert answer.status == 403
    assert answer.headers.get("Access-Control-Allow-Origin") is None


def test_the_own_origin_is_welcome(ask, server):
    port = server.server_address[1]
    headers = [("Origin", f"http://127.0.0.1:{port}"), ("Content-Length", "2")]
    assert ask("POST", "/api/simulate", headers, b"{}")[0].status == 422  # {} is no question, but it was read


@pytest.mark.parametrize(
    "path", ["/", "/static/page.js", "/api/simulate", "/samples/sinai.svg", "/?token=wrong", "/?token="]
)
@pytest.mark.parametrize("method", ["GET", "POST"])
def test_without_the_token_nothing_is_said(ask, server, method, path):
    answer, content = ask(method, path, token=False)
    assert answer.status == 403
    assert server.token.encode() not in content


def test_a_body_that_is_too_large_is_refused_unread(ask):
    answer, _ = ask("POST", "/api/open", [("Content-Length", str(MAX_BODY + 1))])
    assert answer.status == 413
    assert answer.headers["Connection"] == "close"
    assert ask("POST", "/api/open", [("Content-Length", "9" * 400)])[0].status == 413


def test_a_body_needs_a_length(ask):
    assert ask("POST", "/api/open")[0].status == 411
    assert ask("POST", "/api/open", [("Transfer-Encoding", "chunked")])[0].status == 411
    headers = [("Transfer-Encoding", "chunked"), ("Content-Length", "2")]
    assert ask("POST", "/api/open", headers)[0].status == 411


@pytest.mark.parametrize("length", ["-1", "1e3", "abc", "+5", "٣"])
def test_a_length_is_a_number(ask, length):
    assert ask("POST", "/api/open", [("Content-Length", length.encode())])[0].status == 400


@pytest.mark.parametrize(
    "path",
    [
        "/static/../server.py",
        "/static/..%2fserver.py",
        "/static/%2e%2e/server.py",
        "/static//etc/passwd",
        "/static/page.js/",
        "/samples/../pyproject.toml",
        "/samples/..%2f..%2fetc%2fpasswd",
        "/../../etc/passwd",
        "//etc/passwd",
        "/static/",
        "/api/open",
        "/favicon.ico",
    ],
)
def test_nothing_but_the_page_can_be_had(ask, path):
    assert ask("GET", path)[0].status == 404


def test_every_answer_is_strict(ask, server):
    requests = [("GET", "/", []), ("GET", "/nothing", []), ("POST", "/api/open", []), ("PUT", "/", []),
                ("GET", "/", [("Host", "evil.example")])]  # fmt: skip
    for method, path, headers in requests:
        answer, _ = ask(method, path, headers)
        assert answer.headers["Content-Security-Policy"].startswith("default-src 'none'")
        assert "unsafe" not in answer.headers["Content-Security-Policy"]
        assert answer.headers["X-Content-Type-Options"] == "nosniff"
        assert answer.headers["Cache-Control"] == "no-store"
        assert answer.headers["Referrer-Policy"] == "no-referrer"
        assert "Python" not in (answer.headers["Server"] or "")
    assert ask("PUT", "/")[0].status == 501


def test_words_that_are_no_http_end_the_connection(server):
    with socket.create_connection(server.server_address, timeout=20) as connection:
        connection.sendall(b"\x16\x03\x01 nonsense\r\n\r\n")
        answer = b"".join(iter(lambda: connection.recv(4096), b""))
    assert server.token.encode() not in answer
    assert b"Bad" in answer


@pytest.mark.parametrize("body", [b"", b"nonsense", b"[1]", b'{"x": NaN}', b"[" * 100_000, b"\xff"])
def test_a_body_that_is_no_question(post, body):
    assert post("/api/simulate", body)[0] == 400


@pytest.mark.parametrize(
    "change",
    [
        {"document": "nothing"},
        {"document": ["a"]},
        {"balls": []},
        {"balls": [ball()] * (MOST_BALLS + 1)},
        {"balls": [ball(x="1")]},
        {"balls": [ball(vx=1e300)]},
        {"balls": [ball(radius=-1)]},
        {"balls": ["ball"]},
        {"until": -1},
        {"until": 1e300},
        {"until": 10**400},
        {"bounces": 10**9},
        {"bounces": 10**400},
        {"gravity": [0, -(10**400)]},
        {"gravity": [1]},
        {"gravity": [1, None]},
        {"restitution": 10.5},
        {"tangential_restitution": -0.1},
    ],
)
def test_a_question_out_of_bounds_is_refused_in_words(post, room, change):
    question = {"document": room["id"], "balls": [ball()], "bounces": 5} | change
    status, answer = post("/api/simulate", question)
    assert status == 422
    assert answer["error"]
    assert "Traceback" not in answer["error"]


@pytest.mark.parametrize(("change", "range_"), [({"until": 10**400}, "0 to 1e+12"), ({"bounces": 1e9}, "0 to 100000")])
def test_a_number_that_is_too_large_is_told_its_range(post, room, change, range_):
    status, answer = post("/api/simulate", {"document": room["id"], "balls": [ball()], "bounces": 5} | change)
    assert status == 422
    assert range_ in answer["error"]


def test_a_run_is_bounded_whatever_was_asked_for(post, room):
    question = {"document": room["id"], "balls": [ball(vx=40 + i) for i in range(50)], "until": 1e9}
    status, answer = post("/api/simulate", question)
    assert status == 200
    assert set(answer["ending"]) == {"bounce limit"}
    size = len(answer["contacts"]["kind"]["data"]) * 3 // 4
    assert size <= MOST_CONTACTS + 3


def test_a_bad_drawing_gets_the_command_lines_own_words(post, tmp_path):
    import subprocess
    import sys

    bad = b'<svg xmlns="http://www.w3.org/2000/svg"><path d="M0 0'
    file = tmp_path / "bad.svg"
    file.write_bytes(bad)
    told = subprocess.run(
        [sys.executable, "-m", "wallkit", "simulate", "bad.svg"],
        capture_output=True,
        text=True,
        cwd=tmp_path,
        env={"PYTHONPATH": str(Path(__file__).parents[2]), "NO_COLOR": "1", "PATH": ""},
        check=False,
    )
    status, answer = post("/api/open?name=bad.svg", bad)
    assert status == 422
    assert answer["error"] == told.stderr.strip()


def test_a_scene_from_the_page_may_not_name_files(post):
    status, answer = post("/api/open?name=scene.toml", b'drawing = "/etc/passwd"\n')
    assert status == 422
    assert "root:" not in answer["error"]


def test_walls_are_imported_again_with_other_options(post, room):
    status, again = post("/api/walls", {"document": room["id"], "curves": "lines", "tolerance": 2.0})
    assert status == 200
    assert again["tolerance"] == 2.0
    assert again["walls"]["edges"] < 20


@pytest.mark.parametrize("what", ["scene", "walls"])
def test_what_is_saved_opens_again(post, room, what):
    question = {"document": room["id"], "balls": [ball()], "gravity": [0.0, 9.0], "what": what}
    status, saved = post("/api/save", question)
    assert status == 200
    status, opened = post("/api/open?name=saved.json", json.dumps(saved).encode())
    assert status == 200
    assert opened["walls"]["vertices"] == room["walls"]["vertices"]
    if what == "scene":
        assert opened["gravity"] == [0.0, 9.0]
        assert opened["balls"] == [ball()]


def test_a_saved_name_is_harmless(post):
    _, document = post("/api/open?name=a%22%0d%0aX-Evil:%20b/../c.svg", ROOM)
    question = {"document": document["id"], "balls": [ball()], "bounces": 3, "what": "replay"}
    assert post("/api/save", question)[0] == 200


def test_the_last_documents_are_kept_and_no_more(post, room):
    for _ in range(8):
        post("/api/open?name=room.svg", ROOM)
    status, answer = post("/api/simulate", {"document": room["id"], "balls": [ball()], "bounces": 1})
    assert status == 422
    assert "open the file again" in answer["error"]


ANYTHING = st.recursive(
    st.none()
    | st.booleans()
    | st.integers(-(10**20), 10**20)
    | st.floats(allow_nan=False, allow_infinity=False)
    | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=6), inner, max_size=3),
    max_leaves=6,
)
KEYS = [
    "balls",
    "gravity",
    "restitution",
    "tangential_restitution",
    "until",
    "bounces",
    "curves",
    "tolerance",
    "what",
    "name",
]


@settings(max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    name=st.sampled_from(["simulate", "walls", "save", "sample"]),
    change=st.dictionaries(st.sampled_from(KEYS), ANYTHING, max_size=3),
)
def test_no_question_breaks_the_server(server, post, name, change):
    document = post("/api/open?name=room.svg", ROOM)[1]["id"]
    question = {"document": document, "balls": [ball()], "bounces": 3, "what": "walls"} | change
    status, answer = post(f"/api/{name}", question)
    assert status in (200, 422), answer
