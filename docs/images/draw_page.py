"""Draws the pictures of the page in docs/web.md and README.md, with chromium: python docs/images/draw_page.py."""

import json
import os
import subprocess
import sys
from pathlib import Path

from playwright.sync_api import sync_playwright

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parents[1]))
from tests.web.browser import CHROMIUM, FLAGS  # noqa: E402

STATE = "design=mukherjee-i&pose=0.06,0.16,0.84,6,-4,12&tab=modes&mode=2&drawn=0.2"
SERVE = [sys.executable, "-m", "flexapod", "serve", "--port", "0", "--json"]


def draw() -> None:
    with (
        subprocess.Popen(SERVE, stdout=subprocess.PIPE, text=True, env={**os.environ, "PYTHONUNBUFFERED": "1"}) as run,
        sync_playwright() as playwright,
    ):
        assert run.stdout is not None
        url = json.loads(run.stdout.readline())["url"]
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        for scheme in ("light", "dark"):
            page = browser.new_page(viewport={"width": 1400, "height": 850}, color_scheme=scheme)
            page.goto(f"{url}#{STATE}")
            page.locator(".readout[data-answer=current]").wait_for()
            page.wait_for_timeout(1500)  # fonts, and a mode in full swing
            page.screenshot(path=HERE / f"web-{scheme}.png")
        browser.close()
        run.terminate()


if __name__ == "__main__":
    draw()
