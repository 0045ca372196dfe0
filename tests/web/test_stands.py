"""Where the machine does not stand, or cannot go: said before its numbers, and not counted among them."""

import json
import re
from typing import Any
from urllib.parse import quote

import numpy as np
import pytest
from tests.helpers.waiting import until
from tests.web.acts import number, saved

import flexapod as fx


def test_poses_beyond_the_limits_are_grey_and_do_not_count(opened: Any) -> None:
    page = opened("design=motion-base&tab=workspace")
    words = page.locator("#cloud .progress-words", has_text="% within the limits, the others are grey")
    words.wait_for()
    cells = page.locator("#cloud-table tbody td")
    lowest = number(cells.first.text_content())
    rows = np.genfromtxt(
        saved(page, lambda: page.get_by_role("button", name="Cloud as CSV").click()).decode().splitlines(),
        delimiter=",",
        names=True,
    )
    machine = fx.load("motion-base")
    six = [rows[name][:300] for name in ("x_m", "y_m", "z_m", "roll_deg", "pitch_deg", "yaw_deg")]
    ok = fx.check_limits(machine, fx.Pose.from_rpy(*six[:3], *np.radians(six[3:]))).ok
    np.testing.assert_array_equal(rows["within_limits"][:300], ok)
    within = rows["within_limits"] > 0
    assert lowest == pytest.approx(np.nanmin(rows["index_rad_s"][within]), rel=1e-4)
    assert number(re.search(r"(\S+) % within", words.text_content())[1]) == pytest.approx(100 * within.mean(), rel=5e-3)
    page.get_by_label("Which poses count").select_option("all")
    page.locator("#cloud .progress-words", has_text="and all count").wait_for()
    assert number(cells.first.text_content()) == pytest.approx(np.nanmin(rows["index_rad_s"]), rel=1e-4)
    page.get_by_label("Which poses count").select_option("within")
    page.get_by_role("button", name="Worst pose").click()
    page.locator("#worst .progress-words", has_text="of the box is within the limits").wait_for()
    assert until(lambda: number(page.locator("#index").text_content()) <= lowest)
    assert page.locator(".notes .exceeded").count() == 0


def test_a_machine_that_falls_over_says_so_before_all_else(opened: Any) -> None:
    """Its index and limits alone look as good as any."""
    heavy = "design=cubic-isolator&changes=%7B%22platform.mass%22%3A200%7D&pose=0.004,0,0.0346,0,2,0&tab=modes"
    page = opened(heavy)
    state = page.locator("#stability", has_text="falls over")
    state.wait_for()
    assert page.locator(".readout .grave").count() == 1
    assert page.locator(".readout .figure").first.text_content().startswith("At rest")
    first = page.locator(".notes li").first
    assert "Not stable at rest" in first.text_content()
    assert first.evaluate("e => e.className") == "grave"
    page.locator(".readout [aria-live]", has_text="At rest: falls over.").wait_for()
    machine = fx.load("cubic-isolator").replace({"platform.mass": 200.0})
    modes = fx.linearise(machine, fx.Pose.from_rpy(0.004, 0, 0.0346, 0, np.radians(2), 0)).modes()
    grows = int((modes.pole.real > 0).sum())
    assert page.locator("#modes-table tbody tr", has_text="falls over").count() == grows
    rows = page.locator("#modes-table tbody tr")
    for row in rows.all():  # heave stands; roll and pitch fall
        words = row.locator(".words").text_content()
        if "mostly z" in words:
            assert "falls over" not in row.text_content()


def test_a_singular_machine_says_so_before_its_limits(opened: Any) -> None:
    """A platform like its base, in the base's plane."""
    text = fx.load("precision-positioner").to_toml()
    machine = fx.Hexapod.from_toml(text)
    flat = {"base.joints": machine.base_joints.tolist(), "platform.joints": (0.7 * machine.base_joints).tolist()}
    flat["legs.joint_stiffness"] = None  # which would hold it
    page = opened("design=precision-positioner&pose=0,0,0.2,0,0,0&tab=modes&changes=" + quote(json.dumps(flat)))
    page.locator("#stability", has_text="singular").wait_for()
    notes = page.locator(".notes li").all_text_contents()
    assert notes[0].startswith("The pose is singular")
    assert any(note.startswith("▲") for note in notes[1:])
