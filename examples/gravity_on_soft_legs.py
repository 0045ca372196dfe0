"""Does gravity matter for my soft machine, and when does it fall over?

The natural frequencies of `natural_modes` know nothing of weight (the paper's Eq. 5). `linearise` first finds the leg
forces that hold the machine and then takes the exact tangent: loaded legs lose stiffness across their axes.
"""

import numpy as np
from scipy.optimize import brentq

import flexapod as fx


def main() -> float:
    """The leg stiffness at which the machine falls over under its own weight, N/m."""
    machine = fx.load("cubic-isolator")
    home = fx.home_pose(machine)

    def lowest(stiffness: float) -> tuple[float, fx.mechanics.DampedModes]:
        soft = machine.replace({"legs.stiffness": stiffness})
        return float(fx.stability_index(soft, home)), fx.linearise(soft, home).modes()

    print("leg stiffness  without gravity  with gravity")
    for stiffness in (1e6, 1e5, 1e4, 3e3):
        plain, tangent = lowest(stiffness)
        print(f"{stiffness:9.0f} N/m  {plain:9.2f} rad/s  {tangent.omega[0]:8.2f} rad/s")

    def least_stiffness(stiffness: float) -> float:
        """Least eigenvalue of the tangent's stiffness, zero where the machine begins to fall."""
        tangent = fx.linearise(machine.replace({"legs.stiffness": stiffness}), home)
        return float(np.linalg.eigvalsh((tangent.K + tangent.K.T) / 2)[0])

    critical = float(brentq(least_stiffness, 100.0, 1e4, xtol=1e-6))
    growth = lowest(0.9 * critical)[1].pole.real.max()
    print(f"below {critical:.1f} N/m it falls over; at 90 % of that, a tilt grows e-fold in {1 / growth:.2f} s")
    return critical


if __name__ == "__main__":
    main()
