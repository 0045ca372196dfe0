"""How functions of a machine and a pose are called: what may be left out, and in which forms a pose may be given."""

import inspect

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from tests.helpers.plain import plain_machine
from tests.helpers.public import FUNCTIONS, PUBLIC

import flexapod as fx

MACHINE = plain_machine("motion-base")
HOME = MACHINE.home
SIX = [0.1, -0.05, 2.4, 0.02, -0.03, 0.1]
POSE = fx.Pose.from_rpy(*SIX)

OF_A_POSE = [
    name
    for name in FUNCTIONS
    if PUBLIC[name].__module__.startswith("flexapod.mechanics.")
    and list(inspect.signature(PUBLIC[name]).parameters)[:2] == ["hexapod", "pose"]
]


def flat(result) -> list[np.ndarray]:
    """Every number of a result, whatever its type."""
    if isinstance(result, fx.Pose):
        return [result.position, result.matrix]
    if isinstance(result, tuple | list):
        return [number for item in result for number in flat(item)]
    if hasattr(result, "data_vars"):
        return [variable.values for variable in result.data_vars.values()]
    if hasattr(result, "__dataclass_fields__"):
        return flat([getattr(result, name) for name in result.__dataclass_fields__])
    return [np.asarray(result)]


def same(one, other) -> bool:
    return all(str(a.tolist()) == str(b.tolist()) for a, b in zip(flat(one), flat(other), strict=True))


@pytest.mark.parametrize("name", OF_A_POSE)
def test_pose_left_out_is_home_and_six_numbers_are_a_pose(name):
    function = PUBLIC[name]
    assert same(function(MACHINE), function(MACHINE, HOME))
    assert same(function(MACHINE, SIX), function(MACHINE, POSE))


@pytest.mark.parametrize("name", OF_A_POSE)
def test_what_follows_the_pose_is_keyword_only(name):
    kinds = {p.kind for p in list(inspect.signature(PUBLIC[name]).parameters.values())[2:]}
    assert kinds <= {inspect.Parameter.KEYWORD_ONLY}


@pytest.mark.parametrize("name", OF_A_POSE)
def test_a_design_without_home_says_so(name):
    with pytest.raises(fx.PoseError, match=r"pose is not given, and 'motion-base' names no home pose.*\[home\]"):
        PUBLIC[name](MACHINE.replace({"home": None}))


def test_condition_number_does_not_depend_on_where_the_base_is():
    base = fx.Pose([1.0, 2.0, 3.0], Rotation.from_euler("xyz", [0.3, -0.2, 1.0]))
    carried = fx.Pose(base.position + base.matrix @ POSE.position, base.matrix @ POSE.matrix)
    moved = fx.condition_number(MACHINE, carried, base=base)
    np.testing.assert_allclose(moved, fx.condition_number(MACHINE, POSE), rtol=1e-12)


def test_modes_have_frequencies_in_hertz():
    modes = fx.natural_modes(MACHINE)
    omega, shape = modes
    np.testing.assert_allclose(modes.frequency, omega / 2 / np.pi, rtol=1e-15)
    assert shape.shape == (6, 6)
    assert modes.damping_ratio.tolist() == [0.0] * 6
    many = fx.natural_modes(MACHINE, [SIX, SIX])
    assert many.frequency.shape == many.damping_ratio.shape == (2, 6)
    damped = fx.linearise(MACHINE).modes()
    np.testing.assert_allclose(damped.frequency, damped.omega / 2 / np.pi, rtol=1e-15)


def test_poses_and_motions_are_equal_by_value():
    again = fx.Pose.from_rpy(*SIX)
    assert again == POSE
    assert hash(POSE) == hash(again)
    assert fx.Pose.from_rpy(*SIX[:5], 0.2) != POSE
    assert fx.Pose([0.0, 0, 1]) == fx.Pose([-0.0, 0, 1])
    assert hash(fx.Pose([0.0, 0, 1])) == hash(fx.Pose([-0.0, 0, 1]))
    assert fx.Pose(POSE.position[None], POSE.matrix[None]) != POSE
    assert POSE != "home"
    assert len({POSE, again, HOME}) == 2
    assert fx.Motion(POSE) == fx.Motion(again) == fx.Motion(SIX)
    assert hash(fx.Motion(POSE)) == hash(fx.Motion(again))
    assert fx.Motion(POSE) != fx.Motion(POSE, velocity=[0, 0, 1])
    assert fx.Motion(POSE) != POSE


def test_angles_in_degrees():
    degrees = fx.Pose.from_rpy(0, 0, 1, [10, 20], -5, 30, degrees=True)
    radians = fx.Pose.from_rpy(0, 0, 1, np.radians([10, 20]), np.radians(-5), np.radians(30))
    assert degrees == radians
