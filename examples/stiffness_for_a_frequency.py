"""How stiff must my legs be for a lowest frequency of 6 Hz?

Under weight the frequency is not simply as the root of the stiffness, so the stiffness is found as a root.
"""

import numpy as np
from scipy.optimize import brentq

import flexapod as fx

WANTED = 2 * np.pi * 6.0  # rad/s


def main() -> float:
    """The leg stiffness, N/m."""
    machine = fx.load("cubic-isolator")
    home = fx.home_pose(machine)

    def lowest(stiffness: float) -> float:
        """Lowest frequency under gravity, without friction, rad/s."""
        tangent = fx.linearise(machine.replace({"legs.stiffness": stiffness, "legs.damping.prismatic": 0}), home)
        return float(tangent.modes().omega[0])

    stiffness = float(brentq(lambda k: lowest(k) - WANTED, 5e3, 5e4, rtol=1e-12))
    start = float(machine.legs.stiffness[0])
    by_rule = start * (WANTED / float(fx.stability_index(machine, home))) ** 2
    sag = fx.hold(machine.replace({"legs.stiffness": stiffness}), home)
    print(f"as designed: {start:.0f} N/m give {lowest(start) / (2 * np.pi):.3f} Hz")
    print(f"for {WANTED / (2 * np.pi):.0f} Hz: {stiffness:.0f} N/m")
    print(f"the rule without gravity says {by_rule:.0f} N/m, which gives {lowest(by_rule) / (2 * np.pi):.3f} Hz")
    print(f"the legs are then pressed {1e3 * (sag.unstretched_length - sag.leg_length).max():.2f} mm short by weight")
    return stiffness


if __name__ == "__main__":
    main()
