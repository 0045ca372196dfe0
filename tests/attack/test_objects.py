"""Every public constructor, and the methods that take arguments, with bad values; what is accepted is then used.

A value that a constructor takes must be of use: what is made goes at once where a user would give it. An answer or one of
Flexapod's own errors, TypeError for what is no argument at all; nothing hangs. FLEXAPOD_ATTACK_SECONDS: how long in all.
"""

import inspect
import warnings
from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import numpy as np
import pytest
from tests.attack.bounded import limited, rounds, tried
from tests.attack.test_api import BAD, BOX, FULL, HOME, LINE, LINEAR, SHAKEN, UP, H
from tests.helpers.public import CLASSES, PUBLIC

import flexapod as fx
from flexapod import control, design, optimisation, workspace
from flexapod.simulation.run import SimulationRun

pytest.importorskip("optuna")


class Made(NamedTuple):
    """How one of a kind is made, from what, and what is then done with it."""

    make: Callable[..., Any]
    right: dict[str, Any]
    use: Callable[[Any], object]


def _searched(*variables: Any, objective: Any = None, constraints: Any = ()) -> object:
    return fx.optimise(
        H, [*variables] or [MASS], objective, constraints=constraints, trials=1, samples=4, verify=8, seed=1
    )


def _bounded(constraint: Any) -> object:
    return _searched(constraints=[constraint])


def _spread(uncertain: Any) -> object:
    return fx.robustness(H, [uncertain], samples=4, sensitivity=0, pose_samples=2, seed=0)


def _on(controller: Any) -> object:
    return control.closed_loop(H, HOME, controller, unstable="keep")


def _sampled(controller: Any) -> object:
    return control.simulate_control(H, HOME, controller=controller, base_motion=SHAKEN, duration=1e-3)


def _shaken(motion: Any) -> object:
    return fx.simulate(H, HOME, base_motion=motion, duration=2e-3, samples=3)


def _body(part: Any) -> object:
    return fx.natural_modes(H.replace({"legs.lower.mass": part.mass, "legs.lower.inertia": part.inertia}))


def _with_legs(legs: Any) -> object:
    return fx.natural_modes(fx.Hexapod(**(WHOLE | {"legs": legs})))


def _with_law(law: Any) -> object:
    return _with_legs(design.Legs(None, stiffness_law=law))


def _driven(drive: Any) -> object:
    return fx.paths.motor_loads(fx.Hexapod(**(PLAIN | {"drive": drive})), LOADS)


def _of_motion(motion: Any) -> object:
    return fx.equations_of_motion(H, motion)


def _nothing(made: Any) -> object:
    return repr(made)


WIDE = fx.PathRequirements(10.0)
MASS = fx.Variable("platform.mass", 20.0, 30.0)
WHOLE = {
    "base_joints": H.base_joints, "platform_joints": H.platform_joints, "platform_mass": H.platform_mass,
    "platform_mass_center": H.platform_mass_center, "platform_inertia": H.platform_inertia, "legs": H.legs, "home": HOME,
    "name": "own", "gravity": H.gravity, "limits": H.limits, "universal_axes": H.universal_axes, "short_forms": (), "suspension": None, "drive": None, "points": {"vertex": [0.0, 0.0, 0.1]},
}  # fmt: skip
PLAIN, MACHINES = WHOLE, (H, FULL)
LOADS = fx.paths.path_loads(fx.Hexapod(**WHOLE), LINE, samples=8)
CIRCLES = {
    "base_radius": 0.2, "platform_radius": 0.15, "height": 0.2, "platform_mass": 3.0, "platform_inertia": [0.02, 0.02, 0.03],
    "stiffness": 1e6, "base_half_angle": 0.2, "platform_half_angle": 0.3, "degrees": False, "damping": 0.1, "gravity": [0, 0, -9.81],
    "platform_mass_center": [0.0, 0.0, 0.01], "lower": design.LegPart.rod(0.1, 0.1), "upper": None, "limits": None, "name": "own",
    "base_angles": None, "platform_angles": None,
}  # fmt: skip
LAW = control.VelocityFeedback(1e3).on(LINEAR)
SPACE = {"A": LAW.A, "B": LAW.B, "C": LAW.C, "D": LAW.D, "measures": LAW.measures, "name": "own", "dt": None}

#: Every public class that is made by its users.
MADE = {
    "Box": Made(fx.Box, {name: [0.0, 0.01] for name in ("x", "y", "roll", "pitch", "yaw")} | {"z": [0.24, 0.25]},
                lambda box: fx.sweep(H, box, samples=4)),
    "Workspace": Made(fx.Workspace, {"box": fx.Box.about([0] * 6, 0.001, 0.01), "from_home": True}, lambda w: fx.sweep(H, w, samples=4)),
    "Pose": Made(fx.Pose, {"position": HOME.position, "rotation": np.eye(3)}, partial(fx.natural_modes, H)),
    "Motion": Made(fx.Motion, {"pose": HOME, "velocity": [0, 0, 0.1], "angular_velocity": [0] * 3, "acceleration": [0] * 3,
                               "angular_acceleration": [0] * 3}, _of_motion),
    "Trajectory": Made(fx.Trajectory, {"waypoints": LINE.waypoints, "times": LINE.times, "ends": "rest", "weights": None, "origin": None},
                       lambda path: fx.path_index(H, path, samples=16)),
    "Hexapod": Made(fx.Hexapod, WHOLE, fx.natural_modes),
    "Legs": Made(design.Legs, {"stiffness": 1e6, "damping": design.Damping(), "lower": H.legs.lower, "upper": H.legs.upper, "more": {},
                                "series_stiffness": [9e7], "loss_factor": 0.01, "joint_stiffness": design.JointStiffness(1.0), "joint_rest": HOME,
                                "stiffness_law": None},
                 _with_legs),
    "LegPart": Made(design.LegPart, {"mass": 1.0, "mass_center": [0.1, 0, 0], "inertia": [0.01, 0.02, 0.02]}, _body),
    "Damping": Made(design.Damping, {"prismatic": 1.0, "universal": 0.1, "spherical": 0.1},
                    lambda d: fx.linearise(H.replace({f"legs.damping.{k}": getattr(d, k) for k in ("prismatic", "universal")}), HOME).modes()),
    "Material": Made(design.flexures.Material, {"youngs_modulus": 2e11, "strength": 4e8, "poisson_ratio": 0.3},
                     lambda material: design.flexures.wire(0.02, 1e-3, material)),
    "JointStiffness": Made(design.JointStiffness, {"universal": [1.0, 2.0], "spherical": 1.0, "torsion": 1.0, "loss_factor": 0.01},
                           lambda joints: _with_legs(design.Legs(1e6, joint_stiffness=joints))),
    "ScrewLaw": Made(design.ScrewLaw, {"fixed": 8e7, "axial_rigidity": 4e7, "zero_length": 0.1}, _with_law),
    "HydraulicLaw": Made(design.HydraulicLaw, {"bulk_modulus": 1.4e9, "area_1": 2e-3, "area_2": 1e-3, "dead_1": 0.05, "dead_2": 0.05,
                                               "stroke": 1.0, "shortest": 0.05}, _with_law),
    "TableLaw": Made(design.TableLaw, {"lengths": [0.1, 0.5, 1.0], "stiffnesses": [9e7, 7e7, 6e7]}, _with_law),
    "Suspension": Made(design.Suspension, {"stiffness": 1e3 * np.eye(6), "damping": np.eye(6), "point": [0.0, 0.0, 0.01]},
                       lambda s: fx.natural_modes(fx.Hexapod(**(WHOLE | {"suspension": s})))),
    "Motor": Made(design.Motor, {"speeds": [0.0, 100.0, 200.0], "peak_torques": [9.0, 9.0, 5.0], "continuous_torques": [3.0, 2.0, 1.0],
                                 "max_speed": 150.0}, lambda motor: _driven(design.Drive(0.01, 0.9, motor=motor))),
    "Drive": Made(design.Drive, {"lead": 0.01, "efficiency": 0.9, "back_efficiency": 0.8, "gear_ratio": 2.0, "gear_efficiency": 0.95,
                                 "rotor_inertia": 1e-4, "gear_inertia": 1e-5, "screw_inertia": 1e-4, "motor": None}, _driven),
    "Limits": Made(design.Limits, {"leg_length": [0.1, 1.0], "universal_angle": 1.0, "spherical_angle": 1.0, "leg_distance": 0.001,
                                   "universal_moment": 10.0, "spherical_moment": 10.0, "leg_compression": 1e5, "leg_tension": 1e5,
                                   "leg_rate": 1.0, "leg_acceleration": 1.0, "leg_power": 1e3},
                   lambda limits: fx.check_limits(fx.Hexapod(**(WHOLE | {"limits": limits})), HOME)),
    "Excitation": Made(fx.Excitation, {"terms": SHAKEN.terms, "rotation": "rpy"}, _shaken),
    "Spectrum": Made(fx.excitation.Spectrum, vars(fx.vc_curve("VC-C")),
                     lambda s: (s.rms(64), fx.random_motion("z", s, samples=20))),
    "SimulationRun": Made(SimulationRun, {"hexapod": H, "pose": HOME, "base_motion": SHAKEN, "force": None, "moment": None, "leg_command": None,
                                          "start": "rest", "base": None, "unstretched_length": None, "loss_frequency": None},
                          lambda run: fx.simulate_many([run], duration=2e-3, samples=3)),
    "PathRequirements": Made(fx.PathRequirements, {"index": 10.0, "condition_number": None, "clearance": None, "limits": True, "reach": None,
                                                   "turn": 0.5, "joint": "universal"}, lambda r: fx.plan_path(H, HOME, UP, r, seed=1)),
    "Variable": Made(fx.Variable, {"targets": "platform.mass", "low": 20.0, "high": 30.0, "kind": "set", "name": "m", "log": False}, _searched),
    "JointCircle": Made(optimisation.JointCircle, {"plate": "base", "radius": (0.2, 0.25), "half_angle": None, "turn": None, "height": None,
                                                   "axes": "tangent"}, _searched),
    "Uncertain": Made(fx.Uncertain, {"target": "platform.mass", "spread": 0.1, "distribution": "uniform", "relative": True, "each": True}, _spread),
    "RandomLoad": Made(fx.vibration.RandomLoad, {"psd": [1.0, 2.0], "omega": [10.0, 20.0], "frequency": None, "axis": "force_x",
                                                 "point": (0.0, 0.0, 0.1), "name": "wind"},
                       lambda load: fx.random_response(H, HOME, loads=[load], loss_factor=0.01)),
    "PayloadCase": Made(fx.paths.PayloadCase, {"name": "full", "mass": 2.0, "position": (0.0, 0.0, 0.1), "inertia": (0.1, 0.1, 0.1),
                                               "force": (0.0, 1.0, 0.0), "moment": (0.0, 0.0, 0.1)},
                        lambda case: fx.paths.payload_loads(H, LINE, [case], samples=8)),
    "Payload": Made(optimisation.Payload, {"mass": (0.0, 1.0), "position": ((-0.01, 0.01), 0.0, 0.1)}, _spread),
    "LeastIndex": Made(fx.LeastIndex, {"region": HOME}, lambda o: _searched(objective=o)),
    "MeanIndex": Made(optimisation.MeanIndex, {"region": LINE.waypoints, "weights": [1.0, 2.0]}, lambda o: _searched(objective=o)),
    "Dexterity": Made(optimisation.Dexterity, {"region": HOME}, lambda o: _searched(objective=o)),
    "ConditionNumber": Made(optimisation.ConditionNumber, {"most": 100.0, "region": HOME}, _bounded),
    "Deflection": Made(optimisation.Deflection, {"most": 1.0, "force": 1.0, "region": HOME}, _bounded),
    "DesignLimits": Made(optimisation.DesignLimits, {"region": HOME}, _bounded),
    "Footprint": Made(optimisation.Footprint, {"most": 10.0, "plate": "base"}, _bounded),
    "JointAngle": Made(optimisation.JointAngle, {"joint": "universal", "most": 1.0, "region": HOME}, _bounded),
    "LegClearance": Made(optimisation.LegClearance, {"least": 1e-3, "region": HOME}, _bounded),
    "LegLength": Made(optimisation.LegLength, {"least": 0.01, "most": 1.0, "region": HOME}, _bounded),
    "Stroke": Made(optimisation.Stroke, {"most": 1.0, "region": BOX}, _bounded),
    "TotalMass": Made(optimisation.TotalMass, {"most": 100.0}, _bounded),
    "PID": Made(control.PID, {"kp": 1e3, "kd": 1.0, "ki": 0.0, "space": "joint", "actuator": "force", "bandwidth": None}, _on),
    "VelocityFeedback": Made(control.VelocityFeedback, {"gain": 1e3, "legs": (1, 2, 3)}, _on),
    "ForceFeedback": Made(control.ForceFeedback, {"gain": 10.0, "leak": 0.0, "legs": (1, 2, 3)}, _on),
    "Controller": Made(control.Controller, SPACE, _on),
    "Hardware": Made(control.Hardware, {"force_limit": 100.0, "noise": {}, "seed": 1},
                     lambda own: control.simulate_control(H, HOME, controller=LAW.sampled(1e-4), base_motion=SHAKEN, hardware=own, duration=1e-3)),
    "LegSpeed": Made(fx.paths.LegSpeed, {"rate": 0.1, "acceleration": 1.0}, lambda s: fx.plan_path(H, HOME, UP, WIDE, timing=s, seed=1)),
    # methods
    "Box.about": Made(fx.Box.about, {"pose": HOME, "position": 0.001, "angle": 0.01}, lambda box: fx.sweep(H, box, samples=4)),
    "Box.scale": Made(BOX.scale, {"points": np.zeros((2, 6))}, _nothing),
    "Workspace.about_home": Made(fx.Workspace.about_home, {"position": 0.001, "angle": 0.01}, lambda w: fx.sweep(H, w, samples=4)),
    "Pose.from_rpy": Made(fx.Pose.from_rpy, dict.fromkeys(("x", "y", "roll", "pitch", "yaw"), 0.0) | {"z": 0.24, "degrees": True},
                          partial(fx.natural_modes, H)),
    "Pose.from_angles": Made(fx.Pose.from_angles, {"position": HOME.position, "angles": [0.1, 0, 0], "order": "ZXZ", "degrees": False,
                                                   "pivot": [0, 0, 0.1]}, partial(fx.natural_modes, H)),
    "Pose.angles": Made(HOME.angles, {"order": "xyz", "degrees": True}, _nothing),
    "Pose.position_about": Made(HOME.position_about, {"pivot": [0, 0, 0.1]}, _nothing),
    "Pose.displaced": Made(HOME.displaced, {"by": fx.Pose([0, 0, 0.001])}, partial(fx.natural_modes, H)),
    "Hexapod.from_circles": Made(fx.Hexapod.from_circles, CIRCLES, fx.natural_modes),
    "Hexapod.from_values": Made(fx.Hexapod.from_values, {"values": H.values(), "short_forms": ()}, fx.natural_modes),
    "Hexapod.from_toml": Made(fx.Hexapod.from_toml, {"text": H.to_toml()}, fx.natural_modes),
    "Hexapod.replace": Made(lambda changes: H.replace(changes), {"changes": {"platform.mass": 25.0}}, fx.natural_modes),
    "Hexapod.compiled": Made(H.compiled, {"base": fx.Pose([0, 0, 0.1]), "joint": "universal"},
                             lambda handle: handle.stability_index(HOME.packed)),
    **{f"CompiledHexapod.{name}": Made(getattr(H.compiled(), name), dict.fromkeys(more, np.zeros(6)) | {"pose": HOME.packed}, _nothing)
       for name, more in {"stability_index": (), "natural_frequencies": (), "leg_lengths": (), "jacobian": (), "linearised": ("wrench",),
                          "forward_dynamics": ("twist", "leg_force", "wrench"), "inverse_dynamics": ("twist", "acceleration", "wrench")}.items()},
    "Hexapod.save": Made(H.save, {"path": "own.toml"}, _nothing),
    "LegPart.rod": Made(design.LegPart.rod, {"mass": 1.0, "length": 0.1, "radius": 0.01, "upper": True}, _body),
    "Trajectory.grid": Made(LINE.grid, {"samples": 4}, _nothing),
    "Trajectory.poses": Made(LINE.poses, {"samples": 4}, partial(fx.natural_modes, H)),
    "Trajectory.length": Made(LINE.length, {"characteristic_length": 0.1}, _nothing),
    "Trajectory.retimed": Made(LINE.retimed, {"duration": 2.0}, lambda path: fx.path_index(H, path, samples=16)),
    "Excitation.ramped": Made(SHAKEN.ramped, {"duration": 0.01}, _shaken),
    "Excitation.stopped": Made(SHAKEN.stopped, {"time": 0.001, "fall": 0.001}, _shaken),
    "Excitation.delayed": Made(SHAKEN.delayed, {"delay": 0.001}, _shaken),
    "Excitation.on": Made(SHAKEN.on, {"axes": {"z": "x"}}, _shaken),
    "Excitation.for_use": Made(SHAKEN.for_use, {"use": "motion"}, _shaken),
    "Excitation.evaluate": Made(SHAKEN.evaluate, {"times": [0.0, 1.0]}, _nothing),
    "Excitation.motion": Made(SHAKEN.motion, {"times": [0.0, 1.0], "base": None}, _nothing),
    "Spectrum.rms": Made(fx.vc_curve("VC-C").rms, {"samples": 100}, _nothing),
    "VelocityFeedback.on": Made(control.VelocityFeedback(1e3).on, {"linear": LINEAR}, _on),
    "PID.on": Made(control.PID(1e3, 1.0).on, {"linear": LINEAR}, _on),
    "Controller.on": Made(LAW.on, {"linear": LINEAR}, _on),
    "Controller.sampled": Made(LAW.sampled, {"dt": 1e-4, "method": "tustin", "delay": 1}, _sampled),
    "SweepStore.create": Made(workspace.SweepStore.create, {"path": "s.zarr", "hexapod": H, "region": BOX, "quantities": None, "samples": 8,
                                                            "seed": 0, "joint": "universal", "chunk": 4, "keep_poses": True},
                              lambda store: store.run(1)),
    "SweepStore.resume": Made(workspace.SweepStore.resume, {"path": "swept.zarr", "hexapod": H, "region": BOX, "quantities": None,
                                                            "samples": 8, "seed": 0, "joint": "universal", "chunk": None},
                              lambda store: store.run(1)),
}  # fmt: skip
#: What is given back by functions, or is a base of classes of one's own: no user calls their constructors.
FOUND = {"Certificate", "CompiledHexapod", "Constraint", "ConstraintQuantity", "ControlLaw", "DesignDerivatives", "FoundPose", "Linearisation", "Objective", "OptimalDesign",
         "ParetoFront", "PathIndex", "Plan", "PoseSet", "Requirement", "Robustness", "SweepStore", "UncertainParameter", "Verification",
         "Check"}  # fmt: skip


#: What the machine with everything has besides, of the arguments that make a machine.
MORE = {"suspension": FULL.suspension, "drive": FULL.drive, "points": FULL.points}


@pytest.fixture
def turned(monkeypatch):
    """Takes the machine with everything for the plain one, or the plain one again, in what is done with what is made."""

    def take(machine):
        monkeypatch.setitem(globals(), "H", machine)
        monkeypatch.setitem(globals(), "WHOLE", PLAIN | MORE if machine is FULL else PLAIN)

    return take


@pytest.fixture
def store(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    workspace.SweepStore.create(tmp_path / "swept.zarr", H, BOX, samples=8).run(1)
    return tmp_path


def _used(made, given):
    with warnings.catch_warnings(), limited():
        warnings.simplefilter("ignore")
        made.use(made.make(**given))


@pytest.mark.parametrize("machine", [H, FULL], ids=["plain", "everything"])
def test_every_constructor_is_attacked_and_its_right_arguments_are_right(machine, store, turned):
    turned(machine)
    plain = {name for name in CLASSES if not issubclass(PUBLIC[name], tuple | BaseException)}
    assert {name for name in MADE if "." not in name} - {"SimulationRun"} == plain - FOUND - {"SimulationRun"}
    for name, made in MADE.items():
        accepted = {
            p.name
            for p in inspect.signature(made.make).parameters.values()
            if p.kind not in (p.VAR_KEYWORD, p.VAR_POSITIONAL)
        }
        assert set(made.right) >= accepted - {"units"}, name
        _used(made, made.right)


@pytest.mark.parametrize("part", range(4))
def test_what_is_made_of_bad_values_is_refused_or_of_use(part, store, turned):
    names = sorted(MADE)[part::4]
    for draw in rounds(0.9 / 4, f"objects {part}", most=100):
        turned(draw.choice(MACHINES))
        name = draw.choice(names)
        made = MADE[name]
        changed = draw.sample(sorted(made.right), k=min(len(made.right), draw.choice((1, 1, 1, 2))))
        given = made.right | {parameter: draw.choice(BAD) for parameter in changed}
        try:
            _used(made, given)
            tried("constructors and methods with bad values", "of use")
        except (fx.FlexapodError, TypeError) as error:
            own = isinstance(error, fx.FlexapodError)
            tried("constructors and methods with bad values", "an error of Flexapod" if own else "TypeError")
        except BaseException as error:
            if isinstance(error, KeyboardInterrupt):
                raise
            if "truth value" in str(error) and any(isinstance(made.right[parameter], bool) for parameter in changed):
                continue  # NumPy's refusal of an array where yes or no is asked for
            shown = {parameter: repr(given[parameter])[:60] for parameter in changed}
            pytest.fail(f"{name} with {shown}: {type(error).__name__}: {str(error)[:200]}")
