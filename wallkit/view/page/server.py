"""The page's server: this machine only, one token, and nothing believed that a foreign page could send.

A page of another site can make a browser ask 127.0.0.1, too. It cannot read the token, nor send a foreign Host or
Origin unseen, so these three are checked before anything else.
"""

from __future__ import annotations

import json
import secrets
import select
import socket
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any
from urllib.parse import parse_qs, quote, urlsplit

from importers.errors import WallkitError
from wallkit.scene.samples import Sample, lessons, samples, shown
from wallkit.scene.wishes import USUAL
from wallkit.view.page import look
from wallkit.view.page.answers import MOST_CONTACTS
from wallkit.view.page.payload import Table, inlined
from wallkit.view.page.questions import Opening
from wallkit.view.page.thumbnail import thumbnail
from wallkit.view.page.workers import QUESTIONS, InternalError, LostError, Workers

MAX_BODY = 32 * 1024 * 1024
PATIENCE = 30.0  # seconds that a connection may say nothing
PAGE_SCRIPTS = (*look.SHARED_SCRIPTS, "desk.js", "windows.js", "aim.js", "panel.js", "balls.js", "checks.js", "ways.js",
                "panels.js", "gallery.js", "page.js")  # fmt: skip
PAGE_STYLES = ("theme.css", *look.SHARED_STYLES, "page.css", "ways.css", "cards.css", "sheet.css")

POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; connect-src 'self'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
PICTURE_POLICY = "default-src 'none'; style-src 'unsafe-inline'"  # a picture brings its own style sheet
_HEADERS = {
    "X-Content-Type-Options": "nosniff",
    "Cache-Control": "no-store",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
}
_STATUS = {LostError: HTTPStatus.SERVICE_UNAVAILABLE, InternalError: HTTPStatus.INTERNAL_SERVER_ERROR}
_TYPES = {"css": "text/css; charset=utf-8", "js": "text/javascript; charset=utf-8"}


class RefusedError(Exception):
    """A request that is answered with a status and a line of text."""

    def __init__(self, status: HTTPStatus, words: str) -> None:
        super().__init__(words)
        self.status = status
        self.words = words


class PageServer(ThreadingHTTPServer):
    """Serves one page to whoever has the token.

    Attributes:
        workers: what answers, in processes of their own; they end with the server.
        token: in the URL of the page; every request carries it.
        document: the table of the file that is open from the start, or None.
        refused: why that file could not be opened, in the command line's words, or ``""``.
    """

    daemon_threads = True
    allow_reuse_address = False

    def __init__(self, workers: Workers, port: int = 0, document: Table | None = None, refused: str = "") -> None:
        self.workers = workers  # first: where the port is in use, the server closes at once, and they with it
        super().__init__(("127.0.0.1", port), Handler)
        self.token = secrets.token_urlsafe(24)
        self.document = document
        self.refused = refused
        port = self.server_address[1]
        self.hosts = {f"127.0.0.1:{port}", f"localhost:{port}"}
        self.origins = {f"http://{host}" for host in self.hosts}
        self.pictures: dict[str, str] = {}

    @property
    def url(self) -> str:
        """The page's address with its token."""
        return f"http://127.0.0.1:{self.server_address[1]}/?token={self.token}"

    def server_close(self) -> None:
        """Close the socket and end the workers."""
        super().server_close()
        self.workers.close()

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Say nothing about a browser that went away in the middle of an answer."""

    def picture(self, name: str) -> str | None:
        """Draw a sample's walls, once."""
        if name not in self.pictures:
            sample = next((sample for sample in shown() if sample.name == name), None)
            if sample is None:
                return None
            self.pictures[name] = thumbnail(sample.path)
        return self.pictures[name]


class Handler(BaseHTTPRequestHandler):
    """Answers one connection."""

    server: PageServer
    protocol_version = "HTTP/1.1"
    server_version = "wallkit"
    sys_version = ""
    timeout = PATIENCE

    def do_GET(self) -> None:
        """Answer a GET."""
        self._answer(self._get)

    def do_POST(self) -> None:
        """Answer a POST."""
        self._answer(self._post)

    def _answer(self, work: Any) -> None:
        try:
            work(*self._guarded())
        except RefusedError as refused:
            self._refuse(refused.status, refused.words)
        except WallkitError as error:
            words = self.server.workers.reader.describe(error)
            self._send_json(
                {"error": words, "code": error.code}, _STATUS.get(type(error), HTTPStatus.UNPROCESSABLE_ENTITY)
            )
        except OSError:  # the browser went away, or said nothing for too long
            self.close_connection = True
        except Exception as error:  # whatever it is, the page hears of it and the server goes on
            words = f"wallkit: an internal error, please report it: {type(error).__name__}: {error}"
            self._send_json({"error": words}, HTTPStatus.INTERNAL_SERVER_ERROR)

    def _guarded(self) -> tuple[str, dict[str, list[str]]]:
        """Give path and query of a request that comes from the page itself.

        Raises:
            RefusedError: 421 for a foreign, missing or doubled Host, 403 for a foreign Origin or without the token.
        """
        hosts = self.headers.get_all("Host") or []
        if len(hosts) != 1 or hosts[0].strip().lower() not in self.server.hosts or not self.path.startswith("/"):
            raise RefusedError(HTTPStatus.MISDIRECTED_REQUEST, "this server answers to its own address alone")
        if any(origin not in self.server.origins for origin in self.headers.get_all("Origin") or []):
            raise RefusedError(HTTPStatus.FORBIDDEN, "not for pages of other sites")
        try:
            parts = urlsplit(self.path)
            query = parse_qs(parts.query, max_num_fields=8)
        except ValueError:
            raise RefusedError(HTTPStatus.BAD_REQUEST, "not an address") from None
        given = self.headers.get_all("X-Wallkit-Token") or query.get("token") or [""]
        if len(given) != 1 or not secrets.compare_digest(given[0].encode(), self.server.token.encode()):
            raise RefusedError(HTTPStatus.FORBIDDEN, "the token is missing: use the address that wallkit play printed")
        return parts.path, query

    def _get(self, path: str, query: dict[str, list[str]]) -> None:
        folder, _, name = path[1:].partition("/")
        if path == "/":
            self._send(self._index(), "text/html; charset=utf-8")
        elif folder == "static" and name in (*PAGE_SCRIPTS, *PAGE_STYLES):
            text = look.theme_css() if name == "theme.css" else look.part(name)
            self._send(text, _TYPES[name.rpartition(".")[2]])
        elif folder == "samples" and (picture := self.server.picture(name)) is not None:
            self._send(picture, "image/svg+xml", PICTURE_POLICY)
        else:
            raise RefusedError(HTTPStatus.NOT_FOUND, "there is nothing of that name")

    def _post(self, path: str, query: dict[str, list[str]]) -> None:
        body = self._body()
        workers = self.server.workers
        name = path.removeprefix("/api/")
        if path == "/api/open":
            called = query.get("name", ["drawing"])[0][:200]
            reply = workers.open(Opening(body, called, None, USUAL), self._gone)
        elif path.startswith("/api/") and name in QUESTIONS:
            reply = workers.ask(name, _parsed(body), self._gone)
        else:
            raise RefusedError(HTTPStatus.NOT_FOUND, "there is nothing of that name")
        self._send(reply.content, reply.media, download=reply.download)

    def _gone(self) -> bool:
        """Tell whether the browser has closed this connection: it does when the page goes or takes a question back."""
        readable, _, _ = select.select([self.connection], [], [], 0)
        try:
            return bool(readable) and not self.connection.recv(1, socket.MSG_PEEK)
        except OSError:
            return True

    def _body(self) -> bytes:
        """Read a body of stated length.

        Raises:
            RefusedError: 411 without a length, 400 where it is no number, 413 over MAX_BODY.
        """
        lengths = self.headers.get_all("Content-Length") or []
        if not lengths or self.headers.get("Transfer-Encoding") is not None:
            raise RefusedError(HTTPStatus.LENGTH_REQUIRED, "a body needs a Content-Length")
        if len(lengths) != 1 or not (lengths[0].isascii() and lengths[0].isdigit()):
            raise RefusedError(HTTPStatus.BAD_REQUEST, "that is no length")
        if len(lengths[0]) > 12 or int(lengths[0]) > MAX_BODY:
            raise RefusedError(HTTPStatus.REQUEST_ENTITY_TOO_LARGE, f"at most {MAX_BODY // 2**20} MiB")
        return self.rfile.read(int(lengths[0]))

    def _index(self) -> str:
        token = quote(self.server.token)
        data = {
            "token": self.server.token,
            "colours": look.colours(),
            "limits": {"body": MAX_BODY, "contacts": MOST_CONTACTS},
            "lessons": [_card(sample) for sample in lessons()],
            "samples": [_card(sample) for sample in samples()],
            "document": self.server.document,
            "refused": self.server.refused,
        }
        styles = "\n".join(f'<link rel="stylesheet" href="static/{name}?token={token}">' for name in PAGE_STYLES)
        scripts = "\n".join(f'<script src="static/{name}?token={token}"></script>' for name in PAGE_SCRIPTS)
        return look.filled("index.html", {"head": styles, "scripts": scripts, "data": inlined(data)})

    def _send_json(self, table: Table, status: HTTPStatus = HTTPStatus.OK) -> None:
        text = json.dumps(table, allow_nan=False, separators=(",", ":"))
        self._send(text, "application/json; charset=utf-8", status=status)

    def _refuse(self, status: HTTPStatus, words: str) -> None:
        self.close_connection = True  # its body may still be on the way, and is not read
        self._send(words + "\n", "text/plain; charset=utf-8", status=status)

    def _send(
        self,
        body: str | bytes,
        media: str,
        policy: str = POLICY,
        *,
        status: HTTPStatus = HTTPStatus.OK,
        download: str = "",
    ) -> None:
        content = body.encode("utf-8") if isinstance(body, str) else body
        self.send_response(status)
        self.send_header("Content-Type", media)
        self.send_header("Content-Length", str(len(content)))
        self.send_header("Content-Security-Policy", policy)
        for name, value in _HEADERS.items():
            self.send_header(name, value)
        if download:
            self.send_header("Content-Disposition", f'attachment; filename="{download}"')
        if self.close_connection:
            self.send_header("Connection", "close")
        self.end_headers()
        self.wfile.write(content)

    def send_error(self, code: int, message: str | None = None, explain: str | None = None) -> None:
        """Answer what http.server itself refuses (a malformed line, an unknown method) in our own form."""
        self._refuse(HTTPStatus(code), message or HTTPStatus(code).phrase)

    def log_message(self, format: str, *args: Any) -> None:
        """Keep the terminal quiet; the address is all that it should show."""


def _card(sample: Sample) -> Table:
    return {"name": sample.name, "title": sample.title, "about": sample.about}


def _parsed(body: bytes) -> Table:
    try:
        table = json.loads(body, parse_constant=_no_constant)
    except (ValueError, RecursionError):
        raise RefusedError(HTTPStatus.BAD_REQUEST, "the body is not JSON") from None
    if not isinstance(table, dict):
        raise RefusedError(HTTPStatus.BAD_REQUEST, "the body is not a JSON object")
    return table


def _no_constant(word: str) -> float:
    raise ValueError(word)
