"""How fast must my controller sample, wherever the machine stands?

The paper's third conclusion: twenty samples in a period of the highest natural frequency. That frequency is looked for
over the whole workspace, and a controller is then tried at this rate and at slower ones.
"""

import numpy as np

import flexapod as fx


def main() -> float:
    """The advised sampling time over the workspace, s."""
    machine = fx.load("precision-positioner")
    home = fx.home_pose(machine)
    box = fx.Box.about(home, 0.005, np.radians(1.0))
    at_home = fx.control.sampling_time(machine, home)
    advised = fx.control.sampling_time(machine, box)
    print(f"at home: {1e6 * at_home:.1f} us; within 5 mm and 1 degree: {1e6 * advised:.1f} us = {1 / advised:.0f} Hz")

    law = fx.control.VelocityFeedback(2e4).on(fx.linearise(machine, home))
    wanted = fx.control.closed_loop(machine, home, law, nearness=0.0).worst_damping
    print(f"velocity feedback without sampling gives the least damped mode a ratio of {wanted:.3f}; sampled with")
    for slower in (1, 2, 4, 8):
        dt = slower * advised
        loop = fx.control.closed_loop(machine, home, law.sampled(dt, delay=1), nearness=0.0, unstable="keep")
        verdict = "stable" if loop.stable else "unstable"
        print(f"  {1e6 * dt:7.1f} us and one sample late: {loop.worst_damping:.3f}, {verdict}")
    return advised


if __name__ == "__main__":
    main()
