"""Random vibration under control: the Lyapunov equation, sampled loops in time, and what crosses with losses."""

import numpy as np
import pytest
from scipy.linalg import solve_continuous_lyapunov
from tests.vibration.test_random_loads import AT, HOME, MACHINE, TOLD, lever

import flexapod as fx
from flexapod.control.plant import Plant
from flexapod.control.sampled_prediction import Clock, predict

LAWS = [
    fx.control.VelocityFeedback(200.0),
    fx.control.ForceFeedback(20.0, leak=3.0),
    fx.control.PID(2e3, 80.0, 500.0),
    fx.control.PID(2e3, 80.0, space="task", actuator="command", bandwidth=400.0),
]


def lyapunov(machine, law, density, by_base):
    """Covariance of the platform's relative displacement and of the actuators' forces, from the loop in time.

    density: (6, 6), one-sided per rad/s, of the wrench at AT or of the base's acceleration (gravity does not tilt).
    """
    linear = fx.linearise(machine, HOME)
    M, C, K, H = linear.M, linear.C, linear.K, linear.H
    M_inv, law = np.linalg.inv(M), law.on(linear)
    zero, one = np.zeros((6, 6)), np.eye(6)
    A = np.block([[zero, one], [-M_inv @ K, -M_inv @ C]])
    B = np.vstack([zero, M_inv @ H])
    into = -(linear.carry + M_inv @ linear.M_b) if by_base else M_inv @ lever(machine, AT).T
    spring = -linear.leg_stiffness[:, None] * H.T
    seen = {
        "leg_length": ([H.T, zero], zero),
        "leg_rate": ([zero, H.T], zero),
        "leg_force": ([spring, zero], one),
        "position": ([one, zero], zero),
        "velocity": ([zero, one], zero),
    }
    C_y = np.vstack([np.hstack(seen[name][0]) for name in law.measures])
    D_y = np.vstack([seen[name][1] for name in law.measures])
    inner = np.linalg.inv(np.eye(6) - law.D @ D_y)
    F = inner @ np.hstack([law.D @ C_y, law.C])
    y = np.hstack([C_y, np.zeros((len(C_y), law.order))]) + D_y @ F
    loop = np.vstack([np.hstack([A, np.zeros((12, law.order))]) + B @ F, law.B @ y])
    loop[12:, 12:] += law.A
    push = np.vstack([zero, into, np.zeros((law.order, 6))])
    P = solve_continuous_lyapunov(loop, -np.pi * push @ density @ push.T)
    return P[:6, :6], F @ P @ F.T


@pytest.mark.parametrize("law", LAWS, ids=lambda law: type(law).__name__)
@pytest.mark.parametrize("by_base", [False, True], ids=["load", "base"])
def test_white_shaking_gives_the_covariance_of_the_lyapunov_equation(law, by_base):
    machine = MACHINE.replace({"gravity": [0, 0, 0]})
    root = np.random.default_rng(3).normal(size=(6, 6)) * np.repeat([1.0, 0.1], 3)[:, None]
    density, band = root @ root.T, [1e-5, 1e8]
    table = np.tile(density, (2, 1, 1))
    given = (
        {"psd": table, "omega": band} if by_base else {"loads": fx.vibration.RandomLoad(table, omega=band, point=AT)}
    )
    found = fx.control.controlled_random_response(machine, HOME, controller=law, point=TOLD, **given)
    moved, forces = lyapunov(machine, law, density, by_base)
    T = lever(machine, TOLD)
    np.testing.assert_allclose(found.rms_relative, np.sqrt(np.diag(T @ moved @ T.T)), rtol=1e-5)
    np.testing.assert_allclose(found.rms_actuator_force, np.sqrt(np.diag(forces)), rtol=1e-4)
    if not by_base:
        np.testing.assert_allclose(found.rms_relative, found.rms_displacement, rtol=1e-9)


def test_without_gain_it_is_the_random_response():
    """Which is solved in the undamped modes, and not from states; with losses of springs and joints."""
    machine = MACHINE.replace(
        {"legs.loss_factor": 0.03, "legs.joint_stiffness": {"universal": 2.0, "loss_factor": 0.2}}
    )
    shaking = {
        "psd": fx.vc_curve("VC-A"),
        "axis": "z",
        "loads": fx.vibration.RandomLoad([2.0, 1.0], frequency=[1.0, 80.0], axis="force_y", point=AT),
    }
    none = fx.control.VelocityFeedback(0.0)
    found = fx.control.controlled_random_response(machine, HOME, controller=none, point=TOLD, **shaking)
    plain = fx.random_response(machine, HOME, point=TOLD, **shaking)
    for name in ("displacement", "relative", "acceleration", "leg_force"):
        expected = plain[f"source_rms_{name}"].values
        np.testing.assert_allclose(found[f"source_rms_{name}"], expected, rtol=1e-7, atol=1e-9 * expected.max())
    assert not found.rms_actuator_force.any()


def mass(linear, share=-0.1):
    """A controller that acts as mass does: a force against the acceleration of the platform."""
    empty = np.zeros((0, 0)), np.zeros((0, 6)), np.zeros((6, 0))
    return fx.control.Controller(*empty, share * np.linalg.solve(linear.H, linear.M), ("acceleration",), "mass")


@pytest.mark.parametrize(
    "law", [*LAWS[:3], mass(fx.linearise(MACHINE, HOME))], ids=["velocity", "force", "pid", "mass"]
)
@pytest.mark.parametrize("share", [0.1, 0.6])
def test_a_sampled_loop_answers_as_its_samples_do_in_time(law, share):
    """Step by step on a shaken base, until the start has decayed: at 0.1 and 0.6 of half the sampling frequency."""
    plant, dt, samples = Plant(fx.linearise(MACHINE, HOME)), 5e-3, 4000
    sampled = law.on(plant.linear).sampled(dt)
    omega = np.round(share * samples / 4) * 2 * np.pi / (samples / 2 * dt)  # whole periods in the second half
    base = fx.excitation.harmonic("z", 1e-3, omega)
    run = predict(plant, sampled, base, Clock(dt, samples, 8), np.zeros((samples, 36)))
    times = dt * np.arange(samples // 2, samples)
    wave = np.exp(-1j * omega * times)[:, None]
    force, moved = (wave * run.force[samples // 2 :]).mean(axis=0), (wave * base.evaluate(times)[0]).mean(axis=0)[2]
    answer = fx.control.controlled_transmissibility(MACHINE, HOME, controller=sampled, omega=[omega])
    hold = (1 - np.exp(-1j * omega * dt)) / (1j * omega * dt)
    expected = answer.leg_force.sel(base="z").values[0] / hold
    np.testing.assert_allclose(force / moved, expected, atol=1e-3 * abs(expected).max())


def test_bad_input_is_told():
    floor, linear = {"psd": fx.vc_curve("VC-A"), "axis": "z"}, fx.linearise(MACHINE, HOME)
    with pytest.raises(fx.errors.UnstableError, match="never becomes stationary"):
        fx.control.controlled_random_response(MACHINE, HOME, controller=mass(linear, 2.0), **floor)
    slow = fx.control.VelocityFeedback(20.0).on(linear).sampled(0.01)
    with pytest.raises(fx.ArgumentError, match="Sample at least every"):
        fx.control.controlled_random_response(MACHINE, HOME, controller=slow, **floor)
    with pytest.raises(fx.ArgumentError, match="psd and loads are both missing"):
        fx.control.controlled_random_response(MACHINE, HOME, controller=LAWS[0])
