"""Small tools that several test files share."""

import numpy as np
from scipy.spatial.transform import Rotation
from tests.helpers.states import CENTER

import flexapod as fx

EPS = np.finfo(float).eps
MACHINES = ("mukherjee-i", "mukherjee-ii", "motion-base", "precision-positioner", "cubic-isolator")
JOINTS = ("universal", "spin_free")


def relative(found, expected) -> float:
    """Norm of the difference over the norm of what is expected."""
    return float(np.linalg.norm(np.asarray(found) - expected) / np.linalg.norm(expected))


def apart(found, expected, floor=0.0) -> float:
    """The largest difference of two numbers in the same place, each relative to what is expected there plus `floor`."""
    expected = np.asarray(expected)
    return float(np.max(np.abs(np.asarray(found) - expected) / (floor + np.abs(expected))))


def center(hexapod) -> fx.Pose:
    """The middle of the workspace."""
    home = fx.home_pose(hexapod)
    return fx.Pose(CENTER[hexapod.name]) if home is None else home


def size(hexapod) -> float:
    """A length of the machine's order: its longest leg in the middle of the workspace, m."""
    return float(fx.inverse_kinematics(hexapod, center(hexapod)).max())


def away(hexapod, scale: float = 0.05) -> fx.Pose:
    """A pose off every symmetry, `scale` legs' lengths and radians from the middle of the workspace."""
    x = scale * np.array([0.5, -0.8, 0.3, 0.7, -0.4, 0.9])
    x[:3] *= size(hexapod)
    return displaced(center(hexapod), x)


def displaced(pose: fx.Pose, x) -> fx.Pose:
    """The pose moved by a translation and then turned by a rotation vector, both in outer axes."""
    return fx.Pose(pose.position + x[:3], Rotation.from_rotvec(x[3:]).as_matrix() @ pose.matrix)


def later(motion: fx.Motion, t: float) -> fx.Motion:
    """The motion a short time later, exact in the velocities to first order and in the pose to second."""
    w, alpha = motion.angular_velocity, motion.angular_acceleration
    step = [t * motion.velocity + 0.5 * t * t * motion.acceleration, t * w + 0.5 * t * t * alpha]
    pose = displaced(motion.pose, np.concatenate(step))
    return fx.Motion(
        pose, motion.velocity + t * motion.acceleration, w + t * alpha, motion.acceleration, motion.angular_acceleration
    )


def accelerated(motion: fx.Motion, linear, angular) -> fx.Motion:
    """The motion with other accelerations."""
    return fx.Motion(motion.pose, motion.velocity, motion.angular_velocity, linear, angular)


def difference(f, step: float):
    """Derivative of f at zero by fourth-order central differences: error of the order of step^4."""
    return (8 * (f(step) - f(-step)) - (f(2 * step) - f(-2 * step))) / (12 * step)


def time_scale(hexapod, *motions: fx.Motion) -> float:
    """The shortest time, s, in which a motion changes by its own order: a size over a speed, a turn over a rate."""
    length = size(hexapod)
    rates = [1e-9]
    for m in motions:
        rates += [np.linalg.norm(m.velocity) / length, np.linalg.norm(m.angular_velocity)]
        second = [np.linalg.norm(m.acceleration) / length, np.linalg.norm(m.angular_acceleration)]
        rates += list(np.sqrt(second))
    return 1 / max(rates)
