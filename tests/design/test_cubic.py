"""A cubic design and its home."""

import numpy as np

import flexapod as fx


def test_a_cubic_design_may_say_where_its_home_is():
    text = """
        name = "cube"
        [cubic]
        edge = 0.5
        middle = 0.2
        [platform]
        mass = 10
        mass_center = [0, 0, 0]
        inertia = [[0.1, 0, 0], [0, 0.1, 0], [0, 0, 0.1]]
        [legs]
        stiffness = 1e6
        """
    own = fx.Hexapod.from_toml(text)
    lifted = fx.Hexapod.from_toml(text + "[home]\nposition = [0, 0, 0.25]\n")
    np.testing.assert_array_equal(lifted.base_joints, own.base_joints)
    assert fx.home_pose(lifted).position.tolist() == [0, 0, 0.25]
    assert fx.home_pose(own).position[2] > 0
