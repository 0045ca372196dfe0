"""Corners of motion, vibration and control: exact resonances, touched singular poses, designs that fail."""

import numpy as np
import pytest
import slycot

import control
import flexapod as fx
from flexapod.control import isolation
from flexapod.control.h_infinity_synthesis import suboptimal_controller
from flexapod.control.plant import Controller, Plant
from flexapod.mechanics import statics
from flexapod.mechanics.linearisation import linearise
from flexapod.paths.ompl_planner import search
from flexapod.paths.planning_task import PlanningTask
from flexapod.paths.requirements import Margins
from flexapod.plots import animation
from flexapod.pose import rotation_from_vector
from flexapod.simulation.integrator import equations
from flexapod.simulation.run import SimulationRun
from flexapod.vibration import stepped
from flexapod.vibration.harmonic import _solve

TIMES = np.linspace(0, 0.3, 40)


@pytest.fixture(scope="module")
def machine():
    return fx.load("mukherjee-i")


@pytest.fixture(scope="module")
def isolator():
    hexapod = fx.load("cubic-isolator")
    return hexapod, fx.home_pose(hexapod)


@pytest.mark.parametrize(
    "one",
    [
        fx.harmonic("x", [1e-3, 2e-3], [20.0, 33.0], 0.3),
        fx.sine_sweep("x", 1e-3, 10.0, 60.0, 0.2),
        fx.excitation.smooth_step("x", 1e-3, 0.1),
        fx.half_sine_shock("x", 5.0, 0.02, recovery=0.1),
        fx.excitation.time_series(np.linspace(0, 0.3, 60), np.sin(np.linspace(0, 9, 60)), "x"),
    ],
    ids=["sines", "sweep", "step", "shock", "recording"],
)
def test_an_excitation_times_a_number_is_as_much_larger(one):
    for scaled in (-2.5 * one, one * -2.5):
        for found, expected in zip(scaled.evaluate(TIMES), one.evaluate(TIMES), strict=True):
            np.testing.assert_allclose(found, -2.5 * expected, rtol=1e-13, atol=1e-13 * np.abs(expected).max())


def test_equations_for_other_integrators_are_the_forward_dynamics(machine):
    """The state is the platform seen from a base at rest: displacement from rest and velocities."""
    pose = fx.Pose.from_rpy(0.05, 0.02, 0.89, 0.1, 0.0, 0.2)
    found = equations(SimulationRun(machine, pose))
    np.testing.assert_array_equal(found.start(), np.zeros(12))
    y = np.array([1e-3, -2e-3, 5e-4, 0.01, -0.02, 0.015, 0.3, -0.1, 0.2, 0.5, 0.4, -0.6])
    turn = fx.Pose(np.zeros(3), rotation_from_vector(y[3:6])).matrix @ pose.matrix
    moved = fx.Motion(fx.Pose(pose.position + y[:3], turn), y[6:9], y[9:])
    lengths = fx.hold(machine, pose).unstretched_length
    force = machine.legs.stiffness * (lengths - fx.inverse_kinematics(machine, moved.pose))
    expected = np.concatenate(fx.forward_dynamics(machine, moved, leg_force=force))
    np.testing.assert_allclose(found.rates(0.0, y)[6:], expected, rtol=1e-9)


def test_a_resonance_without_damping_hit_exactly_is_infinite_and_only_there():
    Z = np.stack([np.zeros((6, 6)), 2.0 * np.eye(6)]).astype(complex)
    right = np.ones((2, 6, 3), dtype=complex)
    found = _solve(Z, right)
    assert np.isinf(found[0]).all()
    np.testing.assert_array_equal(found[1], 0.5 * right[1])


def test_an_equilibrium_search_that_meets_a_singular_pose_says_where(machine, monkeypatch):
    """Rounding hardly ever lets it be singular to the last digit, so the core's word for it is put in its mouth."""
    real = statics._core.settle
    monkeypatch.setattr(statics._core, "settle", lambda *given: (real(*given)[0], statics._core.Rest.singular))
    lengths = fx.inverse_kinematics(machine, fx.Pose([0, 0, 0.89]))
    with pytest.raises(
        fx.SingularPoseError, match=r"the search for equilibrium met Pose\(.*no stiffness in some direction"
    ):
        fx.static_equilibrium(machine, lengths, start=fx.Pose([0, 0, 0.89]))


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
    monkeypatch.setattr(PlanningTask, "worst", lambda task, path, samples=400: np.array([-0.1, 0.2]))
    with pytest.raises(fx.errors.PathError, match=r"a way was found, but no smooth path along it .* misses by 1"):
        fx.plan_path(machine, fx.Pose([0, 0, 0.89]), fx.Pose.from_rpy(0.05, 0, 0.9), 90.0)


def test_a_stepped_sine_that_runs_out_of_tries_says_so(monkeypatch):
    hexapod = fx.load("mukherjee-ii")
    monkeypatch.setattr(stepped, "_ITERATIONS", 1)
    found = fx.stepped_sine(
        hexapod, fx.home_pose(hexapod), omega=[300.0, 400.0], amplitude=1e-4, axis="z", tolerance=1e-14
    )
    assert found.status.values.tolist() == ["not_found"] * 2


def test_a_simulation_of_one_instant_is_no_film(isolator, tmp_path):
    hexapod, pose = isolator
    one = fx.simulate(hexapod, pose, duration=0.01, samples=2).isel(time=[0])
    with pytest.raises(fx.ArgumentError, match="fewer than two instants; nothing moves"):
        fx.animate_simulation(one, hexapod, tmp_path / "run.gif")


@pytest.mark.parametrize(("metres", "words"), [(2.5, "2.5 m"), (0.0123, "12.3 mm"), (4e-6, "4 um"), (5e-10, "0.5 nm")])
def test_lengths_have_units_of_their_size(metres, words):
    assert animation._length(metres) == words


def test_a_loop_of_gain_one_through_itself_is_not_well_posed(isolator):
    hexapod, pose = isolator
    plant = Plant(linearise(hexapod, pose))
    D = np.linalg.inv(plant.D[plant.measured(("acceleration",))])
    none = np.zeros((0, 0)), np.zeros((0, 6)), np.zeros((6, 0))
    law = Controller(*none, D, ("acceleration",), "acceleration feedback")
    with pytest.raises(fx.errors.UnstableError, match="the loop of acceleration feedback is not well posed"):
        fx.control.closed_loop(hexapod, pose, law)


def test_a_schedule_says_where_there_is_no_gain(isolator):
    hexapod, pose = isolator
    here = np.concatenate([pose.position, pose.rpy])[None]
    gains = np.geomspace(1.0, 10.0, 4)
    small = fx.control.gain_schedule(hexapod, here, "velocity", gains=gains, damping=0.9)
    assert small.status.values.tolist() == ["no_gain"]
    assert np.isnan(small.gain.values).all()
    easy = fx.control.gain_schedule(hexapod, here, "velocity", gains=gains, damping=1e-6)
    assert easy.gain.values.tolist() == [1.0]  # the first is more than enough
    assert easy.least_damping.values[0] > 1e-6
    met = hexapod.base_joints[0] - hexapod.platform_joints[0]  # leg 1 has no length
    mixed = fx.control.gain_schedule(hexapod, np.concatenate([here, [[*met, 0, 0, 0]]]), "velocity", gains=gains)
    assert mixed.status.values.tolist() == ["ok", "no_rest"]


class Routine:
    """SLICOT's routine as seen from outside: it finds controllers above a least gamma, but for some by chance."""

    def __init__(self, least, fails=lambda gamma: False, most_calls=np.inf):
        self.least, self.fails, self.calls, self.most_calls = least, fails, 0, most_calls

    def __call__(self, *given, **options):
        gamma, self.calls = given[5], self.calls + 1
        if gamma < self.least or self.fails(gamma) or self.calls > self.most_calls:
            raise slycot.exceptions.SlycotError("no", 6)
        return (None, *(np.full((1, 1), gamma),) * 4)


SYSTEM = (np.zeros((2, 2)),) * 4


@pytest.mark.parametrize("least", [0.003, 0.7, 40.0])
def test_gamma_is_a_fifth_above_the_least_wherever_that_is(least, monkeypatch):
    monkeypatch.setattr(slycot, "sb10ad", Routine(least))
    gamma, matrices = suboptimal_controller(SYSTEM, 6)
    assert 1.2 * least <= gamma <= 1.2 * 1.01 * least
    assert matrices[0] == gamma


def test_a_gamma_at_which_the_routine_fails_is_passed_by(monkeypatch):
    monkeypatch.setattr(slycot, "sb10ad", Routine(0.7, fails=lambda gamma: 0.8 < gamma < 0.9))
    gamma, _ = suboptimal_controller(SYSTEM, 6)
    assert gamma == pytest.approx(0.7 * 1.1, rel=0.02)


def test_designs_that_cannot_be_made_are_told(isolator, monkeypatch):
    with monkeypatch.context() as patched:
        patched.setattr(slycot, "sb10ad", Routine(np.inf))
        with pytest.raises(fx.errors.UnstableError, match="no H-infinity controller was found"):
            fx.control.h_infinity(*isolator)
    with monkeypatch.context() as patched:
        patched.setattr(slycot, "sb10ad", Routine(0.7, most_calls=10))  # the bisection takes ten
        with pytest.raises(
            fx.errors.UnstableError, match=r"too badly conditioned\. Raise effort and noise, or lower the depth"
        ):
            suboptimal_controller(SYSTEM, 6)
    with monkeypatch.context() as patched:
        patched.setattr(isolation, "is_stable", lambda *given: False)
        with pytest.raises(fx.errors.UnstableError, match=r"too badly conditioned to be used\. Raise effort and noise"):
            fx.control.h_infinity(*isolator)

    def failing(*given):
        raise np.linalg.LinAlgError("no finite solution")

    monkeypatch.setattr(control, "care", failing)
    with pytest.raises(
        fx.errors.UnstableError, match="no optimal controller exists for these weights: no finite solution"
    ):
        fx.control.lqg(*isolator)


def test_a_home_pose_that_no_leg_can_take_is_named(machine):
    met = machine.base_joints[0] - machine.platform_joints[0]
    h = machine.replace({"home.position": met.tolist(), "home.orientation": [0, 0, 0]})
    with pytest.raises(fx.PoseError, match=r"the design's \[home\], which joint angles are measured from: leg 1"):
        fx.joint_angles(h, fx.Pose([0, 0, 0.89]))


def test_one_kind_of_joint_may_be_limited_alone(machine):
    h = machine.replace({"home.position": [0, 0, 0.89], "limits.universal_angle": 0.01})
    found = fx.check_limits(h, fx.Pose.from_rpy(0.1, 0, 0.89))
    assert found.exceeded
    assert all("universal joint" in text for text in found.exceeded)


def test_a_cubic_design_may_say_where_its_home_is():
    text = """
        name = "cube"
        [cubic]
        edge = 0.5
        middle = 0.2
        [platform]
        mass = 10
        mass_center = [0, 0, 0]
        inertia = [[0.1, 0, 0], [0, 0.1, 0], [0, 0, 0.1]]
        [legs]
        stiffness = 1e6
        """
    own = fx.Hexapod.from_toml(text)
    lifted = fx.Hexapod.from_toml(text + "[home]\nposition = [0, 0, 0.25]\n")
    np.testing.assert_array_equal(lifted.base_joints, own.base_joints)
    assert fx.home_pose(lifted).position.tolist() == [0, 0, 0.25]
    assert fx.home_pose(own).position[2] > 0
