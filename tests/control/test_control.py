"""Position loops and active damping on the exact tangent: poles against closed forms, gains, schedules, errors."""

import warnings

import numpy as np
import pytest
from scipy.linalg import eigh
from tests.helpers.plain import plain_machine

import control
import flexapod as fx
from flexapod.control.controllers import damping_law
from flexapod.control.gain_search import best_gain, default_gains
from flexapod.control.plant import Plant, poles, poles_over
from flexapod.mechanics.linearisation import linearise

# The isolator in orbit, without friction: every mode a pure spring, so that Preumont's closed forms hold.
ORBIT = {"gravity": [0, 0, 0], "legs.damping.prismatic": 0.0}


@pytest.fixture(scope="module")
def isolator():
    return plain_machine("cubic-isolator")


@pytest.fixture(scope="module")
def orbit(isolator):
    return isolator.replace(ORBIT)


def uneven(hexapod):
    """The same with six different stiffnesses, so that no mode is repeated or out of a leg's reach."""
    return hexapod.replace({f"legs.stiffness[{i}]": 1e4 * (1 + 0.1 * i) for i in range(6)})


def even(*squares):
    """Coefficients of prod(s^2 + square)."""
    out = np.array([1.0])
    for square in squares:
        out = np.polymul(out, [1.0, 0.0, square])
    return out


def mismatch(found, expected):
    """How far each expected pole is from one of those found, (n,), relative to the largest."""
    assert len(found) == len(expected)
    left, off = list(found), []
    for pole in expected:
        distance = np.abs(np.array(left) - pole)
        off.append(distance.min())
        left.pop(int(distance.argmin()))
    return np.array(off) / np.abs(expected).max()


def matched(found, expected, tolerance):
    """Every expected pole has one of those found within `tolerance` of it, relative to the largest."""
    off = mismatch(found, expected)
    assert (off < tolerance).all(), f"{expected[off.argmax()]} is missing; the nearest is off by {off.max()}"


@pytest.mark.parametrize("gain", [3.0, 30.0, 300.0])
def test_one_force_loop_has_the_poles_of_the_closed_form(orbit, gain, measured):
    """s prod(s^2 + w_i^2) + g prod(s^2 + z_i^2) = 0, z the frequencies without that leg's stiffness (Preumont)."""
    h, pose = uneven(orbit), fx.home_pose(orbit)
    J = fx.equations_of_motion(h, pose).J_p
    H = fx.force_transformation(h, pose)
    k = h.legs.stiffness
    w2 = eigh((H * k) @ H.T, J, eigvals_only=True)
    without = k.copy()
    without[2] = 0.0
    z2 = eigh((H * without) @ H.T, J, eigvals_only=True)
    z2[0] = 0.0
    polynomial = np.polyadd(np.polymul([1.0, 0.0], even(*w2)), gain * even(*z2))
    found = fx.control.closed_loop(
        h, pose, fx.control.ForceFeedback(gain, legs=(3,)), unstable="keep", nearness=0.0
    ).pole
    # the double zero at s = 0 that polynomial and loop share is found to the root of rounding
    measured("control/force", mismatch(found, np.roots(polynomial)), 1e-6)


@pytest.mark.parametrize("gain", [10.0, 200.0, 5000.0])
def test_one_velocity_loop_has_the_poles_of_the_closed_form(orbit, gain, measured):
    """prod(s^2 + w_i^2) + g s c prod(s^2 + z_i^2) = 0, z the frequencies with that leg locked; c = h^T J^-1 h."""
    h, pose = uneven(orbit), fx.home_pose(orbit)
    tangent = linearise(h, pose)
    column = tangent.H[:, 4]
    w2 = eigh(tangent.K, tangent.M, eigvals_only=True)
    z = fx.control.open_zeros(tangent, "velocity", (5,))
    assert len(z) == 5
    c = column @ np.linalg.solve(tangent.M, column)
    polynomial = np.polyadd(even(*w2), gain * c * np.polymul([1.0, 0.0], even(*z**2)))
    found = fx.control.closed_loop(h, pose, fx.control.VelocityFeedback(gain, legs=(5,)), nearness=0.0).pole
    measured("control/velocity", mismatch(found, np.roots(polynomial)), 1e-8)


def test_equal_loops_on_all_legs_damp_every_mode_by_the_closed_form(orbit):
    """s^2 + g s + w^2 = 0 for force feedback (and s = 0), s^2 + (g w^2/k) s + w^2 = 0 for velocity feedback."""
    pose = fx.home_pose(orbit)
    omega = fx.natural_modes(orbit, pose).omega
    for gain in (5.0, 20.0):
        pole = fx.control.closed_loop(orbit, pose, fx.control.ForceFeedback(gain), unstable="keep", nearness=0.0).pole
        expected = np.concatenate([np.zeros(6), *(np.roots([1, gain, w**2]) for w in omega)])
        matched(pole, expected, 1e-7)
    k = float(orbit.legs.stiffness[0])
    for gain in (50.0, 200.0):
        pole = fx.control.closed_loop(orbit, pose, fx.control.VelocityFeedback(gain), nearness=0.0).pole
        matched(pole, np.concatenate([np.roots([1, gain * w**2 / k, w**2]) for w in omega]), 1e-9)


def test_most_damping_of_one_mode_is_preumonts(orbit):
    """Each mode w with a zero z has at most (w - z)/(2 z) of damping, at g = w sqrt(w/z): a leg beside a passive one.

    A platform on soft and stiff legs in which one mode couples to the loops alone: all legs have a loop and a spring
    beside it, so that the zeros are z = w sqrt(share) for every mode.
    """
    pose = fx.home_pose(orbit)
    tangent = linearise(orbit, pose)
    share = 0.25  # of the stiffness stays passive: the zeros lie at half the poles
    w = np.sqrt(eigh(tangent.K, tangent.M, eigvals_only=True))
    z = w * np.sqrt(share)
    plant = Plant(tangent)
    active = (1 - share) * orbit.legs.stiffness[0]

    def pole(g):  # the loop sees only the active part of the leg's force: f' = -g (f - active H^T x)
        law = fx.control.Controller(
            -g * np.eye(6), g * active * np.eye(6), np.eye(6), np.zeros((6, 6)), ("leg_length",), "beside"
        )
        return poles(plant, law)

    for i in (0, 5):
        g = w[i] * np.sqrt(w[i] / z[i])
        found = pole(g)
        mine = np.roots(np.polyadd(np.polymul([1, 0], [1, 0, w[i] ** 2]), g * np.array([1, 0, z[i] ** 2])))
        vibrating = mine[mine.imag > 0][0]
        assert -vibrating.real / abs(vibrating) == pytest.approx((w[i] - z[i]) / (2 * z[i]), rel=1e-12)
        assert np.abs(found - vibrating).min() < 1e-8 * w[i]


def test_root_locus_runs_from_poles_to_zeros(orbit):
    h, pose = uneven(orbit), fx.home_pose(orbit)
    locus = fx.control.root_locus(h, pose, "force", legs=(1, 4), gains=np.geomspace(1e-5, 1e8, 300))
    omega = fx.natural_modes(h, pose).omega
    for end, goals in ((0, omega), (-1, locus.zero.values[locus.zero.values > 1e-3])):
        upper = locus.pole.values[end]
        upper = np.sort(upper[upper.imag > 1e-3].imag)
        np.testing.assert_allclose(upper, np.sort(goals), rtol=1e-6)
    steps = np.abs(np.diff(locus.pole.values, axis=0))
    assert np.median(steps) < 0.05 * omega[5]  # branches are followed, not shuffled


def test_best_gain_is_best(isolator):
    pose = fx.home_pose(isolator)
    locus = fx.control.root_locus(isolator, pose, "force", leak=3.0)
    best, damping = locus.attrs["best_gain"], locus.attrs["best_damping"]
    assert damping > 0.2
    for factor in (0.97, 1.03):
        law = fx.control.ForceFeedback(best * factor, 3.0)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", fx.control.GainWarning)
            assert fx.control.closed_loop(isolator, pose, law, unstable="keep").worst_damping < damping


def test_gravity_makes_pure_integral_feedback_unstable(isolator):
    """The loop takes the legs' static stiffness away, and the weight then topples the platform: a leak is needed."""
    pose = fx.home_pose(isolator)
    with pytest.raises(
        fx.errors.UnstableError, match=r"unstable with integral force feedback: the pole at .* needs a leak"
    ):
        fx.control.closed_loop(isolator, pose, fx.control.ForceFeedback(60.0))
    assert fx.control.closed_loop(isolator, pose, fx.control.ForceFeedback(20.0, leak=5.0)).stable
    assert not fx.control.closed_loop(isolator, pose, fx.control.ForceFeedback(60.0), unstable="keep").stable


def python_control_poles(hexapod, pose, kp, kd):
    """The same loop closed by python-control on `Linearisation.to_control`, with its own differentiation of lengths."""
    system = linearise(hexapod, pose).to_control()
    legs = [f"leg_force_{i}" for i in range(1, 7)]
    lengths = [f"leg_length_{i}" for i in range(1, 7)]
    plant = system[lengths, legs]
    A, B, C = (np.asarray(m) for m in (plant.A, plant.B, plant.C))
    return np.linalg.eigvals(A - B @ (kp * C + kd * C @ A))  # C B = 0: rates are C A x


@pytest.mark.parametrize("name", ["cubic-isolator", "precision-positioner", "motion-base"])
def test_pd_poles_agree_with_python_control(name, measured):
    h = plain_machine(name)
    pose = fx.home_pose(h)
    k = float(h.legs.stiffness[0])
    kp, kd = 0.7 * k, 0.4 * k / fx.stability_index(h, pose)
    found = fx.control.closed_loop(h, pose, fx.control.PID(kp, kd), nearness=0.0).pole
    measured("control/position", mismatch(found, python_control_poles(h, pose, kp, kd)), 1e-9)


def test_what_gains_mean(orbit):
    """Forces and commands, joints and task, agree where they must."""
    pose = fx.home_pose(orbit)
    k = float(orbit.legs.stiffness[0])
    omega = fx.natural_modes(orbit, pose).omega

    def pole(**gains):
        return fx.control.closed_loop(orbit, pose, fx.control.PID(**gains), nearness=0.0).pole

    matched(pole(kp=0.5 * k, kd=100.0), pole(kp=0.5, kd=100.0 / k, actuator="command"), 1e-10)
    # a command of minus the leg's stretch is as good as a stiffer leg, in joint and in task space
    matched(pole(kp=0.5, kd=0.01, actuator="command"), pole(kp=0.5, kd=0.01, space="task", actuator="command"), 1e-9)
    stiffer = orbit.replace({"legs.stiffness": 1.5 * k})
    np.testing.assert_allclose(
        pole(kp=0.5, actuator="command", kd=1e-9).imag.max(), fx.natural_modes(stiffer, pose).omega[5], rtol=1e-9
    )
    # task space, force: gains per inertia shift every mode alike
    p, d = 300.0, 11.0
    matched(pole(kp=p, kd=d, space="task"), np.concatenate([np.roots([1, d, w**2 + p]) for w in omega]), 1e-9)
    # and with the integral
    i = 900.0
    expected = np.concatenate([np.roots([1, d, w**2 + p, i]) for w in omega])
    matched(pole(kp=p, kd=d, ki=i, space="task"), expected, 1e-8)


def test_filtered_derivative_tends_to_the_rate(orbit):
    pose = fx.home_pose(orbit)
    ideal = fx.control.closed_loop(orbit, pose, fx.control.PID(2e3, 150.0, 400.0), nearness=0.0).pole
    filtered = fx.control.closed_loop(orbit, pose, fx.control.PID(2e3, 150.0, 400.0, bandwidth=1e6), nearness=0.0).pole
    slow = filtered[np.abs(filtered) < 1e4]
    matched(slow, ideal, 1e-3)  # of the order of omega/bandwidth


def test_sampling_adds_nothing_when_it_is_fast_and_lag_when_it_is_slow(isolator):
    pose = fx.home_pose(isolator)
    law = fx.control.PID(2e3, 150.0, bandwidth=500.0).on(linearise(isolator, pose))
    ideal = fx.control.closed_loop(isolator, pose, law, nearness=0.0)
    fast = fx.control.closed_loop(isolator, pose, law.sampled(1e-5), nearness=0.0)
    slow = [fx.control.closed_loop(isolator, pose, law.sampled(dt), nearness=0.0).worst_damping for dt in (1e-3, 4e-3)]
    assert fast.worst_damping == pytest.approx(ideal.worst_damping, rel=2e-3)  # lag of half a sample: omega dt/2
    assert ideal.worst_damping > slow[0] > slow[1]
    late = fx.control.closed_loop(isolator, pose, law.sampled(1e-3, delay=2), nearness=0.0).worst_damping
    assert late < slow[0]


@pytest.mark.parametrize("method", ["tustin", "zoh"])
def test_sampled_controllers_are_those_of_another_toolbox(method, isolator):
    law = fx.control.PID(2e3, 150.0, 400.0, bandwidth=500.0).on(linearise(isolator, fx.home_pose(isolator)))
    found = law.sampled(2e-3, method)
    expected = control.sample_system(control.ss(law.A, law.B, law.C, law.D), 2e-3, method=method)
    for name in "ABCD":
        matrix = getattr(expected, name)
        assert getattr(found, name) == pytest.approx(matrix, rel=1e-12, abs=1e-12 * np.abs(matrix).max())


def test_a_pole_that_tustins_rule_sends_to_infinity_is_told():
    law = fx.control.Controller(np.array([[2e3]]), np.ones((1, 6)), np.ones((6, 1)), np.eye(6), ("leg_rate",), "odd")
    with pytest.raises(fx.errors.ArgumentError, match="odd has a pole at 2/dt"):
        law.sampled(1e-3)
    assert pytest.approx((1 + 1.1) / (1 - 1.1)) == law.sampled(1.1e-3).A


def test_gain_map_agrees_with_single_loops_and_warns(isolator):
    pose = fx.home_pose(isolator)
    with pytest.warns(fx.control.GainWarning, match="pairs of gains put a pole within 10% of a natural frequency"):
        found = fx.control.gain_map(isolator, pose, kp=[0.0, 4e3], kd=[0.0, 30.0, 400.0])
    assert found.attrs["natural_frequencies_rad_s"] == linearise(isolator, pose).modes().omega.tolist()
    for i, kp in enumerate((0.0, 4e3)):
        for j, kd in enumerate((0.0, 30.0, 400.0)):
            with warnings.catch_warnings(record=True) as heard:
                warnings.simplefilter("always")
                one = fx.control.closed_loop(isolator, pose, fx.control.PID(kp, kd))
            assert float(found.worst_damping[i, j]) == one.worst_damping
            assert bool(found.near[i, j]) == bool(one.near) == bool(heard)
            assert bool(found.stable[i, j])
            vibrating = one.pole.imag > 0
            assert float(found.distance[i, j]) == one.distance[vibrating].min()
    assert bool(found.near[0, 0])  # no gain at all: the poles are those of the machine
    assert not bool(found.near[1, 2])


def test_gain_map_marks_unstable_gains(isolator):
    k = float(isolator.legs.stiffness[0])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fx.control.GainWarning)
        found = fx.control.gain_map(isolator, fx.home_pose(isolator), kp=[-1.5 * k, 0.0], kd=[10.0, 20.0])
    assert not found.stable.sel(kp=-1.5 * k).any()
    assert found.stable.sel(kp=0.0).all()


def test_schedule_keeps_the_damping_that_one_gain_loses():
    h = plain_machine("motion-base")
    poses = fx.pose_grid(z=[2.2, 2.4, 2.6, 2.8], yaw=[0.0, 0.2])
    found = fx.control.gain_schedule(h, poses, "velocity", damping=0.3)
    assert found.gain.dims == ("z", "yaw")
    np.testing.assert_allclose(found.least_damping, 0.3, rtol=1e-9)
    assert float(found.fixed_damping.min()) < 0.29
    at = fx.Pose.from_rpy(0, 0, 2.6, 0, 0, 0.2)
    gain = float(found.gain.sel(z=2.6, yaw=0.2))
    assert fx.control.closed_loop(h, at, fx.control.VelocityFeedback(gain)).worst_damping == pytest.approx(
        0.3, rel=1e-9
    )
    between = float(found.gain.interp(z=2.5, yaw=0.1))
    loop = fx.control.closed_loop(h, fx.Pose.from_rpy(0, 0, 2.5, 0, 0, 0.1), fx.control.VelocityFeedback(between))
    assert loop.worst_damping == pytest.approx(0.3, rel=0.02)  # linear between poses 0.2 m and 0.2 rad apart


def test_schedule_of_an_own_law_and_of_bad_poses():
    h = plain_machine("cubic-isolator")
    home = fx.home_pose(h)
    poses = fx.Pose(np.stack([home.position, [0.0, 0.0, 0.0]]), np.stack([home.matrix, home.matrix]))
    found = fx.control.gain_schedule(
        h, poses, lambda g: fx.control.PID(0.0, g), gains=np.geomspace(1, 1e3, 10), damping=0.2
    )
    assert found.status.values[0] == "ok"
    assert float(found.least_damping[0]) == pytest.approx(0.2)
    none = fx.control.gain_schedule(h, home.position[None] @ np.zeros((3, 6)) + [0, 0, home.position[2], 0, 0, 0],
                            lambda g: fx.control.PID(-1e6, g), gains=np.geomspace(1, 1e3, 4))  # fmt: skip
    assert none.status.values.tolist() == ["no_gain"]
    assert np.isnan(none.gain.values).all()


@pytest.mark.parametrize(
    ("call", "error", "words"),
    [
        (lambda h, p: fx.control.PID(np.ones(5)), fx.ArgumentError, "a finite number, six numbers, or a 6 x 6"),
        (lambda h, p: fx.control.PID(1, 1, space="leg"), fx.ArgumentError, "must be one of 'joint', 'task'"),
        (lambda h, p: fx.control.PID(1, 1, bandwidth=0), fx.ArgumentError, "bandwidth is 0 rad/s"),
        (lambda h, p: fx.control.ForceFeedback(-1.0), fx.ArgumentError, "gain is -1.0"),
        (lambda h, p: fx.control.VelocityFeedback(1.0, legs=(0, 1)), fx.ArgumentError, "numbers from 1 to 6"),
        (
            lambda h, p: fx.control.closed_loop(h, p, fx.control.PID(-1e6)),
            fx.errors.UnstableError,
            "the machine is unstable with joint-space",
        ),
        (lambda h, p: fx.control.root_locus(h, p, "speed"), fx.ArgumentError, "must be one of 'force', 'velocity'"),
        (lambda h, p: fx.control.root_locus(h, p, gains=[1.0, -1.0]), fx.ArgumentError, "ascending gains > 0"),
        (lambda h, p: fx.control.gain_map(h, p, kp=[1.0, 1.0], kd=[1.0]), fx.ArgumentError, "different, finite gains"),
        (lambda h, p: fx.control.gain_schedule(h, p, lambda g: fx.control.PID(g)), fx.ArgumentError, "needs `gains`"),
        (lambda h, p: fx.control.gain_schedule(h, p, damping=2.0), fx.ArgumentError, "between 0 and 1"),
        (lambda h, p: fx.control.lqg(h, p, measure="jerk"), fx.ArgumentError, "one or several of leg_length"),
        (lambda h, p: fx.control.lqg(h, p, noise=0.0), fx.ArgumentError, "noise is 0.0; it must be finite and > 0"),
        (lambda h, p: fx.control.lqg(h, p).sampled(-1.0), fx.ArgumentError, "dt is -1.0 s; it must be finite and > 0"),
        (lambda h, p: fx.control.lqg(h, p).sampled(1e-3).sampled(1e-3), fx.ArgumentError, "sampled already"),
    ],
)
def test_wrong_arguments_are_told_what_is_wrong(isolator, call, error, words):
    with pytest.raises(error, match=words):
        call(isolator, fx.home_pose(isolator))


@pytest.mark.parametrize(
    ("wrong", "error"),
    [
        ({"joint": "spin-free"}, fx.ArgumentError),
        ({"force": [1, 2]}, fx.ArgumentError),
        ({"moment": "up"}, fx.ArgumentError),
        ({"leak": -1.0}, fx.ArgumentError),
        ({"feedback": "speed"}, fx.ArgumentError),
        ({"base": "floor"}, fx.PoseError),
        ({"base": np.zeros((2, 6))}, fx.PoseError),
        ({"region": "home"}, fx.PoseError),
        ({"hexapod": "cubic-isolator"}, fx.DesignError),
    ],
)
def test_a_wrong_argument_is_not_taken_for_a_pose_without_rest(isolator, wrong, error):
    given = {"hexapod": isolator, "region": fx.home_pose(isolator), "feedback": "velocity", **wrong}
    if "leak" in wrong:
        given["feedback"] = "force"
    with pytest.raises(error):
        fx.control.gain_schedule(**given)


@pytest.mark.parametrize(
    "call",
    [
        fx.control.closed_loop,
        fx.control.root_locus,
        fx.control.lqg,
        fx.control.h_infinity,
        fx.control.sampling_time,
        lambda h, **options: fx.control.gain_map(h, None, kp=[1.0], kd=[1.0], **options),
        lambda h, **options: fx.control.controlled_transmissibility(
            h, None, controller=fx.control.PID(), omega=[1.0], **options
        ),
    ],
)
def test_studies_take_a_hexapod_and_refuse_a_name(call):
    with pytest.raises(fx.DesignError, match="it must be a flexapod Hexapod"):
        call("cubic-isolator")
    with pytest.raises(fx.ArgumentError, match="joint is 'spin-free'"):
        call(plain_machine("cubic-isolator"), joint="spin-free")
    with pytest.raises(TypeError, match="dampling"):
        call(plain_machine("cubic-isolator"), dampling=0.1)


def test_the_home_pose_is_taken_where_none_is_given(isolator):
    home = fx.home_pose(isolator)
    six = [*home.position, *home.rpy]
    law = fx.control.VelocityFeedback(400.0)
    for pose in (home, six):
        np.testing.assert_array_equal(
            fx.control.closed_loop(isolator, pose, law).pole, fx.control.closed_loop(isolator, controller=law).pole
        )
        assert fx.control.sampling_time(isolator, pose) == fx.control.sampling_time(isolator)


def test_no_loop_at_all_leaves_the_machine_as_it_is(isolator):
    pose = fx.home_pose(isolator)
    with pytest.warns(fx.control.GainWarning, match="lie within 10% of a natural frequency"):
        loop = fx.control.closed_loop(isolator, pose, fx.control.PID())
    modes = linearise(isolator, pose).modes()
    matched(loop.pole, np.concatenate([modes.pole, modes.pole.conj()]), 1e-10)


@pytest.mark.filterwarnings("ignore::flexapod.control.GainWarning")  # it comes near to what it is short of
def test_best_sampled_gain_leaves_the_machine_its_stiffness(isolator):
    """The most damping lies where force feedback takes the static stiffness away; the best gain is short of that."""
    pose, tangent = fx.home_pose(isolator), fx.linearise(isolator, fx.home_pose(isolator))
    plant, dt = Plant(tangent), fx.control.sampling_time(isolator, pose)
    for leak in (3.0, 0.1 * float(tangent.modes().omega[0])):

        def sampled(gain, leak=leak):
            return damping_law("force", gain, leak).on(tangent).sampled(dt)

        gain, _ = best_gain(plant, sampled, default_gains(plant, "force")[::5])
        loop = fx.control.closed_loop(isolator, pose, sampled(gain))
        assert loop.stable
        assert loop.pole.real.max() < -1e-3 * loop.omega[0]


@pytest.mark.parametrize("feedback", ["force", "velocity"])
def test_poles_over_gains_are_those_of_each(isolator, feedback):
    plant = Plant(fx.linearise(isolator))

    def law(gain):
        return damping_law(feedback, gain, 3.0 if feedback == "force" else 0.0).on(plant.linear)

    gains = np.geomspace(1.0, 1e3, 7)
    for gain, found in zip(gains, poles_over(plant, law, gains), strict=True):
        alone = poles(plant, law(gain))
        nearest = np.abs(found[:, None] - alone).min(axis=1)
        assert nearest.max() < 1e-6 * np.abs(alone).max()  # several are the same: their digits are fewer
        assert found.sum() == pytest.approx(alone.sum(), rel=1e-9)
