"""The worst pose within a design's limits, at corners of a box, and where a universal joint locks."""

from pathlib import Path

import numpy as np
import pytest
from tests.helpers.plain import plain_machine

import flexapod as fx
from flexapod.workspace.limit_margins import LimitMargins

CASES = Path(__file__).parents[1] / "data" / "cases"
BASE, CUBIC, POSITIONER = (plain_machine(name) for name in ("motion-base", "cubic-isolator", "precision-positioner"))


def around(design, metres, degrees):
    return fx.Box.about(fx.home_pose(design), metres, np.radians(degrees))


LIMITED = [
    (BASE, around(BASE, 0.67, 24)),
    (CUBIC, around(CUBIC, 0.006, 4.6)),
    (POSITIONER, around(POSITIONER, 0.012, 6)),
]


def reachable(design, box, samples, seed, joint="universal"):
    """omega_1 of those of many random poses that are within the limits."""
    found = fx.sweep(design, fx.random_poses(box, samples, seed=seed), joint=joint)
    return found.omega_1.values[found.within_limits.values]


SHARED = fx.load(CASES / "faults" / "octahedron-3-3.toml")  # every joint is that of two legs
SHARED = SHARED.replace({"limits.leg_distance": 0.75 * fx.mechanics.leg_distance(SHARED)})


@pytest.mark.parametrize(
    ("design", "box"), [*LIMITED, (SHARED, around(SHARED, 0.1, 25))], ids=lambda value: getattr(value, "name", "")
)
def test_margins_say_what_check_limits_says(design, box):
    margins = LimitMargins(design)
    rows = fx.random_poses(box, 400, seed=4).rows(0, 400)
    kept = [bool((margins(six)[0] >= 0).all()) for six in rows]
    assert 0 < sum(kept) < 400
    assert kept == fx.check_limits(design, fx.Pose.from_rpy(*rows.T)).ok.tolist()


@pytest.mark.parametrize(("design", "box"), LIMITED, ids=lambda value: getattr(value, "name", ""))
def test_derivatives_of_margins_are_exact(design, box):
    margins = LimitMargins(design)
    six = fx.random_poses(box, 1, seed=5).rows(0, 1)[0]
    slope = margins(six)[1]
    for k, step in enumerate(1e-6 * np.eye(6)):
        central = (margins(six + step)[0] - margins(six - step)[0]) / 2e-6
        # rounding, eps / step, times the size of a margin
        assert np.allclose(slope[:, k], central, rtol=1e-6, atol=1e-7 * np.abs(slope).max())


@pytest.mark.parametrize("joint", ["universal", "spin_free"])
@pytest.mark.parametrize(("design", "box"), LIMITED, ids=lambda value: getattr(value, "name", ""))
def test_no_pose_within_the_limits_is_worse(design, box, joint):
    worst = fx.worst_pose(design, box, joint=joint)
    index = float(fx.stability_index(design, fx.Pose.from_rpy(*worst.pose), joint=joint))
    assert worst.omega_1 == pytest.approx(index, rel=1e-12)
    assert fx.check_limits(design, worst.pose).ok
    assert ((worst.pose >= box.low) & (worst.pose <= box.high)).all()
    assert worst.omega_1 < reachable(design, box, 400_000, 7, joint).min()
    width = box.high - box.low
    for reach in (0.1, 1e-2, 1e-3, 1e-5):
        near = fx.Box(
            *np.stack(
                [np.maximum(worst.pose - reach * width, box.low), np.minimum(worst.pose + reach * width, box.high)],
                axis=1,
            )
        )
        assert reachable(design, near, 50_000, 8, joint).min(initial=np.inf) >= worst.omega_1 * (1 - 1e-8)
    assert worst.at_limits
    assert 0 < worst.share_within_limits < 0.2
    assert fx.worst_pose(design, box, joint=joint, all_poses=True).omega_1 < worst.omega_1


def test_seeds_agree_on_the_worst_pose_within_the_limits():
    design, box = LIMITED[0]
    found = [fx.worst_pose(design, box, seed=seed).omega_1 for seed in range(3)]
    assert np.ptp(found) < 1e-8 * found[0]
    assert found[0] < 24.42  # the least of 2 000 000 random poses within the limits
    assert fx.worst_pose(design, box, all_poses=True).omega_1 < 8.6


def test_a_sliver_within_the_limits_is_found():
    """Less than one pose of a hundred thousand of this box is within the limits."""
    low = [-0.03771, -0.1016, -0.01882, *np.radians([-7.498, -5.852, -5.46])]
    high = [0.06739, 0.06066, 0.06995, *np.radians([6.354, 5.907, 3.226])]
    worst = fx.worst_pose(CUBIC, fx.Box(*zip(low, high, strict=True)))
    assert worst.share_within_limits < 1e-4
    assert fx.check_limits(CUBIC, worst.pose).ok
    narrow = BASE.replace({"limits.leg_length": [2.7, 2.7001]})
    worst = fx.worst_pose(narrow, LIMITED[0][1], samples=1024)
    assert worst.share_within_limits == 0
    assert fx.check_limits(narrow, worst.pose).ok
    home = float(np.mean(fx.inverse_kinematics(BASE, worst.pose)))
    assert home == pytest.approx(2.70005, abs=6e-5)


def test_a_region_out_of_reach_is_told():
    far = fx.Box(z=(3.5, 3.6), yaw=(-0.1, 0.1))
    with pytest.raises(fx.PoseError, match=r"no pose of Box.* is within the limits of 'motion-base'.*length of leg"):
        fx.worst_pose(BASE, far)
    assert fx.worst_pose(BASE, far, all_poses=True).omega_1 > 0
    with pytest.raises(fx.PoseError, match="none of the 5 poses is within"):
        fx.worst_pose(BASE, fx.pose_grid(z=np.linspace(3.5, 3.6, 5)))


def test_of_poses_the_worst_within_the_limits_is_taken():
    poses = fx.random_poses(LIMITED[0][1], 2000)
    found = fx.sweep(BASE, poses)
    inside = np.where(found.within_limits, found.omega_1, np.inf)
    worst = fx.worst_pose(BASE, poses)
    assert np.array_equal(worst.pose, poses.rows(0, 2000)[inside.argmin()])
    assert worst.share_within_limits == found.within_limits.values.mean()
    everywhere = fx.worst_pose(BASE, poses, all_poses=True)
    assert np.array_equal(everywhere.pose, poses.rows(0, 2000)[found.omega_1.values.argmin()])
    assert np.isnan(everywhere.share_within_limits)


def test_without_limits_all_poses_are_the_same():
    design = fx.load("mukherjee-ii")
    box = around(design, 0.02, 5)
    one, other = (fx.worst_pose(design, box, samples=1024, all_poses=choice) for choice in (False, True))
    assert one.omega_1 == other.omega_1
    assert one.at_limits == ()
    assert one.share_within_limits == 1.0


@pytest.mark.parametrize("seed", range(3))
def test_a_corner_that_is_the_worst_is_found(seed):
    box = around(BASE, 0.05 * float(np.mean(fx.inverse_kinematics(BASE))), 5)
    worst = fx.worst_pose(BASE, box, seed=seed, all_poses=True)
    corners = fx.Workspace(box).rows(np.zeros(6), 1)[1:65]
    assert worst.omega_1 == pytest.approx(float(fx.sweep(BASE, corners).omega_1.min()), rel=1e-12)
    assert worst.omega_1 == pytest.approx(26.7694, abs=1e-4)
    assert worst.agreed >= 1


def test_a_pose_that_locks_a_joint_has_index_zero():
    """Every descent in this box meets a pose at which a leg lies along the axis of its universal joint."""
    low = [-0.03771, -0.1016, -0.01882, *np.radians([-7.498, -5.852, -5.46])]
    high = [0.06739, 0.06066, 0.06995, *np.radians([6.354, 5.907, 3.226])]
    worst = fx.worst_pose(CUBIC, fx.Box(*zip(low, high, strict=True)), all_poses=True)
    assert worst.singular
    assert worst.omega_1 < 1e-9
    near = worst.pose + 1e-7 * np.random.default_rng(0).normal(size=(200, 6))
    assert float(fx.sweep(CUBIC, near).omega_1.min()) < 0.05


def test_the_sampling_time_is_that_of_the_poses_within_the_limits():
    design, box = LIMITED[0]
    found = fx.sweep(design, fx.random_poses(box, 400_000, seed=3), quantities=("omega", "within_limits"))
    omega, inside = found.omega.values[:, 5], found.within_limits.values
    for all_poses, dense in ((False, omega[inside].max()), (True, omega.max())):
        highest = 2 * np.pi / (20 * fx.control.sampling_time(design, box, all_poses=all_poses))
        assert dense < highest < 1.2 * dense
    assert omega.max() > 1.02 * omega[inside].max()
    with pytest.raises(fx.PoseError, match="within the limits"):
        fx.control.sampling_time(design, fx.Box(z=(3.5, 3.6)))


@pytest.mark.parametrize("seed", [-1, 1.5, "x"])
def test_a_seed_that_is_none_is_refused(seed):
    with pytest.raises(fx.errors.ArgumentError, match="seed is"):
        fx.worst_pose(POSITIONER, around(POSITIONER, 0.001, 0.5), samples=16, seed=seed)
