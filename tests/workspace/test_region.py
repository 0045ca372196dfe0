"""One argument says where: every kind of region gives the poses that it stands for."""

import numpy as np
import pytest
from tests.helpers.plain import plain_machine

import flexapod as fx
from flexapod.workspace.region import as_region, home_of, poses_of

BASE = plain_machine("motion-base")
HOME = fx.home_pose(BASE)
SIX = np.concatenate([HOME.position, HOME.rpy])
BOX = fx.Box.about(HOME, 0.1, 0.2)
WAY = fx.Pose.from_rpy([0.0, 0.1, 0.0], 0.0, [2.39, 2.4, 2.5])
PATH = fx.Trajectory(WAY, [0, 1, 3])

LISTS = {
    "home": (None, SIX[None]),
    "a pose": (HOME, SIX[None]),
    "poses": (WAY, np.concatenate([WAY.position, WAY.rpy], axis=1)),
    "six numbers": (SIX.tolist(), SIX[None]),
    "rows": (np.stack([SIX, SIX + 0.01]), np.stack([SIX, SIX + 0.01])),
    "a box of one pose": (fx.Box(*SIX), SIX[None]),
    "a set": (fx.random_poses(BOX, 20), fx.random_poses(BOX, 20).rows(0, 20)),
    "a path of poses": (fx.workspace.pose_path(WAY, 3), np.concatenate([WAY.position, WAY.rpy], axis=1)),
}


@pytest.mark.parametrize("kind", LISTS)
def test_regions_that_list_their_poses(kind):
    given, rows = LISTS[kind]
    region = as_region(given)
    assert region.box(SIX) is None
    assert region.rows(home_of(BASE, region), 7) == pytest.approx(rows, abs=1e-12)
    swept = fx.sweep(BASE, given, samples=1)
    assert swept.omega_1.values.ravel() == pytest.approx(fx.sweep(BASE, rows).omega_1.values, rel=1e-10)


@pytest.mark.parametrize("given", [BOX, fx.Workspace(BOX), fx.Workspace.about_home(0.1, 0.2)])
def test_regions_that_fill_a_box(given):
    region = as_region(given)
    box = region.box(home_of(BASE, region))
    assert box.low == pytest.approx(BOX.low, abs=1e-12)
    points = poses_of(BASE, given, 64, seed=3)
    assert points.rows(0, 64) == pytest.approx(fx.workspace.low_discrepancy(BOX, 64, seed=3).rows(0, 64), abs=1e-12)
    assert fx.sweep(BASE, given, samples=64, seed=3).omega_1.shape == (64,)


def test_a_trajectory_is_sampled_with_its_waypoints():
    swept = fx.sweep(BASE, PATH, samples=50)
    assert swept.omega_1.size >= 50
    for k in range(3):
        assert np.abs(swept.x - WAY.position[k, 0]).values.min() < 1e-12
    assert fx.worst_pose(BASE, PATH).omega_1 == pytest.approx(float(fx.sweep(BASE, PATH, samples=400).omega_1.min()))


def test_what_is_no_region_is_told():
    homeless = fx.Hexapod.from_toml(BASE.to_toml().partition("[home]")[0])
    for region in (None, fx.Workspace.about_home(0.1, 0.1)):
        with pytest.raises(fx.PoseError, match="names no home pose"):
            fx.sweep(homeless, region)
    with pytest.raises(fx.PoseError, match="region is 'here'; give a Workspace, a Box, a PoseSet"):
        as_region("here")
    with pytest.raises(fx.ArgumentError, match="or a Workspace fixed in the base"):
        fx.random_poses(fx.Workspace.about_home(0.1, 0.1), 5)
    assert fx.random_poses(fx.Workspace(BOX), 5).box is not None
