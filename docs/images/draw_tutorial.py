"""Draws the figures of docs/tutorial.md, by doing what it says, with chromium: python docs/images/draw_tutorial.py."""

import contextlib
import io
import os
import shutil
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from playwright.sync_api import sync_playwright

from flexapod.cli import main

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parents[1]))
from tests.helpers.documents import run_document  # noqa: E402
from tests.web.browser import CHROMIUM, FLAGS  # noqa: E402


def run(*arguments: str) -> tuple[int, str, str]:
    with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.redirect_stderr(io.StringIO()) as err:
        code = main(list(arguments))
    return code, out.getvalue(), err.getvalue()


def photograph(page: Path, picture: Path) -> None:
    """The top of a report, as a browser shows it."""
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        tab = browser.new_page(viewport={"width": 1100, "height": 860}, color_scheme="light")
        tab.goto(page.as_uri())
        tab.screenshot(path=picture)
        browser.close()


def draw() -> None:
    with TemporaryDirectory() as name, contextlib.chdir(name):
        os.environ["COLUMNS"] = "80"
        folder = Path(name)
        run_document(HERE.parent / "tutorial.md", folder, run)
        photograph(folder / "camera-mount.html", HERE / "tutorial-report.png")
        shutil.copy(folder / "map.png", HERE / "tutorial-map.png")
        shutil.copy(folder / "better" / "camera-mount-optimised.png", HERE / "tutorial-better.png")


if __name__ == "__main__":
    draw()
