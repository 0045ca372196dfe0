"""Machines with springs in their joints, a suspension and stiffness laws in time: balances, and forces against poses."""

import numpy as np
import pytest
from tests.helpers.drawn import machine, sprung, with_round_legs
from tests.helpers.plain import plain_machine
from tests.helpers.support import JOINTS, displaced

import flexapod as fx

OIL = {
    "legs.stiffness": None,
    "legs.stiffness_law.kind": "hydraulic",
    "legs.stiffness_law.bulk_modulus": 1.2e9,
    "legs.stiffness_law.area_1": 5e-3,
    "legs.stiffness_law.area_2": 3e-3,
    "legs.stiffness_law.dead_1": 0.1,
    "legs.stiffness_law.dead_2": 0.1,
    "legs.stiffness_law.stroke": 1.6,
    "legs.stiffness_law.shortest": 1.9,
}


def joints_and_oil() -> fx.Hexapod:
    stiff = {f"legs.joint_stiffness.{name}": 2e4 for name in ("universal", "spherical", "torsion")}
    return plain_machine("motion-base").replace(
        {**OIL, **stiff, "suspension.stiffness": np.diag([2e5] * 3 + [1e5] * 3)}
    )


@pytest.mark.parametrize("joint", JOINTS)
@pytest.mark.parametrize(
    "hexapod", [joints_and_oil(), sprung(machine(2), np.random.default_rng(2))], ids=["oil", "drawn"]
)
def test_energy_is_kept_by_springs_of_all_kinds(hexapod, joint):
    """With commands that change a law's stiffness, friction, a damper, and turns of a radian from rest."""
    if joint == "spin_free":
        hexapod = with_round_legs(hexapod)  # others weigh without a potential in this model
    omega = fx.natural_modes(hexapod).omega
    length = float(fx.inverse_kinematics(hexapod).mean())
    # In the other model legs whose mass is off their axis are no mechanism that keeps energy on a moving base.
    shaken = fx.harmonic("x", 0.01 * length, 0.3 * omega[0] / (2 * np.pi))
    command = fx.harmonic("2", 0.005 * length, 0.4 * omega[0] / (2 * np.pi))
    found = fx.simulate(
        hexapod,
        hexapod.home.displaced([0, 0, 0, 0.05, 0.02, 0.15]),
        leg_command=command,
        base_motion=shaken if joint == "universal" else None,
        duration=20 / omega[0],
        samples=60,
        joint=joint,
    )
    assert found.attrs["energy_error"] < 1e-8
    assert np.ptp(found.elastic_energy.values) > 0


@pytest.mark.parametrize("joint", JOINTS)
def test_small_vibrations_have_the_frequencies_of_the_tangent(joint):
    """Of the machine at rest, loaded and away from where its joints are unstressed."""
    hexapod = joints_and_oil().replace({"legs.damping": None})
    pose = hexapod.home.displaced([0.1, 0.05, -0.1, 0.1, -0.05, 0.1])
    modes = fx.linearise(hexapod, pose, joint=joint).modes()
    shape = 1e-6 * modes.shape[:, 0].real / np.abs(modes.shape[:, 0]).max()
    times = np.linspace(0.0, 2 * np.pi / modes.omega[0], 9)
    found = fx.simulate(hexapod, pose, start=displaced(pose, shape), times=times, joint=joint, energies=False)
    x = found.displacement.values
    expected = np.cos(modes.omega[0] * times)[:, None] * shape
    np.testing.assert_allclose(x, expected, atol=1e-4 * np.abs(shape).max())


def test_forces_of_a_law_with_a_command_are_those_of_its_lengths():
    hexapod = joints_and_oil()
    command = fx.harmonic("3", 0.05, 1.0)
    found = fx.simulate(hexapod, leg_command=command, duration=1.0, samples=21, energies=False)
    rest = fx.hold(hexapod)
    L_0 = rest.unstretched_length + command.evaluate(found.time.values)[0]
    law = hexapod.legs.stiffness_law
    x = L_0 - law.shortest
    k = law.bulk_modulus * (law.area_1 / (x + law.dead_1) + law.area_2 / (law.stroke - x + law.dead_2))
    np.testing.assert_allclose(found.leg_force, k * (L_0 - found.leg_length.values), rtol=1e-9, atol=1e-3)


def test_a_command_beyond_the_law_ends_the_run_and_says_so():
    hexapod = joints_and_oil().replace({"limits": None})
    with pytest.raises(fx.errors.SimulationError, match=r"leaves the range of legs.stiffness_law"):
        fx.simulate(hexapod, leg_command=fx.excitation.polynomial("1", [0.0, 1.0]), duration=2.0)
    with pytest.raises(fx.PoseError, match="unstretched_length"):
        fx.static_equilibrium(hexapod, np.full(6, 5.0))
