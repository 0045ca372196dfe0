"""Every error that a function's docstring names is provoked: what is promised under "Raises:" does happen.

Functions of a machine and a pose are called as in CALLS, at a pose that no leg can take where they name PoseError, and
at a singular pose where they name SingularPoseError. All other pairs of function and error stand in PROVOKED, or in
SHOWN with the test that shows them where a call takes long.
"""

import inspect
import re
import sys
from dataclasses import replace
from pathlib import Path
from unittest.mock import patch

import numpy as np
import pytest
from tests.helpers.docstrings import errors_in
from tests.helpers.plain import plain_machine
from tests.helpers.public import FUNCTIONS, PUBLIC

import flexapod as fx

MACHINE = plain_machine("precision-positioner")
HOME = fx.home_pose(MACHINE)
MEETING = fx.Pose(MACHINE.base_joints[0] - MACHINE.platform_joints[0])  # the joints of leg 1 meet
SINGULAR = fx.Pose(HOME.position, fx.Pose.from_rpy(0, 0, 0, yaw=np.pi / 2).matrix)  # as every such hexapod's
BATCH = fx.Pose(np.zeros((2, 3)))
LINE = fx.Trajectory(fx.Pose(HOME.position + np.array([[0, 0, 0], [0, 0, 0.002]])), [0, 1])
THROUGH = fx.Trajectory(fx.Pose.from_rpy(*HOME.position, 0, 0, [1.4, 1.5, 1.65]), [0, 1, 2])  # passes yaw = 90 degrees
SHAKEN = fx.harmonic("z", 1e-6, 100.0)
SAMPLED = fx.control.VelocityFeedback(1e3).on(fx.linearise(MACHINE, HOME)).sampled(1e-4)
TOO_MUCH = fx.control.VelocityFeedback(1e6)
STEEL = fx.design.flexures.Material(200e9, 400e6)
BOX = fx.Box(x=(-1, 1))
LEGS = fx.inverse_kinematics(MACHINE, HOME)

#: One good call of every function of a machine and a pose, for any machine and pose.
CALLS = {
    "animate_mode": lambda h, p: fx.animate_mode(h, p, 1, "never.gif"),
    "check_limits": fx.check_limits,
    "closed_loop": lambda h, p: fx.control.closed_loop(h, p, fx.control.VelocityFeedback(1e3)),
    "condition_number": fx.condition_number,
    "controlled_random_response": lambda h, p: fx.control.controlled_random_response(
        h, p, controller=fx.control.VelocityFeedback(1e3), psd=fx.vc_curve("VC-C"), axis="z"
    ),
    "controlled_transmissibility": lambda h, p: fx.control.controlled_transmissibility(
        h, p, controller=fx.control.VelocityFeedback(1e3), omega=[1.0]
    ),
    "describe_modes": fx.describe_modes,
    "pose_state": fx.mechanics.pose_state,
    "energy": fx.energy,
    "energy_shares": fx.mechanics.energy_shares,
    "equations_of_motion": fx.equations_of_motion,
    "force_transformation": fx.force_transformation,
    "forward_dynamics": fx.forward_dynamics,
    "frequency_sensitivity": fx.frequency_sensitivity,
    "frequency_grid": fx.vibration.frequency_grid,
    "gain_map": lambda h, p: fx.control.gain_map(h, p, kp=[1.0], kd=[1.0]),
    "h_infinity": fx.control.h_infinity,
    "hold": fx.hold,
    "inverse_dynamics": fx.inverse_dynamics,
    "inverse_kinematics": fx.inverse_kinematics,
    "joint_angles": fx.joint_angles,
    "joint_moments": fx.joint_moments,
    "joint_reactions": fx.joint_reactions,
    "leg_distance": fx.mechanics.leg_distance,
    "leg_bending": fx.mechanics.leg_bending,
    "leg_rates": fx.leg_rates,
    "linearise": fx.linearise,
    "lqg": fx.control.lqg,
    "natural_modes": fx.natural_modes,
    "random_response": lambda h, p: fx.random_response(h, p, psd=fx.vc_curve("VC-C"), axis="z"),
    "root_locus": fx.control.root_locus,
    "sampling_time": fx.control.sampling_time,
    "simulate": lambda h, p: fx.simulate(h, p, duration=1.0),
    "simulate_control": lambda h, p: fx.control.simulate_control(
        h, p, controller=SAMPLED, base_motion=SHAKEN, duration=1.0
    ),
    "stability_index": fx.stability_index,
    "stepped_sine": lambda h, p: fx.stepped_sine(h, p, omega=[100.0], amplitude=1e-6, axis="z"),
    "transmissibility": lambda h, p: fx.transmissibility(h, p, omega=[1.0]),
    "view": fx.view,
    "viscous_equivalent": lambda h, p: fx.mechanics.viscous_equivalent(h.replace({"legs.loss_factor": 0.1}), 1.0, p),
    "write_mat": lambda h, p: fx.interchange.write_mat("no-such-folder/machine.mat", h, p),
    "write_mjcf": lambda h, p: fx.interchange.write_mjcf("no-such-folder/machine.xml", h, p),
    "write_sdf": lambda h, p: fx.interchange.write_sdf("no-such-folder/machine.sdf", h, p),
    "write_urdf": lambda h, p: fx.interchange.write_urdf("no-such-folder/machine.urdf", h, p),
}


def without(package, call):
    """The call where a package is not installed."""

    def called():
        loaded = [name for name in sys.modules if name.partition(".")[0] == package]
        with patch.dict(sys.modules, dict.fromkeys([package, *loaded])):
            call()

    return called


PROVOKED = {
    ("plot", "ArgumentError"): lambda: fx.plot(3.0),
    ("animate_mode", "MissingExtraError"): without(
        "imageio_ffmpeg", lambda: fx.animate_mode(MACHINE, HOME, 1, "a.mp4")
    ),
    ("animate_simulation", "MissingExtraError"): without(
        "imageio_ffmpeg", lambda: fx.animate_simulation(fx.simulate(MACHINE, HOME, duration=1e-3), MACHINE, "a.mp4")
    ),
    ("cluster", "ArgumentError"): lambda: fx.workspace.cluster("local", timeout=-1.0).__enter__(),
    ("view", "MissingExtraError"): without("anywidget", lambda: fx.view(MACHINE)),
    ("h_infinity", "MissingExtraError"): without("slycot", lambda: fx.control.h_infinity(MACHINE, HOME)),
    ("lqg", "MissingExtraError"): without("control", lambda: fx.control.lqg(MACHINE, HOME)),
    ("robustness", "MissingExtraError"): without(
        "SALib", lambda: fx.robustness(MACHINE, [fx.Uncertain("legs.stiffness", 0.1)], samples=16, sensitivity=16)
    ),
    ("certify", "ArgumentError"): lambda: fx.certify(MACHINE, HOME, at_least=-1.0),
    ("certify", "DesignError"): lambda: fx.certify("motion-base", HOME),
    ("certify", "OutputError"): lambda: fx.certify(MACHINE, HOME, path="no-such-folder/proof.json"),
    ("certify", "PoseError"): lambda: fx.certify(MACHINE, MEETING),
    ("certify_condition_number", "ArgumentError"): lambda: fx.certify_condition_number(MACHINE, HOME, gap=2.0),
    ("certify_condition_number", "DesignError"): lambda: fx.certify_condition_number(None),
    ("certify_condition_number", "OutputError"): lambda: fx.certify_condition_number(
        MACHINE, HOME, path="no/proof.json"
    ),
    ("certify_condition_number", "PoseError"): lambda: fx.certify_condition_number(MACHINE, MEETING),
    ("certify_limits", "ArgumentError"): lambda: fx.certify_limits(fx.load("mukherjee-ii")),
    ("certify_limits", "DesignError"): lambda: fx.certify_limits(None),
    ("certify_limits", "OutputError"): lambda: fx.certify_limits(MACHINE, HOME, path="no-such-folder/proof.json"),
    ("certify_limits", "PoseError"): lambda: fx.certify_limits(MACHINE, np.zeros((0, 6))),
    ("certify_regular", "ArgumentError"): lambda: fx.certify_regular(MACHINE, HOME, time_limit=0.0),
    ("certify_regular", "DesignError"): lambda: fx.certify_regular(None),
    ("certify_regular", "OutputError"): lambda: fx.certify_regular(MACHINE, HOME, path="no-such-folder/proof.json"),
    ("certify_regular", "PoseError"): lambda: fx.certify_regular(MACHINE, np.zeros((0, 6))),
    ("certified_box", "ArgumentError"): lambda: fx.certified_box(MACHINE, HOME, 1.0),
    ("certified_box", "DesignError"): lambda: fx.certified_box(None, fx.Workspace.about_home(0.1, 0.1), 1.0),
    ("certified_box", "OutputError"): lambda: fx.certified_box(
        MACHINE, fx.Workspace.about_home(0.1, 0.1), 1.0, path="no-such-folder/largest.json"
    ),
    ("certified_box", "PoseError"): lambda: fx.certified_box(
        fx.load("mukherjee-ii").replace({"home": None}), fx.Workspace.about_home(0.1, 0.1), 1.0
    ),
    ("check_certificate", "ArgumentError"): lambda: fx.certificates.check_certificate(
        replace(fx.certify(MACHINE, HOME), upper=1.0)
    ),
    ("check_certificate", "OutputError"): lambda: fx.certificates.check_certificate("no-such-file.json"),
    ("read_certificate", "OutputError"): lambda: fx.certificates.read_certificate("no-such-file.json"),
    ("animate_mode", "OutputError"): lambda: fx.animate_mode(MACHINE, HOME, 1, "nowhere/never.gif"),
    ("animate_simulation", "OutputError"): lambda: fx.animate_simulation(
        fx.simulate(MACHINE, HOME, duration=1e-3), MACHINE, "nowhere/never.gif"
    ),
    ("animate_mode", "ArgumentError"): lambda: fx.animate_mode(MACHINE, HOME, 7, "never.gif"),
    ("animate_simulation", "ArgumentError"): lambda: fx.animate_simulation(None, MACHINE, "never.gif", frames=1),
    ("circular_notch", "ArgumentError"): lambda: fx.design.flexures.circular_notch(1e-3, 2e-3, 8e-3, STEEL),
    ("crossed", "ArgumentError"): lambda: fx.design.flexures.crossed(1.0, 2.0),
    ("joint_moments", "ArgumentError"): lambda: fx.joint_moments(MACHINE, HOME, joint="ball"),
    ("joint_moments", "DesignError"): lambda: fx.joint_moments(MACHINE.replace({"home": None}), HOME),
    ("leaf", "ArgumentError"): lambda: fx.design.flexures.leaf(1.0, 2.0, 3.0, STEEL),
    ("leg_keys", "ArgumentError"): lambda: fx.design.flexures.leg_keys(1.0, 2.0),
    ("round_notch", "ArgumentError"): lambda: fx.design.flexures.round_notch(1e-3, -1.0, STEEL),
    ("viscous_equivalent", "ArgumentError"): lambda: fx.mechanics.viscous_equivalent(MACHINE, 0.0),
    ("wire", "ArgumentError"): lambda: fx.design.flexures.wire(1.0, 2.0, STEEL),
    ("closed_loop", "ArgumentError"): lambda: fx.control.closed_loop(MACHINE, HOME, "pid"),
    ("closed_loop", "UnstableError"): lambda: fx.control.closed_loop(
        MACHINE, HOME, TOO_MUCH.on(fx.linearise(MACHINE, HOME)).sampled(0.1)
    ),
    ("controlled_random_response", "ArgumentError"): lambda: fx.control.controlled_random_response(
        MACHINE, HOME, controller=TOO_MUCH
    ),
    ("controlled_random_response", "UnstableError"): lambda: fx.control.controlled_random_response(
        MACHINE,
        HOME,
        controller=TOO_MUCH.on(fx.linearise(MACHINE, HOME)).sampled(0.1),
        psd=fx.vc_curve("VC-C"),
        axis="z",
    ),
    ("controlled_transmissibility", "ArgumentError"): lambda: fx.control.controlled_transmissibility(
        MACHINE, HOME, controller=TOO_MUCH, omega=[-1.0]
    ),
    ("envelope", "ArgumentError"): lambda: fx.envelope(MACHINE, directions=5),
    ("envelope", "PoseError"): lambda: fx.envelope(MACHINE, BATCH),
    ("envelope", "DesignError"): lambda: fx.envelope("precision-positioner"),
    ("flat_spectrum", "ArgumentError"): lambda: fx.excitation.flat_spectrum(-1.0, 1.0, 2.0),
    ("forward_kinematics", "KinematicsError"): lambda: fx.forward_kinematics(MACHINE, LEGS * [10, 1, 1, 1, 1, 1]),
    ("condition_number", "ArgumentError"): lambda: fx.condition_number(MACHINE, HOME, characteristic_length=0.0),
    ("forward_kinematics", "ArgumentError"): lambda: fx.forward_kinematics(MACHINE, [0.2, 0.2]),
    ("forward_kinematics", "PoseError"): lambda: fx.forward_kinematics(MACHINE, LEGS, start=BATCH),
    ("forward_kinematics_all", "KinematicsError"): lambda: fx.forward_kinematics_all(
        MACHINE, LEGS * [-1, 1, 1, 1, 1, 1]
    ),
    ("forward_kinematics_all", "ArgumentError"): lambda: fx.forward_kinematics_all(MACHINE, [0.2, 0.2]),
    ("forward_kinematics_all", "PoseError"): lambda: fx.forward_kinematics_all(MACHINE, LEGS, start=BATCH),
    ("frequency_grid", "ArgumentError"): lambda: fx.vibration.frequency_grid(MACHINE, omega_min=2.0, omega_max=1.0),
    ("gain_map", "ArgumentError"): lambda: fx.control.gain_map(MACHINE, HOME, kp=[[1.0]], kd=[1.0]),
    ("gain_schedule", "ArgumentError"): lambda: fx.control.gain_schedule(MACHINE, HOME, gains=[2.0, 1.0, 3.0]),
    ("gain_schedule", "PoseError"): lambda: fx.control.gain_schedule(MACHINE, np.zeros((0, 6))),
    ("ground_noise", "ArgumentError"): lambda: fx.excitation.ground_noise("loud"),
    ("h_infinity", "ArgumentError"): lambda: fx.control.h_infinity(MACHINE, HOME, depth=0.0),
    ("h_infinity", "UnstableError"): lambda: fx.control.h_infinity(MACHINE, HOME, effort=1e-12),
    ("half_sine_pulse", "ArgumentError"): lambda: fx.excitation.half_sine_pulse("up", 1.0, 1.0),
    ("half_sine_shock", "ArgumentError"): lambda: fx.half_sine_shock("z", np.nan, 1.0),
    ("harmonic", "ArgumentError"): lambda: fx.harmonic("z", 1.0, -1.0),
    ("load", "DesignError"): lambda: fx.load("no-such-machine"),
    ("gravity_at", "ArgumentError"): lambda: fx.mechanics.gravity_at(1.0, magnitude=-1.0),
    ("load_cases", "ArgumentError"): lambda: fx.load_cases(MACHINE, reference=1),
    ("load_cases", "DesignError"): lambda: fx.load_cases("precision-positioner"),
    ("load_cases", "PoseError"): lambda: fx.load_cases(MACHINE.replace({"home": None})),
    ("low_discrepancy", "ArgumentError"): lambda: fx.workspace.low_discrepancy(BOX, 2**40),
    ("lqg", "ArgumentError"): lambda: fx.control.lqg(MACHINE, HOME, measure="jerk"),
    ("lqg", "UnstableError"): lambda: fx.control.lqg(MACHINE, HOME, stroke=1e-300, effort=1e-300),
    ("nearest_physical", "DesignError"): lambda: fx.interchange.nearest_physical("mukherjee-ii"),
    ("open_zeros", "ArgumentError"): lambda: fx.control.open_zeros(fx.linearise(MACHINE, HOME), "speed"),
    ("open_sweep", "OutputError"): lambda: fx.open_sweep("no-such-store.zarr"),
    ("optimise", "ArgumentError"): lambda: fx.optimise(MACHINE, [fx.Variable("legs.stiffness", 2.0, 1.0)]),
    ("optimise", "DesignError"): lambda: fx.optimise("motion-base", [fx.Variable("platform.mass", 20, 40)]),
    ("optimise", "OutputError"): lambda: fx.optimise(MACHINE, [fx.Variable("platform.mass", 20, 40)], study=__file__),
    ("optimise", "InfeasibleError"): lambda: fx.optimise(
        MACHINE,
        [fx.Variable("platform.mass", 20, 40)],
        None,
        [fx.optimisation.TotalMass(1.0)],
        start={"platform.mass": 30},
        trials=0,
    ),
    ("pareto_front", "ArgumentError"): lambda: fx.pareto_front(MACHINE, [fx.Variable("platform.mass", 20, 40)], None),
    ("pareto_front", "DesignError"): lambda: fx.pareto_front(
        "motion-base", [fx.Variable("platform.mass", 20, 40)], fx.optimisation.TotalMass()
    ),
    ("pareto_front", "OutputError"): lambda: fx.pareto_front(
        MACHINE, [fx.Variable("platform.mass", 20, 40)], fx.optimisation.TotalMass(), study=__file__
    ),
    ("pareto_front", "InfeasibleError"): lambda: fx.pareto_front(
        MACHINE, [fx.Variable("platform.mass", 20, 40)], fx.optimisation.TotalMass(1.0), trials=2, samples=8
    ),
    ("motor_loads", "ArgumentError"): lambda: fx.paths.motor_loads(MACHINE, fx.paths.path_loads(MACHINE, LINE)),
    ("path_index", "ArgumentError"): lambda: fx.path_index(MACHINE, LINE, bound=-1.0),
    ("path_index", "PoseError"): lambda: fx.path_index(
        MACHINE, fx.Trajectory(fx.Pose([MEETING.position, HOME.position]), [0, 1])
    ),
    ("path_index", "SingularPoseError"): lambda: fx.path_index(MACHINE, THROUGH),
    ("path_loads", "ArgumentError"): lambda: fx.paths.path_loads(MACHINE, LINE, samples=2),
    ("path_loads", "SingularPoseError"): lambda: fx.paths.path_loads(MACHINE, THROUGH),
    ("payload_loads", "ArgumentError"): lambda: fx.paths.payload_loads(MACHINE, LINE, []),
    ("payload_loads", "SingularPoseError"): lambda: fx.paths.payload_loads(
        MACHINE, THROUGH, [fx.paths.PayloadCase("full", 1.0)]
    ),
    ("plan_path", "ArgumentError"): lambda: fx.plan_path(MACHINE, *LINE.waypoints, 1.0, timing=0.0),
    ("plan_path", "MissingExtraError"): without(
        "ompl",
        lambda: fx.plan_path(fx.load("mukherjee-i"), [0, 0, 0.89, 0, -0.57, -0.18], [0, 0, 0.89, 0, 0.78, 0.92], 110.0),
    ),
    ("plan_path", "PathError"): lambda: fx.plan_path(MACHINE, HOME, HOME, 1.0),
    ("plan_path", "PoseError"): lambda: fx.plan_path(MACHINE, BATCH, HOME, 1.0),
    ("plan_slice", "ArgumentError"): lambda: fx.paths.plan_slice(MACHINE, LINE),
    ("plan_slice", "PathError"): lambda: fx.paths.plan_slice(MACHINE, fx.plan_path(MACHINE, *LINE.waypoints, 1.0)),
    ("polynomial", "ArgumentError"): lambda: fx.excitation.polynomial("z", []),
    ("pose_grid", "ArgumentError"): lambda: fx.pose_grid(x=[0, np.nan]),
    ("pose_path", "ArgumentError"): lambda: fx.workspace.pose_path(BATCH, 0),
    ("pose_path", "PoseError"): lambda: fx.workspace.pose_path([[0, 0, 1, 0, 0, 0]], 5),
    ("random_motion", "ArgumentError"): lambda: fx.random_motion("up", fx.vc_curve("VC-A"), seed=0),
    ("random_poses", "ArgumentError"): lambda: fx.random_poses(BOX, 0),
    ("random_response", "ArgumentError"): lambda: fx.random_response(
        MACHINE, HOME, psd=[-1.0, 1.0], omega=[1.0, 2.0], axis="z"
    ),
    ("read_joints", "DesignError"): lambda: fx.design.read_joints("no-such-file.csv"),
    ("read_time_series", "ArgumentError"): lambda: fx.read_time_series("no-such-file.csv"),
    ("robustness", "ArgumentError"): lambda: fx.robustness(MACHINE, [fx.Uncertain("legs.stiffness", 2.0)]),
    ("robustness", "DesignError"): lambda: fx.robustness("motion-base", fx.Uncertain("legs.stiffness", 0.1)),
    ("robustness", "PoseError"): lambda: fx.robustness(MACHINE, [fx.Uncertain("legs.stiffness", 0.1)], "everywhere"),
    ("root_locus", "ArgumentError"): lambda: fx.control.root_locus(MACHINE, HOME, gains=[-1.0, 1.0]),
    ("sampling_time", "DesignError"): lambda: fx.control.sampling_time("precision-positioner", HOME),
    ("sampling_time", "ArgumentError"): lambda: fx.control.sampling_time(-1.0),
    ("sea_motion", "ArgumentError"): lambda: fx.excitation.sea_motion(
        fx.excitation.sea_spectrum(1, 9), {"z": lambda w: np.nan * w}, seed=0
    ),
    ("sea_spectrum", "ArgumentError"): lambda: fx.excitation.sea_spectrum(1.0, 9.0, gamma=0.5),
    ("simulate", "ArgumentError"): lambda: fx.simulate(MACHINE, HOME, duration=-1.0),
    ("simulate", "SimulationError"): lambda: fx.simulate(MACHINE, HOME, base_motion=SHAKEN, duration=1.0, max_steps=5),
    ("simulate_control", "ArgumentError"): lambda: fx.control.simulate_control(
        MACHINE,
        HOME,
        controller=fx.control.VelocityFeedback(1e3).on(fx.linearise(MACHINE, HOME)),
        base_motion=SHAKEN,
        duration=1.0,
    ),
    ("simulate_control", "UnstableError"): lambda: fx.control.simulate_control(
        MACHINE,
        HOME,
        controller=TOO_MUCH.on(fx.linearise(MACHINE, HOME)).sampled(0.1),
        base_motion=SHAKEN,
        duration=1.0,
    ),
    ("simulate_many", "ArgumentError"): lambda: fx.simulate_many([], 1.0),
    ("simulate_many", "SingularPoseError"): lambda: fx.simulate_many(
        [fx.simulation.SimulationRun(MACHINE, SINGULAR)], 1.0
    ),
    ("sine_sweep", "ArgumentError"): lambda: fx.sine_sweep("z", 1.0, 1.0, 2.0, 1.0, law="cubic"),
    ("smooth_step", "ArgumentError"): lambda: fx.excitation.smooth_step("z", 1.0, 0.0),
    ("static_equilibrium", "PoseError"): lambda: fx.static_equilibrium(MACHINE, LEGS, base=BATCH),
    ("static_equilibrium", "ArgumentError"): lambda: fx.static_equilibrium(MACHINE, [1.0, 2.0]),
    ("static_equilibrium", "KinematicsError"): lambda: fx.static_equilibrium(MACHINE, -LEGS),
    ("static_equilibrium", "SingularPoseError"): lambda: fx.static_equilibrium(
        MACHINE.replace({"gravity": [0, 0, 0]}), fx.inverse_kinematics(MACHINE, SINGULAR), start=SINGULAR
    ),
    ("stepped_sine", "ArgumentError"): lambda: fx.stepped_sine(MACHINE, HOME, omega=[100.0], amplitude=1e-6, axis="up"),
    ("summarise", "ArgumentError"): lambda: fx.summarise(fx.sweep(MACHINE, HOME, quantities=("cond_H",))),
    ("summarise", "PoseError"): lambda: fx.summarise(fx.sweep(MACHINE, MEETING)),
    ("sweep", "ArgumentError"): lambda: fx.sweep(MACHINE, BOX, samples=0),
    ("sweep", "DesignError"): lambda: fx.sweep("motion-base", HOME),
    ("sweep", "PoseError"): lambda: fx.sweep(MACHINE, np.full((3, 6), np.nan)),
    ("time_series", "ArgumentError"): lambda: fx.excitation.time_series([0, 1], [0, 1], "z"),
    ("transmissibility", "ArgumentError"): lambda: fx.transmissibility(MACHINE, HOME, omega=[-1.0]),
    ("vc_curve", "ArgumentError"): lambda: fx.vc_curve("VC-Z"),
    ("worst_pose", "ArgumentError"): lambda: fx.worst_pose(MACHINE, BOX, starts=0),
    ("worst_pose", "DesignError"): lambda: fx.worst_pose("motion-base", HOME),
    ("worst_pose", "PoseError"): lambda: fx.worst_pose(MACHINE, MEETING),
    ("write_mat", "ArgumentError"): lambda: fx.interchange.write_mat(MACHINE, "never.mat"),
    ("write_sdf", "ArgumentError"): lambda: fx.interchange.write_sdf(MACHINE, "never.sdf"),
    ("write_urdf", "ArgumentError"): lambda: fx.interchange.write_urdf(MACHINE, "never.urdf"),
    ("write_mat", "OutputError"): lambda: CALLS["write_mat"](MACHINE, HOME),
    ("write_mjcf", "ArgumentError"): lambda: fx.interchange.write_mjcf("never.xml", MACHINE, timestep=-1.0),
    ("write_mjcf", "DesignError"): lambda: fx.interchange.write_mjcf("never.xml", fx.load("mukherjee-ii")),
    ("write_mjcf", "OutputError"): lambda: CALLS["write_mjcf"](MACHINE, HOME),
    ("write_sdf", "DesignError"): lambda: fx.interchange.write_sdf("never.sdf", fx.load("mukherjee-ii")),
    ("write_sdf", "OutputError"): lambda: CALLS["write_sdf"](MACHINE, HOME),
    ("write_urdf", "DesignError"): lambda: fx.interchange.write_urdf("never.urdf", fx.load("mukherjee-ii")),
    ("write_urdf", "OutputError"): lambda: CALLS["write_urdf"](MACHINE, HOME),
}

#: Pairs that take long, or another machine, and the test that shows them.
SHOWN = {
    ("cluster", "ClusterError"): ("workspace/test_sweep_cluster.py", "test_no_scheduler_is_told_soon"),
    ("plan_path", "SingularPoseError"): ("paths/test_planning.py", "test_infeasible_problems_name_the_conflict"),
    ("simulate_control", "SimulationError"): ("control/test_isolation.py", "test_what_cannot_be_run_is_refused"),
}

PAIRS = [(name, error) for name in FUNCTIONS for error in sorted(errors_in(name))]
OURS = [(name, error) for name, error in PAIRS if error in PUBLIC]


def provocation(name, error):
    """What must raise the error; None where another test shows it."""
    if (name, error) in PROVOKED:
        return PROVOKED[name, error]
    where = {"PoseError": MEETING, "SingularPoseError": SINGULAR}.get(error)
    if name in CALLS and where is not None:
        return lambda: CALLS[name](MACHINE, where)
    if error == "ArgumentError" and name in CALLS and "joint" in inspect.signature(PUBLIC[name]).parameters:
        return lambda: PUBLIC[name](MACHINE, HOME, joint="ball")
    assert (name, error) in SHOWN, (
        f"the docstring of {name} names {error}: put a call that raises it into PROVOKED[{name!r}, {error!r}]"
    )
    return None


@pytest.mark.parametrize(("name", "error"), OURS)
def test_error_named_is_raised(name, error):
    call = provocation(name, error)
    if call is None:
        file, test = SHOWN[name, error]
        text = (Path(__file__).parents[1] / file).read_text()
        body = re.search(rf"def {test}\w*\(.*?(?=\ndef |\Z)", text, re.S)
        assert body, f"{file} has no {test}"
        assert name in body[0]
        assert error in text
    else:
        with pytest.raises(PUBLIC[error]):
            call()


def test_good_calls_raise_nothing():
    """Otherwise the calls above would prove little."""
    for name in ("check_limits", "linearise", "leg_rates", "joint_reactions", "random_response", "transmissibility"):
        CALLS[name](MACHINE, HOME)


def test_nothing_is_provoked_that_is_not_named():
    assert set(PROVOKED) | set(SHOWN) <= set(OURS), sorted((set(PROVOKED) | set(SHOWN)) - set(OURS))
