"""The packaged machines as built: their springs follow from what their files say, and the engine has their frequencies."""

import numpy as np
import pytest
from tests.helpers.plain import plain_machine
from tests.oracles.closed_chain import ClosedChain

import flexapod as fx
from flexapod.mechanics import plausibility

flexures = fx.design.flexures

#: Keys in which each differs from the plain machine: its springs, what its flexures bear, and what follows from them.
SPRINGS = {
    "cubic-isolator": (
        "legs.series_",
        "legs.joint_",
        "limits.universal_m",
        "limits.spherical_m",
        "legs.upper.mass_center",  # a coil that is 10 mm longer
        "legs.upper.inertia",
    ),
    "motion-base": ("legs.stiffness", "legs.upper.inertia", "limits.leg_distance"),  # rods of 120 mm, that bend less
    "precision-positioner": (
        "legs.series_",
        "legs.joint_",
        "legs.stiffness",
        "legs.damping.universal",
        "legs.damping.spherical",
        "limits.universal_",
        "limits.spherical_",
    ),
}


def built(name: str) -> fx.Hexapod:
    return fx.load(name)


@pytest.mark.parametrize("name", SPRINGS)
def test_each_is_its_plain_machine_with_springs(name):
    found = built(name)
    assert found.warnings == ()
    assert plausibility.implausible(found) == []
    assert fx.Hexapod.from_toml(found.to_toml()) == found
    one, other = (
        {key: str(value) for key, value in design.values().items() if not key.startswith(SPRINGS[name])}
        for design in (found, plain_machine(name))
    )
    assert one == other


@pytest.mark.parametrize("name", SPRINGS)
def test_frequencies_are_those_of_the_engine(name):
    """Pinocchio's closed chain with springs on its joint coordinates, at home and away from it."""
    machine = built(name)
    chain, ground = ClosedChain(machine), fx.Motion(fx.Pose([0, 0, 0]))
    for step in ([0.0] * 6, [0.001, -0.002, 0.001, 0.004, 0.003, -0.01]):
        pose = machine.home.displaced(step)
        length = fx.inverse_kinematics(machine, pose)
        axial = 1 / (1 / stiffness(machine, length) + machine.legs.series_compliance)
        K = chain.stiffness_matrix(fx.Motion(pose), ground, axial)
        root = np.linalg.inv(np.linalg.cholesky(chain.mass_matrix(fx.Motion(pose), ground)))
        expected = np.sqrt(np.linalg.eigvalsh(root @ K @ root.T))
        np.testing.assert_allclose(fx.natural_modes(machine, pose).omega, expected, rtol=1e-10)


def stiffness(machine: fx.Hexapod, length: np.ndarray) -> np.ndarray:
    """The law of each machine, as its source writes it."""
    law = machine.legs.stiffness_law
    if law is None:
        return machine.legs.stiffness
    if law.kind.name == "screw":
        return 1 / (1 / law.fixed + (length - law.zero_length) / law.axial_rigidity)
    x = length - law.shortest
    return law.bulk_modulus * (law.area_1 / (x + law.dead_1) + law.area_2 / (law.stroke - x + law.dead_2))


def test_the_oil_acts_on_the_area_between_bore_and_rod():
    law = built("motion-base").legs.stiffness_law
    np.testing.assert_allclose(law.area_1, np.pi * (66.3e-3**2 - 60e-3**2), rtol=1e-3)
    np.testing.assert_array_equal(law.area_1, law.area_2)


def test_the_wires_are_those_that_the_file_names():
    wire = flexures.wire(12e-3, 1.2e-3, flexures.Material(114e9, 880e6))
    values = built("cubic-isolator").values()
    for key, number in flexures.leg_keys(wire, wire).items():
        np.testing.assert_allclose(values[key], np.broadcast_to(number, values[key].shape), rtol=5e-3)


def test_the_notches_bear_what_the_file_says():
    notch = flexures.circular_notch(3e-3, 0.25e-3, 18.6e-3, flexures.Material(200e9, 900e6))
    limits = built("precision-positioner").limits
    assert limits.universal_moment == pytest.approx(notch.moment, rel=5e-3)
    assert limits.universal_angle == limits.spherical_angle < notch.angle
    assert 4.83 * limits.universal_angle < limits.universal_moment


def test_at_home_screws_and_oil_are_as_stiff_as_the_plain_legs():
    """The oil in the middle of its stroke, which home is next to."""
    machine = built("precision-positioner")
    length = fx.inverse_kinematics(machine)
    np.testing.assert_allclose(stiffness(machine, length), 50e6, rtol=1e-3)
    np.testing.assert_allclose(machine.legs.stiffness_law.axial_rigidity, 2.1e11 * np.pi * 5e-3**2, rtol=1e-3)
    np.testing.assert_allclose(1 / (1 / 50e6 + machine.legs.series_compliance), 24.23e6, rtol=1e-3)
    oil = built("motion-base")
    law = oil.legs.stiffness_law
    np.testing.assert_allclose(
        stiffness(oil, law.shortest + law.stroke / 2), plain_machine("motion-base").legs.stiffness
    )
    np.testing.assert_allclose(law.range, [[2.131, 3.281]] * 6)


def frequencies(name: str) -> tuple[np.ndarray, np.ndarray]:
    """Those of a machine as built and of the plain one, at home, rad/s."""
    return fx.natural_modes(built(name)).omega, fx.natural_modes(plain_machine(name)).omega


def test_what_the_springs_do_to_the_frequencies():
    oil, without = frequencies("motion-base")
    np.testing.assert_allclose(oil, without, rtol=2e-5)  # home is 0.1 mm from the middle of the stroke
    screws, without = frequencies("precision-positioner")
    np.testing.assert_allclose(screws / without, np.sqrt(24.23 / 50), rtol=2e-3)  # its joints hardly resist
    wires, without = frequencies("cubic-isolator")
    assert ((wires > 1.005 * without) & (wires < 1.05 * without)).all()


@pytest.mark.parametrize(
    ("name", "modulus", "lower", "upper", "above"),
    [
        ("cubic-isolator", 70e9, (20e-3, 17e-3), (10e-3, 0.0), 3),
        ("motion-base", 210e9, (78.3e-3, 66.3e-3), (60e-3, 54e-3), 2),
        ("precision-positioner", 210e9, (25e-3, 17e-3), (17e-3, 0.0), 3),
    ],
)
def test_rods_bend_as_their_dimensions_say_and_above_mode_6(name, modulus, lower, upper, above):
    machine = built(name)
    for form in machine.short_forms:
        if form.table.endswith(".rod"):
            outer, inner = lower if "lower" in form.table else upper
            expected = modulus * np.pi * (outer**4 - inner**4) / 4
            assert form.given["bending_stiffness"] == pytest.approx(expected, rel=3e-3)
    bends = fx.mechanics.leg_bending(machine)
    assert bends.unknown == ""
    weakest = min(form.given["bending_stiffness"] for form in machine.short_forms if form.table.endswith(".rod"))
    mass = float(machine.legs.lower.mass[0] + machine.legs.upper.mass[0])
    length = fx.inverse_kinematics(machine)[0]
    least = (np.pi / length) ** 2 * np.sqrt(weakest * length / mass)  # a uniform beam, as weak and as heavy throughout
    assert bends.lowest > 0.7 * least
    assert bends.lowest > above * fx.natural_modes(machine).omega[-1]
    if name == "cubic-isolator":
        longest = machine.home.displaced([0, 0, 0.004, 0, 0, 0])
        assert fx.mechanics.leg_bending(machine, longest).unknown == ""  # the coil still stands in its housing
