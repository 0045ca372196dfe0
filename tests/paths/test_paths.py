"""Paths: the spline on SE(3), the index along it, what the legs do on it, and what makes no path."""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.spatial.transform import Rotation

import flexapod as fx

SIX = np.random.default_rng(3).normal(size=(5, 6)) * [0.05, 0.05, 0.05, 0.12, 0.12, 0.12] + [0, 0, 0.89, 0, 0, 0]


@pytest.fixture(scope="module")
def machine():
    return fx.load("mukherjee-i")


def waypoints(closed=False):
    rows = np.vstack([SIX, SIX[:1]]) if closed else SIX
    return fx.Pose.from_rpy(*rows.T)


HOME = fx.Pose.from_rpy(0.02, 0, 0.89, 0, 0, 0.1)


def path(ends="rest", **more):
    poses = waypoints(ends == "periodic")
    times = np.cumsum([0.0, 0.7, 0.5, 0.9, 0.6, 0.8])[: poses.shape[0]] + 2.0
    if ends == "joined":
        return path("free", **more).between(HOME, 0.9)
    return fx.Trajectory(poses, times, ends=ends, **more)


@pytest.mark.parametrize("ends", ["rest", "free", "periodic", "joined"])
def test_motion_is_the_derivative_of_the_pose(ends):
    p = path(ends)
    t, h = p.grid(40)[1:-1] + 1e-3, 1e-4  # off the knots of the cubic, where the jerk jumps
    t = t[t < p.times[-1] - 2 * h]
    here, before, after = p(t), p(t - h), p(t + h)
    central = {
        "velocity": (after.pose.position - before.pose.position) / (2 * h),
        "acceleration": (after.velocity - before.velocity) / (2 * h),
        "angular_acceleration": (after.angular_velocity - before.angular_velocity) / (2 * h),
    }
    turn = (after.pose.matrix - before.pose.matrix) / (2 * h) @ np.swapaxes(here.pose.matrix, -1, -2)
    central["angular_velocity"] = np.stack([turn[:, 2, 1], turn[:, 0, 2], turn[:, 1, 0]], axis=-1)
    for name, value in central.items():
        # central differences err by h^2/6 times a third derivative (here up to 1e2), rounding by 1e-16/h
        np.testing.assert_allclose(getattr(here, name), value, atol=1e-5, err_msg=name)


@pytest.mark.parametrize("ends", ["rest", "free", "periodic", "joined"])
def test_path_passes_its_waypoints_and_is_smooth_there(ends):
    p = path(ends)
    at = p(p.times).pose
    np.testing.assert_allclose(at.position, p.waypoints.position, atol=1e-14)
    np.testing.assert_allclose(at.matrix, p.waypoints.matrix, atol=1e-14)
    inner = p.times[1:-1]
    left, right = p(inner - 1e-9), p(inner + 1e-9)
    for name in ("velocity", "angular_velocity", "acceleration", "angular_acceleration"):
        # a jump would be of the order of the value, 1; over 2e-9 s a continuous one changes by less than 1e-6
        np.testing.assert_allclose(getattr(left, name), getattr(right, name), atol=1e-6)


@pytest.mark.parametrize("ends", ["rest", "joined"])
def test_path_starts_and_stops_at_rest(ends):
    p = path(ends)
    for end in (p(p.times[0]), p(p.times[-1])):
        for value in (end.velocity, end.angular_velocity, end.acceleration, end.angular_acceleration):
            np.testing.assert_allclose(value, 0, atol=1e-12)


def test_periodic_path_goes_on_smoothly():
    p = path("periodic")
    first, last = p(p.times[0]), p(p.times[-1])
    for name in ("velocity", "angular_velocity", "acceleration", "angular_acceleration"):
        np.testing.assert_allclose(getattr(first, name), getattr(last, name), atol=1e-10)


def test_rest_to_rest_between_two_poses_is_the_quintic_of_least_jerk():
    p = fx.Trajectory(waypoints()[:2], [0, 2.0])
    s = np.linspace(0, 1, 11)
    share = 10 * s**3 - 15 * s**4 + 6 * s**5
    a, b = p.waypoints.position
    np.testing.assert_allclose(p(2 * s).pose.position, a + np.outer(share, b - a), atol=1e-15)
    turn = Rotation.from_matrix(p.waypoints.matrix[1] @ p.waypoints.matrix[0].T).as_rotvec()
    expected = Rotation.from_rotvec(np.outer(share, turn)).as_matrix() @ p.waypoints.matrix[0]
    np.testing.assert_allclose(p(2 * s).pose.matrix, expected, atol=1e-14)


def test_length_is_that_of_a_straight_line_and_does_not_depend_on_time():
    a, b = waypoints()[0], waypoints()[1]
    p = fx.Trajectory(fx.Pose(np.stack([a.position, b.position]), np.stack([a.matrix, b.matrix])), [0, 3.0])
    angle = np.linalg.norm(Rotation.from_matrix(b.matrix @ a.matrix.T).as_rotvec())
    expected = np.hypot(np.linalg.norm(b.position - a.position), 0.3 * angle)
    assert p.length(0.3) == pytest.approx(expected, rel=1e-12)
    assert path().retimed(0.1).length(0.3) == pytest.approx(path().length(0.3), rel=1e-10)


def test_index_along_a_path_is_the_index_of_its_poses(machine):
    found = fx.path_index(machine, path(), samples=50, singular="keep")
    t = found.samples.time.values
    np.testing.assert_allclose(found.samples["index"], fx.stability_index(machine, path()(t).pose), rtol=1e-12)


def test_minimum_is_refined_between_samples(machine, measured):
    coarse = fx.path_index(machine, path(), samples=16)
    dense = np.linspace(2, path().times[-1], 20001)
    least = fx.stability_index(machine, path()(dense).pose).min()
    sampled = fx.stability_index(machine, path()(path().grid(16)).pose).min()
    assert sampled > least * (1 + 1e-5)  # so that refinement has something to do
    assert coarse.minimum <= least * (1 + 1e-9)
    measured("design/path-minimum", coarse.minimum / least - 1, 1e-6)  # of the dense samples' spacing


def test_times_below_the_bound(machine):
    bound = 200.0
    found = fx.path_index(machine, path(), bound=bound)
    assert found.below
    assert not found.above
    dense = np.linspace(2, path().times[-1], 4001)
    low = fx.stability_index(machine, path()(dense).pose) < bound
    inside = np.any([(dense > a) & (dense < b) for a, b in found.below], axis=0)
    assert (inside == low).mean() > 0.999  # all but samples that lie on an edge
    for edge in np.ravel(found.below):
        if 2.0 < edge < path().times[-1]:
            assert fx.stability_index(machine, path()(edge).pose) == pytest.approx(bound, rel=1e-9)
    assert fx.path_index(machine, path(), bound=0.99 * found.minimum).above


def test_weighted_cumulative_value(machine, measured):
    p = path(weights=[1, 0, 4, 2, 1])
    found = fx.path_index(machine, p, samples=2000)

    def integrand(t):
        return np.interp(t, p.times, p.weights) * fx.stability_index(machine, p(t).pose)

    exact = sum(quad(integrand, a, b, epsabs=1e-8)[0] for a, b in zip(p.times[:-1], p.times[1:], strict=True))
    # Simpson on 2000 samples, with kinks of the weights on samples but those of the index (crossing modes) between them
    measured("design/path-mean", float(found.samples.cumulative_index[-1]) / exact - 1, 1e-6)
    assert found.weighted_mean == pytest.approx(exact / np.trapezoid(p.weights, p.times), rel=1e-6)
    heavy = fx.path_index(machine, path(weights=[0, 0, 1, 0, 0])).weighted_mean
    assert heavy != pytest.approx(fx.path_index(machine, path()).weighted_mean, rel=1e-3)


def test_a_path_through_a_singular_pose_is_refused(machine):
    # pitch -0.57 to 0.78 and yaw -0.18 to 0.92: det H changes its sign twice on the straight line
    ends = fx.Pose.from_rpy(0, 0, 0.89, 0, [-0.57, 0.78], [-0.18, 0.92])
    p = fx.Trajectory(ends, [0, 1])
    with pytest.raises(fx.SingularPoseError, match=r"passes through a singular pose at t = 0\.6"):
        fx.path_index(machine, p)
    with pytest.raises(fx.SingularPoseError, match="no leg forces drive the path"):
        fx.paths.path_loads(machine, p)
    kept = fx.path_index(machine, p, bound=100, singular="keep")
    assert len(kept.crossings) == 2
    assert not kept.above
    for t in kept.crossings:
        omega = fx.natural_modes(machine, p(t).pose).omega
        assert omega[0] < 1e-6 * omega[5]  # zero to the accuracy of the time found


def test_leg_forces_follow_from_the_full_dynamics(machine, measured):
    p = path().retimed(0.4)
    loads = fx.paths.path_loads(machine, p, samples=2000)
    i = 701
    motion = p(loads.time.values[i])
    force = loads.leg_force.values[i]
    linear, angular = fx.forward_dynamics(machine, fx.Motion(motion.pose, motion.velocity, motion.angular_velocity),
                                          leg_force=force)  # fmt: skip
    np.testing.assert_allclose(linear, motion.acceleration, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(angular, motion.angular_acceleration, rtol=1e-9, atol=1e-9)
    assert np.abs(force - loads.static_force.values[i]).max() > 10  # at this speed inertia matters
    np.testing.assert_allclose(loads.stroke, np.ptp(loads.leg_length.values, axis=0))
    # the actuators' work is the change of kinetic (zero at both ends) and potential energy, and friction's loss
    power = loads.power.sum("leg")
    work = float(np.trapezoid(power, loads.time))
    rise = fx.energy(machine, p(p.times[-1])).gravitational - fx.energy(machine, p(p.times[0])).gravitational
    lost = np.trapezoid(fx.energy(machine, p(loads.time.values)).dissipation, loads.time)
    measured("design/path-work", work / (rise + lost) - 1, 1e-5)  # trapezoids on 2000 samples


@pytest.mark.parametrize(
    ("build", "words"),
    [
        (lambda: fx.Trajectory(waypoints(), [0, 1, 2]), r"times has shape \(3,\); it must have shape \(5,\)"),
        (lambda: fx.Trajectory(waypoints(), [0, 1, 2, 3, np.nan]), "NaN or infinity"),
        (lambda: fx.Trajectory(waypoints(), range(5), ends="stop"), "it must be one of 'rest', 'free', 'periodic'"),
        (lambda: fx.Trajectory(waypoints(), range(5), weights=[1, 1, -1, 1, 1]), "weights must be >= 0"),
        (lambda: path().retimed(0), "must be finite and > 0"),
        (lambda: fx.path_index(fx.load("mukherjee-i"), path(), bound=-1), "bound is -1 rad/s; it must be finite and > 0"),
        (lambda: fx.path_index(fx.load("mukherjee-i"), waypoints()), "must be a flexapod Trajectory"),
        (lambda: fx.paths.plan_slice(fx.load("mukherjee-i"), path()), "what flexapod.plan_path gives"),
    ],
)  # fmt: skip
def test_wrong_arguments_are_told(build, words):
    with pytest.raises(fx.ArgumentError, match=words):
        build()


@pytest.mark.parametrize(
    ("build", "words"),
    [
        (lambda: fx.Trajectory(waypoints(), [0, 1, 1, 2, 3]), r"times\[2\] is 1 s, after 1 s; times must increase"),
        (lambda: fx.Trajectory(waypoints()[0], [0]), "at least two poses"),
        (lambda: fx.Trajectory(waypoints(), range(5), ends="periodic"), "must end where it starts"),
        (lambda: fx.Trajectory(fx.Pose.from_rpy(0, 0, 1, 0, 0, np.array([-0.1, 0, 0.1, 3.1])), range(4)), "Split the path"),
        (lambda: path()(10.0), "the path runs from 2 to"),
    ],
)  # fmt: skip
def test_wrong_paths_are_told_what_is_wrong(build, words):
    with pytest.raises(fx.errors.PathError, match=words):
        build()


def test_sampling_time_over_poses_paths_and_boxes(machine):
    p = path()
    omega = fx.natural_modes(machine, p(np.linspace(2, p.times[-1], 5001)).pose).omega[:, 5].max()
    rule = 2 * np.pi / (20 * omega)
    assert fx.control.sampling_time(float(omega)) == pytest.approx(rule)
    assert fx.control.sampling_time(machine, p) == pytest.approx(rule, rel=1e-6)
    assert fx.control.sampling_time(machine, p) <= rule * (1 + 1e-12)
    batch = waypoints()
    expected = 2 * np.pi / (20 * fx.natural_modes(machine, batch).omega[:, 5].max())
    assert fx.control.sampling_time(machine, batch) == pytest.approx(expected)
    box = fx.Box(x=(-0.1, 0.1), y=(-0.1, 0.1), z=(0.8, 1.0), yaw=(-0.2, 0.2))
    dense = fx.sweep(machine, fx.random_poses(box, 200_000, seed=5), quantities=["omega"]).omega.values[:, 5].max()
    found = 2 * np.pi / (20 * fx.control.sampling_time(machine, box))
    assert found >= dense * (1 - 1e-9)  # as high as an independent dense sweep shows
    assert found == pytest.approx(dense, rel=2e-2)
    with pytest.raises(fx.PoseError, match="give a Workspace, a Box, a PoseSet, a Pose, a Trajectory"):
        fx.control.sampling_time(machine, "everywhere")
    with pytest.raises(fx.ArgumentError, match="must be finite and > 0"):
        fx.control.sampling_time(-1.0)


RATES = ("velocity", "angular_velocity", "acceleration", "angular_acceleration")


def numbers_of(motion):
    matrix = motion.pose.matrix.reshape(*motion.pose.shape, 9)
    return np.concatenate([matrix, motion.pose.position, *(getattr(motion, name) for name in RATES)], axis=-1)


@pytest.mark.parametrize("ends", ["rest", "free", "periodic"])
def test_a_path_joined_to_home_is_itself_between(ends):
    inner = path(ends)
    joined = inner.between(HOME, 1.5)
    assert (joined.start, joined.ends, joined.waypoints.shape) == (inner.start - 1.5, "rest", (len(inner.times) + 2,))
    assert joined.duration == pytest.approx(inner.duration + 3.0, rel=1e-15)
    t = inner.grid(200)[:-1]
    np.testing.assert_array_equal(numbers_of(joined(t)), numbers_of(inner(t)))
    np.testing.assert_allclose(numbers_of(joined(inner.times[-1])), numbers_of(inner(inner.times[-1])), atol=1e-12)
    np.testing.assert_allclose(joined(joined.times[[0, -1]]).pose.position, [HOME.position] * 2, atol=1e-15)
    np.testing.assert_allclose(joined(joined.times[[0, -1]]).pose.matrix, [HOME.matrix] * 2, atol=1e-14)
    for join in inner.times[[0, -1]]:
        near = joined([np.nextafter(join, 0), join, np.nextafter(join, np.inf)])
        np.testing.assert_allclose(numbers_of(near), [numbers_of(inner(join))] * 3, atol=1e-12)


def test_a_joined_path_in_another_time_and_as_polynomials():
    inner = path("free")
    joined = inner.between(HOME, 1.5)
    slow = joined.retimed(3 * joined.duration)
    t = joined.grid(50)
    there, later = joined(t), slow(slow.start + 3 * (t - joined.start))
    np.testing.assert_allclose(later.pose.position, there.pose.position, atol=1e-14)
    np.testing.assert_allclose(later.angular_velocity, there.angular_velocity / 3, atol=1e-13)
    np.testing.assert_allclose(later.acceleration, there.acceleration / 9, atol=1e-13)
    pieces, middle, spans = joined.polynomials()
    assert pieces.shape == (len(joined.times) - 1, 6, 6)  # that of the cubic has zeros above
    begin = joined.start + np.concatenate([[0.0], np.cumsum(spans[:-1, 2])])
    for six, at, length in zip(pieces, begin, spans[:, 2], strict=True):
        since = np.linspace(0, length, 7)
        q = np.polynomial.polynomial.polyval(since, six.T).T
        pose = joined(np.clip(at + since, *joined.times[[0, -1]])).pose
        np.testing.assert_allclose(q[:, :3], pose.position, atol=1e-13)
        np.testing.assert_allclose(Rotation.from_rotvec(q[:, 3:]).as_matrix() @ middle, pose.matrix, atol=1e-13)


@pytest.mark.parametrize(
    ("pose", "lead", "error", "words"),
    [
        (HOME, 0, fx.ArgumentError, "lead is 0 s"),
        (HOME, 1e-17, fx.errors.PathError, r"times\[1\] is 2 s, after 2 s; times must increase"),
        (HOME, 1e13, fx.errors.PathError, r"the path lasts 2e\+13 s; it must last at least"),
        (waypoints(), 1.0, fx.PoseError, "batch axes"),
        ([0, 0, 0.9, 0, 0, 3.1], 1.0, fx.errors.PathError, "pose is turned by 1.* deg from the mean orientation of the waypoints"),
    ],
)  # fmt: skip
def test_what_a_path_cannot_be_joined_to(pose, lead, error, words):
    with pytest.raises(error, match=words):
        path().between(pose, lead)
