"""Every public function checks its design, pose and joint model at its entry, before anything is computed."""

import inspect

import numpy as np
import pytest
from tests.helpers.public import FUNCTIONS, PUBLIC

import flexapod as fx

MACHINE = fx.load("mukherjee-ii")
OF_A_MACHINE = [name for name in FUNCTIONS if "hexapod" in inspect.signature(PUBLIC[name]).parameters]
WITH_JOINT = [name for name in OF_A_MACHINE if "joint" in inspect.signature(PUBLIC[name]).parameters]

#: Something for each required argument, good enough that the check of the design or the joint model comes first.
GIVEN = {
    "path": "never.xml",
    "lengths": np.full(6, 0.1),
    "unstretched_length": np.full(6, 0.1),
    "number": 1,
    "mode": 1,
    "dataset": None,
    "kp": [1.0, 2.0],
    "kd": [1.0, 2.0],
    "law": fx.control.VelocityFeedback(1.0),
    "against": fx.optimisation.TotalMass(),
    "psd": fx.vc_curve("VC-C"),
    "requirements": fx.PathRequirements(10.0),
    "base_motion": fx.harmonic("z", 1e-6, 10.0),
    "controller": fx.control.VelocityFeedback(1.0),
    "duration": 0.01,
    "omega": [10.0],
    "amplitude": 1e-6,
    "axis": "z",
    "variables": [fx.Variable("platform.mass", 1.0, 2.0)],
    "uncertain": [fx.Uncertain("legs.stiffness", 0.1)],
    "payloads": [fx.paths.PayloadCase("full", 1.0)],
    "start": MACHINE.home,
    "end": MACHINE.home,
    "goal": MACHINE.home,
    "trajectory": fx.Trajectory(fx.Pose([[0, 0, 0.085], [0, 0, 0.086]]), [0, 1]),
    "region": MACHINE.home,
    "pose": MACHINE.home,
}


def call(name, hexapod, **more):
    """Call a function with something for each of its required arguments."""
    given = {}
    for parameter in inspect.signature(PUBLIC[name]).parameters.values():
        if parameter.default is parameter.empty and parameter.kind is not parameter.VAR_KEYWORD:
            given[parameter.name] = hexapod if parameter.name == "hexapod" else GIVEN.get(parameter.name)
    if name in ("path_index", "path_loads", "payload_loads"):
        given["path"] = GIVEN["trajectory"]
    return PUBLIC[name](**{**given, **more})


@pytest.mark.parametrize("name", OF_A_MACHINE)
def test_a_name_is_not_a_design(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(fx.DesignError, match=r"'mukherjee-ii'; it must be a flexapod Hexapod.*flexapod\.load"):
        call(name, "mukherjee-ii")


@pytest.mark.parametrize("name", WITH_JOINT)
def test_an_unknown_joint_model_is_told(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(fx.ArgumentError, match="joint is 'spin-free'; it must be"):
        call(name, MACHINE, joint="spin-free")
