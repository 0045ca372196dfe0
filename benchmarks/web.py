"""How quickly the page answers: `python -m benchmarks.web` (needs chromium; software WebGL is what it measures).

- page ready: from navigation to a drawn cloud of 100 000 poses, in a fresh browser context with a warm server
- slider to table: from one input event of a slider to the changed table, median and 95th percentile over 100 moves,
  with and without a rest between them in which the page draws
- frames per second of an animated mode at 1400 x 850
- many pages: 20 clients, each with one question in flight and ten moves a second, as hands on sliders make them
"""

from __future__ import annotations

import contextlib
import http.client
import json
import os
import statistics
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import cycle
from typing import Any
from urllib.parse import urlsplit

import psutil
from tests.web.browser import CHROMIUM, FLAGS

from benchmarks._contest import OURS, Contender, Contest, Plan
from benchmarks._machine import all_cores

MOVES = 100
SHARES = [0.3 + 0.4 * ((i * 37) % MOVES) / MOVES for i in range(MOVES)]  # where the slider goes
PAGES = 20
SECONDS = 10.0

# In the page: moves a slider and waits for the first cell of the table to change.
MOVE = """async (share) => {
  const slider = document.querySelector('input[aria-label="x slider"]')
  const cell = () => document.querySelector('#modes-table tbody td').textContent
  const before = cell()
  slider.value = String(Number(slider.min) + share * (Number(slider.max) - Number(slider.min)))
  const began = performance.now()
  slider.dispatchEvent(new Event('input', { bubbles: true }))
  while (cell() === before && performance.now() - began < 5000) await new Promise((r) => setTimeout(r, 1))
  return performance.now() - began
}"""


@contextmanager
def served() -> Iterator[tuple[str, int]]:
    """A server's address and process."""
    command = [sys.executable, "-m", "flexapod", "serve", "--port", "0", "--json"]
    environment = {**os.environ, "PYTHONUNBUFFERED": "1"}
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment) as process:
        assert process.stdout is not None
        try:
            yield json.loads(process.stdout.readline())["url"], process.pid
        finally:
            process.terminate()


def opened(browser: Any, url: str, tab: str) -> Any:
    page = browser.new_context(viewport={"width": 1400, "height": 850}).new_page()
    page.goto(f"{url}#design=motion-base&tab={tab}", wait_until="commit")
    page.locator("#index:not(:empty)").wait_for()
    return page


def page_ready(browser: Any, url: str) -> float:
    """Seconds to the cloud of 100 000 poses, as the page's own clock has it."""
    page = opened(browser, url, "workspace")
    page.locator("#cloud[data-points='100000']").wait_for()
    ready = page.evaluate("new Promise(r => requestAnimationFrame(() => r(performance.now())))") / 1000
    page.context.close()
    return float(ready)


def slider_to_table(browser: Any, url: str, pause: float) -> list[float]:
    """Milliseconds from a move of a slider to the changed table; `pause` ms after each, in which the page draws."""
    page = opened(browser, url, "modes")
    page.wait_for_timeout(1000)
    found = []
    for share in SHARES:
        found.append(float(page.evaluate(MOVE, share)))
        page.wait_for_timeout(pause)
    page.context.close()
    return found


def frames_per_second(browser: Any, url: str) -> float:
    page = opened(browser, url, "modes")
    page.get_by_role("button", name="Animate mode 1").click()
    page.wait_for_timeout(1000)
    scene = page.locator(".scene")
    began, first = time.perf_counter(), int(scene.get_attribute("data-frames"))
    page.wait_for_timeout(5000)
    rate = (int(scene.get_attribute("data-frames")) - first) / (time.perf_counter() - began)
    page.context.close()
    return rate


class Page:
    """A page as a browser holds it: one connection that is kept, and the cookie of its first answer."""

    def __init__(self, url: str, own: str = "127.0.0.1") -> None:
        """own: the address from which it asks."""
        address = urlsplit(url)
        self._server = http.client.HTTPConnection(address.hostname or "", address.port, 60, (own, 0))
        self._head = {"content-type": "application/json"}
        self.cookie = ""
        self.start = json.loads(self.ask("GET", "start"))

    def ask(self, method: str, path: str, body: bytes | None = None) -> bytes:
        """The answer, which must be a good one."""
        self._server.request(method, f"/api/{path}", body, self._head)
        answer = self._server.getresponse()
        if cookie := answer.headers["set-cookie"]:
            self.cookie = self._head["cookie"] = cookie.split(";")[0]
        content = answer.read()
        if answer.status != 200:
            raise OSError(f"{path}: {answer.status} {content[:200]!r}")
        return content


def many_pages(pages: list[Page]) -> list[float]:
    """Milliseconds of every answer to pages with ten moves a second each, as hands on sliders make them."""
    text = pages[0].start["presets"]["motion-base"]
    found: list[float] = []
    faults: list[Exception] = []
    end = time.perf_counter() + SECONDS

    def use(page: Page, number: int) -> None:
        i = 0
        while time.perf_counter() < end:
            i += 1
            pose = [0.001 * (i % 500), 0.002 * number, 2.39, 0, 0, 0]
            body = json.dumps({"design": text, "changes": {}, "pose": pose, "joint": "universal"}).encode()
            began = time.perf_counter()
            try:
                page.ask("POST", "state", body)
            except (OSError, http.client.HTTPException) as error:
                faults.append(error)
                return
            found.append(1e3 * (time.perf_counter() - began))
            time.sleep(max(0.0, 0.1 - (time.perf_counter() - began)))

    threads = [threading.Thread(target=use, args=given) for given in zip(pages, range(len(pages)), strict=True)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    if faults:
        raise faults[0]
    return found


def memory(pid: int) -> float:
    """MB of a process and those that it started, what they share counted once."""
    process = psutil.Process(pid)
    total = 0
    for one in (process, *process.children(recursive=True)):
        with contextlib.suppress(psutil.NoSuchProcess):
            total += one.memory_full_info().pss
    return total / 2**20


def percentile(values: list[float], share: float) -> float:
    return sorted(values)[min(len(values) - 1, int(share * len(values)))]


def contests(plan: Plan) -> Iterator[Contest]:
    """The page by itself: no other tool does this."""
    if plan.quick or CHROMIUM is None or not plan.has("playwright"):
        return
    from playwright.sync_api import sync_playwright

    with all_cores(), served() as (url, _), sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        page_ready(browser, url)
        page = opened(browser, url, "modes")
        shares = cycle(SHARES)

        def move() -> float:
            seconds = float(page.evaluate(MOVE, next(shares))) / 1000
            page.wait_for_timeout(300)  # it draws
            return seconds

        for task, unit, how, run in (
            ("Page opens", "page", "to a drawn cloud of 100 000 poses", lambda: page_ready(browser, url)),
            ("Page follows", "move", "slider to table", lambda: statistics.median(move() for _ in range(5))),
        ):
            yield Contest(task, unit, "", [Contender(OURS, "flexapod", how, run)])
        browser.close()


def main() -> None:
    from playwright.sync_api import sync_playwright

    with served() as (url, pid):
        time.sleep(3)
        print(f"server at rest: {memory(pid):.0f} MB with its idle job process; load average {os.getloadavg()[0]:.1f}")
        with sync_playwright() as playwright:
            browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
            page_ready(browser, url)
            ready = [page_ready(browser, url) for _ in range(5)]
            print(f"page ready with 100 000 poses: median {statistics.median(ready):.2f} s, worst {max(ready):.2f} s")
            for words, pause in (("one move", 300.0), ("without rest", 0.0)):
                moves = slider_to_table(browser, url, pause)
                middle, slow = statistics.median(moves), percentile(moves, 0.95)
                print(f"slider to table, {words}: median {middle:.0f} ms, p95 {slow:.0f} ms")
            print(f"an animated mode in software WebGL: {frames_per_second(browser, url):.0f} frames/s")
            browser.close()
        answers = many_pages([Page(url) for _ in range(PAGES)])
        print(
            f"{PAGES} pages, ten moves a second each: {len(answers) / SECONDS:.0f} answers/s, median "
            f"{statistics.median(answers):.0f} ms, p95 {percentile(answers, 0.95):.0f} ms, {memory(pid):.0f} MB; "
            f"load average {os.getloadavg()[0]:.1f}"
        )


if __name__ == "__main__":
    main()
