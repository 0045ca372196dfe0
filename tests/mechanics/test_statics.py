"""Rest: holding forces, equilibrium, and what gravity does to a soft machine."""

import numpy as np
import pytest
from hypothesis import given, settings
from scipy.optimize import root
from tests.helpers.drawn import machines, seeds
from tests.helpers.plain import plain_machine
from tests.helpers.support import EPS, JOINTS, MACHINES, away, center, displaced, size

import flexapod as fx

TILTED = displaced(fx.Pose([0.3, -0.2, 0.5]), [0, 0, 0, 0.2, -0.3, 0.8])


def on(base: fx.Pose, pose: fx.Pose) -> fx.Pose:
    """A pose given in the base's frame, in the outer one."""
    return fx.Pose(base.position + base.matrix @ pose.position, base.matrix @ pose.matrix)


def load_of(hexapod) -> dict:
    """A wrench of about half the platform's weight."""
    force = 5 * hexapod.platform_mass * np.array([0.3, -0.5, 0.8])
    return {"force": force, "moment": 0.1 * size(hexapod) * force[[2, 0, 1]]}


@pytest.mark.parametrize("base", [None, TILTED], ids=["level", "tilted"])
@pytest.mark.parametrize("name", MACHINES)
def test_hold_then_settle_comes_back(name, base):
    """The unstretched lengths that hold a pose under a load bring the platform there from some way off."""
    hexapod = plain_machine(name)
    pose = away(hexapod) if base is None else on(base, away(hexapod))
    held = fx.hold(hexapod, pose, base=base, **load_of(hexapod))
    start = displaced(pose, 0.03 * np.array([*size(hexapod) * np.array([1, -1, 0.5]), 1, 0.5, -1]))
    found = fx.static_equilibrium(hexapod, held.unstretched_length, start=start, base=base, **load_of(hexapod))
    K = fx.linearise(hexapod, pose, base=base, **load_of(hexapod)).K
    # Lengths of the machine's size err by eps: what that moves the platform is grown by the condition of the tangent.
    tolerance = 1e3 * EPS * np.linalg.cond(_scaled(K, size(hexapod)))
    assert np.linalg.norm(found.pose.position - pose.position) < tolerance * size(hexapod)
    assert np.linalg.norm(found.pose.matrix - pose.matrix) < tolerance
    np.testing.assert_allclose(found.leg_length, held.leg_length, rtol=tolerance)
    np.testing.assert_array_equal(found.unstretched_length, held.unstretched_length)


def _scaled(K, length):
    """K with rotations measured by the way they move a point at this distance."""
    scale = np.repeat([1.0, 1 / length], 3)
    return K * np.outer(scale, scale)


@pytest.mark.parametrize("name", MACHINES)
def test_settling_without_a_start(name):
    """The start is then the pose with these unstretched lengths, on the base wherever it is."""
    hexapod = plain_machine(name)
    held = fx.hold(hexapod, on(TILTED, away(hexapod, 0.02)), base=TILTED)
    found = fx.static_equilibrium(hexapod, held.unstretched_length, base=TILTED)
    np.testing.assert_allclose(found.pose.position, held.pose.position, atol=1e-9 * size(hexapod))
    np.testing.assert_allclose(found.pose.matrix, held.pose.matrix, atol=1e-9)


@settings(max_examples=15)
@given(hexapod=machines(), seed=seeds)
def test_equilibrium_is_rest(hexapod, seed):
    """At the pose found, forward dynamics with the springs' forces gives no acceleration."""
    rng = np.random.default_rng(seed)
    lengths = fx.inverse_kinematics(hexapod, center(hexapod)) * (1 + 0.01 * rng.normal(size=6))
    found = fx.static_equilibrium(hexapod, lengths, **load_of(hexapod))
    np.testing.assert_allclose(found.leg_force, hexapod.legs.stiffness * (lengths - found.leg_length), rtol=1e-12)
    linear, angular = fx.forward_dynamics(hexapod, found.pose, leg_force=found.leg_force, **load_of(hexapod))
    # Lengths round at eps of the size, and springs of some 1e5 m / s2 times mass over size turn that into 1e-11; the
    # condition of J_p takes the rest.
    assert np.linalg.norm(linear) < 1e-8
    assert np.linalg.norm(angular) < 1e-8 / size(hexapod)


@pytest.mark.parametrize("joint", JOINTS)
@given(hexapod=machines())
def test_hold_is_inverse_dynamics_at_rest(joint, hexapod):
    pose = center(hexapod)
    held = fx.hold(hexapod, pose, joint=joint)
    linear, angular = fx.forward_dynamics(hexapod, pose, leg_force=held.leg_force, joint=joint)
    # Ten m/s2 of gravity, rounded and grown by the condition of J_p.
    assert np.linalg.norm(linear) < 1e-11
    assert np.linalg.norm(angular) < 1e-11 / size(hexapod)
    np.testing.assert_array_equal(held.unstretched_length, held.leg_length + held.leg_force / hexapod.legs.stiffness)


def test_a_vertical_load_on_a_symmetric_machine_is_shared():
    """Six equal legs at equal slopes: F = m g / (6 sin slope), compression positive."""
    hexapod = plain_machine("motion-base").replace({"legs.lower": None, "legs.upper": None})
    held = fx.hold(hexapod, center(hexapod))
    slope = fx.force_transformation(hexapod, center(hexapod))[2]
    np.testing.assert_allclose(held.leg_force, 4000 * 9.81 / 6 / slope, rtol=1e-12)
    assert (held.unstretched_length > held.leg_length).all()  # compressed: E6's sign


def test_hold_of_many_poses_gives_nan_where_no_forces_do():
    hexapod = plain_machine("motion-base")
    turned = fx.Pose.from_rpy(0, 0, 2.39, 0, 0, np.radians([0, 90, 10]))
    held = fx.hold(hexapod, turned)
    assert np.isnan(held.leg_force[1]).all()
    assert np.isnan(held.unstretched_length[1]).all()
    for i in (0, 2):
        np.testing.assert_array_equal(held.leg_force[i], fx.hold(hexapod, turned[i]).leg_force)


def test_newton_converges_where_scipy_does(measured):
    """A soft machine that moves a tenth of its size under load, against SciPy's root of the accelerations."""
    hexapod = plain_machine("cubic-isolator")
    lengths = np.full(6, 0.132)
    load = {"force": [15.0, 5.0, -20.0], "moment": [0.5, -0.3, 0.4]}
    found = fx.static_equilibrium(hexapod, lengths, start=center(hexapod), **load)
    assert np.abs(found.leg_length - lengths).max() > 0.005  # not a small displacement

    def acceleration(x):
        pose = displaced(center(hexapod), x)
        pull = hexapod.legs.stiffness * (lengths - fx.inverse_kinematics(hexapod, pose))
        return np.concatenate(fx.forward_dynamics(hexapod, pose, leg_force=pull, **load))

    oracle = displaced(center(hexapod), root(acceleration, np.zeros(6), tol=1e-13).x)
    measured("rest/newton", found.pose.position - oracle.position, 1e-11)  # SciPy's tolerance, 0.1 m
    np.testing.assert_allclose(found.pose.matrix, oracle.matrix, rtol=0, atol=1e-10)


def test_a_load_that_no_leg_can_carry_is_refused_with_the_pose_and_a_remedy():
    hexapod = plain_machine("cubic-isolator")
    with pytest.raises((fx.KinematicsError, fx.SingularPoseError), match=r"Pose\(x=.*(reduce the load|stiffen)"):
        fx.static_equilibrium(hexapod, np.full(6, 0.13), start=center(hexapod), force=[0, 0, -5000.0])


def test_equilibrium_in_the_papers_joint_model_is_its_own():
    """`hold` and `static_equilibrium` undo each other in either joint model, and the two models differ."""
    hexapod = fx.load("mukherjee-i").replace({"legs.stiffness": 2e5})
    pose = fx.home_pose(hexapod)
    for joint in ("universal", "spin_free"):
        held = fx.hold(hexapod, pose, joint=joint)
        settled = fx.static_equilibrium(hexapod, held.unstretched_length, start=pose, joint=joint)
        # Newton ends within a relative step of 1e-10 and converges quadratically
        np.testing.assert_allclose(settled.pose.position, pose.position, atol=1e-10)
    other = fx.static_equilibrium(hexapod, held.unstretched_length, start=pose, joint="universal")
    assert np.linalg.norm(other.pose.position - pose.position) > 1e-6
