"""Corners of statics and kinematics: singular poses met on the way, poses that no leg can take, single limits."""

import pytest

import flexapod as fx
from flexapod.mechanics import statics


@pytest.fixture(scope="module")
def machine():
    return fx.load("mukherjee-i")


def test_an_equilibrium_search_that_meets_a_singular_pose_says_where(machine, monkeypatch):
    """Rounding hardly ever lets it be singular to the last digit, so the core's word for it is put in its mouth."""
    real = statics._core.settle
    monkeypatch.setattr(statics._core, "settle", lambda *given: (real(*given)[0], statics._core.Rest.singular))
    lengths = fx.inverse_kinematics(machine, fx.Pose([0, 0, 0.89]))
    with pytest.raises(
        fx.SingularPoseError, match=r"the search for equilibrium met Pose\(.*no stiffness in some direction"
    ):
        fx.static_equilibrium(machine, lengths, start=fx.Pose([0, 0, 0.89]))


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
