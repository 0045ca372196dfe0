"""A result on the page belongs to its question: design, pose, joint model, box, settings."""

from typing import Any

import numpy as np
import pytest
from tests.web.acts import address, pause, saved, turn_to, type_in, wait_for_index

import flexapod as fx

MACHINE = fx.load("mukherjee-ii")


def change_pose(page: Any) -> None:
    type_in(page, "z", "90")


def change_design(page: Any) -> None:
    type_in(page, "Platform + payload kg", "40")


def change_joint(page: Any) -> None:
    page.get_by_label("Joint model").select_option("spin_free")


def change_box(page: Any) -> None:
    page.evaluate("document.querySelector('[data-part=box]').open = true")
    type_in(page, "Greatest z, m", "0.1")


CHANGES = {"pose": change_pose, "design": change_design, "joint model": change_joint, "pose box": change_box}
HOLDS = {  # the parts of its question, of each result
    "#cloud .plot": {"design", "joint model", "pose box"},
    "#slice .plot": {"pose", "design", "joint model", "pose box"},
    "#response .panels": {"pose", "design", "joint model"},
}
TABS = {"#cloud .plot": "Workspace", "#slice .plot": "Workspace", "#response .panels": "Response"}


class Asked:
    """What a page has asked the server, by the end of the path."""

    def __init__(self, page: Any) -> None:
        self.bodies: dict[str, list[dict[str, Any]]] = {}
        page.on("request", self._take)

    def _take(self, request: Any) -> None:
        if request.method == "POST":
            self.bodies.setdefault(request.url.rsplit("/", 1)[1], []).append(request.post_data_json)


@pytest.mark.parametrize("place", HOLDS)
def test_a_result_out_of_sight_is_asked_again_when_it_is_seen(place: str, opened: Any) -> None:
    """After any change of its question made on another tab; and only then."""
    page = opened("design=mukherjee-ii&tab=" + TABS[place].lower())
    shown = page.locator(place)
    asked = Asked(page)
    kind = place.split()[0][1:]
    shown.and_(page.locator("[data-answer=current]")).wait_for()
    for part, change in CHANGES.items():
        if part == "pose box":
            turn_to(page, "Workspace")
            change(page)
            turn_to(page, "Modes")
        else:
            turn_to(page, "Modes")
            change(page)
        pause(page, 0.4)
        asked.bodies.clear()
        turn_to(page, TABS[place])
        pause(page, 0.5)
        shown.and_(page.locator("[data-answer=current]")).wait_for()
        page.locator(".runner progress").first.wait_for(state="hidden")
        if part != "pose box" or place == "#response .panels":
            assert (kind in asked.bodies) == (part in HOLDS[place]), part
    last = [*asked.bodies.get(kind, [])]
    assert not last or last[-1]["joint"] == "spin_free"


def test_a_slice_is_that_of_the_pose_set_on_another_tab(opened: Any) -> None:
    """It once stayed at the old height, under words that it was the machine's."""
    page = opened("design=motion-base&tab=workspace")
    page.locator("#slice .progress-words", has_text="14").wait_for()
    turn_to(page, "Modes")
    type_in(page, "z", "2900")
    machine = fx.load("motion-base")
    wait_for_index(page, float(fx.stability_index(machine, fx.Pose([0, 0, 2.9]))))
    turn_to(page, "Workspace")
    page.locator("#slice .plot[data-answer=current]").wait_for()
    page.locator("#slice .progress-words", has_text="14").wait_for()
    rows = saved(page, lambda: page.get_by_role("button", name="Slice as CSV").click()).decode().splitlines()
    table = np.array([[float(cell) for cell in row.split(",")] for row in rows[1:]])
    x, y, index = table[np.hypot(table[:, 0], table[:, 1]).argmin(), :3]
    assert index == pytest.approx(fx.stability_index(machine, fx.Pose([x, y, 2.9])), rel=1e-6)


def test_a_click_in_the_slice_leaves_it_as_it_is(opened: Any) -> None:
    page = opened("design=mukherjee-ii&tab=workspace")
    page.locator("#slice .progress-words", has_text="14").wait_for()
    asked = Asked(page)
    page.locator("#slice .plot").click(position={"x": 150, "y": 100})
    pause(page, 0.6)
    assert "state" in asked.bodies
    assert "slice" not in asked.bodies


def change_form(page: Any) -> None:
    type_in(page, "frequency", "7")


def test_a_simulation_of_another_machine_is_marked_and_cannot_be_used(opened: Any) -> None:
    """After any change of its question; and it is current again when the change is taken back."""
    page = opened("design=mukherjee-ii&tab=time&duration=0.02")
    page.locator("#simulate").click()
    page.locator("#time .progress-words", has_text="steps").wait_for()
    note, csv = page.locator("#time .of-before"), page.get_by_role("button", name="Simulation as CSV")
    play = page.locator("#time .result button", has_text="P")
    assert note.is_hidden()
    before = address(page, "pose=")
    for part, change in {**CHANGES, "settings": change_form}.items():
        if part == "pose box":
            continue
        change(page)
        page.locator(
            "#time .of-before", has_text=f"another {part}" if part != "settings" else "other settings"
        ).wait_for()
        assert csv.is_disabled()
        assert play.is_disabled()
        assert "simulate again" in note.text_content()
        page.wait_for_url(lambda url: url.partition("#")[2] != before)  # the address is that of the change
        page.evaluate(f"location.hash = {before!r}")
        note.wait_for(state="hidden")
        assert csv.is_enabled()


def test_the_words_of_the_worst_pose_belong_to_their_box(opened: Any) -> None:
    page = opened("design=precision-positioner&tab=workspace")
    page.get_by_role("button", name="Worst pose").click()
    page.locator("#worst .progress-words", has_text="rad/s, found by").wait_for()
    type_in(page, "z", "250")
    pause(page, 0.3)
    assert page.locator("#worst .of-before").is_hidden()  # the worst pose of a box is none of the machine's pose
    page.evaluate("document.querySelector('[data-part=box]').open = true")
    type_in(page, "Greatest x, m", "0.001")
    page.locator("#worst .of-before", has_text="another pose box: find the worst pose again").wait_for()


def test_numbers_of_another_pose_are_greyed(opened: Any) -> None:
    """Where the pose asked for cannot be computed, what is shown is that of the pose before, and says so."""
    page = opened("design=mukherjee-ii&tab=modes")
    page.locator(".readout[data-answer=current]").wait_for()
    type_in(page, "Platform + payload kg", "-4")
    page.locator(".readout.stale").wait_for()
    assert page.locator("[data-answer=stale]").count() == 4  # readout, 3-D view, modes, legs
    type_in(page, "Platform + payload kg", "4")
    page.locator(".readout[data-answer=current]").wait_for()
    assert page.locator(".stale").count() == 0
