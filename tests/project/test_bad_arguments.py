"""What a function cannot work with is told by name, with its value, what is required, and where it helps the remedy."""

import numpy as np
import pytest

import flexapod as fx
from flexapod import excitation, optimisation
from flexapod.excitation.spectra import Spectrum
from flexapod.simulation.run import SimulationRun

ZERO = np.zeros(3)
PAIR = fx.Pose.from_rpy([0.0, 0.05], 0.0, [0.89, 0.9])
NEAR, FAR = PAIR[0], PAIR[1]


def machine(name="mukherjee-i", **changes):
    return fx.load(name).replace(changes) if changes else fx.load(name)


def coincident():
    """A machine and a pose at which every leg has no length, so that nothing can be computed."""
    h = fx.load("mukherjee-i")
    return h.replace({"platform.joints": h.base_joints.tolist()}), fx.Pose(ZERO)


def stays(pose):
    return fx.Trajectory(fx.Pose(np.stack([pose.position] * 2), np.stack([pose.matrix] * 2)), [0.0, 1.0])


def optimised(*variables, **options):
    return fx.optimise(fx.load("precision-positioner"), list(variables), **{"trials": 0, **options})


MASS = fx.Variable("platform.mass", 20, 30)
BOX = fx.Box(x=(-0.01, 0.01), y=0, z=0.25, roll=0, pitch=0, yaw=0)
POINT = fx.Box(x=0, y=0, z=0.25, roll=0, pitch=0, yaw=0)


def along(**options):
    return fx.path_index(machine(), fx.Trajectory(PAIR, [0, 1]), **options)


def planned(**options):
    return fx.plan_path(machine(), NEAR, FAR, 90.0, **options)


def robust(*uncertain, name="motion-base", region=None, **options):
    given = [fx.Uncertain("legs.stiffness_law.bulk_modulus", 0.1), *uncertain]
    return fx.robustness(fx.load(name), given, region, **{"samples": 16, **options})


def controlled(**hardware):
    h = fx.load("cubic-isolator")
    pose = fx.home_pose(h)
    law = fx.control.VelocityFeedback(10.0).on(fx.linearise(h, pose)).sampled(1e-3)
    return fx.control.simulate_control(
        h,
        pose,
        controller=law,
        base_motion=fx.harmonic("z", 1e-6, 20.0),
        duration=0.01,
        hardware=fx.control.Hardware(**hardware),
    )


def drawn(density, quantity="acceleration"):
    return fx.random_motion("x", Spectrum(lambda omega: density(omega), quantity, 1.0, 10.0), seed=1)


A, D = fx.ArgumentError, fx.DesignError
CASES = [
    # designs, poses, places
    (lambda: fx.check_limits(machine(), ZERO), fx.PoseError, r"pose has shape \(3,\); its last axis must hold 6 numbers"),
    (lambda: fx.hold(machine(), "home"), fx.PoseError, "pose is str; give a flexapod Pose"),
    (lambda: fx.Box.about(PAIR, 0.1, 0.1), fx.PoseError, r"a box lies about one pose; this one has batch axes \(2,\)"),
    (lambda: fx.pose_grid(x="wide"), A, "x is 'wide'; it must be a number or a list of numbers, in m"),
    (lambda: fx.static_equilibrium(machine(), np.ones((2, 6))), A, r"unstretched_length has shape \(2, 6\); it must have shape \(6,\)"),
    (lambda: fx.LeastIndex([[1, 2, 3]]), fx.PoseError, "give a Workspace, a Box, a PoseSet, a Pose, a Trajectory, or rows"),
    (lambda: fx.LeastIndex("home"), fx.PoseError, "region is 'home'; give a Workspace"),
    (lambda: fx.Workspace(PAIR), A, "a workspace is a flexapod Box; this is Pose"),
    (lambda: fx.Workspace(POINT), A, "a workspace needs a range of at least one coordinate"),
    # excitations and spectra
    (lambda: drawn(lambda omega: -omega), A, "the density holds NaN, infinity or negative numbers"),
    (lambda: drawn(np.ones_like, "jerk"), A, "quantity of the spectrum is 'jerk'; it must be one of 'displacement', 'velocity'"),
    (lambda: excitation.flat_spectrum(-1.0, 1.0, 2.0), A, "rms is -1.0; it must be finite and > 0"),
    (
        lambda: excitation.sea_motion(excitation.sea_spectrum(2, 8), {"roll": lambda omega: omega * np.nan}, seed=1),
        A,
        "the response of roll holds NaN or infinity",
    ),
    (lambda: SimulationRun(machine(), NEAR, base="floor"), fx.PoseError, "base is str; give a flexapod Pose"),
    (
        lambda: fx.simulate(machine(), NEAR, force=np.ones((2, 3)), duration=0.1),
        A,
        r"force has shape \(2, 3\); it must have shape \(3,\)",
    ),
    (lambda: fx.simulate(machine(), NEAR, times=np.zeros((3, 4))), A, r"times have shape \(3, 4\)"),
    (
        lambda: fx.random_response(machine(), NEAR, psd=np.ones((2, 5)), omega=[1.0, 2.0]),
        A,
        r"psd has shape \(2, 5\); for 2 frequencies give \(2,\), \(2, 6\) or \(2, 6, 6\)",
    ),
    # paths and plans
    (lambda: along(samples=3), A, "samples is 3; it must be a whole number, at least 8"),
    (lambda: along(singular="ignore"), A, "singular is 'ignore'; it must be one of 'raise', 'keep'"),
    (lambda: fx.path_index(coincident()[0], stays(coincident()[1])), fx.PoseError, "no leg can take the pose at t = 0"),
    (lambda: fx.Trajectory(PAIR, ["now", "then"]), A, r"times is \['now', 'then'\]; it must hold numbers"),
    (
        lambda: fx.Trajectory(fx.Pose.from_rpy([0.0, 0.0], 0, 0.9), [0, 1], ends="periodic"),
        fx.errors.PathError,
        "a periodic path needs at least three waypoints",
    ),
    (lambda: fx.paths.LegSpeed(rate=-1.0), A, "rate of the leg speed is -1.0 m/s; it must be finite and > 0"),
    (lambda: fx.plan_path(machine(), "here", FAR, 90.0), fx.PoseError, "start is str; give a flexapod Pose"),
    (lambda: planned(objective="energy"), A, "objective is 'energy'; it must be one of 'length', 'time'"),
    (lambda: planned(timing=0.0), A, "timing is 0.0 s; it must be finite and > 0"),
    (lambda: fx.paths.plan_slice(machine(), planned()), fx.errors.PathError, "the planned path is straight; it spans no plane"),
    (lambda: fx.control.sampling_time(100.0, NEAR), A, "100.0 is a frequency and takes no region; give a Hexapod"),
    (lambda: fx.control.sampling_time(coincident()[0], fx.Pose(np.zeros((2, 3)))), fx.PoseError, "no leg can take any"),
    (lambda: fx.control.sampling_time(coincident()[0], stays(coincident()[1])), fx.PoseError, "no leg can take any"),
    (
        lambda: fx.control.sampling_time(coincident()[0], fx.Box(x=0, y=0, z=0, roll=0, pitch=0, yaw=0)),
        fx.PoseError,
        "no leg can take any of these poses",
    ),
    # control
    (lambda: fx.control.PID(kp="stiff"), A, "kp is 'stiff'; give a number, six numbers, or a 6 x 6 matrix"),
    (lambda: controlled(force_limit="strong"), A, "force_limit is 'strong'; give a number, or six for the legs"),
    (lambda: controlled(noise={"leg_rate": -1.0}), A, "noise of leg_rate is -1.0; give a finite number >= 0, or six"),
    (
        lambda: fx.control.VelocityFeedback(1.0).on(fx.linearise(machine(), NEAR)).sampled(1e-3, delay=0.5),
        A,
        "delay, in samples, is 0.5; it must be a whole number, at least 0",
    ),
    (
        lambda: fx.certify(machine(), fx.Box.about(NEAR, 1e-4, 1e-3), at_least=1.0, stop=np.ma.array([1.0, 2.0], mask=[0, 1])),
        A,
        "it must be a function that answers whether to stop",
    ),
    (
        lambda: fx.control.controlled_transmissibility(machine(), NEAR, controller=fx.control.PID(1.0, 1.0), omega=[0.0, 1.0]),
        A,
        "holds zero; the loop needs frequencies > 0",
    ),
    (lambda: fx.control.gain_schedule(machine(), PAIR, gains=[1.0, 3.0, 2.0]), A, "give at least 3 ascending gains > 0"),
    # robustness
    (lambda: robust(samples=1), A, "samples is 1; it must be a whole number, at least 2"),
    (lambda: robust(optimisation.Payload((0, 1), ((0.1, -0.1), 0, 0))), A, r"the payload's x is \(0.1, -0.1\) m"),
    (lambda: robust(fx.Uncertain("platform.mass", 3.0, "lognormal")), A, "of the logarithm; it must be at most 2"),
    (lambda: fx.robustness(machine(home=None), fx.Uncertain("legs.stiffness", 0.1)), fx.PoseError, "names no home pose. Give"),
    (
        lambda: fx.robustness(coincident()[0], fx.Uncertain("legs.stiffness", 0.1), coincident()[1]),
        A,
        "the index of 'mukherjee-i' itself is zero at these poses",
    ),
    # optimal design
    (lambda: optimised(MASS, trials=-1), A, "trials is -1; it must be a whole number, at least 0"),
    (lambda: optimised(MASS, trials=2, sampler="grid"), A, "sampler is 'grid'; it must be one of 'tpe', 'sobol'"),
    (lambda: optimised(MASS, constraints=["mass"]), A, "constraints holds 'mass', which is no constraint"),
    (lambda: optimised(MASS, start={"mass": 25}), A, "start names 'mass', which is no variable. There are: platform.m"),
    (lambda: optimised(), A, "variables is empty; give at least one Variable or JointCircle"),
    (lambda: fx.optimise(fx.load("mukherjee-ii"), np.zeros(0), trials=0), A, "variables is empty"),
    (lambda: fx.optimise(fx.load("mukherjee-ii"), np.zeros(2), trials=0), A, "variables holds np.float64"),
    (lambda: optimised("platform.mass"), A, "variables holds 'platform.mass'"),
    (lambda: optimised(fx.Variable("home.orientation_deg[2]", -10, 4e4)), A, "may go up to .* Lower its upper bound"),
    (lambda: optimised(fx.Variable("platform.mass", 1, 2, "replace")), A, "kind is 'replace'; it must be one of 'set', 'add'"),
    (lambda: optimised(fx.Variable({}, 1, 2)), A, "ties nothing; give one key or more, with factors that are not 0"),
    (lambda: optimised(fx.Variable({"platform.mass": 0.0}, 1, 2)), A, "with factors that are not 0"),
    (lambda: optimised(fx.Variable("platform.mass", 1, np.inf)), A, r"platform\.mass: the upper bound is inf kg; it must be a finite number"),
    (lambda: optimised(fx.Variable("platform.mass_center[0]", -1, 1, log=True)), A, "searched in its logarithm"),
    (lambda: optimised(fx.Variable("platform.mass[", 1, 2)), A, "is no number of a design; write it as legs.stiffness"),
    (
        lambda: fx.optimise(machine(), [fx.Variable("base.circle.radius", 1, 2)], trials=0),
        A,
        r"'mukherjee-i' has no \[base\.circle\]; .* Use JointCircle.\"base\"",
    ),
    (
        lambda: optimised(MASS, fx.Variable("legs.upper.mass", 1, 2, name="platform.mass")),
        A,
        "two variables are named 'platform.mass'",
    ),
    (lambda: optimised(optimisation.JointCircle("top", radius=(0.1, 0.2))), A, "plate of a joint circle is 'top'; it must be one of 'base', 'platform'"),
    (lambda: optimised(optimisation.JointCircle("base", radius=(0.0, 0.2))), A, r"base\.circle\.radius may go down to 0, but .* must be > 0"),
    (lambda: optimised(optimisation.JointCircle("base", radius=(0.1, 0.2, 0.3))), A, "give a number, or a pair .least, most."),
    (lambda: optimised(optimisation.JointCircle("base", radius=(0.1, 0.2), axes="free")), A, "axes of a joint circle is 'free'"),
    (lambda: optimised(MASS, constraints=[optimisation.TotalMass(-1.0)]), A, "total mass: the bound is -1.0 kg"),
    (lambda: optimised(MASS, constraints=[optimisation.Footprint(plate="bas")]), A, "the plate is 'bas'; it must be one of 'base'"),
    (lambda: optimised(MASS, constraints=[optimisation.Deflection(force=0.0)]), A, "the force is 0.0 N; it must be finite and > 0"),
    (
        lambda: fx.optimise(machine("precision-positioner", gravity=[0, 0, 0]), [MASS], constraints=[optimisation.Deflection()]),
        A,
        "without gravity the platform has no weight",
    ),
    (lambda: optimisation.MeanIndex(BOX), A, "a mean is taken over poses one by one, not over a box"),
    (lambda: optimisation.MeanIndex(PAIR, [1.0, -1.0]), A, r"one number >= 0 is needed for each, not all 0"),
    (lambda: fx.pareto_front(machine(), [MASS], optimisation.LegClearance()), A, "a constraint with an upper bound"),
    # stores
    (
        lambda: fx.workspace.SweepStore.create("never.zarr", machine(), fx.pose_grid(z=0.9), chunk=0),
        A,
        "chunk is 0; it must be a whole number, at least 1",
    ),
]  # fmt: skip


@pytest.mark.parametrize(("call", "kind", "words"), CASES, ids=[str(number) for number in range(len(CASES))])
def test_it_is_told_by_name(call, kind, words):
    with pytest.raises(kind, match=words):
        call()


def test_an_excitation_adds_to_excitations_only():
    with pytest.raises(TypeError, match="unsupported operand"):
        fx.harmonic("x", 1.0, 1.0) + 1.0


def test_objects_show_what_they_are():
    assert repr(PAIR) == "<Pose (2,)>"
    assert repr(fx.Motion(NEAR)).startswith("Motion(Pose(x=0 y=0 z=0.89 m")
    assert repr(fx.Motion(PAIR)) == "<Motion (2,)>"
    assert repr(fx.harmonic("x", 1.0, 1.0) + fx.harmonic("x", 1.0, 2.0)) == "<Excitation of x, 2 terms>"
    assert repr(type(fx.harmonic("x", 1.0, 1.0))()) == "<Excitation of nothing, 0 terms>"
    assert repr(fx.LeastIndex(NEAR)) == "least index over one pose"
    assert repr(fx.LeastIndex(PAIR)) == "least index over 2 poses"
    shown = "Box(x=-0.01..0.01, y=0, z=0.25, roll=0, pitch=0, yaw=0)"
    assert repr(fx.LeastIndex(BOX)) == f"least index over {shown}"
    assert repr(fx.Workspace(BOX, from_home=True)) == f"home + {shown}"


def test_unreadable_design_files_are_told(tmp_path, monkeypatch):
    """As where permission is missing, which an administrator never meets."""
    from pathlib import Path

    file = tmp_path / "own.toml"
    file.write_text(machine().to_toml())

    def refused(self, mode):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "open", refused)
    with pytest.raises(fx.DesignError, match=r"own\.toml cannot be read: Permission denied\. Check the file's perm"):
        fx.load(file)


def test_paths_know_when_they_begin():
    path = fx.Trajectory(PAIR, [2.0, 3.0])
    assert path.start == 2.0
    np.testing.assert_allclose(path(path.start).pose.position, NEAR.position, atol=1e-15)
