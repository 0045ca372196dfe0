"""How much does a payload lower my natural frequencies, and how much can I carry?

The platform's mass, mass centre and inertia are those of platform and payload together.
"""

import numpy as np
from scipy.optimize import brentq

import flexapod as fx

WANTED_HZ = 4.0


def loaded(machine: fx.Hexapod, mass: float, height: float) -> fx.Hexapod:
    """The machine with a compact payload (kg) at a height (m) above the platform's reference point."""
    m, c, d = machine.platform_mass, machine.platform_mass_center[2], height
    center = (m * c + mass * d) / (m + mass)
    inertia = machine.platform_inertia.copy()
    inertia[[0, 1], [0, 1]] += m * (center - c) ** 2 + mass * (center - d) ** 2  # parallel axes
    return machine.replace(
        {"platform.mass": m + mass, "platform.mass_center": [0, 0, center], "platform.inertia": inertia}
    )


def main() -> float:
    """The heaviest payload that keeps the lowest frequency at 4 Hz, kg."""
    machine = fx.load("motion-base")
    home = fx.home_pose(machine)

    def lowest_hz(mass: float) -> float:
        return float(fx.stability_index(loaded(machine, mass, 1.5), home)) / (2 * np.pi)

    for mass in (0, 250, 500, 1000):
        print(f"payload {mass:5} kg at 1.5 m: {lowest_hz(mass):.3f} Hz")
    most = float(brentq(lambda mass: lowest_hz(mass) - WANTED_HZ, 0, 5000, xtol=1e-9))
    print(f"{WANTED_HZ} Hz allow {most:.1f} kg")
    force = fx.hold(loaded(machine, most, 1.5), home).leg_force
    print(f"each leg then carries {force.mean():.0f} N at rest")
    return most


if __name__ == "__main__":
    main()
