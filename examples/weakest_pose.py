"""Will my isolator be stable at every pose of its workspace, and where is it weakest?

A sweep shows how the lowest natural frequency (the dynamic stability index) is spread over the workspace; a search with
exact derivatives then finds the least one, which lies between the poses of any sweep.
"""

import numpy as np

import flexapod as fx

WANTED = 30.0  # rad/s: the controller needs no less


def main() -> float:
    """The least index over the workspace, rad/s."""
    machine = fx.load("cubic-isolator")
    home = fx.home_pose(machine)
    box = fx.Box.about(home, 0.002, np.radians(1))  # +-2 mm and +-1 degree in all six coordinates
    sweep = fx.sweep(machine, box, quantities=("omega_1", "cond_H", "within_limits"), samples=2**12)
    summary = fx.summarise(sweep, at_least=WANTED)
    print(f"at home the index is {fx.stability_index(machine, home):.2f} rad/s")
    print(f"over {summary.poses} poses: {summary.worst.omega_1:.2f} to {summary.best.omega_1:.2f} rad/s")
    print(f"{summary.above.fraction:.1%} of the workspace has at least {WANTED} rad/s")
    print(f"{float(sweep.within_limits.mean()):.1%} of it is within the limits of legs and joints")

    worst = fx.worst_pose(machine, box, samples=2**10)
    print(f"the least is {worst.omega_1:.3f} rad/s at {fx.Pose.from_rpy(*worst.pose)}")
    print(f"found by {worst.agreed} of {worst.starts} searches; on the bounds of {', '.join(worst.at_bounds)}")
    print("answer:", "there is a singular pose in it" if worst.singular else "stable everywhere")
    return worst.omega_1


if __name__ == "__main__":
    main()
