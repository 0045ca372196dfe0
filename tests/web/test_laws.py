"""Stiffness laws, springs in series, a suspension and losses on the page: in the answers, and in a browser."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.web.acts import saved, turn_to, type_in, wait_for_index
from tests.web.browser import PATIENCE

import flexapod as fx

pytest.importorskip("starlette")
from flexapod.design.schema import KEYS
from flexapod.web.description import described, fields
from flexapod.web.designs import Source
from flexapod.web.laws import law_choices
from flexapod.web.response import response, shake
from flexapod.web.state import snapshot

MACHINES = {
    "limits": fx.load("precision-positioner"),
    "no limits": fx.load("mukherjee-ii"),
    "six stiffnesses, in series": fx.load("motion-base").replace(
        {"legs.stiffness": [8e6, 7e6, 9e6, 8e6, 6e6, 8e6], "legs.series_stiffness": [5e7, 9e7]}
    ),
}


@pytest.mark.parametrize("kind", ["constant", "screw", "hydraulic", "table"])
@pytest.mark.parametrize("name", MACHINES)
def test_each_law_starts_as_stiff_at_home_as_the_legs_are(name: str, kind: str) -> None:
    machine = MACHINES[name]
    changed = machine.replace(law_choices(machine)[kind])
    assert (changed.legs.stiffness_law is None) == (kind == "constant")
    known = fx.natural_modes(machine, _home(machine)).omega
    found = fx.natural_modes(changed, _home(machine)).omega
    one_for_all = kind == "table" and np.ptp(machine.legs.stiffness) > 0  # its legs are alike then
    np.testing.assert_allclose(found, known, rtol=0.1 if one_for_all else 1e-12)
    for back in ("constant", "screw", "hydraulic"):
        again = changed.replace(law_choices(changed)[back])
        np.testing.assert_allclose(fx.natural_modes(again, _home(machine)).omega, found, rtol=1e-12)


def _home(machine: fx.Hexapod) -> Any:
    return machine.home or fx.Pose(described(Source(machine.to_toml()))["home"][:3])


def test_the_form_has_every_number_but_short_forms() -> None:
    known = {field["key"]: field for field in fields()}
    for key in ("legs.series_stiffness", "legs.stiffness_law.stroke", "suspension.damping", "legs.joint_rest.position"):
        assert key in known
    assert {key for key in KEYS if key.startswith("drive.")} <= known.keys()
    assert known["legs.stiffness_law.stroke"]["laws"] == ["hydraulic"]
    assert known["legs.stiffness"]["laws"] == []
    assert known["suspension.stiffness"]["shapes"] == [[6], [6, 6]]
    for kind, law in fx.design.stiffness_laws.LAWS.items():
        numbers = {key for key, field in known.items() if kind in field["laws"]}
        assert numbers == {f"legs.stiffness_law.{name}" for name in fx.design.stiffness_laws.keys_of(law)}


def _asked(machine: fx.Hexapod, **options: Any) -> dict[str, Any]:
    home = described(Source(machine.to_toml()))["home"]
    return {"design": machine.to_toml(), "changes": {}, "pose": home, "joint": "universal", **options}


@pytest.mark.parametrize(
    ("changes", "box", "words"),
    [
        ({}, 0, "No loss factors act."),
        ({"legs.loss_factor": 0.02}, 0, "0.02 in the legs, of the design."),
        ({"legs.loss_factor": 0.02}, 0.1, "0.1 in the legs, of the box."),
        ({"legs.joint_stiffness": {"spherical": 1.0, "loss_factor": [0.1] * 5 + [0.2]}}, 0, "0.1 to 0.2 in the joints"),
        ({"legs.joint_stiffness": {"loss_factor": 0.1}}, 0, "No loss factors act."),  # joints without stiffness
    ],
)
def test_a_response_says_which_losses_act_and_has_them(changes: dict[str, Any], box: float, words: str) -> None:
    machine = fx.load("mukherjee-ii").replace(changes)
    asked = _asked(machine, quantity="absolute", loss_factor=box)
    found = response(asked)
    assert words in found["losses"]
    options = {"loss_factor": box} if box else {}
    pose = fx.Pose(asked["pose"][:3])
    exact = abs(fx.transmissibility(machine, pose, omega=found["omega"], **options)["absolute"].to_numpy())
    np.testing.assert_allclose(np.moveaxis(np.array(found["magnitude"]), -1, 0), exact, rtol=1e-4, atol=1e-12)
    resonance = float(found["modes"][0]["omega"])
    shaken = shake({**asked, "axis": "x", "omega": resonance})
    there = fx.transmissibility(machine, pose, omega=[resonance], **options)["absolute"].sel(base="x").to_numpy()[0]
    np.testing.assert_allclose(np.array(shaken["platform"]["real"]) + 1j * np.array(shaken["platform"]["imag"]), there)


def test_a_law_is_chosen_and_its_numbers_change_the_machine(opened: Any) -> None:
    page = opened("design=mukherjee-ii&tab=design")
    page.locator("#design summary", has_text="Legs").click()
    rows = page.locator("#design .field-row")
    shown = lambda key: page.locator(f"#design .field-row[data-key='{key}']")  # noqa: E731
    assert shown("legs.stiffness").is_visible()
    assert shown("legs.stiffness_law.fixed").is_hidden()
    page.get_by_label("Stiffness of the legs").select_option("screw")
    shown("legs.stiffness_law.fixed").wait_for()
    assert shown("legs.stiffness").is_hidden()
    assert page.get_by_label("Leg stiffness N/m", exact=True).is_hidden()
    assert shown("legs.stiffness_law.stroke").is_hidden()
    machine, pose = fx.load("mukherjee-ii"), [0, 0, 0.085, 0, 0, 0]
    wait_for_index(page, fx.natural_modes(machine, pose).omega[0])
    law = law_choices(machine)["screw"]["legs.stiffness_law"]
    fixed = page.get_by_label("legs.stiffness_law.fixed N/m")
    fixed.fill("1e8")
    fixed.press("Enter")
    page.get_by_label("Stiffness of the legs").select_option("constant")  # before the page knows the softer legs
    softer = machine.replace({"legs.stiffness_law": law | {"fixed": 1e8}})
    shown("legs.stiffness").wait_for()
    wait_for_index(page, fx.natural_modes(softer, pose).omega[0])
    assert rows.count() > 30


def test_springs_in_series_and_a_suspension_are_edited(opened: Any) -> None:
    page = opened("design=mukherjee-ii&tab=design")
    page.locator("#design summary", has_text="Legs").click()
    series = page.get_by_label("legs.series_stiffness N/m, separated by semicolons")
    series.fill("1e8; two")
    series.press("Enter")
    page.locator(".field-row[data-key='legs.series_stiffness'] .wrong", has_text="“two” is not a number.").wait_for()
    series.fill("1e8; 2e8")
    series.press("Enter")
    machine, pose = fx.load("mukherjee-ii").replace({"legs.series_stiffness": [1e8, 2e8]}), [0, 0, 0.085, 0, 0, 0]
    wait_for_index(page, fx.natural_modes(machine, pose).omega[0])
    assert series.input_value() == "1e8; 2e8"
    page.locator("#design summary", has_text="Suspension").click()
    for place, text in enumerate(["1e6", "1e6", "1e6", "1e3", "1e3", "1e3"]):
        cell = page.get_by_label(f"suspension.stiffness[{place}]", exact=False).first
        cell.fill(text)
        cell.press("Enter")
    held = machine.replace({"suspension.stiffness": [1e6, 1e6, 1e6, 1e3, 1e3, 1e3]})
    wait_for_index(page, fx.natural_modes(held, pose).omega[0])
    series.fill("")
    series.press("Enter")
    wait_for_index(page, fx.natural_modes(held.replace({"legs.series_stiffness": None}), pose).omega[0])


def test_a_drive_is_edited_and_points_are_kept(opened: Any, tmp_path: Path) -> None:
    motor = {"speeds": [0, 300, 400], "peak_torques": [9, 9, 6], "continuous_torques": [3, 2.5, 2]}
    drive = {"lead_mm": 5, "efficiency": 0.9, "rotor_inertia_kg_cm2": 0.06, "motor": motor}
    own = fx.load("mukherjee-ii").replace({"drive": drive, "points": {"vertex": [0, 0, -0.15]}, "name": "driven"})
    file = tmp_path / "own.toml"
    own.save(file)
    page = opened("design=mukherjee-ii&tab=design")
    page.set_input_files("#design-file", file)
    page.locator("#design summary", has_text="Drive").click()
    lead = page.get_by_label("drive.lead m", exact=True)
    sync_api = pytest.importorskip("playwright.sync_api")
    sync_api.expect(lead).to_have_value("0.005", timeout=PATIENCE)  # when the file is read
    lead.fill("0.01")
    lead.press("Enter")
    curve = page.get_by_label("drive.motor.peak_torques N m, separated by semicolons")
    curve.fill("9; 9")
    curve.press("Enter")
    wrong = page.locator(".field-row[data-key='drive.motor.peak_torques'] .wrong")
    wrong.filter(has_text="drive.motor.peak_torques has 2 numbers and drive.motor.speeds 3").wait_for()
    curve.fill("9; 9; 7")
    curve.press("Enter")
    wrong.wait_for(state="hidden")
    text = saved(page, lambda: page.get_by_role("button", name="Save TOML").click()).decode()
    assert fx.Hexapod.from_toml(text) == own.replace({"drive.lead": 0.01, "drive.motor.peak_torques": [9, 9, 7]})


def test_a_drive_is_made_in_the_form(opened: Any) -> None:
    page = opened("design=mukherjee-ii&tab=design")
    page.locator("#design summary", has_text="Drive").click()
    for label, text in (("drive.lead m", "0.01"), ("drive.efficiency ", "0.9")):
        page.get_by_label(label, exact=True).fill(text)
        page.get_by_label(label, exact=True).press("Enter")
        if "lead" in label:
            page.locator(".wrong", has_text="missing: drive.efficiency").wait_for()
    page.locator(".wrong", has_text="missing: drive.efficiency").wait_for(state="hidden")
    text = saved(page, lambda: page.get_by_role("button", name="Save TOML").click()).decode()
    made = fx.load("mukherjee-ii").replace({"drive": {"lead": 0.01, "efficiency": 0.9}})
    assert fx.Hexapod.from_toml(text) == made


def test_the_box_of_losses_tells_that_they_act(opened: Any) -> None:
    page = opened("design=mukherjee-ii&tab=response")
    page.locator("#losses", has_text="No loss factors act.").wait_for()
    type_in(page, "Loss factor", "0.05")
    page.locator("#losses", has_text="Loss factors that act: 0.05 in the legs, of the box.").wait_for()
    turn_to(page, "Design")
    page.locator("#design summary", has_text="Legs").click()
    cell = page.get_by_label("legs.loss_factor ", exact=False).first
    cell.fill("0.02")
    cell.press("Enter")
    turn_to(page, "Response")
    type_in(page, "Loss factor", "0")
    page.locator("#losses", has_text="Loss factors that act: 0.02 in the legs, of the design.").wait_for()


def test_limits_are_those_of_the_joint_model() -> None:
    springs = {"legs.joint_stiffness.universal": [400.0, 10.0], "legs.joint_stiffness.spherical": 300.0}
    machine = fx.load("motion-base").replace(springs)
    pose = [0.2, 0.1, 2.42, 5.0, 0, 8.0]
    where = fx.Pose.from_rpy(*pose, degrees=True)
    moments = {
        joint: np.linalg.norm(fx.joint_moments(machine, where, joint=joint).universal_moment, axis=-1).max()
        for joint in ("universal", "spin_free")
    }
    low, high = sorted(moments, key=lambda joint: float(moments[joint]))
    assert moments[high] > 1.001 * moments[low]
    limited = machine.replace({"limits.universal_moment": float(0.5 * (moments[low] + moments[high]))})
    for joint in (low, high):
        limits = snapshot(limited, pose, joint)["limits"]
        assert any("moment" in words for words in limits["exceeded"]) == (joint == high)
