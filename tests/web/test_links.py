"""Links restore the whole state of the page, and say where they cannot."""

import re
from pathlib import Path
from typing import Any

import pytest
from tests.helpers.waiting import until
from tests.web.acts import pause, turn_to, type_in, wait_for_index

import flexapod as fx

MACHINE = fx.load("mukherjee-ii")
SCHEMA = (Path(__file__).parents[2] / "web" / "src" / "state" / "options.ts").read_text(encoding="utf-8")
OPTIONS = re.findall(r"^  (\w+)(?:: |,)", SCHEMA.split("export const OPTIONS = {")[1].split("\n}\n")[0], re.M)

CONTROLS = "input, select, textarea, button[aria-pressed], [contenteditable]"
NOT_IN_LINKS = """[...document.querySelectorAll(%r)].filter(e =>
  !e.dataset.option && !e.closest('[data-part]') && e.type !== 'file' && !e.matches('#time [aria-label="Time of the playback"]')
  && !e.matches('.play')).map(e => e.outerHTML)"""


def test_every_control_is_in_the_schema_of_the_links(opened: Any) -> None:
    """Or part of design, changes, pose or box, which links have too. Files and the hand of a playback are not state."""
    page = opened("design=mukherjee-ii&tab=time&duration=0.01")
    page.locator("#simulate").click()
    page.locator("#time .progress-words", has_text="steps").wait_for()
    turn_to(page, "Response")
    page.locator("#response .lines canvas").nth(5).wait_for()
    assert page.evaluate(NOT_IN_LINKS % CONTROLS) == []
    used = set(page.evaluate("[...document.querySelectorAll('[data-option]')].map(e => e.dataset.option)"))
    assert used == set(OPTIONS) - {"tab", "mode", "view"}  # tabs, buttons of modes, and of views


def test_controls_of_a_link_are_as_they_were(opened: Any) -> None:
    """Each control is changed as a user does; the link opens a page in which each is the same."""
    page = opened("design=mukherjee-ii&tab=modes")
    read = """Object.fromEntries([...document.querySelectorAll('[data-option]')].map(e => [
      e.dataset.option + (e.dataset.name ?? e.closest('[data-key]')?.dataset.key ?? ''),
      e.getAttribute('aria-pressed') ?? e.value]))"""
    turn_to(page, "Response")
    page.locator("#response .lines canvas").nth(5).wait_for()
    before = page.evaluate(read)
    page.evaluate("""() => {
      for (const e of document.querySelectorAll('[data-option]')) {
        if (e.dataset.option === 'motion') continue
        if (e.matches('select')) e.selectedIndex = (e.selectedIndex + 1) % e.options.length
        else if (e.type === 'range') e.value = '0.5'
        else if (e.matches('input')) e.value = '1.5'
        else if (e.dataset.option !== 'wide') { e.click(); continue }
        e.dispatchEvent(new Event(e.type === 'range' ? 'input' : 'change', { bubbles: true }))
      }
    }""")
    pause(page, 0.5)
    page.locator("#response .panels[data-answer=current]").wait_for()
    pause(page, 0.5)
    changed = page.evaluate(read)
    same = {key for key in before if before[key] == changed[key]}
    assert same <= {"motion", "wide"}
    other = opened(page.url.split("#")[1])
    other.locator("#response .lines canvas").first.wait_for()
    assert until(lambda: other.evaluate(read) == changed)


def test_a_link_pasted_into_an_open_page_resets_what_it_leaves_out(opened: Any) -> None:
    """The joint model once stayed that of the page before."""
    link = "design=mukherjee-i&pose=0.1,0.2,0.8,0,0,0&tab=modes"
    page = opened("design=mukherjee-ii&joint=spin_free&unit=m&colour=plain&loss=0.1&tab=modes&mode=2&changes={}")
    page.evaluate(f"location.hash = {link!r}")
    pose = fx.Pose([0.1, 0.2, 0.8])
    wait_for_index(page, float(fx.stability_index(fx.load("mukherjee-i"), pose)))
    pause(page, 0.5)
    fresh = opened(link)
    pause(fresh, 0.5)
    assert page.url == fresh.url
    assert page.get_by_label("Joint model").input_value() == "universal"


def test_a_link_is_not_lost_where_the_page_writes_its_own_address_meanwhile(opened: Any) -> None:
    page = opened("design=mukherjee-ii&tab=modes")
    pause(page, 0.5)
    link = "#design=mukherjee-i&pose=0.1,0.2,0.8,0,0,0&tab=modes"
    page.evaluate(
        """link => {
      const own = location.hash
      location.hash = link
      history.replaceState(null, '', own)
    }""",
        link,
    )
    wait_for_index(page, float(fx.stability_index(fx.load("mukherjee-i"), fx.Pose([0.1, 0.2, 0.8]))))


@pytest.mark.parametrize("next_by", ["link", "file"])
def test_changes_of_a_link_do_not_reach_the_machine_of_the_next(next_by: str, opened: Any, tmp_path: Path) -> None:
    page = opened("design=mukherjee-ii&tab=modes")
    late: list[Any] = []

    def held(route: Any) -> None:
        if route.request.post_data_json["changes"]:
            late.append(route)
        else:
            route.continue_()

    machine = fx.load("mukherjee-i")
    page.route("**/api/design", held)
    page.evaluate("""location.hash = 'design=motion-base&changes={"platform.mass":400}&tab=modes'""")
    assert until(lambda: page.evaluate("1") and late)
    if next_by == "link":
        page.evaluate("location.hash = 'design=mukherjee-i&tab=modes'")
    else:
        machine.save(tmp_path / "next.toml")
        page.set_input_files("#design-file", tmp_path / "next.toml")
    index = float(fx.stability_index(machine))
    wait_for_index(page, index)
    late[0].continue_()
    pause(page, 1.0)
    page.locator(".readout[data-answer=current]").wait_for()
    wait_for_index(page, index)
    assert "400" not in page.evaluate("new URLSearchParams(location.hash.slice(1)).get('changes') ?? ''")
    page.unroute_all(behavior="wait")


@pytest.mark.parametrize(
    ("link", "words"),
    [
        ("design=nope", "there is no design “nope” here; there are cubic-isolator, dehaeze-cubic"),
        ("design=constructor", "there is no design “constructor” here"),
        ("toml=qqqq", "the design in it is damaged"),
        ("toml=", "the design in it is damaged"),
        ("design=mukherjee-ii&changes={broken", "the changes to the design in it are damaged"),
        ('design=mukherjee-ii&changes={"platform.mass":-4}', "platform.mass is -4 kg; it must be > 0"),
        ('design=mukherjee-ii&changes={"platform.colour":1}', "platform.colour"),
        ("design=mukherjee-ii&pose=1,2,3", "its pose, “1,2,3”, is not six numbers"),
        ("design=mukherjee-ii&joint=ball", "joint is “ball”; it must be one of universal, spin_free"),
        ("design=mukherjee-ii&jiont=spin_free", "“jiont” is nothing that this page knows"),
    ],
)
def test_a_damaged_link_says_what_is_wrong_and_shows_the_rest(link: str, words: str, opened: Any) -> None:
    page = opened(link)
    page.locator("#faults", has_text=words).wait_for()
    assert page.locator("#index").text_content()
    page.get_by_role("button", name="Close").first.click()
    assert page.locator("#faults").is_hidden()
    type_in(page, "yaw", "1")
    page.locator(".readout[data-answer=current]").wait_for()
    assert page.locator("#faults").is_hidden()
