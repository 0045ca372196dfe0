"""Planned paths: round weak regions, within limits, short or quick, and clear about what cannot be."""

import numpy as np
import pytest
from tests.helpers.plain import plain_machine

import flexapod as fx

pytest.importorskip("ompl")

START = fx.Pose.from_rpy(0, 0, 0.89, 0, -0.57, -0.18)
GOAL = fx.Pose.from_rpy(0, 0, 0.89, 0, 0.78, 0.92)
BOUND = 110.0


@pytest.fixture(scope="module")
def machine():
    return fx.load("mukherjee-i")


@pytest.fixture(scope="module")
def plan(machine):
    return fx.plan_path(machine, START, GOAL, BOUND, timing=2.0)


def dense(path, count=5000):
    return path(np.linspace(path.times[0], path.times[-1], count)).pose


def test_the_straight_line_crosses_a_weak_region_and_the_plan_goes_round_it(machine, plan):
    assert fx.stability_index(machine, dense(plan.straight)).min() < 0.1 * BOUND
    assert fx.stability_index(machine, dense(plan.path)).min() >= BOUND  # on points that no search has seen
    assert fx.path_index(machine, plan.path, bound=BOUND).above
    ends = plan.path(plan.path.times[[0, -1]]).pose
    np.testing.assert_allclose(ends.position, [START.position, GOAL.position], atol=1e-12)
    np.testing.assert_allclose(ends.matrix, [START.matrix, GOAL.matrix], atol=1e-12)


def test_the_plan_is_short(plan):
    rough = fx.Trajectory(plan.rough, np.arange(plan.rough.shape[0]), ends="free")
    corners = plan.path.chart.coordinates(plan.rough) * np.repeat([1.0, plan.size], 3)
    polyline = np.linalg.norm(np.diff(corners, axis=0), axis=1).sum()
    assert rough.duration > 1  # corners
    assert plan.straight_length < plan.length < 0.9 * polyline
    assert plan.length < 1.25 * plan.straight_length  # goes round on the near side


def test_the_same_seed_gives_the_same_path(machine, plan):
    again = fx.plan_path(machine, START, GOAL, BOUND, timing=2.0)
    np.testing.assert_array_equal(again.path.waypoints.position, plan.path.waypoints.position)
    np.testing.assert_array_equal(again.path.waypoints.matrix, plan.path.waypoints.matrix)


def test_no_shorter_path_lies_next_to_it(machine, plan):
    """Pulling the inner waypoints a little towards the straight line makes the path shorter but breaks the bound."""
    chart = plan.path.chart
    z = chart.coordinates(plan.path.waypoints)
    line = chart.coordinates(plan.straight.waypoints)
    pulled = fx.Trajectory(chart.poses(z + 0.03 * (line - z)), plan.path.times)
    assert pulled.length(plan.size) < plan.length
    assert fx.stability_index(machine, dense(pulled)).min() < BOUND


def test_a_free_straight_line_is_taken(machine):
    goal = fx.Pose.from_rpy(0.05, 0, 0.9)
    plan = fx.plan_path(machine, fx.Pose([0, 0, 0.89]), goal, 100.0)
    assert plan.rough is None
    assert plan.length == pytest.approx(np.hypot(0.05, 0.01), rel=1e-9)


def test_limits_and_clearance_hold_along_the_plan():
    h = plain_machine("motion-base")
    start, goal = fx.Pose.from_rpy(-0.45, 0, 2.39, 0, 0, -0.3), fx.Pose.from_rpy(0.45, 0, 2.39, 0, 0, -0.3)
    ends = min(float(fx.mechanics.leg_distance(h, p)) for p in (start, goal))
    with pytest.raises(fx.errors.PathError, match="least distance between legs"):
        fx.plan_path(h, start, goal, fx.PathRequirements(20.0, clearance=1.01 * ends))
    plan = fx.plan_path(h, start, goal, fx.PathRequirements(20.0, clearance=0.99 * ends))
    assert fx.check_limits(h.replace({"limits.leg_distance": 0.99 * ends}), dense(plan.path)).ok.all()


def test_least_time_is_less_than_the_time_of_the_shortest_path(machine):
    speed = fx.paths.LegSpeed(rate=0.5, acceleration=2.0)
    shortest = fx.plan_path(machine, START, GOAL, BOUND, timing=speed)
    quickest = fx.plan_path(machine, START, GOAL, BOUND, objective="time", timing=speed)
    assert quickest.path.duration < 0.95 * shortest.path.duration
    for plan in (shortest, quickest):
        legs = fx.leg_rates(machine, plan.path(np.linspace(0, plan.path.duration, 3000)))
        rate, acceleration = np.abs(legs.rate).max(), np.abs(legs.acceleration).max()
        # timed on 801 samples, checked on 3000
        assert rate <= 0.5 * (1 + 1e-3)
        assert acceleration <= 2.0 * (1 + 1e-3)
        assert max(rate / 0.5, acceleration / 2.0) > 0.99  # and no slower than it has to be
        assert fx.stability_index(machine, dense(plan.path)).min() >= BOUND


def test_slice_shows_the_index(machine, plan):
    cut = fx.paths.plan_slice(machine, plan, samples=31)
    assert float(cut["index"].min()) < BOUND < float(cut["index"].max())
    start = float(cut["index"].interp(along=0.0, aside=0.0))
    assert start == pytest.approx(fx.stability_index(machine, START), rel=0.05)  # interpolated on a coarse grid
    assert not bool(cut.met.sel(along=0.8 * cut.attrs["straight"], aside=0.0, method="nearest"))


def test_progress_is_reported(machine):
    seen = []
    fx.plan_path(machine, START, GOAL, BOUND, progress=seen.append)
    assert seen == sorted(seen)
    assert 0 <= seen[0] < 0.5 < seen[-1] == 1.0  # the search, then smoothing


@pytest.mark.parametrize(
    ("start", "goal", "needs", "error", "words"),
    [
        (
            START,
            GOAL,
            150.0,
            fx.errors.PathError,
            r"the goal pose has a lowest natural frequency of 130.* below the bound",
        ),
        (START, START, 100.0, fx.errors.PathError, "the same pose"),
        (START, fx.Pose.from_rpy(0, 0, 0.89, 0, 0.3, 0.9), 20.0, fx.SingularPoseError, "det H changes its sign"),
        (
            START,
            GOAL,
            fx.PathRequirements(100.0, condition_number=20.0),
            fx.errors.PathError,
            r"cond\(H\) = .* above the bound",
        ),
        (START, GOAL, -1.0, fx.ArgumentError, "index is -1.0 rad/s; it must be finite and > 0"),
        (fx.Pose(np.zeros((2, 3))), GOAL, 100.0, fx.PoseError, "batch axes"),
    ],
)
def test_infeasible_problems_name_the_conflict(machine, start, goal, needs, error, words):
    with pytest.raises(error, match=words):
        fx.plan_path(machine, start, goal, needs)


def test_contradictory_requirements(machine):
    with pytest.raises(fx.ArgumentError, match="it must be > 1, as no H has a smaller one"):
        fx.PathRequirements(100.0, condition_number=0.5)
    with pytest.raises(fx.ArgumentError, match="least time needs a LegSpeed"):
        fx.plan_path(machine, START, GOAL, BOUND, objective="time", timing=1.0)
    with pytest.raises(fx.ArgumentError, match="leg speed has no bound"):
        fx.paths.LegSpeed()
    limited = machine.replace({"limits.leg_length": [0.1, 0.7]})
    with pytest.raises(fx.errors.PathError, match=r"the start pose is outside the limits: legs? 1.*: length"):
        fx.plan_path(limited, START, GOAL, BOUND)


def test_no_way_within_reach_is_said_with_what_stands_in_it(machine, monkeypatch):
    monkeypatch.setattr("flexapod.paths.ompl_planner.BATCHES", 4)
    tight = fx.PathRequirements(130.0, reach=0.002, turn=0.01)
    with pytest.raises(fx.errors.PathError, match=r"no path was found .* of poses sampled .* have that index"):
        fx.plan_path(machine, START, GOAL, tight)


# --- low bounds -------------------------------------------------------------------------------------------------------


def kept(hexapod, plan, points=20_001):
    """Whether a path keeps its bound at many points, all on one side of the singular poses."""
    poses = plan.path(np.linspace(plan.path.start, plan.path.start + plan.path.duration, points)).pose
    index = fx.sweep(hexapod, poses, quantities=["omega_1"], threads=1)["omega_1"].values
    sign = np.linalg.slogdet(fx.force_transformation(hexapod, poses))[0]
    return index.min() >= plan.requirements.index * (1 - 1e-9) and (sign == sign[0]).all()


def test_a_low_bound_lets_no_path_through_singular_poses(machine):
    """The straight line between these poses passes two singular ones; at a few hundred points its index is > 0.1."""
    a = fx.Pose.from_rpy(-0.00141843, 0.235985, 0.845271, 17.693, 19.792, 12.298, degrees=True)
    b = fx.Pose.from_rpy(0.105097, 0.251246, 0.731466, 15.162, -27.468, -6.2811, degrees=True)
    plan = fx.plan_path(machine, a, b, fx.PathRequirements(1.0))
    assert plan.rough is not None
    assert plan.margin >= 0
    assert plan.least_index >= 1.0
    assert kept(machine, plan)
    assert plan.straight_least_index < 1e-3
    fx.path_index(machine, plan.path)  # raises where it passes a singular pose


DRAWN = 12


def test_no_drawn_plan_breaks_its_bound(machine):
    rng, planned = np.random.default_rng(11), 0
    for _ in range(DRAWN):
        places, turns = machine.home.position + rng.uniform(-0.25, 0.25, (2, 3)), rng.uniform(-35, 35, (2, 3))
        ends = fx.Pose.from_rpy(*places.T, *turns.T, degrees=True)
        needs = fx.PathRequirements(10 ** rng.uniform(-1.5, 1.5), limits=False)
        try:
            plan = fx.plan_path(machine, ends[0], ends[1], needs)
        except (fx.errors.PathError, fx.SingularPoseError):
            continue
        planned += 1
        assert plan.margin >= 0
        assert kept(machine, plan)
    assert planned > DRAWN // 4


@pytest.mark.parametrize("clearance", [5e-324, 1e-300])
def test_a_clearance_near_zero_is_none(clearance):
    """Margins are relative to the bound, and beside such a one beyond all numbers."""
    ends = fx.Pose.from_rpy(0, 0, 2.39), fx.Pose.from_rpy(0.05, 0, 2.39)
    machine = fx.load("motion-base").replace({"limits.leg_distance": None})
    with np.errstate(all="raise", under="ignore"):
        found = [fx.plan_path(machine, *ends, fx.PathRequirements(5.0, clearance=one)) for one in (clearance, 1e-6)]
    assert found[0].margin == found[1].margin > 0
