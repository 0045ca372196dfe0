"""Force feedback on flexures: its zeros are the machine's frequencies without legs, and what it damps has an end.

The numbers are those of published flexures (bending and torsion of both ends in series, N m/rad) on the packaged
isolator with legs that do not spin, from an estimate that was made before the model had joint springs.
"""

import numpy as np
import pytest
from tests.helpers.plain import file, plain_machine

import flexapod as fx
from flexapod.control.losses import assumptions

ISOLATOR = plain_machine("cubic-isolator").replace({"gravity": [0, 0, 0]})

#: Bending, torsion -> ends of the frequencies and of the zeros, rad/s, and of what feedback damps at most.
PUBLISHED = {
    (1.0, 5.0): ((31.2, 51.1), (5.2, 8.9), None),
    (5.0, 130.0): ((33.3, 59.2), (11.6, 36.5), (0.15, 0.93)),
    (15.0, 10.0): ((37.1, 54.6), (20.1, 24.4), (0.29, 0.62)),
    (33.0, 118.0): ((43.2, 64.1), (29.9, 46.6), (0.09, 0.22)),
}


def with_flexures(bending, torsion, **changes):
    joints = {"universal": bending, "spherical": bending, "torsion": torsion}
    return ISOLATOR.replace({"legs.joint_stiffness": joints, **changes})


@pytest.mark.parametrize(("flexure", "expected"), PUBLISHED.items())
def test_frequencies_zeros_and_reachable_damping_of_published_flexures(flexure, expected):
    hexapod = with_flexures(*flexure)
    omega = fx.natural_modes(hexapod, joint="spin_free").omega
    zero = fx.control.open_zeros(fx.linearise(hexapod, joint="spin_free"), "force")
    assert (omega[0], omega[-1]) == pytest.approx(expected[0], abs=0.06)
    assert (zero[0], zero[-1]) == pytest.approx(expected[1], abs=0.06)
    reachable = (omega - zero) / (2 * zero)
    if expected[2]:
        assert (reachable.min(), reachable.max()) == pytest.approx(expected[2], abs=0.006)
        best = fx.control.root_locus(hexapod, joint="spin_free").attrs["best_damping"]
        assert best < 1.5 * reachable.min()  # one gain for all six modes
    else:
        assert reachable.min() > 1


@pytest.mark.parametrize("joint", ["universal", "spin_free"])
def test_zeros_are_frequencies_of_the_machine_without_legs(joint):
    zero = fx.control.open_zeros(fx.linearise(with_flexures(15.0, 10.0), joint=joint), "force")
    bare = with_flexures(15.0, 10.0, **{"legs.stiffness": 1e-7})
    assert zero == pytest.approx(fx.natural_modes(bare, joint=joint).omega, rel=1e-6)
    alone = fx.control.open_zeros(fx.linearise(ISOLATOR, joint=joint), "force")
    assert (alone == 0).all()


def test_a_suspension_lifts_the_zeros_too():
    held = ISOLATOR.replace({"suspension.stiffness": np.diag([5e3, 5e3, 5e3, 100.0, 100.0, 100.0])})
    zero = fx.control.open_zeros(fx.linearise(held), "force")
    bare = fx.natural_modes(held.replace({"legs.stiffness": 1e-7})).omega
    assert zero == pytest.approx(bare, rel=1e-6)
    assert zero[0] > 5


def test_what_is_left_out_is_told_of_the_machine_at_hand():
    assert "no structural loss" in assumptions(ISOLATOR)
    assert "Its joints have no stiffness" in assumptions(ISOLATOR)
    assert "joints have no stiffness" not in assumptions(with_flexures(15.0, 10.0))
    lossy = with_flexures(15.0, 10.0, **{"legs.loss_factor": 0.02})
    assert "The loss factors of the design are left out here" in assumptions(lossy)
    assert "no structural loss" not in assumptions(lossy)


def test_the_command_takes_losses_as_viscous_friction(result):
    lossy = ("--set", "legs.loss_factor=0.05", "--set", "gravity=[0,0,0]", "--gain", 20)
    without = result("control", file("cubic-isolator"), "force", *lossy)
    viscous = result("control", file("cubic-isolator"), "force", "--loss-frequency", 40, *lossy)
    assert any("loss factors of the design are left out" in words for words in without["warnings"])
    assert not any("loss factors of the design are left out" in words for words in viscous["warnings"])
