"""Springs for the closed chain: joint coordinates by decomposed rotations, moments as derivatives of energies.

Written apart from the core: rotations are quaternions, angles come from their parts, and a moment is minus the
derivative of an energy by a small turn, taken by complex steps.
"""

from collections.abc import Callable

import numpy as np
from scipy.spatial.transform import Rotation

STEP = 1e-200


def leg_axes(hexapod, i: int, platform, base) -> np.ndarray:
    """Columns s, y = k x s normalised, and s x y of leg i in inertial axes."""
    s = platform.position + platform.matrix @ hexapod.platform_joints[i]
    s = s - base.position - base.matrix @ hexapod.base_joints[i]
    s = s / np.linalg.norm(s)
    y = _cross(base.matrix @ hexapod.universal_axes[i], s)
    y = y / np.linalg.norm(y)
    return np.column_stack([s, y, _cross(s, y)])


def _cross(a, b) -> np.ndarray:
    """Of two vectors; `np.cross`, which takes many, spends twenty times as long."""
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


class _Origin:
    position, matrix = np.zeros(3), np.eye(3)


def universal_angles(hexapod, platform, base) -> np.ndarray:
    """Turns about k and then about y that bring each leg from where it rests to where it is, (6, 2)."""
    angles = np.empty((6, 2))
    for i in range(6):
        at_rest = leg_axes(hexapod, i, hexapod.rest, _Origin)
        turn = base.matrix.T @ leg_axes(hexapod, i, platform, base) @ at_rest.T
        k, y = hexapod.universal_axes[i], at_rest[:, 1]
        first, second, none = Rotation.from_matrix(turn).as_davenport([k, y, _cross(k, y)], "intrinsic")
        assert abs(none) < 1e-12
        angles[i] = first, second
    return angles


def platform_turn(hexapod, i: int, platform, base) -> np.ndarray:
    """Quaternion (w, x, y, z) of the platform's turn relative to leg i from rest, in the leg's axes."""
    now = leg_axes(hexapod, i, platform, base).T @ platform.matrix
    at_rest = leg_axes(hexapod, i, hexapod.rest, _Origin).T @ hexapod.rest.matrix
    return Rotation.from_matrix(now @ at_rest.T).as_quat(scalar_first=True)


def bend_and_twist(q) -> tuple:
    """Angle of the axis that was along x, and the twist about it before it was bent."""
    w, x, y, z = q
    return 2 * np.arctan(np.sqrt(y * y + z * z) / np.sqrt(w * w + x * x)), 2 * np.arctan(x / w)


def _turned(q, axis: int) -> list:
    """The quaternion after a small turn by STEP, times i, about one of the outer axes."""
    half, (w, v) = 0.5j * STEP * np.eye(3)[axis], (q[0], q[1:])
    return [w - half @ v, *(v + w * half + _cross(half, v))]


def _gradient(energy: Callable, q) -> np.ndarray:
    return np.array([energy(_turned(q, axis)).imag / STEP for axis in range(3)])


def platform_moments(hexapod, platform, base) -> np.ndarray:
    """Moments on the platform at its joints by the legs, inertial axes, (6, 3)."""
    springs, moments = hexapod.legs.joint_stiffness, np.empty((6, 3))
    for i in range(6):

        def energy(q, i=i):
            bend, twist = bend_and_twist(q)
            return 0.5 * (springs.spherical[i] * bend**2 + springs.torsion[i] * twist**2)

        q = platform_turn(hexapod, i, platform, base)
        moments[i] = -leg_axes(hexapod, i, platform, base) @ _gradient(energy, q)
    return moments


def suspension_load(hexapod, platform, base) -> tuple[np.ndarray, np.ndarray]:
    """Force and moment of spring and damper on the platform at its reference point, inertial axes.

    platform, base: motions.
    """
    suspension = hexapod.suspension
    p, b = platform.pose, base.pose
    arm = p.matrix @ suspension.point
    point = b.matrix.T @ (p.position + arm - b.position)
    e = point - hexapod.rest.position - hexapod.rest.matrix @ suspension.point
    q = Rotation.from_matrix(b.matrix.T @ p.matrix @ hexapod.rest.matrix.T).as_quat(scalar_first=True)

    def strain(q, e=e):
        v = np.array(q[1:])
        sine = np.sqrt(v @ v)
        return np.concatenate([e, 2 * np.arctan(sine / q[0]) / sine * v])

    def energy(q):
        return 0.5 * strain(q) @ suspension.stiffness @ strain(q)

    velocity = platform.velocity + np.cross(platform.angular_velocity, arm) - base.velocity
    velocity = velocity - np.cross(base.angular_velocity, p.position + arm - b.position)
    rate = np.concatenate([b.matrix.T @ velocity, b.matrix.T @ (platform.angular_velocity - base.angular_velocity)])
    lost = suspension.damping @ rate
    force = -b.matrix @ ((suspension.stiffness @ strain(q))[:3] + lost[:3])
    moment = -b.matrix @ (_gradient(energy, q) + lost[3:])
    return force, np.cross(arm, force) + moment
