"""A function that needs one pose needs one of every pose argument: a batch is refused by name, never half used."""

import inspect

import numpy as np
import pytest
from tests.helpers.public import PUBLIC
from tests.project.test_raises import CALLS

import flexapod as fx

MACHINE = fx.load("motion-base")
TWO = fx.Pose([[0.0, 0.0, 0.0], [0.0, 0.0, 5.0]])
TWO_HOMES = fx.Pose(np.tile(MACHINE.home.position, (2, 1)))
LAW = fx.control.VelocityFeedback(1e4)
#: What the functions need besides a machine and a pose.
NEEDS = {
    "viscous_equivalent": {"loss_frequency": 10.0},
    "closed_loop": {"controller": LAW},
    "controlled_random_response": {"controller": LAW, "psd": fx.vc_curve("VC-C"), "axis": "z"},
    "controlled_transmissibility": {"controller": LAW, "omega": [1.0]},
    "gain_map": {"kp": [1e6], "kd": [1e5]},
    "gain_schedule": {"feedback": "velocity"},
    "random_response": {"psd": fx.vc_curve("VC-C"), "axis": "z"},
    "simulate": {"duration": 1e-3},
    "simulate_control": {
        "controller": LAW.on(fx.linearise(MACHINE)).sampled(1e-3),
        "base_motion": fx.harmonic("z", 1e-6, 30.0),
        "duration": 1e-2,
    },
    "static_equilibrium": {"unstretched_length": fx.inverse_kinematics(MACHINE)},
    "transmissibility": {"omega": [1.0]},
    "write_mat": {"path": "never.mat"},
}


def takes_many(name):
    """Whether the function takes a batch of poses, and so may take one of bases."""
    try:
        CALLS[name](MACHINE, TWO_HOMES)
    except fx.PoseError:
        return False
    return True


def with_base(name):
    parameters = inspect.signature(PUBLIC[name]).parameters
    return "base" in parameters and "hexapod" in parameters and "dataset" not in parameters


@pytest.mark.parametrize(
    "name", sorted(name for name in PUBLIC if inspect.isfunction(PUBLIC[name]) and with_base(name))
)
def test_many_bases_are_refused_where_one_pose_is_needed(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    if name in CALLS and takes_many(name):
        return  # a batch of bases has a batch of results
    given = {"hexapod": MACHINE, **NEEDS.get(name, {}), "base": TWO}
    with pytest.raises(fx.PoseError, match=r"base has batch axes \(2,\); one pose is needed"):
        PUBLIC[name](**given)


def test_many_starts_are_refused_where_one_is_needed():
    lengths = fx.inverse_kinematics(MACHINE)
    with pytest.raises(fx.PoseError, match=r"start has batch axes \(2,\)"):
        fx.static_equilibrium(MACHINE, lengths, start=TWO_HOMES)
    with pytest.raises(fx.PoseError, match=r"start has batch axes \(2,\)"):
        fx.plan_path(MACHINE, TWO_HOMES, MACHINE.home, requirements=fx.PathRequirements(1.0))


def test_an_animation_is_on_one_base(tmp_path):
    shaken = fx.simulate(MACHINE, duration=1e-2)
    with pytest.raises(fx.PoseError, match=r"base has batch axes \(2,\)"):
        fx.animate_simulation(shaken, MACHINE, tmp_path / "a.gif", base=TWO)
