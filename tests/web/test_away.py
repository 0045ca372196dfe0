"""While the server does not answer, the page says so, names the machine that it shows, and tries again by itself."""

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from tests.web.acts import number, type_in, wait_for_index
from tests.web.browser import PATIENCE

import flexapod as fx


@contextmanager
def serving(port: int) -> Iterator[str]:
    command = [sys.executable, "-m", "flexapod", "serve", "motion-base", "--port", str(port), "--json"]
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, text=True, env={**os.environ, "PYTHONUNBUFFERED": "1"}
    ) as run:
        assert run.stdout is not None
        yield json.loads(run.stdout.readline())["url"]
        run.terminate()


def test_a_page_outlives_its_server(browser: Any) -> None:
    with serving(0) as url:
        page = browser.new_page()
        page.set_default_timeout(PATIENCE)
        page.goto(f"{url}#design=motion-base&tab=response")
        page.locator("#response .lines canvas").nth(5).wait_for()
        before = page.locator("#index").text_content()
    design, away = page.get_by_role("banner").get_by_role("combobox"), page.locator("#away")
    type_in(page, "z", "2400")
    away.wait_for()
    assert "tries again by itself" in away.text_content()
    page.locator(".readout.stale").wait_for()
    assert page.locator("#index").text_content() == before
    design.select_option("cubic-isolator")
    page.locator(".toast", has_text="cubic-isolator opens as soon as the server answers again").wait_for()
    assert design.input_value() == "motion-base"  # what is shown
    assert page.locator("#design .hint", has_text="not a design").count() == 0
    with serving(int(url.rsplit(":", 1)[1].strip("/"))):
        away.wait_for(state="hidden")
        machine = fx.load("cubic-isolator")
        wait_for_index(page, float(fx.stability_index(machine, fx.home_pose(machine))))
        assert design.input_value() == "cubic-isolator"
        page.locator("#response .panels[data-answer=current]").wait_for()
        assert page.title().startswith("cubic-isolator")
    page.close()


def test_what_was_asked_meanwhile_is_answered_when_the_server_is_back(browser: Any) -> None:
    with serving(0) as url:
        page = browser.new_page()
        page.set_default_timeout(PATIENCE)
        page.goto(f"{url}#design=motion-base&tab=modes")
        page.locator("#index:not(:empty)").wait_for()
    type_in(page, "z", "2400")
    type_in(page, "Platform + payload kg", "4000")
    page.locator("#away").wait_for()
    with serving(int(url.rsplit(":", 1)[1].strip("/"))):
        machine = fx.load("motion-base").replace({"platform.mass": 4000.0})
        wait_for_index(page, float(fx.stability_index(machine, fx.Pose([0, 0, 2.4]))))
        page.locator(".readout[data-answer=current]").wait_for()
        page.locator(".refused").wait_for(state="hidden")
        assert number(page.get_by_label("Platform + payload kg", exact=True).input_value()) == 4000
    page.close()
