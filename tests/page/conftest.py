"""A browser for the tests of the page and the replay, or a reason why there is none."""

import json
import os
import shutil
import threading
from dataclasses import replace

import pytest

from wallkit.cli.play import reader
from wallkit.kernels import compile_aside
from wallkit.view.page.bounds import HEAVY
from wallkit.view.page.server import PageServer
from wallkit.view.page.workers import Workers

ARGUMENTS = [
    "--no-sandbox",
    "--disable-gpu",
    "--disable-dev-shm-usage",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]
PATIENCE = 240_000  # milliseconds: a slow machine with other work may have to compile first
NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")


@pytest.fixture(scope="session")
def browser():
    playwright = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
    found = os.environ.get("CHROMIUM") or next(filter(None, map(shutil.which, NAMES)), None)
    if not found:
        pytest.skip(f"no browser: none of {', '.join(NAMES)} is on the PATH")
    with playwright.sync_playwright() as driver:
        running = driver.chromium.launch(executable_path=found, args=ARGUMENTS)
        yield running
        running.close()


def until(page, condition):
    """Wait until a condition in the page holds (its own policy forbids the eval that wait_for_function needs)."""
    assert page.evaluate(
        f"""new Promise((done) => {{ const end = performance.now() + {PATIENCE};
        const look = () => ({condition}) ? done(true) : performance.now() > end ? done(false) : setTimeout(look, 10);
        look(); }})"""
    ), f"waited in vain for {condition}"


class Watch:
    """What a page said and asked for: a test fails on any error, and on any request that leaves the machine."""

    def __init__(self, page, expected=()):
        self.messages, self.requests, self.expected = [], [], list(expected)
        page.on("console", self.heard)
        page.on("pageerror", lambda error: self.messages.append(f"uncaught {error}"))
        page.on("request", lambda request: self.requests.append(request.url))
        page.on("dialog", lambda dialog: (self.messages.append(f"dialog {dialog.message}"), dialog.dismiss()))

    def heard(self, message):
        # The tests read pixels back, which a browser thinks slow.
        if message.type in ("error", "warning") and "willReadFrequently" not in message.text:
            self.messages.append(f"{message.type} {message.text}")

    def check(self):
        unexpected = [text for text in self.messages if not any(part in text for part in self.expected)]
        assert not unexpected
        away = [url for url in self.requests if not url.startswith(("http://127.0.0.1:", "file://", "blob:", "data:"))]
        assert not away


@pytest.fixture(name="until")
def until_fixture():
    return until


@pytest.fixture(scope="session")
def compiled_aside():
    """A function that waits for the compilers that a question has begun, as long as it takes."""

    def wait():
        for process in filter(None, compile_aside._processes.values()):
            process.wait()

    return wait


@pytest.fixture
def opened(browser):
    """Open a URL in a fresh page; when the test ends, see that nothing went wrong in it."""
    contexts = []

    def open_page(url, *, expected=(), **options):
        options = {"viewport": {"width": 1200, "height": 780}, "reduced_motion": "reduce"} | options
        context = browser.new_context(**options)
        page = context.new_page()
        page.set_default_timeout(PATIENCE)
        contexts.append((context, Watch(page, expected)))
        page.goto(url)
        until(page, "globalThis.Wallkit && (Wallkit.replay || Wallkit.page)")
        return page

    yield open_page
    for context, watch in contexts:
        context.close()
        watch.check()


@pytest.fixture(scope="module")
def server():
    bounds = replace(HEAVY, seconds=PATIENCE / 1000)  # bounds have tests of their own
    with PageServer(Workers(reader(), bounds)) as running:
        threading.Thread(target=running.serve_forever, kwargs={"poll_interval": 0.01}, daemon=True).start()
        yield running
        running.shutdown()


@pytest.fixture
def page(opened, server):
    return opened(server.url)


@pytest.fixture
def drop(until):
    """Drop a file on the page, as a hand would: a drag with a file in it."""

    def dropped(page, name, text, waits=True):
        data = page.evaluate_handle(
            """([name, text]) => { const transfer = new DataTransfer();
            transfer.items.add(new File([text], name)); return transfer; }""",
            [name, text],
        )
        page.dispatch_event("body", "dragover", {"dataTransfer": data})
        page.dispatch_event("body", "drop", {"dataTransfer": data})
        if waits:
            until(page, f"Wallkit.page.document && Wallkit.page.document.name === {json.dumps(name)}")

    return dropped


@pytest.fixture
def accessible():
    """See that axe-core finds nothing wrong with a page as it is now, in light and in dark."""
    axe = pytest.importorskip("axe_playwright_python.sync_playwright", reason="axe-playwright-python is not installed")

    def looked_at(page, **options):
        for scheme in ("light", "dark"):
            page.emulate_media(color_scheme=scheme)
            found = axe.Axe().run(page, **options).response["violations"]
            assert [(rule["id"], node["html"][:120]) for rule in found for node in rule["nodes"]] == [], scheme

    return looked_at
