"""What a user does on the page, for tests in a browser."""

import re
from pathlib import Path
from typing import Any


def number(text: str) -> float:
    return float(text.replace("−", "-"))


def type_in(page: Any, label: str, text: str) -> None:
    box = page.get_by_label(label, exact=True)
    box.fill(text)
    box.press("Enter")


def turn_to(page: Any, tab: str) -> None:
    page.get_by_role("tab", name=tab, exact=True).click()


def wait_for_index(page: Any, expected: float) -> None:
    page.locator("#index", has_text=re.compile(f"^{re.escape(f'{expected:#.5g}'.rstrip('.'))}$")).wait_for()


def saved(page: Any, click: Any) -> bytes:
    with page.expect_download() as download:
        click()
    return Path(download.value.path()).read_bytes()
