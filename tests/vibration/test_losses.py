"""Loss factors of the design: exact by frequency, viscous at a stated frequency in time, and never left out in silence."""

import warnings

import numpy as np
import pytest
from tests.helpers.drawn import machine
from tests.helpers.plain import file, plain_machine

import flexapod as fx
from flexapod.mechanics.springs import axial_stiffness
from flexapod.mechanics.viscous_losses import LEFT_OUT, has_losses
from flexapod.vibration.harmonic import complex_poles

JOINTS = {"universal": 15.0, "spherical": 15.0, "torsion": 15.0, "loss_factor": 0.1}
ISOLATOR = plain_machine("cubic-isolator").replace({"legs.damping": None})
LOSSY = ISOLATOR.replace({"legs.loss_factor": 0.05, "legs.joint_stiffness": JOINTS})


def test_a_suspension_is_a_spring_and_a_damper():
    """Closed form of one mass on a spring and a damper: the legs are next to nothing, the mass centre is held."""
    k, c, m = 2e4, 150.0, ISOLATOR.platform_mass
    held = np.diag([k, k, k, 500.0, 500.0, 500.0])
    hexapod = ISOLATOR.replace(
        {
            "gravity": [0, 0, 0],
            "legs.stiffness": 1e-3,
            "legs.lower": None,
            "legs.upper": None,
            "suspension.stiffness": held,
            "suspension.damping": held * c / k,
            "suspension.point": ISOLATOR.platform_mass_center,
        }
    )
    omega = np.array([5.0, 30.0, np.sqrt(k / m), 200.0])
    found = fx.transmissibility(hexapod, omega=omega, point=ISOLATOR.platform_mass_center)
    expected = (k + 1j * omega * c) / (k + 1j * omega * c - m * omega**2)
    for axis in "xyz":
        np.testing.assert_allclose(found.absolute.sel(output=axis, base=axis).values, expected, rtol=1e-6)
    run = fx.simulate(hexapod, start=[*hexapod.home.displaced([0, 0, 1e-6, 0, 0, 0]).position, 0, 0, 0], duration=1.0)
    decay, ring = c / (2 * m), np.sqrt(k / m - (c / (2 * m)) ** 2)
    t = run.time.values
    expected = 1e-6 * np.exp(-decay * t) * (np.cos(ring * t) + decay / ring * np.sin(ring * t))
    np.testing.assert_allclose(run.displacement.sel(output="z").values, expected, atol=1e-11)


@pytest.mark.parametrize("joint", ["universal", "spin_free"])
def test_every_spring_has_its_loss_factor(joint):
    """Against the complex matrices put together by hand, spring by spring."""
    rng = np.random.default_rng(4)
    joints = {
        "universal": rng.uniform(5, 20, (6, 2)),
        "spherical": rng.uniform(5, 20, 6),
        "torsion": rng.uniform(5, 20, 6),
    }
    hexapod = machine(5).replace(
        {
            "legs.joint_stiffness": joints | {"loss_factor": rng.uniform(0, 0.3, 6)},
            "legs.loss_factor": rng.uniform(0, 0.2, 6),
        }
    )
    linear = fx.linearise(hexapod, joint=joint)
    F, k = linear.springs, linear.leg_stiffness
    loss = (linear.H * k * hexapod.legs.loss_factor) @ linear.H.T
    for leg, eta in enumerate(hexapod.legs.joint_stiffness.loss_factor):
        only = {
            name: np.where((np.arange(6) == leg)[:, None] if np.ndim(value) == 2 else np.arange(6) == leg, value, 0.0)
            for name, value in joints.items()
        }
        alone = fx.linearise(hexapod.replace({"legs.joint_stiffness": only}), joint=joint).springs[:, 6:]
        loss = loss + eta * alone @ alone.T
    w = np.array([3.0, 40.0])
    found = fx.transmissibility(hexapod, omega=w, joint=joint).compliance.values
    for i, omega in enumerate(w):
        by_hand = np.linalg.inv(linear.K + 1j * loss + 1j * omega * linear.C - omega**2 * linear.M)
        np.testing.assert_allclose(found[i], by_hand, rtol=1e-9, atol=1e-12 * np.abs(by_hand).max())
    assert F.shape[1] == 42


def test_the_designs_loss_factor_is_the_default_and_an_argument_overrides_it():
    w = np.array([20.0, 35.0])
    plain = ISOLATOR.replace({"legs.loss_factor": 0.05})
    own = fx.transmissibility(plain, omega=w)
    given = fx.transmissibility(ISOLATOR, omega=w, loss_factor=0.05)
    without = fx.transmissibility(plain, omega=w, loss_factor=0.0)
    assert (own.absolute.values == given.absolute.values).all()
    assert (without.absolute.values == fx.transmissibility(ISOLATOR, omega=w).absolute.values).all()
    assert own.attrs["loss_factor"] == [0.05] * 6
    assert without.attrs["loss_factor"] == [0.0] * 6
    psd = {"psd": fx.vc_curve("VC-C"), "axis": "z"}
    rms = [
        float(fx.random_response(hexapod, **psd, **options).rms_displacement.sel(output="z"))
        for hexapod, options in ((plain, {}), (ISOLATOR, {"loss_factor": 0.05}), (plain, {"loss_factor": 0.2}))
    ]
    assert rms[0] == rms[1] > 1.2 * rms[2]
    with pytest.raises(fx.errors.ArgumentError, match="has no damping"):
        fx.random_response(plain, loss_factor=0.0, **psd)
    near = fx.vibration.frequency_grid(plain, samples=10)
    assert (near == fx.vibration.frequency_grid(ISOLATOR, samples=10, loss_factor=0.05)).all()


def test_half_the_loss_factor_is_the_damping_ratio_of_a_mode():
    viscous = [
        fx.mechanics.viscous_equivalent(ISOLATOR.replace({"legs.loss_factor": 0.04, "gravity": [0, 0, 0]}), omega)
        for omega in (10.0, 50.56)
    ]
    ratios = [fx.linearise(hexapod).modes().damping_ratio for hexapod in viscous]
    assert ratios[1][-1] == pytest.approx(0.02, rel=1e-3)
    assert ratios[0] == pytest.approx(5.056 * ratios[1], rel=1e-3)


def test_a_stepped_sine_loses_what_complex_springs_lose():
    """The non-linear machine in time, at a small amplitude, against the exact loss factors by frequency."""
    found = fx.stepped_sine(LOSSY, axis="z", amplitude=1e-9, omega=[25.0, 42.7, 59.0, 80.0])
    assert (found.status == "found").all()
    exact = fx.transmissibility(LOSSY, omega=[25.0, 42.7, 59.0, 80.0]).absolute.sel(base="z").values
    np.testing.assert_allclose(found.linear.values, exact, rtol=1e-12, atol=1e-15)
    np.testing.assert_allclose(found.response.values, exact, atol=2e-6 * np.abs(exact).max())


def test_in_time_losses_are_viscous_or_said_to_be_left_out():
    shock = {"base_motion": fx.half_sine_shock("z", 1e-3, 0.02), "duration": 2.5, "samples": 1000}
    with pytest.warns(UserWarning, match="loss factors of the design are left out"):
        left_out = fx.simulate(LOSSY, **shock)
    assert LEFT_OUT in left_out.attrs["warnings"]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        viscous = fx.simulate(LOSSY, loss_frequency=59.3, **shock)
    assert viscous.attrs["loss_frequency_rad_s"] == 59.3
    assert viscous.attrs["energy_error"] < 1e-6
    by_hand = fx.simulate(fx.mechanics.viscous_equivalent(LOSSY, 59.3), **shock)
    assert (viscous.displacement.values == by_hand.displacement.values).all()
    late = slice(2.0, 2.5)
    amplitudes = [
        float(np.abs(run.relative_displacement.sel(output="z", time=late)).max()) for run in (left_out, viscous)
    ]
    assert amplitudes[1] < 0.3 * amplitudes[0]


def test_the_viscous_equivalent_by_its_formula():
    pose = LOSSY.home.displaced([0, 0, 0.001, 0.01, 0, 0])
    law = {"kind": "screw", "fixed": 2e4, "axial_rigidity": 1e4, "zero_length": 0.1}
    hexapod = LOSSY.replace({"legs.stiffness_law": law, "legs.damping.prismatic": 3.0})
    found = fx.mechanics.viscous_equivalent(hexapod, 40.0, pose)
    k, _ = axial_stiffness(hexapod, fx.inverse_kinematics(hexapod, pose))
    np.testing.assert_allclose(found.legs.damping.prismatic, 3.0 + 0.05 * k / 40.0)
    np.testing.assert_allclose(found.legs.damping.universal, 0.1 * 15.0 / 40.0)
    np.testing.assert_allclose(found.legs.damping.spherical, 0.1 * 15.0 / 40.0)
    assert not has_losses(found)
    assert fx.mechanics.viscous_equivalent(ISOLATOR, 40.0) is ISOLATOR


@pytest.mark.parametrize("omega", [0.0, -1.0, np.nan, np.inf])
def test_a_loss_frequency_is_positive(omega):
    with pytest.raises(fx.errors.ArgumentError, match="loss_frequency"):
        fx.mechanics.viscous_equivalent(LOSSY, omega)
    with pytest.raises(fx.errors.ArgumentError, match="loss_frequency"):
        fx.simulate(LOSSY, loss_frequency=omega, duration=0.1)


def test_the_commands_know_losses(run, result):
    lossy = ("--set", "legs.loss_factor=0.05")
    out = " ".join(
        run("simulate", file("cubic-isolator"), "--shock", "z", "1", "10ms", "--duration", "0.1", *lossy)[1].split()
    )
    assert "loss factors of the design are left out" in out
    quiet = run(
        "simulate",
        file("cubic-isolator"),
        "--shock",
        "z",
        "1",
        "10ms",
        "--duration",
        "0.1",
        "--loss-frequency",
        "5Hz",
        *lossy,
    )[1]
    assert "left out" not in quiet
    ratio = [
        result("response", file("cubic-isolator"), *options)["damping_ratio"][0]
        for options in (lossy, ("--loss-factor", "0.05"))
    ]
    assert ratio[0] == ratio[1]


STIFF_IN_TORSION = {"universal": [20.0, 5.0], "spherical": 2.0, "torsion": 200.0, "loss_factor": 0.05}


@pytest.mark.parametrize("joint", ["universal", "spin_free"])
@pytest.mark.parametrize("mode", range(6))
def test_in_its_mode_the_viscous_equivalent_takes_what_joints_of_any_stiffness_lose(joint, mode):
    """Against the poles of the complex stiffness; bending, twist and both axes of a joint differ a hundredfold."""
    changes = {"legs.joint_stiffness": STIFF_IN_TORSION, "gravity": [0, 0, 0], "platform.mass_center": [0.01, 0.02, 0]}
    hexapod = ISOLATOR.replace(changes)
    linear = fx.linearise(hexapod, joint=joint)
    pole = complex_poles(linear, linear.losses)[mode]
    viscous = fx.mechanics.viscous_equivalent(hexapod, abs(pole), joint=joint)
    ratio = fx.linearise(viscous, joint=joint).modes().damping_ratio[mode]
    assert ratio == pytest.approx(-pole.real / abs(pole), rel=2e-3)
    assert ratio > 2e-4


def test_a_joint_gets_a_mean_of_the_stiffnesses_it_has():
    """And one that moves a mean between the two stiffnesses of its axes; without stiffness there is nothing to lose."""
    rest = ISOLATOR.replace({"legs.joint_stiffness": {"universal": [3.0, 1.0], "loss_factor": 0.1}})
    found = fx.mechanics.viscous_equivalent(rest, 40.0).legs.damping
    assert (found.spherical == 0).all()
    assert ((found.universal >= 0.1 * 1.0 / 40.0) & (found.universal <= 0.1 * 3.0 / 40.0)).all()


def test_in_time_friction_stands_for_losses_in_the_joint_model_of_the_run():
    """The modes, by which the stiffnesses of a joint are weighted, are those of the model."""
    hexapod = LOSSY.replace({"legs.joint_stiffness.universal": [30.0, 5.0], "legs.joint_stiffness.torsion": 90.0})
    pushed = {"base_motion": fx.half_sine_shock("x", 1e-4, 0.02), "duration": 0.1, "samples": 5}
    by_model = {}
    for joint in ("universal", "spin_free"):
        viscous = fx.mechanics.viscous_equivalent(hexapod, 59.3, joint=joint)
        by_hand = fx.simulate(viscous, joint=joint, **pushed).displacement.values
        by_model[joint] = fx.simulate(hexapod, loss_frequency=59.3, joint=joint, **pushed).displacement.values
        assert (by_model[joint] == by_hand).all()
    frictions = [
        fx.mechanics.viscous_equivalent(hexapod, 59.3, joint=joint).legs.damping.spherical for joint in by_model
    ]
    assert not np.allclose(*frictions, rtol=1e-3)
