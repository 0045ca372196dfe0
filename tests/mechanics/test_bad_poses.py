"""Poses, motions and lengths that cannot be: the error says what, which value, what is needed and what to do."""

import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.helpers.plain import plain_machine
from tests.helpers.support import MACHINES, center

import flexapod as fx

HEXAPOD = plain_machine("motion-base")
HOME = center(HEXAPOD)
MEETING = HEXAPOD.base_joints[2] - HEXAPOD.platform_joints[2]  # the third leg's joints at one point
NAN, INF = float("nan"), float("inf")


def refused(error, *parts):
    """The error's message holds all parts, in this order."""
    return pytest.raises(error, match="(?s)" + ".*".join(map(re.escape, parts)))


# --- poses and motions ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("make", "parts"),
    [
        (lambda: fx.Pose([0, 0, NAN]), ["position", "NaN", "must be finite"]),
        (lambda: fx.Pose([0, 0, INF]), ["position", "infinity", "must be finite"]),
        (lambda: fx.Pose([0, 0]), ["position", "(2,)", "3 numbers"]),
        (lambda: fx.Pose(1.0), ["position", "()", "3 numbers"]),
        (lambda: fx.Pose("here"), ["position", "'here'", "3 numbers"]),
        (lambda: fx.Pose([0, 0, 1], np.ones((3, 3))), ["rotation", "R R^T", "identity"]),
        (lambda: fx.Pose([0, 0, 1], np.diag([1.0, 1, -1])), ["rotation", "det R", "+1"]),
        (lambda: fx.Pose([0, 0, 1], np.full((3, 3), NAN)), ["rotation", "R R^T", "identity"]),
        (lambda: fx.Pose([0, 0, 1], [0.1, 0.2, 0.3]), ["rotation", "(3,)", "scipy Rotation", "(..., 3, 3)"]),
        (lambda: fx.Pose([0, 0, 1], "upright"), ["rotation", "upright", "scipy Rotation"]),
        (
            lambda: fx.Pose(np.zeros((2, 3)), np.tile(np.eye(3), (3, 1, 1))),
            ["position (2, 3)", "rotation (3, 3, 3)", "equal or 1"],
        ),
        (lambda: fx.Pose.from_rpy(0, 0, NAN), ["NaN", "must be finite"]),
        (lambda: fx.Pose.from_rpy(0, 0, [1, 2], [1, 2, 3]), ["must be numbers, or arrays that fit"]),
        (lambda: fx.Pose.from_rpy(0, "y", 1), ["must be numbers, or arrays that fit"]),
        (lambda: fx.Motion(HOME, velocity=[1, 2]), ["velocity", "(2,)", "3 numbers"]),
        (lambda: fx.Motion(HOME, angular_acceleration=[1, 2, NAN]), ["angular_acceleration", "NaN"]),
        (
            lambda: fx.Motion(HOME, velocity=np.zeros((2, 3)), acceleration=np.zeros((3, 3))),
            ["leading axes", "equal or 1"],
        ),
    ],
)
def test_poses_and_motions_that_cannot_be(make, parts):
    with refused(fx.PoseError, *parts):
        make()


@given(off=st.floats(1e-8, 1e-3), row=st.integers(0, 2), column=st.integers(0, 2))
def test_a_matrix_that_is_nearly_a_rotation_is_refused(off, row, column):
    matrix = np.eye(3)
    matrix[row, column] += off
    with refused(fx.PoseError, "rotation", "1e-9"):
        fx.Pose([0, 0, 1], matrix)


# --- arguments --------------------------------------------------------------------------------------------------------


#: Of these, the errors are ArgumentErrors; of poses, PoseErrors.
ARGUMENTS = (
    "joint is 'ball'",
    "leg_force",
    "force",
    "moment",
    "lengths",
    "unstretched_length",
    "characteristic_length",
)


@pytest.mark.parametrize(
    ("call", "parts"),
    [
        (lambda: fx.natural_modes(HEXAPOD, [0, 0, 1]), ["pose has shape (3,)", "6 numbers"]),
        (lambda: fx.natural_modes(HEXAPOD, HOME, base=[0, 0, 1]), ["base has shape (3,)", "6 numbers"]),
        (lambda: fx.natural_modes(HEXAPOD, HOME, joint="ball"), ["joint is 'ball'", "'universal'", "'spin_free'"]),
        (lambda: fx.forward_dynamics(HEXAPOD, HOME, leg_force=[1, 2, 3]), ["leg_force", "(3,)", "6 numbers"]),
        (lambda: fx.forward_dynamics(HEXAPOD, HOME, leg_force=np.zeros((4, 6))), ["leg_force", "(4, 6)", "batch"]),
        (lambda: fx.forward_dynamics(HEXAPOD, HOME, force=[INF, 0, 0]), ["force", "infinity", "finite"]),
        (lambda: fx.forward_dynamics(HEXAPOD, HOME, moment=[0, 0]), ["moment", "(2,)", "3 numbers"]),
        (
            lambda: fx.equations_of_motion(HEXAPOD, fx.Pose(np.ones((2, 3))), base=fx.Pose(np.zeros((3, 3)))),
            ["pose", "(2,)", "base", "(3,)", "equal or 1"],
        ),
        (
            lambda: fx.condition_number(HEXAPOD, HOME, characteristic_length=-1.0),
            ["characteristic_length", "is -1.0 m", "> 0"],
        ),
        (
            lambda: fx.condition_number(HEXAPOD, HOME, characteristic_length=NAN),
            ["characteristic_length", "is nan m", "> 0"],
        ),
        (
            lambda: fx.describe_modes(HEXAPOD, fx.Pose(np.ones((2, 3)))),
            ["pose has batch axes (2,)", "one pose is needed", "Index it"],
        ),
        (
            lambda: fx.frequency_sensitivity(HEXAPOD, fx.Pose(np.ones((2, 3)))),
            ["pose has batch axes (2,)", "one pose is needed", "Index it"],
        ),
        (
            lambda: fx.linearise(HEXAPOD, fx.Pose(np.ones((2, 3)))),
            ["pose has batch axes (2,)", "one pose is needed", "Index it"],
        ),
        (lambda: fx.forward_kinematics(HEXAPOD, [3.0] * 5), ["lengths", "(5,)", "6 numbers"]),
        (lambda: fx.forward_kinematics(HEXAPOD, [3.0] * 5 + [NAN]), ["lengths", "NaN", "finite"]),
        (lambda: fx.forward_kinematics(HEXAPOD, [3.0] * 6, start=[0, 0, 2]), ["start has shape (3,)", "6 numbers"]),
        (
            lambda: fx.forward_kinematics(HEXAPOD, [3.0] * 6, start=fx.Pose(np.ones((2, 3)))),
            ["start has batch axes (2,)", "lengths, ()"],
        ),
        (lambda: fx.static_equilibrium(HEXAPOD, [3.0] * 5), ["unstretched_length", "(5,)", "shape (6,)"]),
        (
            lambda: fx.static_equilibrium(HEXAPOD, [3.0] * 6, start=HOME, base=fx.Pose(np.ones((2, 3)))),
            ["base has batch axes (2,)", "one pose is needed"],
        ),
    ],
)
def test_arguments_that_do_not_fit(call, parts):
    error = fx.ArgumentError if parts[0] in ARGUMENTS else fx.PoseError
    with refused(error, *parts):
        call()


def test_a_name_is_not_a_design():
    with refused(fx.DesignError, "hexapod is 'motion-base'", "flexapod.load"):
        fx.natural_modes("motion-base", HOME)


@pytest.mark.parametrize("lengths", [[3.0] * 5 + [-1.0], [3.0] * 5 + [0.0]])
def test_lengths_must_be_positive(lengths):
    with refused(fx.KinematicsError, "lengths has", f"{lengths[-1]:.6g} m", "must be > 0 m"):
        fx.forward_kinematics(HEXAPOD, lengths)
    with refused(fx.KinematicsError, "unstretched_length has", f"{lengths[-1]:.6g} m", "must be > 0 m"):
        fx.static_equilibrium(HEXAPOD, lengths, start=HOME)


# --- poses that no leg can take ---------------------------------------------------------------------------------------

AT_ONE_POSE = {
    "inverse_kinematics": fx.inverse_kinematics,
    "leg_rates": fx.leg_rates,
    "force_transformation": fx.force_transformation,
    "condition_number": fx.condition_number,
    "joint_angles": fx.joint_angles,
    "leg_distance": fx.mechanics.leg_distance,
    "check_limits": fx.check_limits,
    "equations_of_motion": fx.equations_of_motion,
    "forward_dynamics": fx.forward_dynamics,
    "inverse_dynamics": fx.inverse_dynamics,
    "joint_reactions": fx.joint_reactions,
    "energy": fx.energy,
    "natural_modes": fx.natural_modes,
    "stability_index": fx.stability_index,
    "energy_shares": fx.mechanics.energy_shares,
    "describe_modes": fx.describe_modes,
    "frequency_sensitivity": fx.frequency_sensitivity,
    "hold": fx.hold,
    "linearise": fx.linearise,
}
IN_A_BATCH = [
    n for n in AT_ONE_POSE if n not in ("check_limits", "describe_modes", "frequency_sensitivity", "linearise")
]


@pytest.mark.parametrize("name", AT_ONE_POSE)
@pytest.mark.parametrize("off", [0.0, 1e-13])
def test_leg_without_length(name, off):
    with refused(fx.PoseError, "leg 3 has length", "m at this pose", "must not meet", "Move the platform"):
        AT_ONE_POSE[name](HEXAPOD, fx.Pose(MEETING + off))


@pytest.mark.parametrize("name", AT_ONE_POSE)
def test_axis_parallel_to_a_leg(name):
    leg = HOME.position + HEXAPOD.platform_joints[1] - HEXAPOD.base_joints[1]
    hexapod = HEXAPOD.replace({"base.universal_axes[1]": leg, "home": None})
    with refused(fx.PoseError, "base.universal_axes[1] is parallel to leg 2", "cannot turn", "Choose an axis"):
        AT_ONE_POSE[name](hexapod, HOME)


def arrays_of(result) -> list[np.ndarray]:
    parts = [result] if isinstance(result, np.ndarray | float) else result
    return [np.asarray(part) for part in parts if not isinstance(part, fx.Pose)]


@pytest.mark.parametrize("off", [0.0, 1e-15, 1e-12])
@pytest.mark.parametrize("name", IN_A_BATCH)
def test_a_bad_pose_in_a_batch_is_nan_and_the_rest_right(name, off):
    function = AT_ONE_POSE[name]
    poses = fx.Pose(np.array([HOME.position, MEETING + off, HOME.position + 0.1]))
    found = arrays_of(function(HEXAPOD, poses))
    if name == "energy":
        assert (found.pop(2) == 0).all()  # no springs, no elastic energy
    for i in (0, 2):
        single = arrays_of(function(HEXAPOD, poses[i]))
        if name == "energy":
            single.pop(2)
        for many, one in zip(found, single, strict=True):
            np.testing.assert_array_equal(many[i], one)
    for many in found:
        assert np.isnan(many[1]).all()


def test_a_bad_pose_in_a_batch_is_outside_the_limits():
    poses = fx.Pose(np.array([HOME.position, MEETING]))
    np.testing.assert_array_equal(fx.check_limits(HEXAPOD, poses).ok, [True, False])


# --- singular and out of reach ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["motion-base", "precision-positioner", "cubic-isolator"])
@pytest.mark.parametrize("call", [fx.hold, fx.inverse_dynamics, fx.linearise])
def test_singular_pose(name, call):
    hexapod = plain_machine(name)
    x, y, z = center(hexapod).position
    with refused(fx.SingularPoseError, "at this pose", "H is singular", "Choose another pose"):
        call(hexapod, fx.Pose.from_rpy(x, y, z, yaw=np.pi / 2))


@pytest.mark.parametrize("name", MACHINES)
@pytest.mark.parametrize("start", [False, True])
def test_lengths_that_admit_no_pose(name, start):
    """One leg ten times as long as the others: the triangle of legs cannot close."""
    hexapod = plain_machine(name)
    lengths = fx.inverse_kinematics(hexapod, center(hexapod)) * [10, 1, 1, 1, 1, 1]
    parts = "leg lengths", "admit no pose", "misses a length by", "m; check the lengths"
    with refused(fx.KinematicsError, *parts) as caught:
        fx.forward_kinematics(hexapod, lengths, start=center(hexapod) if start else None)
    misfit = float(re.search(r"by ([\d.e+-]+) m", str(caught.value))[1])
    # Two joints on a plate are at most twice its circle apart: the misfit is most of the excess, shared by legs.
    assert 0.1 * lengths[0] < misfit < lengths[0]


def test_no_equilibrium():
    isolator = plain_machine("cubic-isolator")
    with pytest.raises((fx.SingularPoseError, fx.KinematicsError), match=r"Pose\(x=") as caught:
        fx.static_equilibrium(isolator, [0.13] * 6, start=center(isolator), force=[0, 0, -1e4])
    assert "stiffen the legs" in str(caught.value)


def test_all_errors_are_flexapods_and_value_errors():
    for error in (fx.DesignError, fx.PoseError, fx.KinematicsError, fx.SingularPoseError):
        assert issubclass(error, fx.FlexapodError)
        assert issubclass(error, ValueError)


def test_limits_of_batches_of_any_shape():
    """None at all, and one pose on many bases: a base that moves along changes nothing, one that stays does."""
    for change in ({}, {"limits.leg_distance": 0.01, "limits.leg_length": None}, {"limits": None}):
        hexapod = HEXAPOD.replace(change)
        assert fx.check_limits(hexapod, fx.Pose(np.empty((0, 3)))).ok.shape == (0,)
        bases = fx.Pose([[0, 0, 0], [0, 0, 2.0]])
        assert fx.check_limits(hexapod, HOME, base=bases).ok.shape == (2,)
        carried = fx.Pose(bases.position + HOME.position)
        assert fx.check_limits(hexapod, carried, base=bases).ok.tolist() == [True, True]
    assert fx.check_limits(HEXAPOD, HOME, base=bases).ok.tolist() == [True, False]
