"""A running server, a real browser without a network, and pages that fail a test when they break their own rules."""

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from typing import Any

import pytest
from tests.web.browser import CHROMIUM, FLAGS, PATIENCE

# What a page may do to a design is bounded by no network: these are the messages that a browser itself writes.
QUIET = ("GPU stall due to ReadPixels", "status of 422", "status of 421", "status of 403")


@pytest.fixture(scope="session")
def server() -> Iterator[str]:
    """Address of `flexapod serve` on a free port."""
    command = [sys.executable, "-m", "flexapod", "serve", "mukherjee-ii", "--port", "0", "--json"]
    environment = {**os.environ, "PYTHONUNBUFFERED": "1"}
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment) as run:
        assert run.stdout is not None
        yield json.loads(run.stdout.readline())["url"]
        run.terminate()


@pytest.fixture(scope="session")
def browser() -> Iterator[Any]:
    sync_api = pytest.importorskip("playwright.sync_api")
    if CHROMIUM is None:
        pytest.skip("chromium is not installed")
    with sync_api.sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        yield chromium
        chromium.close()


class Opener:
    """Opens pages, each in a context of its own, and remembers what they asked for and complained of."""

    def __init__(self, browser: Any, server: str) -> None:
        self.browser, self.server = browser, server
        self.requests: list[str] = []
        self.complaints: list[str] = []
        self.contexts: list[Any] = []

    def __call__(self, address: str = "", **options: Any) -> Any:
        context = self.browser.new_context(viewport={"width": 1280, "height": 640}, accept_downloads=True, **options)
        context.set_default_timeout(PATIENCE)
        self.contexts.append(context)
        page = context.new_page()
        page.on("request", lambda request: self.requests.append(request.url))
        page.on("pageerror", lambda error: self.complaints.append(str(error)))
        page.on("console", self._listen)
        page.goto(f"{self.server}#{address}")
        page.locator("#index:not(:empty)").wait_for()
        return page

    def _listen(self, message: Any) -> None:
        if message.type in ("error", "warning") and not any(quiet in message.text for quiet in QUIET):
            self.complaints.append(message.text)

    def close(self) -> None:
        for context in self.contexts:
            context.close()


@pytest.fixture
def opened(browser: Any, server: str) -> Iterator[Opener]:
    """`opened("design=mukherjee-ii&tab=modes")` is a page. After the test: no complaint, no request off localhost."""
    opener = Opener(browser, server)
    yield opener
    opener.close()
    assert opener.complaints == []
    assert all(url.startswith((server, "data:", "blob:")) for url in opener.requests)
