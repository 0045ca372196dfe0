"""What a user does on the page, for tests in a browser."""

import re
from pathlib import Path
from typing import Any

from tests.helpers.waiting import until


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


def pause(page: Any, seconds: float) -> None:
    """Wait by the page's own clock: what it does within that time is done, however slow the machine is.

    The page looks at each change in its next frame, and sets its timers there: that frame comes first.
    """
    page.evaluate(
        "seconds => new Promise(done => requestAnimationFrame(() => setTimeout(done, 1000 * seconds)))", seconds
    )


def address(page: Any, holds: str) -> str:
    """What a link to the page has behind #, once that holds these words: it is written a while after each change."""
    page.wait_for_url(lambda url: holds in url.partition("#")[2])
    return str(page.url.partition("#")[2])


def box_of(place: Any) -> dict[str, float]:
    """Where an element is, once it stays there: a page that is laid out anew has no place for it, or another one."""
    read = [None, place.bounding_box()]

    def stays() -> bool:
        pause(place.page, 0.1)
        read[:] = read[1], place.bounding_box()
        return read[0] is not None and read[0] == read[1]

    assert until(stays), f"{place} does not stay anywhere"
    return read[1]


def frames(scene: Any) -> int:
    """How often the scene was drawn."""
    return int(scene.get_attribute("data-frames"))


def moves(scene: Any) -> bool:
    """Whether the scene is drawn again and again."""
    begun = frames(scene)
    return until(lambda: frames(scene) > begun + 5)


def rests(scene: Any) -> bool:
    """Whether the scene is no longer drawn, once what was begun has ended."""

    def still() -> bool:
        begun = frames(scene)
        pause(scene.page, 0.4)
        return frames(scene) == begun

    return until(still)


def saved(page: Any, click: Any) -> bytes:
    with page.expect_download() as download:
        click()
    return Path(download.value.path()).read_bytes()
