"""Every public function, by its own signature, with bad values in place of good ones.

Whatever comes, an answer or one of Flexapod's own errors; TypeError for what is no argument at all. Nothing hangs.
FLEXAPOD_ATTACK_SECONDS: how long in all.
"""

import inspect
import warnings

import numpy as np
import pytest
from tests.attack.bounded import limited, rounds, tried
from tests.helpers.everything import machine_with_everything
from tests.helpers.plain import plain_machine
from tests.helpers.public import FUNCTIONS, PUBLIC

import flexapod as fx
from flexapod import control, optimisation
from flexapod.certificates.file import write_certificate
from flexapod.simulation.run import SimulationRun

pytest.importorskip("optuna")
pytest.importorskip("ompl")
pytest.importorskip("zarr")

H = plain_machine("precision-positioner")
FULL = machine_with_everything()  # the same machine with all that a design may say
HOME = fx.home_pose(H)
UP = fx.Pose(HOME.position + np.array([0, 0, 0.002]))
SHAKEN = fx.harmonic("z", 1e-6, 100.0)
BOX = fx.Box.about(HOME, 0.001, 0.01)
LINE = fx.Trajectory(fx.Pose(np.stack([HOME.position, UP.position])), [0.0, 1.0])
LINEAR = fx.linearise(H, HOME)
SAMPLED = control.VelocityFeedback(1e3).on(LINEAR).sampled(1e-4)
SWEPT = fx.sweep(H, BOX, samples=16, seed=0)

#: Something right for a parameter of a name, in all functions that do not say otherwise below.
STEEL = fx.design.flexures.Material(200e9, 400e6)
WIRE = fx.design.flexures.wire(0.02, 1e-3, STEEL)
PROVED = fx.certify(H, fx.Box.about(HOME, 1e-4, 1e-3), at_least=1.0)
RIGHT = {
    "hexapod": H, "pose": HOME, "base": None, "joint": "universal", "force": (0.0, 0.0, 1.0), "moment": (0.0, 0.0, 0.1),
    "lengths": fx.inverse_kinematics(H, HOME), "unstretched_length": fx.inverse_kinematics(H, HOME), "leg_force": np.ones(6),
    "number": 1, "omega": [10.0, 20.0], "samples": 16, "seed": 1, "threads": 1, "progress": None, "axis": "z",
    "controller": control.VelocityFeedback(1e3), "kp": [1.0, 2.0], "kd": [1.0, 2.0], "nearness": 1e-9, "region": BOX,
    "gains": [10.0, 100.0, 1000.0], "psd": fx.vc_curve("VC-C"), "amplitude": 1e-6, "duration": 0.005, "times": np.linspace(0.0, 0.003, 7),
    "base_motion": SHAKEN, "path": LINE, "start": HOME, "goal": UP, "requirements": fx.PathRequirements(10.0), "box": BOX,
    "variables": [fx.Variable("platform.mass", 20.0, 30.0)], "against": optimisation.TotalMass(), "trials": 2, "verify": 32,
    "uncertain": [fx.Uncertain("legs.damping.prismatic", 0.1), fx.Uncertain("platform.mass", 0.1)], "sweep": SWEPT, "linear": LINEAR, "feedback": "velocity",
    "runs": [SimulationRun(H, HOME)], "modes": fx.natural_modes(H), "damped": LINEAR.modes(), "spectrum": fx.vc_curve("VC-C"),
    "rms": 1.0, "omega_min": 1.0, "omega_max": 10.0, "peak": 1.0, "acceleration": 1.0, "coefficients": [0.0, 1.0], "change": 1.0,
    "omega_start": 1.0, "omega_end": 10.0, "height": 2.0, "period": 8.0, "waypoints": fx.Pose(np.stack([HOME.position, UP.position])),
    "values": 1e-6 * np.arange(7.0), "refine": 0, "pose_samples": 4, "sensitivity": 0, "legs": (1, 2), "starts": 2, "bound": 10.0,
    "point": (0.0, 0.0, 0.01), "loss_factor": 0.01, "quantities": ("omega_1",), "at_least": 5.0, "gap": 1e-3, "section": 0.5,
    "x": 0.0, "y": 0.0, "z": [0.24, 0.25], "roll": 0.0, "pitch": 0.0, "yaw": 0.0, "timeout": 1.0, "window": (0.0, 0.004), "time_limit": 5.0,
}  # fmt: skip
OWN = {
    ("animate_mode", "path"): "a.gif", ("animate_simulation", "path"): "a.gif", ("animate_simulation", "frames"): 2,
    ("animate_simulation", "dataset"): fx.simulate(H, HOME, base_motion=SHAKEN, duration=0.005, samples=5),
    ("write_mat", "path"): "m.mat", ("write_mjcf", "path"): "m.xml", ("write_sdf", "path"): "m.sdf", ("write_urdf", "path"): "m.urdf",
    ("open_sweep", "path"): "swept.zarr", ("read_joints", "path"): "joints.csv", ("read_time_series", "path"): "way.csv",
    ("sea_motion", "response"): {"z": lambda omega: omega * 0 + 1.0}, ("sea_motion", "spectrum"): fx.excitation.sea_spectrum(2, 8),
    ("simulate_control", "controller"): SAMPLED, ("load", "name_or_path"): "motion-base", ("template", "name"): "own",
    ("vc_curve", "name"): "VC-A", ("plan_slice", "plan"): None, ("plan_path", "start"): HOME, ("cluster", "address"): "tcp://127.0.0.1:1",
    ("near_repeated", "omega"): np.arange(1.0, 7.0), ("gravity_at", "elevation"): 1.0, ("viscous_equivalent", "loss_frequency"): 10.0,
    ("leaf", "length"): 0.02, ("leaf", "thickness"): 1e-3, ("leaf", "width"): 0.01, ("leaf", "material"): STEEL,
    ("wire", "length"): 0.02, ("wire", "diameter"): 1e-3, ("wire", "material"): STEEL,
    ("circular_notch", "radius"): 0.01, ("circular_notch", "thickness"): 1e-3, ("circular_notch", "width"): 0.01,
    ("circular_notch", "material"): STEEL, ("round_notch", "radius"): 0.01, ("round_notch", "diameter"): 1e-3,
    ("round_notch", "material"): STEEL, ("crossed", "first"): WIRE, ("crossed", "second"): WIRE,
    ("leg_keys", "at_base"): WIRE, ("leg_keys", "at_platform"): WIRE, ("check_certificate", "certificate"): PROVED, ("read_certificate", "path"): "proved.json",
    ("random_response", "frequency"): None, ("random_response", "loads"): (), ("controlled_random_response", "frequency"): None, ("controlled_random_response", "loads"): (), ("optimise", "start"): None, ("sine_sweep", "law"): "logarithmic",
    ("gain_schedule", "samples"): 2, ("frequency_grid", "omega_min"): None, ("frequency_grid", "omega_max"): None,
    ("simulate", "times"): None, ("simulate_many", "times"): None, ("simulate", "start"): "rest", ("transmissibility", "omega"): [10.0],
    ("root_locus", "legs"): (1, 2, 3), ("gain_map", "controller"): control.PID(1.0, 1.0), ("path_index", "samples"): 16, ("plot", "result"): fx.natural_modes(H), ("payload_loads", "payloads"): [fx.paths.PayloadCase("full", 2.0)],
    ("motor_loads", "hexapod"): H.replace({"drive": {"lead": 0.01, "efficiency": 0.9}}), ("motor_loads", "dataset"): fx.paths.path_loads(H, LINE, samples=8),
    ("motor_loads", "hold"): 1.0,
}  # fmt: skip
#: What a call needs besides its required arguments, to be short.
NEEDED = {
    "gain_schedule": ("samples", "gains"), "optimise": ("trials", "samples", "verify"), "pareto_front": ("trials", "samples", "refine"),
    "robustness": ("samples", "sensitivity", "pose_samples"), "simulate": ("duration", "samples"), "simulate_many": ("duration", "samples"),
    "stepped_sine": ("omega",), "random_response": ("psd", "axis", "omega"), "worst_pose": ("region", "samples", "starts"), "harmonic": ("omega",),
    "sweep": ("region", "samples"), "transmissibility": ("omega",), "controlled_transmissibility": ("omega",), "controlled_random_response": ("psd", "axis", "omega"), "root_locus": ("gains",),
    "animate_simulation": ("frames",), "sampling_time": ("region", "samples"), "path_index": ("samples",), "pose_grid": ("z",), "cluster": ("timeout",),
    "payload_loads": ("samples",), "simulate_control": ("pose",), "gain_map": ("nearness",), "certified_box": ("time_limit",),
}  # fmt: skip
FULL_LOADS = fx.paths.path_loads(FULL, LINE, samples=8)
#: What the machine with everything is refused by, and why.
REFUSED = {"certify_limits": "limits leg forces"}
#: Not called rightly here: what they need takes long to make, or a cluster.
NEVER_RIGHT = {"cluster", "plan_slice"}

BAD = [
    None, True, 0, -1, 3, 7, 1.5, 0.0, -0.5, float("nan"), float("inf"), 1e308, -1e308, 5e-324, 10**400, -(2**63), 2**70, 1j, "", "x",
    "nan", b"x", [], [[]], {}, set(), (), (1,), [1, 2], ["a", "b"], [None], [float("nan")] * 6, [0.0] * 6, [1e200] * 6, [0] * 7,
    np.zeros(6), np.zeros(0), np.zeros((2, 6)), np.zeros((0, 6)), np.full((3, 3), np.nan), np.ones(6) * 1j, np.array("x"), np.array(None),
    np.zeros((2, 2, 2, 2)), np.ma.masked_array([1.0, 2.0], [0, 1]), np.datetime64("2020-01-01"), object(), object, print, lambda: 1,
    {"x": 1}, {1: 2}, range(3), iter([1]), slice(1), np.float32(2), np.int8(3), np.bool_(True), H, HOME, BOX, LINE, fx, fx.load,
    fx.Pose(np.zeros((2, 3))), fx.Pose(np.zeros((0, 3))), fx.Motion(HOME), SHAKEN, SWEPT, "cubic-isolator", "z", "x" * 3000, "a\0b", "/", "..",
]  # fmt: skip


def _right(name, parameter):
    return OWN.get((name, parameter), RIGHT.get(parameter))


def _arguments(name, machine=H):
    """The right arguments of a short call, for one of the machines."""
    parameters = inspect.signature(PUBLIC[name]).parameters.values()
    required = [p.name for p in parameters if p.default is p.empty and p.kind not in (p.VAR_KEYWORD, p.VAR_POSITIONAL)]
    right = {parameter: _right(name, parameter) for parameter in (*required, *NEEDED.get(name, ()))}
    if machine is FULL and "hexapod" in right:
        right |= {"hexapod": FULL} | ({"dataset": FULL_LOADS} if name == "motor_loads" else {})
    return right


def _is_flag(name, parameter):
    return inspect.signature(PUBLIC[name]).parameters[parameter].annotation in (bool, "bool")


@pytest.fixture
def files(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    store = fx.workspace.SweepStore.create(tmp_path / "swept.zarr", H, fx.random_poses(BOX, 8))
    store.run(1)
    rows = "".join(f"{leg},{leg},0,0,{leg},{leg},1\n" for leg in range(1, 7))
    (tmp_path / "joints.csv").write_text("leg,base_x,base_y,base_z,platform_x,platform_y,platform_z\n" + rows)
    (tmp_path / "way.csv").write_text("time,z_um\n" + "".join(f"{k / 10},{k % 2}\n" for k in range(9)))
    write_certificate(PROVED, tmp_path / "proved.json")
    return tmp_path


def _call(name, given):
    with warnings.catch_warnings(), limited():
        warnings.simplefilter("ignore")
        found = PUBLIC[name](**given)
        if name == "cluster":
            with found:
                pass


@pytest.mark.parametrize("machine", [H, FULL], ids=["plain", "everything"])
def test_every_function_has_right_arguments_here(machine, files):
    """Else an attack stops at the first of them, and the others are never reached."""
    right = {name: _arguments(name, machine) for name in FUNCTIONS}
    assert {name for name, given in right.items() if any(value is None for value in given.values())} <= NEVER_RIGHT
    for name in sorted(set(FUNCTIONS) - NEVER_RIGHT):
        if machine is FULL and "hexapod" not in right[name]:
            continue
        if machine is FULL and name in REFUSED:
            with pytest.raises(fx.FlexapodError, match=REFUSED[name]):
                _call(name, right[name])
            continue
        try:
            _call(name, right[name])
        except Exception as error:
            pytest.fail(f"{name}: {type(error).__name__}: {error}")


@pytest.mark.parametrize("part", range(8))
def test_bad_values_are_answered_by_flexapods_errors(part, files):
    names = [name for name in FUNCTIONS[part::8] if name != "cluster"]  # test_cluster.py
    for draw in rounds(0.7 / 8, f"part {part}", most=150):
        name = draw.choice(names)
        given = _arguments(name, draw.choice((H, FULL)))
        accepted = [p.name for p in inspect.signature(PUBLIC[name]).parameters.values() if p.kind != p.VAR_KEYWORD]
        changed = draw.sample(accepted, k=min(len(accepted), draw.choice((1, 1, 1, 2))))
        given |= {parameter: draw.choice(BAD) for parameter in changed}
        try:
            _call(name, given)
            tried("calls of the library with bad values", "answered")
        except (fx.FlexapodError, TypeError) as error:
            own = isinstance(error, fx.FlexapodError)
            tried("calls of the library with bad values", "an error of Flexapod" if own else "TypeError")
        except BaseException as error:
            if isinstance(error, KeyboardInterrupt):
                raise
            if "truth value" in str(error) and any(_is_flag(name, parameter) for parameter in changed):
                continue  # NumPy's refusal of an array where yes or no is asked for
            shown = {parameter: repr(given[parameter])[:60] for parameter in changed}
            pytest.fail(f"{name} with {shown}: {type(error).__name__}: {str(error)[:200]}")
