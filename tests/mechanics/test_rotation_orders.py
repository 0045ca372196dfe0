"""Poses from angles of any order, turned about any point, and displaced."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import flexapod as fx
from flexapod.rotations import vector_from_rotation

ORDERS = ["xyz", "XYZ", "ZXZ", "zxz", "ZYX", "yxy", "YZX"]


@pytest.mark.parametrize("order", ORDERS)
def test_angles_of_every_order_are_scipys(order):
    rng = np.random.default_rng(1)
    angles, place = rng.uniform(-1.4, 1.4, (50, 3)), rng.normal(size=(50, 3))
    pose = fx.Pose.from_angles(place, angles, order)
    np.testing.assert_allclose(pose.matrix, Rotation.from_euler(order, angles).as_matrix(), atol=1e-15)
    np.testing.assert_array_equal(pose.position, place)
    again = fx.Pose.from_angles(place, pose.angles(order), order)
    np.testing.assert_allclose(again.matrix, pose.matrix, atol=1e-14)


def test_the_default_order_is_roll_pitch_yaw():
    assert fx.Pose.from_angles([1, 2, 3], [4, 5, 6], degrees=True) == fx.Pose.from_rpy(1, 2, 3, 4, 5, 6, degrees=True)
    assert fx.Pose.from_rpy(0, 0, 0, 0.1, 0.2, 0.3).angles().round(12).tolist() == [0.1, 0.2, 0.3]


def test_a_pivot_stays_where_it_would_be_without_the_turn():
    pivot, place = [0.1, -0.2, 0.3], np.array([1.0, 2.0, 3.0])
    pose = fx.Pose.from_angles(place, [10, 20, 30], "XYZ", degrees=True, pivot=pivot)
    np.testing.assert_allclose(pose.position + pose.matrix @ pivot, place + pivot, atol=1e-15)
    np.testing.assert_allclose(pose.position_about(pivot), place, atol=1e-15)


def test_gimbal_lock_gives_angles_of_the_same_pose():
    pose = fx.Pose.from_angles([0, 0, 1], [0.3, np.pi / 2, 0.2], "XYZ")
    np.testing.assert_allclose(
        fx.Pose.from_angles([0, 0, 1], pose.angles("XYZ"), "XYZ").matrix, pose.matrix, atol=1e-12
    )


def test_displaced():
    home = fx.Pose.from_rpy(0, 0, 2.39, yaw=90, degrees=True)
    moved = home.displaced(fx.Pose.from_rpy(0.1, 0, 0.2, roll=10, degrees=True))
    np.testing.assert_allclose(moved.position, [0.1, 0, 2.59])
    np.testing.assert_allclose(
        moved.matrix, Rotation.from_euler("xyz", [10, 0, 0], degrees=True).as_matrix() @ home.matrix
    )


@pytest.mark.parametrize("order", ["XYz", "xxy", "xy", "abc", "", 5, None, "xyzx"])
def test_orders_that_are_none(order):
    with pytest.raises(fx.PoseError, match=r"rotation order is .* three letters .* 'XYZ'"):
        fx.Pose.from_angles([0, 0, 1], [0, 0, 0], order)
    with pytest.raises(fx.PoseError, match="rotation order is"):
        fx.Pose([0, 0, 1]).angles(order)


def test_shapes_that_do_not_fit():
    with pytest.raises(fx.PoseError, match="do not fit"):
        fx.Pose.from_angles(np.zeros((2, 3)), np.zeros((3, 3)))


@pytest.mark.parametrize("angle", [0.0, 1e-12, 1e-6, 0.3, 2.6, 2.7, 3.0, np.pi - 1e-9, np.pi])
def test_rotation_vectors_are_those_of_scipy(angle):
    rng = np.random.default_rng(3)
    axes = np.concatenate([rng.normal(size=(40, 3)), np.eye(3), -np.eye(3), [[1, 1, 0], [0, -1, 1e-9]]])
    vectors = angle * axes / np.linalg.norm(axes, axis=1, keepdims=True)
    turn = Rotation.from_rotvec(vectors)
    found, expected = vector_from_rotation(turn.as_matrix()), turn.as_rotvec()
    same = np.abs(found - expected).max(axis=1) <= 1e-15 + 1e-14 * angle
    half = np.abs(angle - np.pi) < 1e-8  # an axis and its opposite are the same half turn
    assert np.all(same | (half & (np.abs(found + expected).max(axis=1) < 1e-8)))
    assert np.abs(vector_from_rotation(turn.as_matrix()[0]) - found[0]).max() == 0
