"""Loss factors of a design under control: exact in responses by frequency, viscous or left out, and said, elsewhere."""

import warnings

import numpy as np
import pytest

import flexapod as fx
from flexapod.control.losses import assumptions

JOINTS = {"universal": [3.0, 1.0], "spherical": 2.0, "torsion": 20.0, "loss_factor": 0.2}
LOSSY = fx.load("cubic-isolator").replace(
    {"legs.loss_factor": [0.02, 0.04, 0.06, 0.08, 0.1, 0.12], "legs.joint_stiffness": JOINTS}
)
OMEGA = np.array([3.0, 30.0, 31.5, 50.0, 90.0])


def gain(factor, *measures):
    empty = np.zeros((0, 0)), np.zeros((0, 6 * len(measures))), np.zeros((6, 0))
    return fx.control.Controller(*empty, factor * np.eye(6), measures, "proportional")


@pytest.mark.parametrize("joint", ["universal", "spin_free"])
def test_without_control_it_is_the_transmissibility(joint):
    """Which is solved in the undamped modes, and not from states."""
    found = fx.control.controlled_transmissibility(LOSSY, controller=gain(0.0, "leg_rate"), omega=OMEGA, joint=joint)
    exact = fx.transmissibility(LOSSY, omega=OMEGA, joint=joint).absolute.values
    for name in ("passive", "controlled"):
        np.testing.assert_allclose(found[name].values, exact, atol=1e-11 * np.abs(exact).max())
    assert found.attrs["loss_factor"] == LOSSY.legs.loss_factor.tolist()
    assert found.attrs["joint_loss_factor"] == [0.2] * 6


def test_force_feedback_softens_springs_with_their_losses():
    """f = -g F of each leg's force F: K (1 + i eta) becomes K (1 + i eta)/(1 + g), if nothing else is in the leg."""
    machine = LOSSY.replace({"gravity": [0, 0, 0], "legs.damping": None})
    found = fx.control.controlled_transmissibility(machine, controller=gain(-0.5, "leg_force"), omega=OMEGA)
    changes = {f"legs.{name}": getattr(machine.legs, name) / 1.5 for name in ("stiffness", "series_stiffness")}
    softer = machine.replace(changes)
    exact = fx.transmissibility(softer, omega=OMEGA).absolute.values
    np.testing.assert_allclose(found.controlled.values, exact, atol=1e-10 * np.abs(exact).max())


def test_acceleration_is_measured_with_the_losses_in_it():
    """A force against the absolute acceleration in translation is a mass that the base does not carry."""
    machine = LOSSY.replace({"gravity": [0, 0, 0]})
    H = fx.force_transformation(machine)
    mass = np.diag([4.0, 4.0, 4.0, 0.0, 0.0, 0.0])
    empty = np.zeros((0, 0)), np.zeros((0, 6)), np.zeros((6, 0))
    law = fx.control.Controller(*empty, -np.linalg.solve(H, mass), ("acceleration",), "more mass")
    found = fx.control.controlled_transmissibility(machine, controller=law, omega=OMEGA)
    M = fx.linearise(machine).M
    inertia = machine.platform_inertia
    heavier = machine.replace({"platform.mass": machine.platform_mass + 4.0, "platform.inertia": inertia})
    assert np.allclose(fx.linearise(heavier).M, M + mass)  # the mass centre is at the reference point
    exact = fx.transmissibility(heavier, omega=OMEGA).absolute.values
    np.testing.assert_allclose(found.controlled.values, exact, atol=1e-10 * np.abs(exact).max())


def test_the_default_grid_meets_the_resonances_that_losses_leave():
    found = fx.control.controlled_transmissibility(LOSSY, controller=gain(0.0, "leg_rate"))
    assert np.allclose(found.omega.values, fx.vibration.frequency_grid(LOSSY))


def test_stability_is_that_of_the_machine_with_friction_only():
    with_losses = fx.control.controlled_transmissibility(LOSSY, controller=gain(-100.0, "leg_rate"), omega=OMEGA)
    assert with_losses.attrs["stability"] == "stable"
    assert "Stability is judged by the poles" in fx.control.controlled_transmissibility.__doc__


@pytest.mark.parametrize("design", [fx.control.lqg, fx.control.h_infinity])
def test_designs_take_losses_as_friction_at_a_frequency_and_say_so(design):
    plain = LOSSY.replace({"legs.loss_factor": 0.0, "legs.joint_stiffness.loss_factor": 0.0})
    names = [
        design(machine, measure="acceleration", **options).name
        for machine, options in ((plain, {}), (LOSSY, {}), (LOSSY, {"loss_frequency": 40.0}))
    ]
    assert "loss" not in names[0]
    assert "loss factors left out" in names[1]
    assert "losses viscous at 40 rad/s" in names[2]
    found = design(LOSSY, measure="acceleration", loss_frequency=40.0)
    by_hand = design(fx.mechanics.viscous_equivalent(LOSSY, 40.0), measure="acceleration")
    assert (found.A == by_hand.A).all()
    assert not np.allclose(found.A, design(LOSSY, measure="acceleration").A, rtol=1e-6)
    with pytest.raises(fx.errors.ArgumentError, match="loss_frequency"):
        design(LOSSY, loss_frequency=-1.0)


def test_assumptions_say_what_became_of_losses():
    assert "at 40 rad/s" in assumptions(LOSSY, 40.0)
    assert "left out" in assumptions(LOSSY)
    assert "no structural loss" in assumptions(fx.load("motion-base"), 40.0)


@pytest.mark.parametrize("function", ["closed_loop", "gain_map", "gain_schedule", "simulate_control"])
def test_what_leaves_losses_out_warns_of_it(function):
    machine = LOSSY.replace({"legs.joint_stiffness.loss_factor": 0.0})
    law = fx.control.VelocityFeedback(100.0)
    sampled = law.on(fx.linearise(machine)).sampled(2e-3)
    call = {
        "closed_loop": lambda of: fx.control.closed_loop(of, None, law),
        "gain_map": lambda of: fx.control.gain_map(of, kp=[2e3, 4e3], kd=[300.0, 400.0]),
        "gain_schedule": lambda of: fx.control.gain_schedule(of, of.home, "velocity", gains=[50.0, 100.0, 200.0]),
        "simulate_control": lambda of: fx.control.simulate_control(
            of, controller=sampled, base_motion=fx.half_sine_shock("z", 1e-4, 0.02), duration=0.02
        ),
    }[function]
    with pytest.warns(UserWarning, match="loss factors of the design are left out") as told:
        call(machine)
    assert told[0].filename == __file__
    with warnings.catch_warnings():
        warnings.simplefilter("error", UserWarning)
        warnings.simplefilter("ignore", fx.control.GainWarning)
        call(fx.mechanics.viscous_equivalent(machine, 40.0))
