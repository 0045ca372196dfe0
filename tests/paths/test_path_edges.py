"""Corners of paths: touched singular poses, obstacles, ways without a smooth path."""

import numpy as np
import pytest

import flexapod as fx
from flexapod.paths.ompl_planner import search
from flexapod.paths.planning_task import PlanningTask
from flexapod.paths.requirements import Margins


@pytest.fixture(scope="module")
def machine():
    return fx.load("mukherjee-i")


def test_a_path_that_touches_a_singular_pose_is_refused(machine):
    """It turns back there: det H does not change its sign, and still the legs cannot hold the platform."""
    ends = fx.Pose.from_rpy(0, 0, 0.89, 0, [-0.57, 0.78], [-0.18, 0.92])
    across = fx.Trajectory(ends, [0, 1])
    at = fx.path_index(machine, across, singular="keep").crossings[0]
    way = across([0.0, at * (1 - 1e-9), 0.0]).pose
    touching = fx.Trajectory(way, [0.0, 1.0, 2.0])
    with pytest.raises(fx.SingularPoseError, match="passes through a singular pose at t = 1"):
        fx.path_index(machine, touching, samples=8)
    kept = fx.path_index(machine, touching, samples=8, singular="keep")
    assert kept.crossings == pytest.approx((1.0,), abs=1e-6)
    assert not kept.above


def test_a_bound_on_the_condition_number_is_one_of_the_margins(machine):
    poses = fx.Pose.from_rpy(np.linspace(-0.1, 0.4, 12), 0.05, 0.89, 0.0, 0.3, 0.1)
    cond = fx.condition_number(machine, poses)
    bound = float(np.median(cond))
    margins = Margins(machine, fx.PathRequirements(1.0, condition_number=bound))
    np.testing.assert_array_equal(margins.met(poses), cond <= bound)
    np.testing.assert_allclose(margins.worst(poses), 1 - cond / bound, rtol=1e-12)


def test_the_planner_goes_round_what_is_in_its_way():
    pytest.importorskip("ompl")

    def met(points):
        return np.linalg.norm(points - 0.5, axis=1) > 0.3

    ends = np.array([[0.1, 0.1], [0.9, 0.9]])
    found = search(met, ends, np.zeros(2), np.ones(2), step=0.02, seed=3)
    np.testing.assert_allclose(found.points[[0, -1]], ends)
    pieces = zip(found.points, found.points[1:], strict=False)
    dense = np.concatenate([np.linspace(a, b, 200) for a, b in pieces])
    assert (np.linalg.norm(dense - 0.5, axis=1) > 0.29).all()  # checked every 0.02
    length = np.linalg.norm(np.diff(found.points, axis=0), axis=1).sum()
    around = 2 * (np.sqrt(0.32 - 0.09) + 0.3 * (np.pi / 2 - np.arccos(0.3 / np.sqrt(0.32))))
    assert around * 0.98 < length < 1.2 * around


def test_a_way_without_a_smooth_path_is_said_so(machine, monkeypatch):
    pytest.importorskip("ompl")
    monkeypatch.setattr("flexapod.paths.planning_task.WAYPOINTS", (8,))
    monkeypatch.setattr("flexapod.paths.planning_task._MARGINS", (0.005,))
    monkeypatch.setattr(PlanningTask, "margin", lambda task, path: -0.1)
    with pytest.raises(fx.errors.PathError, match=r"a way was found, but no smooth path along it .* misses by 1"):
        fx.plan_path(machine, fx.Pose([0, 0, 0.89]), fx.Pose.from_rpy(0.05, 0, 0.9), 90.0)


@pytest.mark.parametrize("timing", [1e308, 1e-320, 1e-200, fx.paths.LegSpeed(1e-300), fx.paths.LegSpeed(1e300)])
def test_plans_that_last_too_short_or_too_long(machine, timing):
    with pytest.raises(fx.errors.PathError, match=r"the path lasts .* at least 1e-09 s and at most 1e\+12 s"):
        fx.plan_path(machine, fx.Pose([0, 0, 0.89]), fx.Pose([0.05, 0, 0.89]), 90.0, timing=timing)


def test_waypoints_that_follow_at_once(machine):
    places = fx.Pose([[0, 0, 0.89], [0, 0, 0.9], [0, 0, 0.91]])
    with pytest.raises(fx.errors.PathError, match=r"times\[1\] is 1e-60 s after times\[0\]"):
        fx.Trajectory(places, [0, 1e-60, 1])
    fx.Trajectory(places, [1e-9, 2e-9, 3e-9])


def test_arguments_of_absurd_size(machine):
    path = fx.Trajectory(fx.Pose([[0, 0, 0.89], [0, 0, 0.9]]), [0, 1])
    for study in (fx.path_index, fx.paths.path_loads):
        with pytest.raises(fx.errors.ArgumentError, match="at most 1000000 are computed"):
            study(machine, path, samples=10**9)
    with pytest.raises(fx.errors.PoseError, match="must hold"):
        fx.Pose([0, 0, 10**400])
    with pytest.raises(fx.errors.PoseError, match="origin has batch axes"):
        fx.Trajectory(path.waypoints, [0, 1], origin=path.waypoints)


def test_a_crossing_keeps_its_minimum_at_zero(machine):
    """Between these poses H is singular: the index is zero there, whatever rounding leaves of it."""
    path = fx.Trajectory(fx.Pose.from_rpy(0, 0, [0.5, -0.5]), [0, 1])
    found = fx.path_index(machine, path, singular="keep")
    assert found.crossings
    assert (found.minimum, found.minimum_time) == (0.0, found.crossings[0])
