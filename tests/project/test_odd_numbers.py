"""Arrays that NumPy takes and that are no numbers to compute with: masked, complex, integers beyond a float."""

import numpy as np
import pytest

import flexapod as fx

MACHINE = fx.load("motion-base")
HOME = np.array([0, 0, 2.39, 0, 0, 0])
PLACES = {
    "a design": lambda value: MACHINE.replace({"base.joints": value(MACHINE.base_joints)}),
    "a number of a design": lambda value: MACHINE.replace({"legs.stiffness": value(MACHINE.legs.stiffness)}),
    "a part": lambda value: fx.design.Legs(value(MACHINE.legs.stiffness)),
    "a home": lambda value: MACHINE.replace({"home.position": value(HOME[:3])}),
    "the field of a home": lambda value: fx.design.Hexapod(
        **{name: getattr(MACHINE, name) for name in FIELDS}, home=value(HOME)
    ),
    "a pose": lambda value: fx.natural_modes(MACHINE, value(HOME)),
    "a position": lambda value: fx.Pose(value(HOME[:3])),
    "a rotation": lambda value: fx.Pose(HOME[:3], value(np.eye(3))),
    "angles": lambda value: fx.Pose.from_rpy(*HOME[:3], value(HOME[3:]), 0, 0),
    "a velocity": lambda value: fx.Motion(fx.Pose(HOME[:3]), value(HOME[:3])),
    "poses": lambda value: fx.sweep(MACHINE, value(np.tile(HOME, (3, 1)))),
    "an axis of a grid": lambda value: fx.pose_grid(x=value(HOME)),
    "a range": lambda value: fx.Box(x=value(np.array([-0.1, 0.1])), y=0, z=2.39, roll=0, pitch=0, yaw=0),
    "lengths": lambda value: fx.forward_kinematics(MACHINE, value(fx.inverse_kinematics(MACHINE))),
    "frequencies": lambda value: fx.transmissibility(MACHINE, omega=value(np.array([1.0, 2.0]))),
}
FIELDS = ("base_joints", "platform_joints", "platform_mass", "platform_mass_center", "platform_inertia", "legs")


def masked(array):
    return np.ma.masked_array(array, mask=np.arange(array.size).reshape(array.shape) == 1)


def huge(array):
    numbers = array.tolist()
    inner = numbers
    while isinstance(inner[0], list):
        inner = inner[0]
    inner[0] = 10**400
    return numbers


def imaginary(array):
    return array + 1j


@pytest.mark.parametrize("make", [masked, huge, imaginary])
@pytest.mark.parametrize("place", PLACES)
def test_they_are_refused(place, make):
    with pytest.raises(fx.FlexapodError):
        PLACES[place](make)


def test_a_masked_array_without_masked_entries_is_an_array():
    whole = np.ma.masked_array(MACHINE.base_joints, mask=False)
    assert MACHINE.replace({"base.joints": whole}) == MACHINE
    assert fx.Pose(np.ma.masked_array(HOME[:3])).position.tolist() == HOME[:3].tolist()


@pytest.mark.parametrize("value", [10**400, -(10**400)], ids=["large", "small"])
def test_single_numbers_beyond_a_float(value):
    for call in (
        lambda: MACHINE.replace({"platform.mass": value}),
        lambda: fx.condition_number(MACHINE, characteristic_length=value),
        lambda: fx.robustness(MACHINE, fx.Uncertain("platform.mass", value)),
    ):
        with pytest.raises(fx.FlexapodError):
            call()
