"""A browser for the tests of the page and the replay, or a reason why there is none."""

import os
import shutil

import pytest

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
