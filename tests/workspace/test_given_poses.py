"""Poses as users have them, of matrices, of SciPy's rotations or of six numbers, are one set to a sweep."""

import pickle

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from tests.helpers.plain import plain_machine

import flexapod as fx
from flexapod import _core
from flexapod.workspace.pose_sets import given_poses

H = plain_machine("motion-base")
RNG = np.random.default_rng(4)
POSITION = np.array([0.0, 0.0, 2.4]) + RNG.uniform(-0.1, 0.1, (300, 3))
ANY = Rotation.random(300, rng=5)
SMALL = Rotation.from_euler("xyz", RNG.uniform(-0.2, 0.2, (300, 3)))


def test_a_sweep_is_the_same_however_rotations_are_given():
    six = np.concatenate([POSITION, SMALL.as_euler("xyz")], axis=1)
    expected = fx.sweep(H, six, quantities=["omega", "cond_H", "leg_length"])
    for poses in (fx.Pose(POSITION, SMALL), fx.Pose(POSITION, SMALL.as_matrix())):
        found = fx.sweep(H, poses, quantities=["omega", "cond_H", "leg_length"])
        for name in ("omega", "cond_H", "leg_length"):
            np.testing.assert_allclose(found[name], expected[name], rtol=1e-11)
        for k, name in enumerate(("x", "y", "z", "roll", "pitch", "yaw")):
            np.testing.assert_allclose(found[name], six[:, k], rtol=0, atol=2e-15)
            assert found[name].attrs["units"] == ("m" if k < 3 else "rad")


@pytest.mark.parametrize("rotation", [ANY, ANY.as_matrix()], ids=["rotations", "matrices"])
def test_coordinates_turn_the_platform_as_given(rotation):
    """By SciPy, for turns of any size: pitch is within a right angle."""
    found = fx.sweep(H, fx.Pose(POSITION, rotation), quantities="leg_length")
    angles = np.stack([found["roll"].values, found["pitch"].values, found["yaw"].values], axis=1)
    apart = (Rotation.from_euler("xyz", angles) * ANY.inv()).magnitude()
    assert apart.max() < 1e-13
    assert np.abs(angles[:, 1]).max() <= np.pi / 2


def test_upright_platforms_have_no_yaw():
    upright = Rotation.from_euler("xyz", [[0.3, np.pi / 2, 0.5], [0.3, -np.pi / 2, 0.5], [0.0, 0.0, 0.0]])
    for rotation in (upright, upright.as_matrix()):
        pose = fx.Pose(POSITION[:3], rotation)
        swept = fx.sweep(H, pose, quantities="leg_length")
        for angles in (pose.rpy, np.stack([swept["roll"].values, swept["pitch"].values, swept["yaw"].values], axis=1)):
            assert np.allclose(angles[:, 1], [np.pi / 2, -np.pi / 2, 0])
            assert (angles[:, 2] == 0).all()
            assert (Rotation.from_euler("xyz", angles) * upright.inv()).magnitude().max() < 1e-7


def test_batch_axes_and_pieces():
    poses = fx.Pose(POSITION.reshape(20, 15, 3), ANY[:1])
    found, points = fx.sweep(H, poses, quantities="omega_1"), given_poses(poses)
    assert found.omega_1.dims == ("pose_0", "pose_1")
    rows = points.rows(0, 300)
    assert rows.shape == (300, 12)
    np.testing.assert_array_equal(points.rows(40, 70), rows[40:70])
    np.testing.assert_allclose(
        fx.sweep(H, fx.Pose(rows[:, :3], rows[:, 3:].reshape(-1, 3, 3))).omega_1, found.omega_1.values.ravel()
    )
    assert points.identity() == given_poses(fx.Pose(POSITION.reshape(20, 15, 3), poses.matrix)).identity()


def test_a_pose_of_rotations_is_a_pose_of_their_matrices():
    pose, plain = fx.Pose(POSITION, ANY), fx.Pose(POSITION, ANY.as_matrix())
    assert fx.Pose(POSITION, ANY).numbers[1].shape == (300, 4)
    assert np.abs(pose.matrix - plain.matrix).max() < 1e-15
    assert not pose.matrix.flags.writeable
    assert pose == fx.Pose(POSITION, pose.matrix)
    assert hash(pose) == hash(fx.Pose(POSITION, pose.matrix))
    for index in (7, slice(10, 40, 3), np.arange(300) % 7 == 0):
        assert fx.Pose(POSITION, ANY)[index] == pose[index]
    for other in (pickle.loads(pickle.dumps(fx.Pose(POSITION, ANY))), fx.Pose(POSITION, ANY)):
        assert other == pose
        assert other.rotation.approx_equal(ANY, atol=1e-15).all()
    one = fx.Pose(POSITION, ANY)[3]
    assert one.shape == ()
    assert np.array_equal(fx.natural_modes(H, one).omega, fx.natural_modes(H, pose[3]).omega)


def test_many_numbers_are_checked_on_several_threads():
    count = 50_000
    position, rotation = np.zeros((count, 3)), np.tile(np.eye(3), (count, 1, 1))
    assert fx.Pose(position, rotation).shape == (count,)
    wrong = {"position": (position.copy(), rotation), "rotation": (position, rotation.copy())}
    wrong["position"][0][count - 1, 2] = np.inf
    wrong["rotation"][1][count - 2, 1, 1] = -1.0
    for name, (p, R) in wrong.items():
        with pytest.raises(fx.PoseError, match=name):
            fx.Pose(p, R)
    for bad in (1 + 1e-8, np.nan):
        rotation[count // 2, 0, 0] = bad
        with pytest.raises(fx.PoseError, match="rotation is not a rotation matrix"):
            fx.Pose(position, rotation)


@pytest.mark.parametrize("threads", [1, 3])
def test_conversions_are_scipys(threads):
    many = Rotation.random(40_000, rng=6)
    matrices, quaternions = many.as_matrix(), many.as_quat()
    found = _core.matrices_of_quaternions(quaternions, threads).reshape(-1, 3, 3)
    assert np.abs(found - matrices).max() < 1e-15
    angles = _core.angles_of_matrices(matrices, threads)
    assert np.abs(angles - many.as_euler("xyz")).max() < 1e-9  # where pitch is nearly a right angle
    assert np.abs(_core.matrices_of_angles(angles, threads).reshape(-1, 3, 3) - matrices).max() < 1e-13
    assert _core.all_rotate(matrices, threads)
    assert _core.all_of_length_one(quaternions, threads)
    assert not _core.all_of_length_one(quaternions * (1 + 1e-8), threads)
    assert not _core.all_rotate(np.concatenate([matrices, -matrices[:1]]), threads)
