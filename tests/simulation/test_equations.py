"""The equations of motion for other integrators."""

import numpy as np
import pytest

import flexapod as fx
from flexapod.rotations import rotation_from_vector
from flexapod.simulation.integrator import equations
from flexapod.simulation.run import SimulationRun


@pytest.fixture(scope="module")
def machine():
    return fx.load("mukherjee-i")


def test_equations_for_other_integrators_are_the_forward_dynamics(machine):
    """The state is the platform seen from a base at rest: displacement from rest and velocities."""
    pose = fx.Pose.from_rpy(0.05, 0.02, 0.89, 0.1, 0.0, 0.2)
    found = equations(SimulationRun(machine, pose))
    np.testing.assert_array_equal(found.start(), np.zeros(12))
    y = np.array([1e-3, -2e-3, 5e-4, 0.01, -0.02, 0.015, 0.3, -0.1, 0.2, 0.5, 0.4, -0.6])
    turn = fx.Pose(np.zeros(3), rotation_from_vector(y[3:6])).matrix @ pose.matrix
    moved = fx.Motion(fx.Pose(pose.position + y[:3], turn), y[6:9], y[9:])
    lengths = fx.hold(machine, pose).unstretched_length
    force = machine.legs.stiffness * (lengths - fx.inverse_kinematics(machine, moved.pose))
    expected = np.concatenate(fx.forward_dynamics(machine, moved, leg_force=force))
    np.testing.assert_allclose(found.rates(0.0, y)[6:], expected, rtol=1e-9)
