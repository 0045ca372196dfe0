"""Draws the pictures of the view in docs/notebooks.md, with chromium: python docs/images/draw_view.py."""

import sys
from pathlib import Path

from playwright.sync_api import sync_playwright

import flexapod as fx

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parents[1]))
from tests.web.browser import CHROMIUM, FLAGS  # noqa: E402
from tests.web.cells import Notebook  # noqa: E402

PAPER = {"light": "background: #fff; color: #222", "dark": "background: #111; color: #ddd"}


def draw() -> None:
    view = fx.view(fx.load("motion-base"), fx.Pose.from_rpy(0.2, -0.1, 2.5, 4, -6, 10, degrees=True))
    view.mode = 2
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        for scheme, style in PAPER.items():
            page = browser.new_page(viewport={"width": 916, "height": 640}, color_scheme=scheme)
            cell = Notebook(page, style).show(view)
            page.wait_for_timeout(1500)  # fonts, and a mode in full swing
            cell.screenshot(path=HERE / f"view-{scheme}.png")
            page.close()
        browser.close()


if __name__ == "__main__":
    draw()
