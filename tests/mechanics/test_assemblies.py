"""Forward kinematics: all assemblies, the one on the start's side, and rows that have none."""

import json

import numpy as np
import pytest
from hypothesis import given
from tests.helpers.cases import case
from tests.helpers.drawn import machines, seeds
from tests.helpers.plain import plain_machine
from tests.helpers.support import MACHINES

import flexapod as fx

NAN = float("nan")
SINGULAR = fx.Pose.from_rpy(0, 0, 2.39, yaw=90, degrees=True)


def loaded(folder: str, name: str | None = None) -> tuple[fx.Hexapod, dict]:
    expected = case(folder, "expected.json")
    return fx.load(case(folder, f"{name or folder}.toml")), json.loads(
        expected.read_text()
    ) if expected.exists() else {}


def side(hexapod, pose):
    return np.sign(np.linalg.det(fx.force_transformation(hexapod, pose)))


def near(hexapod, rng, count, reach=0.3, turn=30.0):
    """Poses about home: within a share of the base's size, and angles in degrees."""
    size = np.ptp(hexapod.base_joints, axis=0).max()
    place = hexapod.home.position + reach * size * rng.uniform(-1, 1, (count, 3))
    return fx.Pose.from_rpy(*place.T, *rng.uniform(-turn, turn, (3, count)), degrees=True)


def contains(found, pose, tolerance):
    off = np.linalg.norm(found.pose.position - pose.position, axis=-1)
    turned = np.linalg.norm(found.pose.matrix - pose.matrix, axis=(-2, -1))
    return bool((off + turned < tolerance).any())


# --- all assemblies ---------------------------------------------------------------------------------------------------


def test_the_forty_of_dietmaier():
    hexapod, expected = loaded("dietmaier")
    found = fx.forward_kinematics_all(hexapod, expected["leg_lengths"])
    assert (found.status, found.paths, len(found.row)) == ("complete", 40, 40)
    lengths = np.broadcast_to(expected["leg_lengths"], (40, 6))
    np.testing.assert_allclose(fx.inverse_kinematics(hexapod, found.pose), lengths, atol=2e-11)
    taken = set()
    for posture in expected["postures"]:
        # The published postures meet the lengths to 6e-10; their condition stands between lengths and posture.
        off = np.linalg.norm(found.pose.position - posture["n"], axis=1)
        assert off.min() < 1e-10 / posture["rco"]
        turned = found.pose.matrix[off.argmin()] @ np.eye(3)[:, 0]
        np.testing.assert_allclose(turned, posture["a1"], atol=1e-10 / posture["rco"])
        taken.add(int(off.argmin()))
    assert len(taken) == 40


def test_the_four_of_the_three_three_machine():
    hexapod, _ = loaded("three-three")
    found = fx.forward_kinematics_all(hexapod, [6, 12, 7, 11, 13, 9])
    assert (found.status, len(found.row)) == ("complete", 4)
    expected = [[-0.4, y, sign * z] for y, z in ((-2.76191, 5.31148), (-5.90098, 1.00916)) for sign in (1, -1)]
    for place in expected:
        assert np.linalg.norm(found.pose.position - place, axis=1).min() < 1e-5
    index = fx.stability_index(hexapod, found.pose)
    np.testing.assert_allclose(np.unique(index.round(3)), [32.029, 61.332])


@pytest.mark.parametrize("name", MACHINES)
def test_every_pose_is_among_the_assemblies_of_its_lengths(name):
    hexapod = plain_machine(name)
    poses = near(hexapod, np.random.default_rng(1), 12)
    found = fx.forward_kinematics_all(hexapod, fx.inverse_kinematics(hexapod, poses))
    assert (found.status == "complete").all()
    for k in range(12):
        own = found.row == k
        these = fx.mechanics.Assemblies(found.pose[own], *(values[own] for values in found[1:4]), "complete", 0)
        assert contains(these, poses[k], 1e-6)
        assert (these.side == side(hexapod, these.pose)).all()
        # Far lengths have no assembly, so that the map from poses to lengths has degree 0: the signs of det H cancel.
        assert these.side.sum() == 0
    np.testing.assert_allclose(
        fx.inverse_kinematics(hexapod, found.pose), fx.inverse_kinematics(hexapod, poses)[found.row], rtol=2e-11
    )


@given(hexapod=machines(), seed=seeds)
def test_assemblies_of_drawn_machines(hexapod, seed):
    pose = near(hexapod, np.random.default_rng(seed), 1)[0]
    found = fx.forward_kinematics_all(hexapod, fx.inverse_kinematics(hexapod, pose))
    assert found.status == "complete"
    assert contains(found, pose, 1e-5)
    assert found.side.sum() == 0


def test_planar_joints_have_mirrored_assemblies():
    """Reflected in the plane of the base and turned back, a platform with flat joints has the same lengths."""
    hexapod = plain_machine("motion-base")
    assert np.ptp(hexapod.base_joints[:, 2]) == np.ptp(hexapod.platform_joints[:, 2]) == 0
    pose = fx.Pose.from_rpy(0.1, 0.2, 2.3, 5, -10, 20, degrees=True)
    found = fx.forward_kinematics_all(hexapod, fx.inverse_kinematics(hexapod, pose))
    flip = np.diag([1.0, 1.0, -1.0])
    z = hexapod.base_joints[0, 2], hexapod.platform_joints[0, 2]
    for k in range(len(found.row)):
        matrix = flip @ found.pose.matrix[k] @ flip
        place = flip @ (found.pose.position[k] - [0, 0, z[0]]) + [0, 0, z[0]]
        place = place + flip @ found.pose.matrix[k] @ [0, 0, z[1]] - matrix @ [0, 0, z[1]]
        assert contains(found, fx.Pose(place, matrix), 1e-7)


def test_the_nearest_to_the_start_comes_first():
    hexapod = plain_machine("motion-base")
    lengths = fx.inverse_kinematics(hexapod)
    below = fx.forward_kinematics_all(hexapod, lengths, start=[0, 0, -2.4, 0, 0, 0])
    assert below.pose[0].position[2] < 0 < fx.forward_kinematics_all(hexapod, lengths).pose[0].position[2]


def test_a_singular_pose_is_found_with_side_zero():
    hexapod = plain_machine("motion-base")
    found = fx.forward_kinematics_all(hexapod, fx.inverse_kinematics(hexapod, SINGULAR), start=SINGULAR)
    assert found.side[0] == 0
    assert found.misfit[0] < 1e-10


def test_lengths_that_nothing_has():
    hexapod = plain_machine("motion-base")
    lengths = fx.inverse_kinematics(hexapod) * [10, 1, 1, 1, 1, 1]
    found = fx.forward_kinematics_all(hexapod, lengths)
    assert (found.status, found.pose.shape, found.row.shape) == ("complete", (0,), (0,))
    assert fx.forward_kinematics_all(hexapod, np.empty((0, 6))).status.shape == (0,)


def test_bad_rows_among_many():
    hexapod = plain_machine("motion-base")
    good = fx.inverse_kinematics(hexapod)
    rows = np.stack([good, good * NAN, good * [-1, 1, 1, 1, 1, 1], good])
    found = fx.forward_kinematics_all(hexapod, rows)
    assert found.status.tolist() == ["complete", "wrong_lengths", "wrong_lengths", "complete"]
    assert sorted(set(found.row)) == [0, 3]
    with pytest.raises(fx.KinematicsError, match="must be > 0 m"):
        fx.forward_kinematics_all(hexapod, rows[2])


def test_threads_change_nothing():
    hexapod = plain_machine("precision-positioner")
    lengths = fx.inverse_kinematics(hexapod, near(hexapod, np.random.default_rng(3), 5))
    one, two = (fx.forward_kinematics_all(hexapod, lengths, threads=n) for n in (1, 2))
    assert one.pose == two.pose
    np.testing.assert_array_equal(one.row, two.row)


# --- the assembly that the legs lead to ------------------------------------------------------------------------------


def test_not_from_beyond_a_singular_pose():
    """Newton's method alone ends on the other side of det H = 0 here, where no motion from home leads."""
    hexapod = fx.load("mukherjee-i")
    pose = fx.Pose.from_rpy(0.225151, 0.336923, 0.885842, 0.87237, -18.298, 17.147, degrees=True)
    found = fx.forward_kinematics(hexapod, fx.inverse_kinematics(hexapod, pose))
    assert found.status == "nearest"
    assert side(hexapod, found) == side(hexapod, hexapod.home)
    np.testing.assert_allclose(found.position, pose.position, atol=1e-8)


@pytest.mark.parametrize("name", ["mukherjee-i", "cubic-isolator"])
def test_many_poses_of_homes_side_come_back_on_it(name):
    hexapod = plain_machine(name)
    poses = near(hexapod, np.random.default_rng(5), 600, turn=35.0)
    poses = poses[side(hexapod, poses) == side(hexapod, hexapod.home)]
    found = fx.forward_kinematics(hexapod, fx.inverse_kinematics(hexapod, poses))
    assert set(found.status) == {"found", "nearest"}
    assert (side(hexapod, found) == side(hexapod, hexapod.home)).all()


def test_a_bad_row_does_not_stop_a_batch():
    hexapod = plain_machine("motion-base")
    pose = fx.Pose.from_rpy(0.1, 0, 2.4, pitch=3, degrees=True)
    good = fx.inverse_kinematics(hexapod, pose)
    rows = np.stack([good, np.ones(6), good * NAN, good - 10, good])
    found = fx.forward_kinematics(hexapod, rows)
    assert found.status.tolist() == ["found", "not_found", "wrong_lengths", "wrong_lengths", "found"]
    np.testing.assert_allclose(found.position[[0, 4]], np.stack([pose.position] * 2), atol=1e-9)
    assert np.isnan(found.position[1:4]).all()
    assert np.isnan(found.matrix[1:4]).all()
    assert found.misfit[1] > 0.1
    assert found[0].status == "found"
    assert np.isnan(fx.inverse_kinematics(hexapod, found)[1:4]).all()
    assert np.isnan(fx.stability_index(hexapod, found)).tolist() == [False, True, True, True, False]


def test_a_batch_without_rows():
    hexapod = plain_machine("motion-base")
    assert fx.forward_kinematics(hexapod, np.empty((0, 6))).shape == (0,)


def test_a_found_pose_is_a_pose():
    import pickle

    hexapod = plain_machine("motion-base")
    found = fx.forward_kinematics(hexapod, fx.inverse_kinematics(hexapod))
    again = pickle.loads(pickle.dumps(found))
    assert again == found
    assert (again.status, repr(again)) == ("found", repr(found))
    assert fx.forward_kinematics(hexapod, fx.inverse_kinematics(hexapod), start=found).status == "found"


# --- lengths that others have published -------------------------------------------------------------------------------


def test_lengths_and_directions_of_wolfram():
    hexapod, expected = loaded("wolfram")
    np.testing.assert_allclose(fx.inverse_kinematics(hexapod), expected["lengths"], atol=5e-15)
    directions = fx.force_transformation(hexapod)[:3].T
    np.testing.assert_allclose(directions, expected["directions"], atol=5e-15)
    found = fx.forward_kinematics(hexapod, expected["lengths"])
    np.testing.assert_allclose(found.position, [0, 0.15, 0], atol=1e-13)


def test_lengths_of_genhexkins():
    hexapod, expected = loaded("genhexkins")
    for each in expected["cases"]:
        pose = fx.Pose.from_rpy(*each["position"], *each["rpy"])
        np.testing.assert_allclose(fx.inverse_kinematics(hexapod, pose), each["lengths"], atol=5.1e-5)
        found = fx.forward_kinematics(hexapod, each["lengths"], start=pose)
        np.testing.assert_allclose(found.position, each["position"], atol=1e-3)
