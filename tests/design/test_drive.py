"""The drive of the legs in a design: read, written, changed, told apart, and refused."""

import json
import math
import pickle
from pathlib import Path

import numpy as np
import pytest
from tests.helpers.plain import plain_machine

import flexapod as fx
from flexapod.report.studies import inputs
from flexapod.web.description import described, fields
from flexapod.web.designs import Source

MACHINE = plain_machine("motion-base")
TABLES = """
[drive]
lead_mm = 20
efficiency = 0.9
gear_ratio = [1, 1, 1, 2, 2, 2]
rotor_inertia_kg_cm2 = 70

[drive.motor]
speeds_rpm = [0, 2000, 3000]
peak_torques_N_m = [100, 100, 60]
continuous_torques = [40, 30, 20]
"""
DRIVEN = fx.Hexapod.from_toml(MACHINE.to_toml() + TABLES)


def test_a_drive_is_read_in_its_units_and_written_bit_for_bit():
    drive = DRIVEN.drive
    assert drive.lead.tolist() == [0.02] * 6
    assert drive.gear_ratio.tolist() == [1, 1, 1, 2, 2, 2]
    assert drive.rotor_inertia.tolist() == [0.007] * 6
    assert drive.motor.speeds[1] == 2000 * math.pi / 30
    assert drive.motor.fastest.tolist() == [3000 * math.pi / 30] * 6
    for machine in (DRIVEN, DRIVEN.replace({"drive.motor.max_speed_rpm": 2500, "drive.back_efficiency": -0.2})):
        again = fx.Hexapod.from_toml(machine.to_toml())
        assert again == machine
        assert again.digest == machine.digest
        assert pickle.loads(pickle.dumps(machine)) == machine


def test_a_drive_tells_designs_apart_and_those_without_one_are_as_before():
    assert MACHINE.digest == "02342b1b77641070"  # as it was before there were drives
    assert DRIVEN != MACHINE
    others = [DRIVEN.replace({"drive.lead[2]": 0.01}), DRIVEN.replace({"drive.motor": None}), DRIVEN, MACHINE]
    assert len({machine.digest for machine in others}) == 4
    without = DRIVEN.replace({"drive": None})
    assert without == MACHINE
    assert (without.digest, hash(without)) == (MACHINE.digest, hash(MACHINE))
    np.testing.assert_array_equal(DRIVEN.packed, MACHINE.packed)  # no part of the dynamics


def test_what_is_left_out_follows_what_is_given():
    drive = fx.design.Drive(0.01, 0.8)
    np.testing.assert_allclose(drive.backwards, 0.75, rtol=1e-15)
    np.testing.assert_array_equal(DRIVEN.replace({"drive.efficiency": 0.4}).drive.backwards, 2 - 1 / 0.4)
    np.testing.assert_array_equal(fx.design.Drive(0.01, 0.8, 0.5).backwards, 0.5)


def test_the_relation_of_both_efficiencies_is_that_of_a_screw_with_little_friction():
    """Square thread of lead angle a and friction angle p: tan a / tan(a + p) forwards, tan(a - p) / tan a backwards."""
    a, apart = np.radians(8.0), []
    for p in (1e-2, 1e-3):
        forwards, backwards = np.tan(a) / np.tan(a + p), np.tan(a - p) / np.tan(a)
        apart.append(abs(float(fx.design.Drive(0.01, forwards).backwards[0]) - backwards))
    assert apart[0] < 0.02 * (1 - 0.9)
    assert apart[1] < apart[0] / 90  # of second order in the friction


def test_reflected_mass_has_the_kinetic_energy_of_what_turns():
    drive = fx.design.Drive(0.005, 0.9, gear_ratio=3.0, rotor_inertia=2e-4, gear_inertia=1e-5, screw_inertia=5e-4)
    rate = 0.3
    screw = 2 * math.pi * rate / 0.005
    turning = 0.5 * (2e-4 + 1e-5) * (3 * screw) ** 2 + 0.5 * 5e-4 * screw**2
    np.testing.assert_allclose(0.5 * drive.reflected_mass * rate**2, turning, rtol=1e-14)


def test_torques_between_and_beyond_the_speeds():
    motor = DRIVEN.drive.motor
    assert motor.peak(-2500 * math.pi / 30) == pytest.approx(80.0)
    assert motor.continuous(1000 * math.pi / 30) == pytest.approx(35.0)
    assert motor.peak(3001 * math.pi / 30) == 0.0


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (
            {"drive.lead": 0.01},
            r"missing: drive\.efficiency \(efficiency of the screw .*Add it, or leave \[drive\] out",
        ),
        (
            {"drive.motor.speeds": [0, 1], "drive.lead": 0.01, "drive.efficiency": 1},
            r"missing: drive\.motor\.peak_torques",
        ),
        ({"drive": {"lead": 0, "efficiency": 1}}, r"drive.lead is 0 m; it must be >= 1e-06 m"),
        ({"drive": {"lead": 0.01, "efficiency": 90}}, r"drive.efficiency is 90; it must be <= 1\. Give a share"),
        ({"drive": {"lead_rpm": 1}}, r"'rpm' is no unit of length"),
        ({"drive.ratio": 2}, r"drive.ratio is not a key of a design"),
        ({"drive": {"lead": [1, 2], "efficiency": 1}}, r"drive.lead has shape 2; it must be one number or six numbers"),
        ({"drive": 3}, r"drive is 3; it must be a table"),
    ],
)
def test_what_is_no_drive_is_refused(given, words):
    with pytest.raises(fx.DesignError, match=words):
        MACHINE.replace(given)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (([0], [1], [1]), "has one speed; it must have two or more"),
        (([1, 2], [1, 1], [1, 1]), r"speeds\[0\] is 1 rad/s; a curve begins at 0"),
        (([0, 2, 2], [1, 1, 1], [1, 1, 1]), r"speeds\[2\] is 2 rad/s, after 2 rad/s; speeds must rise"),
        (([0, 2], [1, 1, 1], [1, 1]), r"peak_torques has 3 numbers and drive\.motor\.speeds 2"),
        (([0, 2], [1, 1], [1, 1.5]), r"continuous_torques\[1\] is 1\.5 N m, above 1 N m"),
        (([0, 2], [1, 1], [1, 1], 3.0), r"max_speed is 3 rad/s, beyond 2 rad/s"),
    ],
)
def test_what_is_no_curve_is_refused(given, words):
    with pytest.raises(fx.DesignError, match=words):
        fx.design.Motor(*given)


def test_parts_of_the_wrong_kind_are_refused():
    with pytest.raises(fx.DesignError, match=r"drive\.motor is 3; it must be a Motor"):
        fx.design.Drive(0.01, 0.9, motor=3)
    parts = {name: getattr(MACHINE, name) for name in ("base_joints", "platform_joints", "platform_mass", "legs")}
    parts |= {name: getattr(MACHINE, name) for name in ("platform_mass_center", "platform_inertia")}
    with pytest.raises(fx.DesignError, match=r"drive is 0\.01; it must be a Drive"):
        fx.Hexapod(**parts, drive=0.01)


def test_a_drive_is_checked_shown_and_no_variable_of_a_search(run, tmp_path):
    file = tmp_path / "driven.toml"
    file.write_text(MACHINE.to_toml() + TABLES)
    code, out, _ = run("check", file, "--json", "--set", "drive.lead_mm=10")
    assert code == 0
    assert json.loads(out)["values"]["drive.lead"] == [0.01] * 6
    titles = [table.title for table in inputs.section(DRIVEN).items]
    assert "Drive of the legs" in titles
    assert "Torque and speed of the motors" in titles
    with pytest.raises(fx.ArgumentError, match=r"drive.lead is not a number that a search can change"):
        fx.optimisation.Variable("drive.lead", 0.01, 0.02).parts(DRIVEN)


def test_the_page_takes_a_design_with_a_drive():
    found = described(Source(DRIVEN.to_toml(), "{}"))
    assert found["digest"] == DRIVEN.digest
    assert "[drive.motor]" in found["toml"]
    keys = [field["key"] for field in fields()]
    assert all(key in keys for key in found["values"] if key.startswith("drive."))
    lighter = described(Source(DRIVEN.to_toml(), '{"platform.mass": 5.0, "drive.lead": 0.004}'))
    assert fx.Hexapod.from_toml(lighter["toml"]) == DRIVEN.replace({"platform.mass": 5.0, "drive.lead": 0.004})


def test_a_table_of_six_stiffnesses_is_no_number_of_each_leg():
    """Nor is a curve of six points: they have tables of their own."""
    lengths, six = np.linspace(1.9, 3.5, 6), np.arange(6.0)
    law = MACHINE.replace(
        {"legs.stiffness_law": {"kind": "table", "lengths": lengths, "stiffnesses": np.full(6, 8e6)},
         "drive": {"lead": 0.01, "efficiency": 1, "motor": {"speeds": six, "peak_torques": 9 - six, "continuous_torques": 6 - six}}}
    )  # fmt: skip
    for table in inputs.section(law).items:
        if table.title in ("Legs", "Drive of the legs"):
            assert not any(
                word in column.title for column in table.columns for word in ("lengths", "speeds", "torques")
            )
    assert fx.Hexapod.from_toml(law.to_toml()) == law


def test_the_example_with_screws_is_the_motion_base_with_a_drive():
    machine = fx.load(Path(__file__).parents[2] / "examples" / "machines" / "motion-base-screws.toml")
    assert machine.replace({"drive": None}).digest == MACHINE.digest
    steel, diameter, length = 7850.0, 0.05, 1.5
    np.testing.assert_allclose(machine.drive.screw_inertia, math.pi / 32 * steel * diameter**4 * length, rtol=0.01)
