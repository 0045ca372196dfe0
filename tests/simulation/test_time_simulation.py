"""Time simulation against conservation laws, closed forms, statics, SciPy and the closed-chain engine."""

import signal
import time as clock

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import root
from scipy.spatial.transform import Rotation
from tests.helpers.plain import plain_machine
from tests.helpers.states import perturbed
from tests.oracles.closed_chain import ClosedChain

import flexapod as fx
from flexapod.errors import ArgumentError, PoseError, SimulationError, SingularPoseError
from flexapod.simulation.integrator import IntegratorOptions, integrate

FRICTION = ("prismatic", "universal", "spherical")
SMOOTH = {f"legs.damping.{joint}": 0.0 for joint in FRICTION}
SHAKEN = (
    fx.harmonic("x", [2e-3, 1e-3], [40.0, 90.0], [0.2, 1.0])
    + fx.harmonic("z", 3e-3, 70.0)
    + fx.harmonic("roll", 0.2, 25.0, 0.4)
    + fx.harmonic("pitch", 0.1, 45.0)
    + fx.harmonic("yaw", 0.3, 15.0, 1.0)
)


def machine(name="mukherjee-ii", **changes):
    hexapod = plain_machine(name)
    if changes:
        hexapod = hexapod.replace(changes)
    return hexapod, fx.home_pose(hexapod)


def motion_at(dataset, i):
    pose = fx.Pose(dataset.position.values[i], dataset.rotation.values[i])
    names = ("velocity", "angular_velocity", "acceleration", "angular_acceleration")
    return fx.Motion(pose, *(dataset[name].values[i] for name in names))


# --- conservation ----------------------------------------------------------------------------------------------------


def test_energy_is_kept_for_a_thousand_periods_without_friction(measured):
    """All six modes ring; what is lost is lost at the rate of the fastest one's 3000 periods."""
    hexapod, pose = machine("precision-positioner")
    hexapod = hexapod.replace(SMOOTH)
    size = np.linalg.norm(hexapod.platform_joints, axis=1).mean()
    period = 2 * np.pi / fx.stability_index(hexapod, pose)
    start = fx.Motion(fx.Pose(pose.position + 1e-5 * size), [0.01, 0.0, -0.02], [0.03, 0.05, -0.04])
    dataset = fx.simulate(hexapod, pose, start=start, duration=1000 * period, samples=500, rtol=1e-12)
    measured("time/energy", dataset.attrs["energy_error"], 1e-8)  # what is promised
    assert dataset.kinetic_energy.max() > 0


def test_papers_machine_keeps_its_energy():
    """Its fastest modes are 33 times the lowest: 100 periods of the lowest, at a tenth of the loss allowed for 1000."""
    hexapod, pose = machine()
    hexapod = hexapod.replace(SMOOTH)
    period = 2 * np.pi / fx.stability_index(hexapod, pose)
    start = fx.Motion(fx.Pose(pose.position + np.array([1e-4, -5e-5, 2e-5])), [0, 0.01, 0], [0.1, 0.2, -0.3])
    dataset = fx.simulate(hexapod, pose, start=start, duration=100 * period, samples=500, rtol=1e-12)
    assert dataset.attrs["energy_error"] < 1e-9


def test_works_balance_the_energy(measured):
    """Base, wrench, leg commands and friction all at work; the machine's energy is what they bring and take."""
    hexapod, pose = machine()
    hexapod = hexapod.replace(
        {f"legs.damping.{joint}": c for joint, c in zip(FRICTION, (300.0, 0.5, 0.7), strict=True)}
    )
    dataset = fx.simulate(
        hexapod,
        pose,
        base_motion=SHAKEN,
        force=fx.harmonic("x", 30.0, 300.0).ramped(0.01),
        moment=fx.excitation.smooth_step("z", 0.5, 0.02),
        leg_command=fx.harmonic("2", 1e-4, 200.0) + fx.excitation.smooth_step("5", -2e-4, 0.03),
        duration=0.1,
        rtol=1e-12,
    )
    work = dataset.work.values
    assert (np.abs(work).max(axis=0) > 1e-4).all()  # each of them took part, J
    assert (np.diff(work[:, 3]) < 0).all()  # friction only takes
    measured("time/works", dataset.attrs["energy_error"], 1e-10)  # of a few thousand steps at 1e-12, and rounding


@pytest.mark.parametrize("joint", ["universal", "spin_free"])
def test_order_of_convergence(joint, measured):
    """Steps of one length: halving them divides the error by 2^8, while platform and base turn by 0.2 rad."""
    hexapod, pose = machine("precision-positioner")
    omega = fx.natural_modes(hexapod, pose).omega
    size = np.linalg.norm(hexapod.platform_joints, axis=1).mean()
    start = fx.Motion(pose, 0.1 * size * omega[0] * np.array([1, 0, -1]), 0.1 * omega[0] * np.array([1, -1, 2]))
    base = fx.harmonic("roll", 0.2, 0.4 * omega[0]) + fx.harmonic("x", 0.05 * size, 0.6 * omega[0])
    runs, duration = [fx.simulation.SimulationRun(hexapod, pose, base_motion=base, start=start)], 32.0 / omega[-1]

    def end(step, rtol=1e-2):
        options = IntegratorOptions(rtol=rtol, max_step=step, method="runge_kutta")
        return integrate(runs, [duration], joint=joint, options=options).displacement[0, 0]

    exact = end(0.05 / omega[-1], 1e-14)
    errors = np.array([np.linalg.norm(end(h / omega[-1]) - exact) for h in (1.6, 0.8, 0.4)])
    order = np.log2(errors[:-1] / errors[1:])
    measured("time/order", order - 8, 0.7)  # the next power of the step adds a little at these lengths


def test_interpolant_is_as_good_as_the_steps():
    """Samples fall inside steps, in the middle of which order 7 is worst."""
    hexapod, pose = machine()
    run = [fx.simulation.SimulationRun(hexapod, pose, base_motion=fx.harmonic("z", 1e-6, 750.0))]
    times = np.linspace(0, 0.05, 997)
    coarse = integrate(run, times, options=IntegratorOptions(rtol=1e-8, method="runge_kutta")).displacement
    exact = integrate(run, times, options=IntegratorOptions(rtol=1e-13)).displacement
    scale = np.abs(exact).max()
    assert np.abs(coarse - exact).max() < 1e-5 * scale  # 700 steps at 1e-8 each
    assert np.abs(coarse - exact).max() > 1e-12 * scale  # and the tolerance matters


# --- closed forms ----------------------------------------------------------------------------------------------------


def test_free_flight_of_a_symmetric_top(measured):
    """Legs without mass and next to no stiffness: a thrown top precesses about its angular momentum, for many turns."""
    hexapod, pose = machine()
    center, flat = np.array([0.01, -0.02, 0.03]), np.diag([0.02, 0.02, 0.035])
    axes = Rotation.from_rotvec([0.4, -0.3, 0.9])  # the top's own axes in the platform
    inertia = axes.as_matrix() @ flat @ axes.as_matrix().T
    hexapod = hexapod.replace(
        {
            **SMOOTH,
            "legs.stiffness": 1e-12,
            "legs.lower.mass": 0.0,
            "legs.upper.mass": 0.0,
            "legs.lower.inertia": np.zeros((3, 3)),
            "legs.upper.inertia": np.zeros((3, 3)),
            "platform.mass_center": center,
            "platform.inertia": 0.5 * (inertia + inertia.T),
        }
    )
    spin, velocity = np.array([3.0, -2.0, 7.0]), np.array([0.1, 0.2, 0.3])
    start = fx.Motion(pose, velocity - np.cross(spin, center), spin)  # velocity: of the mass centre
    times = np.linspace(0, 10.0, 101)
    dataset = fx.simulate(
        hexapod,
        pose,
        start=start,
        unstretched_length=fx.inverse_kinematics(hexapod, pose),
        times=times,
        rtol=1e-12,
        stop_at_singular=False,
    )
    momentum = inertia @ spin
    own_axis = axes.apply([0, 0, 1])
    own_spin = (1 - 0.035 / 0.02) * (spin @ own_axis)
    turn = Rotation.from_rotvec(np.outer(times, momentum / 0.02)) * Rotation.from_rotvec(
        np.outer(times, own_spin * own_axis)
    )
    mass_center = pose.position + center + np.outer(times, velocity) + 0.5 * np.outer(times**2, hexapod.gravity)
    # A thousand steps at 1e-12; the stiffness moves the top by 1e-12 N/m * 500 m / 4 kg in 100 s^2 / 2: 1e-9 m.
    measured("time/top", dataset.rotation.values - turn.as_matrix(), 1e-8)
    np.testing.assert_allclose(dataset.position.values, mass_center - turn.apply(center), atol=1e-7)
    assert dataset.attrs["energy_error"] < 1e-9


def test_base_moved_slowly_carries_the_platform_along():
    hexapod, pose = machine()
    lowest = fx.stability_index(hexapod, pose)
    duration = 300 / lowest
    base = fx.excitation.smooth_step("x", 0.02, duration) + fx.excitation.smooth_step("yaw", 0.3, duration)
    dataset = fx.simulate(hexapod, pose, base_motion=base, duration=1.2 * duration, samples=300)
    turned = Rotation.from_rotvec([0, 0, 0.3])
    expected = turned.as_matrix() @ pose.position + [0.02, 0, 0]
    # Inertia bends the legs by a / omega^2 on the way, 8e-5 of the travel at the largest acceleration 7.5 s / T^2, and
    # leaves ringing of (omega T)^-4 of it.
    largest = np.abs(dataset.relative_displacement.values).max()
    assert largest < 0.3 * 8e-5 * 2
    assert np.abs(dataset.relative_displacement.values[-50:]).max() < 1e-3 * largest
    np.testing.assert_allclose(dataset.position.values[-1], expected, atol=1e-7)
    np.testing.assert_allclose(dataset.rotation.values[-1], turned.as_matrix(), atol=1e-6)
    np.testing.assert_allclose(dataset.displacement.values[-1, 5], 0.3, atol=1e-6)


def test_spinning_base_holds_the_centrifugal_equilibrium(measured):
    """The balance is found apart from the simulation, in the rotating frame; started there, the platform stays."""
    hexapod, pose = machine("cubic-isolator")
    spin = np.array([0.0, 0.0, 6.0])
    rest = fx.hold(hexapod, pose)
    base = fx.Motion(fx.Pose((0, 0, 0)), angular_velocity=spin)

    def unbalanced(x):
        turned = Rotation.from_rotvec(x[3:]).as_matrix() @ pose.matrix
        position = pose.position + x[:3]
        platform = fx.Motion(fx.Pose(position, turned), np.cross(spin, position), spin)
        length = fx.inverse_kinematics(hexapod, platform.pose)
        force = hexapod.legs.stiffness * (rest.unstretched_length - length)
        a, alpha = fx.forward_dynamics(hexapod, platform, base=base, leg_force=force)
        return np.concatenate([a - np.cross(spin, np.cross(spin, position)), alpha])

    found = root(unbalanced, np.zeros(6), tol=1e-13)
    assert np.abs(found.x).max() > 1e-6  # it does move outwards
    position = pose.position + found.x[:3]
    start = fx.Motion(
        fx.Pose(position, Rotation.from_rotvec(found.x[3:]).as_matrix() @ pose.matrix), np.cross(spin, position), spin
    )
    base_motion = fx.excitation.polynomial("yaw", [0.0, spin[2]])
    dataset = fx.simulate(hexapod, pose, base_motion=base_motion, start=start, duration=3.0, samples=100)
    relative = dataset.relative_displacement.values
    measured("time/centrifugal", (relative - found.x) / np.abs(found.x).max(), 1e-8)
    assert np.linalg.norm(dataset.angular_velocity.values - spin, axis=1).max() < 1e-9


def test_small_vibration_has_the_tangents_frequency(measured):
    hexapod, pose = machine("precision-positioner")
    linear = fx.linearise(hexapod, pose)
    modes = linear.modes()
    shape, pole = modes.shape[:, 0], modes.pole[0]
    scale = 1e-9 / np.abs(shape[:3]).max()
    velocity = scale * np.real(pole * shape)
    start = fx.Motion(
        fx.Pose(pose.position + scale * shape[:3].real, Rotation.from_rotvec(scale * shape[3:].real).as_matrix()),
        velocity[:3],
        velocity[3:],
    )
    times = np.linspace(0, 60 / abs(pole), 300)
    found = integrate([fx.simulation.SimulationRun(hexapod, pose, start=start)], times).displacement[0]
    expected = scale * np.real(np.exp(np.outer(times, [pole])) * shape)
    # Start: positions of 1e-1 m rounded to 1e-17 m; the rest is 1e-9 of the machine's size squared.
    measured("time/tangent", (found - expected) / np.abs(expected).max(), 1e-6)


# --- rest, loads and commands ----------------------------------------------------------------------------------------


def test_gravity_rings_only_when_asked():
    hexapod, pose = machine()
    still = fx.simulate(hexapod, pose, duration=0.1, samples=50)
    assert np.abs(still.displacement).max() < 1e-14
    assert still.attrs["status"] == "complete"
    lengths = fx.inverse_kinematics(hexapod, pose)
    ringing = fx.simulate(hexapod, pose, unstretched_length=lengths, duration=0.1, samples=2000)
    settled = fx.static_equilibrium(hexapod, lengths, start=pose).pose.position - pose.position
    # Released from unloaded legs without much friction it swings between there and twice as far.
    middle = ringing.displacement.sel(output="z").values
    assert middle.mean() == pytest.approx(settled[2], rel=0.05)  # a finite number of periods
    assert middle.min() == pytest.approx(2 * settled[2], rel=0.05)


def test_slow_loads_and_commands_lead_to_static_equilibrium(measured):
    hexapod, pose = machine("precision-positioner")
    T = 500 / fx.stability_index(hexapod, pose)
    force, change = np.array([50.0, -20.0, 30.0]), 2e-5
    steps = [fx.excitation.smooth_step(axis, f, T) for axis, f in zip("xyz", force, strict=True)]
    dataset = fx.simulate(
        hexapod,
        pose,
        force=steps[0] + steps[1] + steps[2],
        moment=fx.excitation.smooth_step("y", 3.0, T),
        leg_command=fx.excitation.smooth_step("3", change, T),
        duration=1.3 * T,
        samples=100,
    )
    lengths = fx.hold(hexapod, pose).unstretched_length + change * (np.arange(6) == 2)
    end = fx.static_equilibrium(hexapod, lengths, start=pose, force=force, moment=(0, 3.0, 0))
    travel = np.abs(end.pose.position - pose.position).max()
    measured("time/statics", (dataset.position.values[-1] - end.pose.position) / travel, 1e-6)
    np.testing.assert_allclose(dataset.leg_force.values[-1], end.leg_force, atol=1e-4)
    held = fx.simulate(hexapod, pose, force=force, moment=(0, 3.0, 0), duration=0.01)
    assert np.abs(held.displacement).max() < 1e-13  # constant loads belong to rest


def test_start_with_the_base():
    """Carried: nothing moves inside the machine at first, wherever the base is and however it moves."""
    hexapod, pose = machine()
    base = fx.harmonic("x", 1e-3, 10.0, 1.0) + fx.harmonic("pitch", 0.1, 10.0, 0.5)
    first = fx.simulate(hexapod, pose, base_motion=base, start="carried", duration=1e-3, samples=3).isel(time=0)
    assert np.abs(first.relative_displacement).max() == 0
    carried = base.motion(0.0)
    np.testing.assert_allclose(first.position, carried.pose.position + carried.pose.matrix @ pose.position, atol=1e-16)
    np.testing.assert_allclose(first.angular_velocity, carried.angular_velocity, atol=1e-15)
    rest = fx.simulate(hexapod, pose, base_motion=base, duration=1e-3, samples=3).isel(time=0)
    np.testing.assert_allclose(rest.position, pose.position, atol=1e-17)
    np.testing.assert_allclose(rest.displacement, 0, atol=1e-17)
    np.testing.assert_allclose(rest.velocity, 0, atol=1e-17)


def test_a_base_elsewhere_changes_nothing():
    """The whole experiment moved and turned in a world without gravity gives the same motion seen from the base."""
    hexapod, pose = machine()
    hexapod = hexapod.replace({"gravity": [0.0, 0.0, 0.0]})
    world = fx.Pose((3.0, -2.0, 1.0), Rotation.from_rotvec([0.5, 1.0, -0.7]))
    there = fx.Pose(world.position + world.matrix @ pose.position, world.matrix @ pose.matrix)
    drive = {"force": fx.harmonic("x", 30.0, 300.0), "leg_command": fx.harmonic("4", 1e-5, 500.0), "duration": 0.02}
    here = fx.simulate(hexapod, pose, **drive)
    moved = fx.simulate(hexapod, there, base=world, **drive)
    scale = np.abs(here.relative_displacement).max()
    # Differences of the world's coordinates (3 m) round by 4e-16 m at the start and stiff legs make 1e-15 of it.
    np.testing.assert_allclose(moved.relative_displacement, here.relative_displacement, atol=1e-7 * scale)
    turned = moved.displacement.values[:, :3] @ world.matrix
    np.testing.assert_allclose(turned, here.displacement.values[:, :3], atol=1e-7 * scale)


# --- other codes -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["mukherjee-i", "mukherjee-ii"])
def test_trajectory_has_the_engines_accelerations(name, measured):
    """50 points along a violent one: base shaken in six directions, friction, wrench, leg commands."""
    rng = np.random.default_rng(35)
    hexapod = perturbed(plain_machine(name), rng)
    pose = fx.Pose((0, 0, 0.89)) if name == "mukherjee-i" else fx.home_pose(hexapod)
    shaken = SHAKEN.ramped(0.05)
    force, moment = fx.harmonic("x", 200.0, 90.0, 1.0), fx.harmonic("z", 3.0, 150.0)
    dataset = fx.simulate(
        hexapod,
        pose,
        base_motion=shaken,
        force=force,
        moment=moment,
        leg_command=fx.harmonic("1", 1e-4, 120.0),
        duration=0.2,
        samples=50,
    )
    chain = ClosedChain(hexapod)
    base = shaken.motion(dataset.time.values)
    names = ("velocity", "angular_velocity", "acceleration", "angular_acceleration")
    for i, t in enumerate(dataset.time.values):
        base_now = fx.Motion(base.pose[i], *(getattr(base, name)[i] for name in names))
        loads = force.evaluate(t)[0][:3], moment.evaluate(t)[0][:3]
        linear, angular = chain.acceleration(motion_at(dataset, i), base_now, dataset.leg_force.values[i], *loads)
        for found, expected in ((dataset.acceleration, linear), (dataset.angular_acceleration, angular)):
            scale = np.linalg.norm(expected) + 1e-3 * np.linalg.norm(found.values, axis=1).max()
            measured("time/engine", np.linalg.norm(found.values[i] - expected) / scale, 1e-10)  # what is promised


def test_trajectory_agrees_with_scipy_in_the_inertial_frame(measured):
    """Another formulation: absolute position and quaternion, `fx.forward_dynamics`, SciPy's integrator."""
    hexapod, pose = machine()
    rest = fx.hold(hexapod, pose)

    def rates(t, z):
        q = z[3:7]
        turn = Rotation.from_quat(q)
        base = SHAKEN.motion(t)
        platform = fx.Motion(fx.Pose(z[:3], turn), z[7:10], z[10:])
        force = hexapod.legs.stiffness * (
            rest.unstretched_length - fx.inverse_kinematics(hexapod, platform.pose, base=base.pose)
        )
        a, alpha = fx.forward_dynamics(hexapod, platform, base=base, leg_force=force)
        w = z[10:]
        q_rate = 0.5 * np.concatenate([w * q[3] + np.cross(w, q[:3]), [-w @ q[:3]]])
        return np.concatenate([z[7:10], q_rate, a, alpha])

    z0 = np.concatenate([pose.position, [0, 0, 0, 1.0], np.zeros(6)])
    times = np.linspace(0, 0.002, 9)
    other = solve_ivp(rates, (0, times[-1]), z0, "DOP853", times, rtol=1e-11, atol=1e-13)
    dataset = fx.simulate(hexapod, pose, base_motion=SHAKEN, times=times, rtol=1e-11)
    # Travels of 1e-3 m in some 50 steps of 1e-11; legs of 8e7 N/m make 1e-13 m of SciPy's tolerance felt.
    measured("time/scipy", dataset.position.values - other.y[:3].T, 1e-9)
    turn = Rotation.from_quat(other.y[3:7].T).as_matrix()
    np.testing.assert_allclose(dataset.rotation.values, turn, atol=1e-8)
    np.testing.assert_allclose(dataset.velocity.values, other.y[7:10].T, atol=1e-6)


# --- many at once ----------------------------------------------------------------------------------------------------


def test_many_runs_are_the_single_ones_whatever_the_threads():
    hexapod, pose = machine()
    other, elsewhere = machine("cubic-isolator")
    runs = [
        fx.simulation.SimulationRun(hexapod, pose, base_motion=fx.harmonic("z", 1e-6, w)) for w in (300.0, 500.0, 800.0)
    ]
    runs.append(fx.simulation.SimulationRun(other, elsewhere, force=fx.excitation.half_sine_pulse("x", 3.0, 0.01)))
    many = fx.simulate_many(runs, 0.05, samples=40)
    alone = fx.simulate_many(runs, 0.05, samples=40, threads=1)
    assert many.sizes["run"] == 4
    assert many.identical(alone)
    single = fx.simulate(hexapod, pose, base_motion=runs[1].base_motion, duration=0.05, samples=40)
    np.testing.assert_array_equal(single.displacement, many.displacement[1])


def test_a_run_that_ends_early_is_data():
    hexapod, pose = machine()
    soft = hexapod.replace({"legs.stiffness": 1e3, "gravity": [0, 0, 0]})
    thrown = fx.simulation.SimulationRun(soft, pose, start=fx.Motion(pose, (0, 0, -3.0)))
    dataset = fx.simulate_many([fx.simulation.SimulationRun(soft, pose), thrown], 0.2, samples=50)
    assert dataset.status.values.tolist() == ["complete", "singular"]
    end = dataset.end_time.values[1]
    assert 0 < end < 0.2
    assert np.isnan(dataset.position[1].values[dataset.time > end]).all()
    assert np.isfinite(dataset.position[1].values[dataset.time <= end]).all()
    assert np.isfinite(dataset.position[0].values).all()


# --- what ends a simulation ------------------------------------------------------------------------------------------


def test_singular_pose_ends_it_with_time_and_pose():
    hexapod, pose = machine()
    soft = hexapod.replace({"legs.stiffness": 1e3, "gravity": [0, 0, 0]})
    start = fx.Motion(pose, (0, 0, -3.0))
    with pytest.raises(SimulationError, match=r"ended at t = 0\.1.*singular|det H changes sign") as caught:
        fx.simulate(soft, pose, start=start, duration=1.0)
    error = caught.value
    assert fx.condition_number(soft, error.pose) > 1e10  # found to rounding: det H is bisected to the last digit
    assert error.result.time[-1] <= error.time < error.result.time[-1] + 0.1
    assert error.result.attrs["status"] == "singular"
    before = fx.Pose(error.result.position.values[-1], error.result.rotation.values[-1])
    assert fx.condition_number(soft, before) < 1e10
    through = fx.simulate(soft, pose, start=start, duration=0.11, stop_at_singular=False)
    assert through.time[-1] > error.time


def test_leg_through_zero_length_ends_it():
    """Platform joints over base joints: straight down, all legs shrink to nothing together."""
    hexapod, _ = machine()
    hexapod = hexapod.replace(
        {
            **SMOOTH,
            "gravity": [0.0, 0.0, 0.0],
            "legs.stiffness": 100.0,
            "legs.lower.mass": 0.0,
            "legs.upper.mass": 0.0,
            "base.joints": hexapod.platform_joints,
            "base.universal_axes": np.tile([1.0, 0.0, 0.0], (6, 1)),
        }
    )
    pose = fx.Pose((0.0, 0.0, 0.1))
    with pytest.raises(SimulationError, match="length passes through zero") as caught:
        fx.simulate(
            hexapod,
            pose,
            start=fx.Motion(pose, (0, 0, -30.0)),
            unstretched_length=fx.inverse_kinematics(hexapod, pose),
            duration=1.0,
            stop_at_singular=False,
        )
    assert caught.value.time == pytest.approx(0.1 / 30, rel=0.01)  # nearly free fall: K x^2 is 1 % of M v^2
    assert np.abs(caught.value.pose.position[2]) < 1e-4


def test_locked_universal_joint_ends_it():
    hexapod, pose = machine()
    soft = hexapod.replace({"legs.stiffness": 1e3, "gravity": [0, 0, 0]})
    with pytest.raises(SimulationError, match="along its universal joint's axis"):
        fx.simulate(soft, pose, start=fx.Motion(pose, (1.0, 0, 0)), duration=1.0)


def test_steps_can_run_out():
    hexapod, pose = machine()
    with pytest.raises(SimulationError, match="Raise max_steps") as caught:
        fx.simulate(hexapod, pose, base_motion=fx.harmonic("z", 1e-6, 750.0), duration=1.0, max_steps=100)
    assert 0 < caught.value.time < 0.1


def test_steps_that_collapse_are_told():
    """A push that grows beyond all bounds: t^7 to 1e300 N."""
    hexapod, pose = machine("cubic-isolator")
    with pytest.raises(SimulationError):
        fx.simulate(
            hexapod, pose, force=fx.excitation.polynomial("x", [0] * 7 + [1e300]), duration=10.0, stop_at_singular=False
        )


def test_the_shortest_duration_there_is_ends():
    hexapod, pose = machine()
    with pytest.raises(SimulationError, match="step"):
        fx.simulate(hexapod, pose, base_motion=fx.harmonic("z", 1e-6, 750.0), duration=5e-324)


def test_interrupt_stops_it():
    class Interrupted(Exception):
        pass

    def interrupt(*_):
        raise Interrupted

    hexapod, pose = machine()
    before = signal.signal(signal.SIGALRM, interrupt)
    signal.setitimer(signal.ITIMER_REAL, 0.3)
    began = clock.perf_counter()
    try:
        with pytest.raises(Interrupted):
            fx.simulate(hexapod, pose, base_motion=fx.harmonic("z", 1e-6, 750.0), duration=1e4, samples=10)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
    assert clock.perf_counter() - began < 60.0  # it looks every 0.05 s; an hour's work otherwise


def test_progress_goes_from_nothing_to_all():
    hexapod, pose = machine()
    seen = []
    fx.simulate(hexapod, pose, base_motion=fx.harmonic("z", 1e-6, 750.0), duration=2.0, samples=9, progress=seen.append)
    assert seen
    assert seen == sorted(seen)
    assert all(0 <= part <= 1 for part in seen)

    def stop(_):
        raise ValueError("enough")

    with pytest.raises(ValueError, match="enough"):
        fx.simulate(hexapod, pose, base_motion=fx.harmonic("z", 1e-6, 750.0), duration=1e4, samples=9, progress=stop)


# --- samples, settings, warnings -------------------------------------------------------------------------------------


def test_reactions_are_those_of_the_motion():
    hexapod, pose = machine()
    dataset = fx.simulate(hexapod, pose, base_motion=SHAKEN, duration=0.01, samples=20, reactions=True)
    i = 13
    base_now = SHAKEN.motion(dataset.time.values[i])
    found = fx.joint_reactions(hexapod, motion_at(dataset, i), base=base_now, leg_force=dataset.leg_force.values[i])
    for name, value in found._asdict().items():
        np.testing.assert_allclose(dataset[name].values[i], value, rtol=1e-9, atol=1e-9)
    assert "spherical_force" not in fx.simulate(hexapod, pose, duration=0.01, samples=3)


def test_default_samples_resolve_the_fastest_mode():
    hexapod, pose = machine()
    dataset = fx.simulate(hexapod, pose, duration=0.01)
    highest = fx.natural_modes(hexapod, pose).omega[-1]
    assert dataset.time.values[1] <= fx.control.sampling_time(highest)
    assert dataset.sizes["time"] < 1000
    assert {"units"} <= set(dataset.leg_force.attrs)
    given = fx.simulate(hexapod, pose, times=[0.0, 0.003, 0.003, 0.01])
    np.testing.assert_array_equal(given.time, [0.0, 0.003, 0.003, 0.01])


def test_velocity_and_acceleration_are_those_seen_from_the_base():
    """Against differences of where the platform stands in the axes of a base that turns and shakes."""
    hexapod, pose = machine("cubic-isolator")
    base = fx.harmonic("z", 2e-3, 20.0) + fx.harmonic("yaw", 0.02, 7.0) + fx.harmonic("roll", 0.01, 11.0)
    times = 0.1 + 1e-4 * np.arange(41)
    run = fx.simulate(hexapod, pose, base_motion=base, times=times, start="carried", rtol=1e-12)
    turn = run.base_rotation.values
    place = np.einsum("nji,nj->ni", turn, run.position.values - run.base_position.values)
    rotation = np.einsum("nji,njk->nik", turn, run.rotation.values)
    step = times[1] - times[0]

    def rate(values):
        return (values[:-4] - 8 * values[1:-3] + 8 * values[3:-1] - values[4:]) / (12 * step)

    spin = np.einsum("nij,nkj->nik", rate(rotation), rotation[2:-2])
    angular = np.stack([spin[:, 2, 1], spin[:, 0, 2], spin[:, 1, 0]], axis=1)
    velocity, acceleration = run.relative_velocity.values, run.relative_acceleration.values
    for found, expected in ((velocity[2:-2], np.hstack([rate(place), angular])), (acceleration[2:-2], rate(velocity))):
        np.testing.assert_allclose(found, expected, atol=1e-6 * np.abs(expected).max())
    assert run.relative_velocity.attrs["mixed_units"] == "output_unit/s"


def test_a_recording_gives_the_duration():
    hexapod, pose = machine()
    times = np.arange(0.0, 0.01, 1e-5)
    record = fx.excitation.time_series(times, 1e-9 * (1 - np.cos(100 * times)), "z")
    for duration in (None, 0.01, 0.009995):
        dataset = fx.simulate(hexapod, pose, base_motion=record, duration=duration, samples=3)
        assert dataset.time.values[-1] == pytest.approx(times[-1], rel=1e-15)
    two = fx.simulation.SimulationRun(hexapod, pose, base_motion=record, force=record.on({"z": "x"}).delayed(0.001))
    assert fx.simulate_many([two], samples=3).time.values[-1] == pytest.approx(times[-1], rel=1e-15)


def test_the_balance_may_begin_later():
    hexapod, pose = machine("cubic-isolator")
    drive = fx.harmonic("z", 1e-5, 40.0)
    late = fx.simulate(hexapod, pose, base_motion=drive, times=np.linspace(0.2, 0.3, 50))
    assert late.attrs["energy_error"] < 1e-6
    assert late.attrs["warnings"] == []


def test_a_balance_that_is_off_is_told():
    hexapod, pose = machine("mukherjee-ii")
    shaken = {"base_motion": fx.harmonic("z", 1e-6, 750.0), "samples": 400}
    with pytest.warns(UserWarning, match=r"the energy balance is off by 0\.\d+ of the largest"):
        fx.simulate(hexapod, pose, duration=5.0, rtol=1e-2, method="runge_kutta", **shaken)
    assert fx.simulate(hexapod, pose, duration=0.1, **shaken).attrs["warnings"] == []


def test_limits_of_many_runs_are_told_once():
    hexapod, pose = machine("motion-base")
    lift = [sum((fx.excitation.smooth_step(str(leg), size, 0.1) for leg in range(1, 7)), fx.Excitation())
            for size in (0.01, 0.7, 0.8)]  # fmt: skip
    runs = [fx.simulation.SimulationRun(hexapod, pose, leg_command=command) for command in lift]
    with pytest.warns(UserWarning, match="run 1, and 1 of 3 runs besides: limit exceeded: length of legs") as caught:
        fx.simulate_many(runs, 0.2, samples=40)
    assert len(caught) == 1


def test_coarse_recording_warns():
    hexapod, pose = machine()
    times = np.linspace(0, 0.1, 101)
    record = fx.excitation.time_series(times, 1e-6 * (1 - np.cos(100 * times)), "z")
    with pytest.warns(UserWarning, match=r"sampled every 0\.001 s and holds nothing above 3142 rad/s") as caught:
        dataset = fx.simulate(hexapod, pose, base_motion=record, duration=0.05)
    assert caught[0].filename == __file__
    assert len(dataset.attrs["warnings"]) == 1
    fine = np.linspace(0, 0.1, 1001)
    fx.simulate(
        hexapod, pose, base_motion=fx.excitation.time_series(fine, 1e-6 - np.cos(100 * fine) * 1e-6, "z"), duration=0.05
    )


@pytest.mark.filterwarnings("ignore:the recording")
def test_recordings_of_several_channels_are_told_of_once():
    """Of all six coarse ones one sentence, and one of those that begin in motion, with its speed."""
    hexapod, pose = machine()
    times = np.linspace(0, 0.1, 101)
    record = sum(
        (
            fx.excitation.time_series(
                times, 1e-6 * (np.sin(90 * times) if axis == "y" else 1 - np.cos(90 * times)), axis
            )
            for axis in fx.conventions.AXES
        ),
        fx.Excitation(),
    )
    first, second = fx.simulate(hexapod, pose, base_motion=record, duration=0.01, samples=3).attrs["warnings"]
    assert first.startswith(
        "the recordings of base_motion x, y, z, roll, pitch, yaw are sampled every 0.001 s and hold "
    )
    assert second.startswith("the recording of base_motion begins in motion, y with 9e-05 m/s, up to 100% of")
    carried = fx.simulate(hexapod, pose, base_motion=record, duration=0.01, samples=3, start="carried")
    assert list(carried.attrs["warnings"]) == [first]


def test_a_quiet_recording_is_not_stepped_over():
    """A pulse of 2 ms after 5 s of nothing moves a machine whose periods are a hundred times as long."""
    hexapod, pose = machine("cubic-isolator")
    times = np.arange(0, 6.0, 1e-3)
    pulse = 2e-4 * np.exp(-(((times - 5.5) / 1e-3) ** 2))
    dataset = fx.simulate(
        hexapod, pose, base_motion=fx.excitation.time_series(times, pulse, "z"), duration=5.9, samples=5901
    )
    seen = dataset.relative_displacement.sel(output="z").values
    assert np.abs(seen).max() == pytest.approx(2e-4, rel=0.05)  # the base moves, the platform hardly


@pytest.mark.parametrize(
    ("arguments", "kind", "words"),
    [
        ({"duration": 0.0}, ArgumentError, "duration is 0"),
        ({}, ArgumentError, "duration is missing"),
        ({"duration": 5e-324, "samples": 50}, ArgumentError, "instants are the same"),
        ({"duration": 1.0, "samples": 10**12}, ArgumentError, "samples is 1000000000000; at most 10000000"),
        ({"duration": 1.0, "threads": 0.5}, ArgumentError, "threads is 0.5"),
        ({"duration": 10**400}, ArgumentError, "an integer of 1329 bits"),
        ({"times": "now"}, ArgumentError, "times is 'now'"),
        ({"duration": 1.0, "atol": "fine"}, ArgumentError, "atol is 'fine'"),
        ({"duration": 1.0, "times": [0, 1]}, ArgumentError, "must not be"),
        ({"times": [0.0, 1.0, 0.5]}, ArgumentError, "ascending"),
        ({"times": [-1.0, 1.0]}, ArgumentError, ">= 0"),
        ({"duration": 1.0, "samples": 1}, ArgumentError, "samples is 1"),
        ({"duration": 1.0, "rtol": 0.5}, ArgumentError, "rtol is 0.5"),
        ({"duration": 1.0, "atol": -1.0}, ArgumentError, "atol is -1"),
        ({"duration": 1.0, "threads": 0}, ArgumentError, "threads is 0"),
        (
            {"duration": 1.0, "tolerance": 1e-9},
            TypeError,
            r"simulate\(\) got an unexpected keyword argument 'tolerance'",
        ),
        ({"duration": 1.0, "base": fx.harmonic("z", 1.0, 1.0)}, ArgumentError, "Did you mean base_motion"),
        ({"duration": 1.0, "base_motion": [0, 0, 1]}, ArgumentError, "base_motion is .* must be an Excitation"),
        ({"duration": 1.0, "start": "moving"}, ArgumentError, "start is 'moving'"),
        ({"duration": 1.0, "joint": "ball"}, fx.ArgumentError, "joint is 'ball'"),
        ({"duration": 1.0, "force": [1.0, 2.0]}, ArgumentError, "force has shape"),
        ({"duration": 1.0, "force": fx.harmonic("roll", 1.0, 1.0)}, ArgumentError, "force drives 'roll'"),
        ({"duration": 1.0, "moment": fx.harmonic("1", 1.0, 1.0)}, ArgumentError, "moment drives '1'"),
        ({"duration": 1.0, "base_motion": fx.harmonic("1", 1.0, 1.0)}, ArgumentError, "base_motion drives '1'"),
        ({"duration": 1.0, "leg_command": fx.harmonic("x", 1.0, 1.0)}, ArgumentError, "leg_command drives 'x'"),
        ({"duration": 1.0, "unstretched_length": np.ones(5)}, ArgumentError, "unstretched_length has shape"),
        ({"duration": 1.0, "start": fx.Pose(np.zeros((2, 3)))}, PoseError, "start has batch axes"),
        (
            {"duration": 1.0, "base_motion": fx.excitation.time_series(np.arange(9) * 1e-5, np.zeros(9), "z")},
            ArgumentError,
            "ends at 8e-05 s, the simulation at 1 s",
        ),
    ],
)
def test_bad_arguments(arguments, kind, words):
    hexapod, pose = machine()
    with pytest.raises(kind, match=words):
        fx.simulate(hexapod, pose, **arguments)


def test_bad_poses():
    hexapod, _ = machine()
    with pytest.raises(PoseError, match="batch axes"):
        fx.simulate(hexapod, fx.Pose([[0, 0, 0.085]] * 2), duration=1.0)
    with pytest.raises(SingularPoseError):
        fx.simulate(hexapod, fx.Pose((0.0, 0.0, 0.0)), duration=1.0)
    with pytest.raises(ArgumentError, match="nothing to simulate"):
        fx.simulate_many([], 1.0)


def test_without_energies_the_motion_is_the_same():
    """The balance is integrated beside the motion and does not touch it."""
    hexapod = fx.load("mukherjee-ii")
    drive = {"base_motion": fx.harmonic("z", 1e-6, 700.0), "duration": 0.01}
    with_balance = fx.simulate(hexapod, fx.home_pose(hexapod), **drive)
    without = fx.simulate(hexapod, fx.home_pose(hexapod), energies=False, **drive)
    assert "energy_error" not in without
    assert "energy_error" not in without.attrs
    # steps are chosen without the work integrals, so the two agree to the tolerance of the integrator (1e-9)
    np.testing.assert_allclose(without.displacement, with_balance.displacement, atol=1e-8 * 1e-6 * 100)
