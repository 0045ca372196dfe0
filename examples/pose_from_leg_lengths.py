"""Where is my platform, when all I know is what the encoders of its legs say?

Forward kinematics from six lengths, and how errors of the encoders become errors of the pose.
"""

import numpy as np

import flexapod as fx

ENCODER = 1e-6  # m, largest error of a leg's encoder


def main() -> float:
    """The largest error of the position that the encoders' errors can make, m."""
    machine = fx.load("precision-positioner")
    true = fx.Pose.from_rpy(0.004, -0.003, 0.246, 0.01, 0.02, -0.015)
    lengths = fx.inverse_kinematics(machine, true)
    print("encoders:", np.round(1e3 * lengths, 4), "mm")
    found = fx.forward_kinematics(machine, lengths, start=fx.home_pose(machine))
    print(found)
    print(f"off by {np.linalg.norm(found.position - true.position):.0e} m from the pose they were made of")

    to_pose = np.linalg.inv(fx.force_transformation(machine, true).T)  # leg rates are H^T times the twist
    signs = np.array(np.meshgrid(*[[-1, 1]] * 6)).reshape(6, -1)  # every combination of largest errors
    errors = ENCODER * to_pose @ signs
    worst = np.linalg.norm(errors[:3], axis=0).argmax()
    again = fx.forward_kinematics(machine, lengths + ENCODER * signs[:, worst], start=found)
    error = float(np.linalg.norm(again.position - true.position))
    turn = float(np.linalg.norm(errors[3:], axis=0).max())
    print(f"errors of 1 um in each leg move it by {1e6 * error:.2f} um and turn it by {1e6 * turn:.1f} urad at most")
    return error


if __name__ == "__main__":
    main()
