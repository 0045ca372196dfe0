"""Motions told of a point of the platform: against Pinocchio, 50 digits, and a machine whose frame has its origin there."""

import mpmath
import numpy as np
import pinocchio as pin
import pytest
import xarray as xr
from scipy.spatial.transform import Rotation
from tests.helpers.support import away, displaced
from tests.helpers.twins import moved, moved_origin

import flexapod as fx
from flexapod.mechanics.point_motion import at_point, displacement_at

POINT = np.array([0.03, -0.02, 0.11])
BASE = fx.Pose.from_rpy(0.4, -0.2, 0.1, 0.3, -0.2, 0.5)


def machine(name="cubic-isolator", **changes):
    return fx.load(name).replace({"points.tip": POINT.tolist(), "legs.damping.prismatic": 60.0, **changes})


def test_a_free_body_in_pinocchio_has_the_same_motion_at_a_point():
    rng = np.random.default_rng(7)
    model = pin.Model()
    body = model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), "platform")
    frame = model.addFrame(pin.Frame("tip", body, pin.SE3(np.eye(3), POINT), pin.FrameType.OP_FRAME))
    data = model.createData()
    turn = Rotation.random(rng=rng)
    where, v, w, a, alpha = (rng.normal(size=3) for _ in range(5))
    R = turn.as_matrix()
    motion = fx.Motion(fx.Pose(where, R), v, w, a, alpha)
    q = np.concatenate([where, turn.as_quat()])
    body_v = np.concatenate([R.T @ v, R.T @ w])
    body_a = np.concatenate([R.T @ (a - np.cross(w, v)), R.T @ alpha])  # Pinocchio's spatial acceleration
    pin.forwardKinematics(model, data, q, body_v, body_a)
    pin.updateFramePlacements(model, data)
    world = pin.LOCAL_WORLD_ALIGNED
    found = at_point(motion, POINT)
    np.testing.assert_allclose(found.pose.position, data.oMf[frame].translation, rtol=1e-14)
    velocity = pin.getFrameVelocity(model, data, frame, world)
    acceleration = pin.getFrameClassicalAcceleration(model, data, frame, world)
    np.testing.assert_allclose(np.r_[found.velocity, found.angular_velocity], velocity.vector, rtol=1e-13)
    np.testing.assert_allclose(
        np.r_[found.acceleration, found.angular_acceleration], acceleration.vector, rtol=1e-12, atol=1e-13
    )


@pytest.mark.parametrize("size", [1e-12, 1e-6, 0.3, 3.0])
def test_displacements_of_a_point_keep_their_digits(size):
    rng = np.random.default_rng(8)
    turn = size * rng.normal(size=3)
    given = np.concatenate([size * rng.normal(size=3), turn])
    with mpmath.workdps(50):
        K = mpmath.matrix([[0, -turn[2], turn[1]], [turn[2], 0, -turn[0]], [-turn[1], turn[0], 0]])
        R = mpmath.expm(K, method="taylor")
        exact = mpmath.matrix(given[:3]) + R * mpmath.matrix(POINT) - mpmath.matrix(POINT)
        expected = np.array([float(x) for x in exact])
    np.testing.assert_allclose(displacement_at(given, POINT)[:3], expected, rtol=1e-13, atol=1e-15 * size)
    np.testing.assert_array_equal(displacement_at(given, POINT)[3:], turn)


def same(found: xr.Dataset, twin: xr.Dataset, names, rtol=1e-9):
    """Variables of the machine told of its point are those of the machine whose origin is the point."""
    for name in names:
        scale = float(np.abs(twin[name]).max())
        np.testing.assert_allclose(found[name], twin[name], rtol=0, atol=rtol * scale, err_msg=name)


MOTION = ("displacement", "relative_displacement", "relative_velocity", "relative_acceleration")
MOTION += ("position", "velocity", "acceleration", "rotation", "angular_acceleration", "leg_force")


def test_simulations_are_those_of_a_machine_whose_origin_is_the_point():
    own = machine()
    pose = fx.Pose(BASE.position + BASE.matrix @ own.home.position, BASE.matrix @ away(own, 0.02).matrix)
    drive = fx.harmonic("roll", 0.02, 9.0) + fx.harmonic("y", 2e-3, 14.0) + fx.harmonic("yaw", 0.03, 5.0)
    given = {"base_motion": drive, "base": BASE, "duration": 0.4, "samples": 60, "rtol": 1e-12}
    told = fx.simulate(own, pose, point="tip", **given)
    twin = fx.simulate(moved_origin(own, POINT), moved(pose, POINT), **given)
    same(told, twin, MOTION, 1e-8)
    assert (told.attrs["point"], told.attrs["point_m"]) == ("tip", POINT.tolist())
    placed = fx.simulate(own, pose, point=POINT, **given)
    same(placed, told, MOTION, 1e-15)
    assert placed.attrs["point"] == ""


def test_limits_and_pictures_of_a_simulation_do_not_depend_on_the_point(tmp_path):
    length = float(fx.inverse_kinematics(machine()).max())
    own = machine(**{"limits.leg_length": [0.5 * length, 1.001 * length]})
    given = {"base_motion": fx.harmonic("z", 0.005, 20.0), "duration": 0.3, "samples": 50}
    with pytest.warns(UserWarning, match="limit exceeded"):
        plain = fx.simulate(own, **given)
    with pytest.warns(UserWarning, match="limit exceeded"):
        told = fx.simulate(own, point=[0, 0, 3.0], **given)
    assert told.attrs["warnings"] == plain.attrs["warnings"]
    from flexapod.plots.animation import _simulated

    films = [_simulated(one, own, fx.Pose([0, 0, 0]))[0] for one in (plain, told)]
    np.testing.assert_allclose(films[1].platform, films[0].platform, atol=1e-14)
    np.testing.assert_allclose(films[1].pose.position, films[0].pose.position, atol=1e-14)


def test_many_runs_share_a_point():
    own = machine()
    runs = [fx.simulation.SimulationRun(own, base_motion=fx.harmonic("x", 1e-3, w)) for w in (10.0, 20.0)]
    many = fx.simulate_many(runs, 0.1, samples=20, point="tip")
    one = fx.simulate(own, base_motion=fx.harmonic("x", 1e-3, 20.0), duration=0.1, samples=20, point="tip")
    same(many.isel(run=1), one, MOTION, 1e-14)
    other = own.replace({"points.tip[2]": 0.3})
    runs.append(fx.simulation.SimulationRun(other))
    with pytest.raises(fx.ArgumentError, match="point 'tip' is at different places in the designs"):
        fx.simulate_many(runs, 0.1, point="tip")


@pytest.mark.parametrize("joint", ["universal", "spin_free"])
def test_linear_responses_are_those_of_a_machine_whose_origin_is_the_point(joint):
    own = machine(**{"legs.loss_factor": 0.03})
    pose = away(own, 0.03)
    twin, there = moved_origin(own, POINT), moved(pose, POINT)
    given = {"omega": np.geomspace(3.0, 400.0, 40), "joint": joint}
    told = fx.transmissibility(own, pose, point="tip", **given)
    same(told, fx.transmissibility(twin, there, **given), ("absolute", "relative", "compliance", "command"))
    given = {"psd": fx.vc_curve("VC-C"), "axis": "x", "joint": joint}
    told = fx.random_response(own, pose, point="tip", **given)
    same(told, fx.random_response(twin, there, **given), ("rms_displacement", "rms_acceleration", "rms_relative"))
    law = fx.control.VelocityFeedback(300.0)
    given = {"controller": law, "omega": np.geomspace(3.0, 400.0, 40), "joint": joint}
    told = fx.control.controlled_transmissibility(own, pose, point="tip", **given)
    same(told, fx.control.controlled_transmissibility(twin, there, **given), ("controlled", "passive", "leg_force"))
    modes, expected = fx.natural_modes(own, pose, point="tip", joint=joint), fx.natural_modes(twin, there, joint=joint)
    sign = np.sign((modes.shape * expected.shape).sum(axis=0))
    np.testing.assert_allclose(modes.omega, expected.omega, rtol=1e-11)
    np.testing.assert_allclose(modes.shape * sign, expected.shape, atol=1e-8 * np.abs(expected.shape).max())


def test_a_stepped_sine_is_that_of_a_machine_whose_origin_is_the_point():
    own = machine()
    pose = away(own, 0.02)
    given = {"axis": "roll", "amplitude": 5e-3, "omega": [20.0, 60.0]}
    told = fx.stepped_sine(own, pose, point="tip", **given)
    twin = fx.stepped_sine(moved_origin(own, POINT), moved(pose, POINT), **given)
    assert (told.status.values == "found").all()
    same(told, twin, ("ratio", "response", "linear", "peak", "harmonics"), 1e-6)


def test_controlled_runs_are_those_of_a_machine_whose_origin_is_the_point():
    own = machine()
    turned = fx.Pose(BASE.position + BASE.matrix @ own.home.position, BASE.matrix @ own.home.matrix)
    drive = fx.harmonic("roll", 0.02, 9.0) + fx.harmonic("y", 2e-3, 14.0) + fx.harmonic("yaw", 0.05, 11.0)
    runs = {}
    for name, (hexapod, pose, point) in {
        "told": (own, turned, "tip"),
        "twin": (moved_origin(own, POINT), moved(turned, POINT), (0, 0, 0)),
    }.items():
        law = fx.control.VelocityFeedback(300.0).on(fx.linearise(hexapod, pose, base=BASE)).sampled(2e-3)
        runs[name] = fx.control.simulate_control(
            hexapod, pose, controller=law, base_motion=drive, duration=0.6, base=BASE, point=point
        )
    names = ("acceleration", "displacement", "relative", "rms_acceleration", "rms_displacement")
    same(runs["told"], runs["twin"], (*names, "predicted_rms_acceleration", "predicted_rms_displacement"), 1e-7)
    assert runs["told"].attrs["point"] == "tip"


def test_load_cases_at_a_named_point():
    own = fx.load("motion-base").replace({"points.tip": POINT.tolist()})
    given = {"gravity": fx.mechanics.gravity_at(np.radians([90, 40])), "force": [0, 0, -2000.0]}
    named = fx.load_cases(own, point="tip", at="tip", **given)
    placed = fx.load_cases(own, point=POINT, at=POINT, **given)
    same(named, placed, ("deflection", "leg_force", "compliance"), 1e-15)
    assert named.attrs["point"] == "tip"
    with pytest.raises(fx.ArgumentError, match="at is 'tap', which is no point"):
        fx.load_cases(own, at="tap")


def test_small_and_large_motions_agree_where_both_hold():
    own = machine()
    moved_by = displaced(own.home, np.array([0, 0, 0, 1e-6, -2e-6, 3e-6]))
    turn = Rotation.from_matrix(moved_by.matrix @ own.home.matrix.T).as_rotvec()
    from flexapod.mechanics.point_motion import shift

    linear = shift(own.home, POINT) @ np.r_[np.zeros(3), turn]
    exact = displacement_at(np.r_[np.zeros(3), turn], own.home.matrix @ POINT)
    np.testing.assert_allclose(linear, exact, atol=1e-11 * np.abs(POINT).max())
