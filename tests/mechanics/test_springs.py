"""The springs as the core has them: one stiffness for modes, linear dynamics, shares of energy and losses."""

from hypothesis import given
from tests.helpers.drawn import machines
from tests.helpers.support import away, relative

import flexapod as fx
from flexapod.mechanics.springs import spring_matrix

ROUNDING = 1e-12  # of sums of some dozen products


@given(hexapod=machines())
def test_springs_along_the_legs_stiffen_by_H_k_H_T(hexapod):
    pose = away(hexapod)
    F, H = spring_matrix(hexapod, pose), fx.force_transformation(hexapod, pose)
    assert relative(F @ F.T, (H * hexapod.legs.stiffness) @ H.T) < ROUNDING
    assert F.shape == (6, 6)


@given(hexapod=machines())
def test_the_unloaded_machine_has_the_stiffness_of_its_springs(hexapod):
    floating, pose = hexapod.replace({"gravity": [0.0, 0.0, 0.0]}), away(hexapod)
    linear = fx.linearise(floating, pose)
    assert relative(linear.K, linear.springs @ linear.springs.T) < ROUNDING


@given(hexapod=machines())
def test_springs_hold_the_strain_energy_of_modes(hexapod):
    pose = away(hexapod)
    modes = fx.natural_modes(hexapod, pose)
    energy = (spring_matrix(hexapod, pose).T @ modes.shape) ** 2
    assert relative(energy.sum(axis=0), modes.omega**2) < ROUNDING
    assert relative(fx.mechanics.energy_shares(hexapod, pose).strain, energy / energy.sum(axis=0)) < ROUNDING
