"""The machines of `examples/machines`: packaged ones with springs that these leave out."""

from pathlib import Path

import numpy as np
import pytest

import flexapod as fx
from flexapod.mechanics import plausibility

FOLDER = Path(__file__).parents[2] / "examples" / "machines"
PLAIN = {path.stem: path.stem.rpartition("-")[0] for path in sorted(FOLDER.glob("*.toml"))}


def machine(name):
    return fx.load(FOLDER / f"{name}.toml")


def test_there_are_three():
    assert sorted(PLAIN.values()) == ["cubic-isolator", "motion-base", "precision-positioner"]


@pytest.mark.parametrize("name", PLAIN)
def test_each_is_a_packaged_machine_with_other_springs(name):
    found, plain = machine(name), fx.load(PLAIN[name])
    assert found.name == name
    assert found.warnings == ()
    assert plausibility.implausible(found) == []
    assert fx.Hexapod.from_toml(found.to_toml()) == found
    springs = (
        "name",
        "legs.stiffness",
        "legs.series_",
        "legs.loss",
        "legs.joint_",
        "limits.universal_m",
        "limits.spherical_m",
    )
    one, other = (
        {key: value.tolist() for key, value in design.values().items() if not key.startswith(springs)}
        for design in (found, plain)
    )
    assert one == other


def test_the_wires_are_those_that_the_file_names():
    flexures = fx.design.flexures
    wire = flexures.wire(12e-3, 1.2e-3, flexures.Material(114e9, 880e6))
    values = machine("cubic-isolator-flexures").values()
    for key, number in flexures.leg_keys(wire, wire).items():
        np.testing.assert_allclose(values[key], np.broadcast_to(number, values[key].shape), rtol=5e-3)


def test_in_the_middle_of_its_stroke_the_oil_is_as_stiff_as_the_plain_leg():
    law = machine("motion-base-oil").legs.stiffness_law
    x = law.stroke / 2
    stiffness = law.bulk_modulus * (law.area_1 / (x + law.dead_1) + law.area_2 / (law.stroke - x + law.dead_2))
    np.testing.assert_allclose(stiffness, fx.load("motion-base").legs.stiffness, rtol=1e-12)
    np.testing.assert_allclose(law.range, [[2.131, 3.281]] * 6)


def test_at_home_the_screws_are_as_stiff_as_the_plain_leg():
    screws, plain = machine("precision-positioner-screws"), fx.load("precision-positioner")
    law, length = screws.legs.stiffness_law, fx.inverse_kinematics(plain)
    stiffness = 1 / (1 / law.fixed + (length - law.zero_length) / law.axial_rigidity)
    np.testing.assert_allclose(stiffness, plain.legs.stiffness, rtol=1e-3)
    np.testing.assert_allclose(1 / (1 / plain.legs.stiffness + screws.legs.series_compliance), 24.23e6, rtol=1e-3)


def frequencies(name):
    """Those of a machine of this folder and of the packaged one, at home, rad/s."""
    return fx.natural_modes(machine(name)).omega, fx.natural_modes(fx.load(PLAIN[name])).omega


def test_at_home_the_oil_changes_no_frequency():
    oil, plain = frequencies("motion-base-oil")
    np.testing.assert_allclose(oil, plain, rtol=2e-5)  # home is 0.1 mm from the middle of the stroke


def test_joints_in_series_lower_the_positioner_by_a_third():
    screws, plain = frequencies("precision-positioner-screws")
    np.testing.assert_allclose(screws / plain, np.sqrt(24.23 / 50), rtol=2e-3)  # its joints hardly resist


def test_wires_raise_the_isolator_and_hold_it_more_firmly():
    wires, plain = frequencies("cubic-isolator-flexures")
    assert ((wires > 1.005 * plain) & (wires < 1.05 * plain)).all()
    least = [
        fx.linearise(design).modes().omega[0]
        for design in (machine("cubic-isolator-flexures"), fx.load("cubic-isolator"))
    ]
    assert least[0] > 1.01 * least[1]
