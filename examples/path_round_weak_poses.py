"""How do I move between two poses without passing the weak ones between them?

The straight line passes near singular poses; a planned path keeps the lowest natural frequency above a bound.
"""

import numpy as np

import flexapod as fx

BOUND = 110.0  # rad/s


def main() -> float:
    """The least index along the planned path, rad/s."""
    machine = fx.load("mukherjee-i")
    start = fx.Pose.from_rpy(0, 0, 0.89, *np.radians([0, -33, -10]))
    goal = fx.Pose.from_rpy(0, 0, 0.89, *np.radians([0, 45, 53]))
    plan = fx.plan_path(machine, start, goal, BOUND, timing=2.0)
    straight = fx.path_index(machine, plan.straight, bound=BOUND, singular="keep")
    planned = fx.path_index(machine, plan.path, bound=BOUND)
    print(f"straight line: {plan.straight_length:.3f} m, least index {straight.minimum:.2g} rad/s,", end=" ")
    print(f"{len(straight.crossings)} singular poses passed")
    print(f"planned: {plan.length:.3f} m, least index {planned.minimum:.2f} rad/s at t = {planned.minimum_time:.2f} s")
    loads = fx.paths.path_loads(machine, plan.path)
    print(f"legs on it: {float(loads.peak_force.max()):.0f} N at most, {1e3 * float(loads.stroke.max()):.0f} mm travel")
    print("answer:", "the plan keeps the bound" if planned.above else "the plan misses the bound", f"of {BOUND} rad/s")
    return planned.minimum


if __name__ == "__main__":
    main()
