"""Geometry against SciPy's rotations and minimisers, and forward against inverse kinematics."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation
from tests.helpers.drawn import machines, seeds, situations
from tests.helpers.plain import plain_machine
from tests.helpers.support import EPS, MACHINES, apart, away, center, displaced, relative, size

import flexapod as fx
from flexapod.mechanics.limited import together

# --- poses ------------------------------------------------------------------------------------------------------------

angles = st.floats(-3.1, 3.1)


@given(rpy=st.tuples(angles, st.floats(-1.5, 1.5), angles))
def test_roll_pitch_yaw_are_scipys_fixed_axes(rpy):
    pose = fx.Pose.from_rpy(1, 2, 3, *rpy)
    np.testing.assert_array_equal(pose.position, [1, 2, 3])
    np.testing.assert_allclose(pose.matrix, Rotation.from_euler("xyz", rpy).as_matrix(), atol=4 * EPS)
    # Near pitch = pi/2 roll and yaw are ill-determined: the cosine there is 0.07.
    np.testing.assert_allclose(pose.rpy, rpy, atol=4 * EPS / np.cos(rpy[1]) ** 2)


@pytest.mark.parametrize("pitch", [np.pi / 2, -np.pi / 2])
def test_roll_pitch_yaw_at_gimbal_lock(pitch):
    matrix = Rotation.from_euler("xyz", [0.4, pitch, -0.9]).as_matrix()
    rpy = fx.Pose([0, 0, 0], matrix).rpy
    assert rpy[2] == 0
    assert rpy[1] == pytest.approx(pitch, abs=1e-12)
    np.testing.assert_allclose(fx.Pose.from_rpy(0, 0, 0, *rpy).matrix, matrix, atol=1e-12)


def test_identity_has_no_negative_zeros():
    assert "-0" not in repr(fx.Pose([0, 0, 1]))


def test_pose_takes_scipy_rotations_one_or_many():
    one, many = Rotation.from_rotvec([0.1, 0.2, 0.3]), Rotation.from_rotvec(np.arange(12).reshape(4, 3) / 10)
    np.testing.assert_array_equal(fx.Pose([0, 0, 1], one).matrix, one.as_matrix())
    poses = fx.Pose([0, 0, 1], many)
    assert poses.shape == (4,)
    np.testing.assert_allclose(poses.matrix, many.as_matrix(), rtol=0, atol=2 * EPS)
    np.testing.assert_array_equal(poses.position, [[0, 0, 1]] * 4)
    np.testing.assert_allclose(poses.rotation.as_matrix(), many.as_matrix(), atol=4 * EPS)


def test_poses_broadcast_and_index():
    poses = fx.Pose.from_rpy(np.zeros((3, 1)), 0, np.linspace(1, 2, 4), yaw=[[0.1], [0.2], [0.3]])
    assert poses.shape == (3, 4)
    assert poses[1].shape == (4,)
    np.testing.assert_allclose(poses[1, 2].rpy, [0, 0, 0.2], atol=EPS)
    np.testing.assert_allclose(poses[1, 2].position, [0, 0, 1 + 2 / 3])
    motion = fx.Motion(poses, velocity=np.zeros((3, 1, 3)), angular_velocity=[0, 0, 1])
    assert motion.shape == (3, 4)
    assert motion.packed.shape == (3, 4, 24)


def test_a_pose_does_not_change_with_the_arrays_it_was_made_from():
    position, matrix, velocity = np.zeros(3), np.eye(3), np.zeros(3)
    pose = fx.Pose(position, matrix)
    motion = fx.Motion(pose, velocity)
    position[:], matrix[:], velocity[:] = 7, 7, 7
    np.testing.assert_array_equal(pose.position, np.zeros(3))
    np.testing.assert_array_equal(pose.matrix, np.eye(3))
    np.testing.assert_array_equal(motion.velocity, np.zeros(3))
    with pytest.raises(ValueError, match="read-only"):
        pose.position[0] = 1.0


def test_motion_defaults_to_rest_and_the_fixed_base_to_the_origin():
    motion = fx.Motion.fixed()
    np.testing.assert_array_equal(motion.packed, [0] * 3 + [1, 0, 0, 0, 1, 0, 0, 0, 1] + [0] * 12)
    np.testing.assert_array_equal(fx.Motion(fx.Pose([1, 2, 3])).packed[12:], np.zeros(12))


# --- inverse kinematics -----------------------------------------------------------------------------------------------


@given(case=situations())
def test_lengths_are_distances_between_joints(case, measured):
    platform, base = case.platform.pose, case.base.pose
    upper = Rotation.from_matrix(platform.matrix).apply(np.array(case.hexapod.platform_joints)) + platform.position
    lower = Rotation.from_matrix(base.matrix).apply(np.array(case.hexapod.base_joints)) + base.position
    expected = np.linalg.norm(upper - lower, axis=1)
    measured("geometry/lengths", apart(fx.inverse_kinematics(case.hexapod, platform, base=base), expected), 1e-13)


@pytest.mark.parametrize("name", MACHINES)
def test_condition_number_with_a_characteristic_length(name):
    hexapod = plain_machine(name)
    pose = away(hexapod)
    H = fx.force_transformation(hexapod, pose)
    assert fx.condition_number(hexapod, pose) == pytest.approx(np.linalg.cond(H), rel=1e-12)
    lever = 0.37 * size(hexapod)
    scaled = H / np.repeat([1.0, lever], 3)[:, None]
    assert fx.condition_number(hexapod, pose, characteristic_length=lever) == pytest.approx(
        np.linalg.cond(scaled), rel=1e-12
    )


@given(hexapod=machines())
def test_condition_number_with_a_characteristic_length_has_no_unit(hexapod):
    """A machine a thousand times larger, measured by its own size, is conditioned the same."""
    values, pose = hexapod.values(), center(hexapod)
    larger = fx.Hexapod.from_values(values | {k: 1000 * values[k] for k in ("base.joints", "platform.joints")})
    poses = pose, fx.Pose(1000 * pose.position)
    small = fx.condition_number(hexapod, poses[0], characteristic_length=size(hexapod))
    large = fx.condition_number(larger, poses[1], characteristic_length=1000 * size(hexapod))
    assert large == pytest.approx(small, rel=1e-9)  # eps times the condition number, below 1e6 here


# --- forward kinematics -----------------------------------------------------------------------------------------------


def nearby(hexapod, rng, linear, angular):
    x = np.concatenate([linear * size(hexapod) * rng.uniform(-1, 1, 3), angular * rng.uniform(-1, 1, 3)])
    return displaced(center(hexapod), x)


def assert_same_pose(hexapod, found, pose):
    # Lengths are met to 1e-11 of the longest; H's condition stands between them and the pose.
    H = fx.force_transformation(hexapod, pose)
    H[3:] /= size(hexapod)
    tolerance = 1e-11 * np.linalg.cond(H) * 10
    assert np.linalg.norm(found.position - pose.position) < tolerance * size(hexapod)
    assert np.linalg.norm(found.matrix - pose.matrix) < tolerance


@pytest.mark.parametrize("name", MACHINES)
def test_forward_kinematics_from_a_start(name):
    """Many poses of every packaged machine, from starts some way off."""
    hexapod, rng = plain_machine(name), np.random.default_rng(6)
    for _ in range(40):
        pose = nearby(hexapod, rng, 0.08, 0.15)
        start = displaced(pose, np.concatenate([0.03 * size(hexapod) * rng.normal(size=3), 0.05 * rng.normal(size=3)]))
        found = fx.forward_kinematics(hexapod, fx.inverse_kinematics(hexapod, pose), start=start)
        assert_same_pose(hexapod, found, pose)


@pytest.mark.parametrize("name", MACHINES)
def test_forward_kinematics_without_a_start(name, measured):
    """The assembly found has the lengths; near home it is the one near home."""
    hexapod, rng = plain_machine(name), np.random.default_rng(7)
    for _ in range(40):
        pose = nearby(hexapod, rng, 0.1, 0.3)
        lengths = fx.inverse_kinematics(hexapod, pose)
        found = fx.forward_kinematics(hexapod, lengths)
        measured("geometry/forward", apart(fx.inverse_kinematics(hexapod, found), lengths), 2e-11)  # its promise
    pose = nearby(hexapod, rng, 0.01, 0.02)
    assert_same_pose(hexapod, fx.forward_kinematics(hexapod, fx.inverse_kinematics(hexapod, pose)), pose)


@pytest.mark.parametrize("name", ["motion-base", "precision-positioner", "mukherjee-i"])
def test_forward_kinematics_without_a_home(name):
    hexapod = plain_machine(name)
    lengths = fx.inverse_kinematics(hexapod, away(hexapod))
    found = fx.forward_kinematics(hexapod.replace({"home": None}), lengths)
    np.testing.assert_allclose(fx.inverse_kinematics(hexapod, found), lengths, rtol=2e-11)


@given(hexapod=machines(), seed=seeds)
def test_forward_kinematics_of_drawn_machines(hexapod, seed):
    pose = nearby(hexapod, np.random.default_rng(seed), 0.1, 0.3)
    lengths = fx.inverse_kinematics(hexapod, pose)
    found = fx.forward_kinematics(hexapod, lengths)
    np.testing.assert_allclose(fx.inverse_kinematics(hexapod, found), lengths, rtol=2e-11)
    np.testing.assert_allclose(found.matrix @ found.matrix.T, np.eye(3), atol=20 * EPS)


def test_forward_kinematics_of_many_with_one_start_or_one_each():
    hexapod, rng = plain_machine("motion-base"), np.random.default_rng(8)
    poses = fx.Pose(center(hexapod).position + rng.uniform(-0.2, 0.2, (2, 3, 3)))
    lengths = fx.inverse_kinematics(hexapod, poses)
    for start in (None, center(hexapod), poses):
        found = fx.forward_kinematics(hexapod, lengths, start=start)
        assert found.shape == (2, 3)
        np.testing.assert_allclose(found.position, poses.position, atol=1e-9)


def test_forward_kinematics_starts_each_from_its_own():
    """Two assemblies of the same lengths, above and below the base: each start leads to its own."""
    hexapod = plain_machine("motion-base")
    above = center(hexapod)
    below = fx.Pose(above.position * [1, 1, -1])
    lengths = fx.inverse_kinematics(hexapod, above)
    np.testing.assert_allclose(fx.inverse_kinematics(hexapod, below), lengths, rtol=1e-15)
    starts = fx.Pose(np.array([above.position, below.position]) + 0.05)
    found = fx.forward_kinematics(hexapod, [lengths, lengths], start=starts)
    np.testing.assert_allclose(found.position, [above.position, below.position], atol=1e-9)


# --- joint angles and distances ---------------------------------------------------------------------------------------


@given(case=situations())
def test_joint_angles_rebuild_the_leg(case):
    """Turning by the first angle about k, then by the second about the cross's own axis, takes neutral to the leg."""
    hexapod, platform, base = case.hexapod, case.platform.pose, case.base.pose
    found = fx.joint_angles(hexapod, platform, base=base)
    neutral = center(hexapod).position + hexapod.platform_joints - hexapod.base_joints
    neutral /= np.linalg.norm(neutral, axis=1, keepdims=True)
    upper = platform.position + hexapod.platform_joints @ platform.matrix.T
    leg = (upper - base.position) @ base.matrix - hexapod.base_joints  # in base axes
    leg /= np.linalg.norm(leg, axis=1, keepdims=True)
    for i in range(6):
        k = hexapod.universal_axes[i]
        across = np.cross(k, neutral[i])
        across /= np.linalg.norm(across)
        first = Rotation.from_rotvec(found.universal_first[i] * k)
        second = Rotation.from_rotvec(-found.universal_second[i] * across)  # positive lifts the leg towards k
        # An arc tangent of components of order one: some eps, grown where the leg is steep to its axis.
        np.testing.assert_allclose(first.apply(second.apply(neutral[i])), leg[i], atol=1e-12)
        assert found.universal[i] == pytest.approx(np.arccos(np.clip(neutral[i] @ leg[i], -1, 1)), abs=3e-8)
        turned = platform.matrix.T @ base.matrix @ leg[i]
        assert found.spherical[i] == pytest.approx(np.arccos(np.clip(neutral[i] @ turned, -1, 1)), abs=3e-8)


def test_joint_angles_are_zero_at_home_and_frame_z_is_neutral_without_one():
    hexapod = plain_machine("motion-base")
    for angle in fx.joint_angles(hexapod, center(hexapod)):
        np.testing.assert_allclose(angle, 0, atol=1e-15)
    homeless = fx.joint_angles(hexapod.replace({"home": None}), center(hexapod))
    s = fx.force_transformation(hexapod, center(hexapod))[:3]
    np.testing.assert_allclose(homeless.universal, np.arccos(s[2]), rtol=1e-12)
    np.testing.assert_allclose(homeless.spherical, np.arccos(s[2]), rtol=1e-12)


def segments_apart(p, a, q, b) -> float:
    """Distance of two segments by SciPy: a convex problem on the unit square."""
    result = minimize(
        lambda x: np.sum((p + x[0] * a - q - x[1] * b) ** 2),
        [0.5, 0.5],
        jac=lambda x: 2 * (p + x[0] * a - q - x[1] * b) @ np.column_stack([a, -b]),
        bounds=[(0, 1), (0, 1)],
        tol=1e-15,
    )
    return float(np.sqrt(result.fun))


@settings(max_examples=8)  # SciPy's minimiser is slow
@given(case=situations())
def test_leg_distance_is_the_least_of_all_pairs(case):
    hexapod, platform, base = case.hexapod, case.platform.pose, case.base.pose
    lower = hexapod.base_joints @ base.matrix.T + base.position
    legs = hexapod.platform_joints @ platform.matrix.T + platform.position - lower
    pairs = [segments_apart(lower[i], legs[i], lower[j], legs[j]) for i in range(5) for j in range(i + 1, 6)]
    # SciPy finds the minimum of the square to about 1e-8 of the legs' square.
    assert fx.mechanics.leg_distance(hexapod, platform, base=base) == pytest.approx(
        min(pairs), abs=1e-4 * size(hexapod), rel=1e-6
    )


@pytest.mark.parametrize("seed", range(40))
def test_leg_distance_of_any_two_segments(seed, measured):
    """Crossing, end to end, coplanar, past each other: the other four legs stand far away."""
    rng = np.random.default_rng(seed)
    while True:  # half of them on a lattice, where segments cross, touch and share planes
        ends = rng.uniform(-1, 1, (4, 3)) if seed % 2 else rng.integers(-1, 2, (4, 3)).astype(float)
        legs = ends[2:] - ends[:2]
        apart = [np.linalg.norm(v) for v in (*legs, ends[0] - ends[1], ends[2] - ends[3])]
        if min(apart) > 1e-2:
            break
    far, up = 100 + 20 * np.arange(12).reshape(4, 3) ** 1.5, np.array([0, 0, 3.0])
    changes = {
        "home": None,
        "base.joints": np.vstack([ends[:2], far]),
        "platform.joints": np.vstack([ends[2:], far + up]),
        "base.universal_axes": np.cross([*legs, *[up] * 4], [0.36, 0.48, 0.8]),
    }
    found = fx.mechanics.leg_distance(plain_machine("motion-base").replace(changes), fx.Pose([0, 0, 0]))
    # SciPy's minimum of the square is good to about 1e-9.
    measured("geometry/clearance", found - segments_apart(ends[0], legs[0], ends[1], legs[1]), 3e-5)


@pytest.mark.parametrize("offset", [0.0, 0.4, 1.0, 1.7])
def test_leg_distance_of_parallel_legs(offset):
    """Two parallel legs of length 1, 0.3 apart, shifted along each other."""
    hexapod = plain_machine("motion-base").replace({"home": None, "limits": None})
    base = np.array([[0, 0, 0], [0.3, 0, offset], [9, 0, 0], [0, 9, 0], [9, 9, 0], [18, 0, 0]], dtype=float)
    apart = hexapod.replace({"base.joints": base, "platform.joints": base, "base.universal_axes": [[1, 0, 0]] * 6})
    found = fx.mechanics.leg_distance(apart, fx.Pose([0, 0, 1]))
    assert found == pytest.approx(np.hypot(0.3, max(0.0, offset - 1)), rel=1e-12)


# --- limits -----------------------------------------------------------------------------------------------------------


def test_limits_hold_at_home_and_say_what_is_exceeded():
    hexapod = plain_machine("motion-base")
    assert fx.check_limits(hexapod, center(hexapod)) == (True, ())
    high = displaced(center(hexapod), [0, 0, 0.8, 0, 0, 0])
    ok, exceeded = fx.check_limits(hexapod, high)
    assert not ok
    longest = fx.inverse_kinematics(hexapod, high)[0]
    assert exceeded[0] == f"leg 1: length {longest:.4g} m is above 3.261 m"
    low = fx.check_limits(hexapod, fx.Pose([0, 0, 1.5]))
    assert any("is below 2.151 m" in words for words in low.exceeded)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"limits.universal_angle_deg": 5.0}, "universal joint angle"),
        ({"limits.spherical_angle_deg": 5.0}, "spherical joint angle"),
        ({"limits.leg_distance": 0.5}, "least distance between legs"),
    ],
)
def test_each_limit_counts(change, words):
    hexapod = plain_machine("motion-base")
    pose = fx.Pose.from_rpy(0.3, 0, 2.39, 0, 0, 0.2)
    assert fx.check_limits(hexapod, pose).ok
    ok, exceeded = fx.check_limits(hexapod.replace(change), pose)
    assert not ok
    assert all(words in line for line in exceeded)


def test_without_limits_everything_is_allowed_and_a_batch_is_checked_pose_by_pose():
    hexapod = plain_machine("motion-base")
    poses = fx.Pose(center(hexapod).position + np.array([[0, 0, 0], [0, 0, 0.8], [0, 0, 0.1]]))
    np.testing.assert_array_equal(fx.check_limits(hexapod, poses).ok, [True, False, True])
    assert fx.check_limits(hexapod.replace({"limits": None}), poses).ok.all()


def test_pose_of_a_moved_base_counts_from_the_base():
    hexapod = fx.load("mukherjee-i")
    pose, base = away(hexapod), displaced(fx.Pose([1, 2, 3]), [0.1, 0, 0, 0.3, 0.4, -0.5])
    outer = fx.Pose(base.position + base.matrix @ pose.position, base.matrix @ pose.matrix)
    assert relative(fx.inverse_kinematics(hexapod, outer, base=base), fx.inverse_kinematics(hexapod, pose)) < 1e-14
    for moved, still in zip(fx.joint_angles(hexapod, outer, base=base), fx.joint_angles(hexapod, pose), strict=True):
        np.testing.assert_allclose(moved, still, atol=1e-14)
    assert fx.mechanics.leg_distance(hexapod, outer, base=base) == pytest.approx(
        fx.mechanics.leg_distance(hexapod, pose), rel=1e-13
    )


def test_legs_of_which_the_same_is_to_be_said_are_told_together():
    told = together(["leg 1: too long", "leg 2: too short", "legs too near", "leg 6: too long"])
    assert told == {"legs 1, 6: too long": 2, "leg 2: too short": 1, "legs too near": 1}
    high = fx.check_limits(plain_machine("motion-base"), fx.Pose([0, 0, 3.5])).exceeded
    assert len(high) == 6
    (words,) = together(high)
    assert words.startswith("legs 1, 2, 3, 4, 5, 6: length")
