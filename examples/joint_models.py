"""Does it matter whether I let the legs spin, as real universal joints make them, or not, as the paper does?

The exact joint model is the default; joint="spin_free" is the paper's. Both are compared in frequencies and in forces.
"""

import numpy as np

import flexapod as fx


def main() -> float:
    """The largest relative difference of a natural frequency over the poses drawn."""
    machine = fx.load("mukherjee-ii")
    center = fx.Pose([0, 0, 0.085])
    exact, paper = (fx.natural_modes(machine, center, joint=joint).omega for joint in ("universal", "spin_free"))
    print("at the centre:", np.round(exact, 3), "rad/s")
    print("paper's model:", np.round(paper, 3), "rad/s")

    rows = fx.random_poses(fx.Box.about(center, 0.01, np.radians(10)), 500, seed=0).rows(0, 500)
    poses = fx.Pose.from_rpy(*rows.T)
    exact, paper = (fx.natural_modes(machine, poses, joint=joint).omega for joint in ("universal", "spin_free"))
    difference = np.abs(paper / exact - 1)
    print(f"over 500 poses they differ by {np.median(difference):.2%} (median) to {difference.max():.2%}")
    print(f"the lowest one differs by up to {difference[:, 0].max():.2%}")

    spinning = fx.Motion(poses, angular_velocity=[0, 0, 3.0])
    exact, paper = (fx.forward_dynamics(machine, spinning, joint=joint)[0] for joint in ("universal", "spin_free"))
    off = np.linalg.norm(paper - exact, axis=-1) / np.linalg.norm(exact, axis=-1)
    print(f"turning at 3 rad/s, its free acceleration differs by {np.median(off):.2%} (median)")
    return float(difference.max())


if __name__ == "__main__":
    main()
