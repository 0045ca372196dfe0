"""Default axes of the universal joints: tangents where these lie across the legs at home, else across the legs."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tests.helpers.plain import plain_machine
from tests.helpers.support import relative

import flexapod as fx
from flexapod.design.universal_axes import ACROSS, tangent_axes
from flexapod.optimisation.design_map import DesignMap

CASES = Path(__file__).parents[1] / "data" / "cases" / "tangential-struts"
RIGHT = {  # rad/s, computed apart from Flexapod for legs that do not spin
    "m2": [205.674, 206.606, 248.165, 274.185, 299.101, 308.887],
    "m2-mass": [203.638, 204.499, 245.631, 271.939, 295.670, 305.523],
    "m2-tangential": [204.414],
}
JOINTS = {"platform_mass": 100.0, "platform_mass_center": np.zeros(3), "platform_inertia": [5, 5, 9]}


def leg_angles(hexapod: fx.Hexapod) -> np.ndarray:
    """Angles between axes and legs at home, rad."""
    leg = hexapod.home.position + hexapod.platform_joints @ hexapod.home.matrix.T - hexapod.base_joints
    leg /= np.linalg.norm(leg, axis=1, keepdims=True)
    return np.arcsin(np.linalg.norm(np.cross(hexapod.universal_axes, leg), axis=1))


@pytest.mark.parametrize("name", RIGHT)
@pytest.mark.parametrize("joint", ["universal", "spin_free"])
def test_struts_along_the_tangent_get_axes_across(name, joint):
    hexapod = fx.load(CASES / f"{name}.toml")
    found = fx.natural_modes(hexapod, joint=joint).omega[: len(RIGHT[name])]
    assert found[0] == pytest.approx(RIGHT[name][0], abs=6e-4)
    assert found == pytest.approx(RIGHT[name], rel=3e-6 if joint == "spin_free" else 6e-4)
    assert leg_angles(hexapod).min() > ACROSS
    along = slice(3, 6) if name == "m2-tangential" else slice(3, 4)  # legs 5 and 6 of the others are 30 degrees off
    assert relative(hexapod.universal_axes[along], np.tile([0.0, 0.0, 1.0], (6, 1))[along]) < 1e-12
    others = np.delete(np.arange(6), along)
    assert relative(hexapod.universal_axes[others], tangent_axes(hexapod.base_joints)[0][others]) == 0


def test_packaged_machines_without_axes_keep_their_tangents():
    for name in ("motion-base", "precision-positioner", "cubic-isolator"):
        hexapod = plain_machine(name)
        assert relative(hexapod.universal_axes, tangent_axes(hexapod.base_joints)[0]) == 0
        assert leg_angles(hexapod).min() > ACROSS


def test_every_way_to_a_design_gives_the_same_axes():
    file = fx.load(CASES / "m2-tangential.toml")
    parts = {"base_joints": file.base_joints, "platform_joints": file.platform_joints, "legs": file.legs, **JOINTS}
    built = fx.Hexapod(**parts, home=file.home)
    assert relative(built.universal_axes, file.universal_axes) == 0
    assert fx.Hexapod.from_toml(file.to_toml()) == file
    joints = {"base.joints": file.base_joints, "platform.joints": file.platform_joints, "base.universal_axes": None}
    other = plain_machine("motion-base").replace({**joints, "home.position": file.home.position})
    assert relative(other.universal_axes, file.universal_axes) == 0


def test_axes_stay_when_the_home_pose_alone_is_another():
    file = fx.load(CASES / "m2-tangential.toml")
    moved = file.replace({"home.position": file.home.position + np.array([0, 0, 0.3])})
    assert relative(moved.universal_axes, file.universal_axes) == 0


def test_without_home_all_axes_are_tangents():
    file = fx.load(CASES / "m2-tangential.toml")
    tangents = replace(file, home=None, universal_axes=None).universal_axes
    assert relative(tangents, tangent_axes(file.base_joints)[0]) == 0
    with pytest.raises(fx.PoseError, match=r"universal_axes\[3\] is parallel to leg 4"):
        fx.natural_modes(replace(file, home=None, universal_axes=None), file.home)


def test_a_joint_above_the_centroid_gets_an_axis_across_its_leg():
    base = np.array([[0, 0, 0], [1, 0, 0], [-0.5, 0.8, 0], [-0.5, -0.8, 0], [1, 0.2, 0], [-1, -0.2, 0.0]])
    parts = {"base_joints": base, "platform_joints": base, "legs": fx.design.Legs(1e6), **JOINTS}
    hexapod = fx.Hexapod(**parts, home=[0.1, 0, 1, 0, 0, 0])
    assert leg_angles(hexapod).min() > ACROSS
    with pytest.raises(fx.DesignError, match=r"or \[home\], which tells"):
        fx.Hexapod(**parts)


def test_a_search_over_circles_keeps_axes_across_across():
    """Which axes follow the circle is settled by the design: they do not jump within a search."""
    base = fx.Hexapod.from_circles(
        1.0, 1 / np.cos(np.radians(40)), 0.05, platform_mass=10, platform_inertia=[1, 1, 2], stiffness=1e6,
        base_half_angle=10, platform_half_angle=10, degrees=True,
    )  # fmt: skip
    assert (np.abs(base.universal_axes[:, 2]) > 0.9).all()  # nearly flat: all legs lie along their tangents
    search = DesignMap(base, [fx.optimisation.JointCircle("base", radius=(0.5, 2.0))])
    steps = [search.hexapod_at(np.array([r])).universal_axes for r in np.linspace(0.6, 1.9, 40)]
    assert all(relative(axes, base.universal_axes) == 0 for axes in steps)
