"""How large must the bearings of my joints be for the quickest move?

The platform tilts from one side to the other and back in 4 s; every joint's force and moment follow from the motion.
"""

import numpy as np

import flexapod as fx


def main() -> float:
    """The largest force on a platform joint, N."""
    machine = fx.load("motion-base")
    tilt = np.radians(12)
    poses = fx.Pose.from_rpy([0, 0.2, 0, -0.2, 0], 0, 2.39, [0, tilt, 0, -tilt, 0], 0, 0)
    path = fx.Trajectory(poses, [0, 1, 2, 3, 4], ends="periodic")
    motion = path(np.linspace(0, 4, 401))
    leg_force = fx.inverse_dynamics(machine, motion)
    carried = fx.joint_reactions(machine, motion, leg_force=leg_force)

    def largest(vectors: np.ndarray) -> tuple[float, int]:
        sizes = np.linalg.norm(vectors, axis=-1)  # (time, leg)
        return float(sizes.max()), int(sizes.max(axis=0).argmax()) + 1

    for name, vectors, unit in (
        ("platform joint, force", carried.spherical_force, "N"),
        ("base joint, force", carried.universal_force, "N"),
        ("base joint, moment of the universal joint", carried.universal_moment, "N m"),
        ("slider at half length, bending and torsion", carried.prismatic_moment, "N m"),
    ):
        size, leg = largest(vectors)
        print(f"{name}: {size:.1f} {unit}, in leg {leg}")
    side = np.linalg.norm(carried.base_force[:, :2], axis=1).max()
    print(f"the floor carries up to {-carried.base_force[:, 2].min():.0f} N, and {side:.0f} N sideways")
    travel = np.ptp(fx.inverse_kinematics(machine, motion.pose), axis=0).max()
    print(f"the actuators push with up to {leg_force.max():.0f} N over a travel of {travel:.3f} m")
    return largest(carried.spherical_force)[0]


if __name__ == "__main__":
    main()
