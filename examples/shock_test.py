"""Does a shock of 10 g under the base overload my legs?

A half sine of 10 g and 6 ms shakes the base along z. The machine is simulated in full; beside it stands what the
textbook says of a single mass on a spring with the frequency of the vertical mode.
"""

import numpy as np

import flexapod as fx

PEAK, DURATION, ALLOWED = 10 * 9.81, 0.006, 3000.0  # m/s2, s, N


def main() -> float:
    """The platform's largest acceleration over that of the base."""
    machine = fx.load("precision-positioner")
    home = fx.home_pose(machine)
    shock = fx.half_sine_shock("z", PEAK, DURATION, recovery=0.05)
    run = fx.simulate(machine, home, base_motion=shock, duration=0.03, samples=1201)
    ratio = float(np.abs(run.acceleration.sel(axis="z")).max()) / PEAK
    force = float(np.abs(run.leg_force).max())

    vertical = next(i for i, mode in enumerate(fx.describe_modes(machine, home)) if mode.dominant == "z")
    omega = fx.natural_modes(machine, home).omega[vertical]
    beta = np.pi / DURATION / omega  # pulse's frequency over the mode's, below 1
    textbook = np.sin(2 * np.pi * beta / (1 + beta)) / (1 - beta)  # undamped, largest during the pulse
    print(f"the pulse lasts {1e3 * DURATION:.1f} ms, the vertical mode's period is {2e3 * np.pi / omega:.2f} ms")
    print(f"the platform feels {ratio:.3f} times the base's peak; a mass on a spring would feel {textbook:.3f} times")
    print(f"legs: {force:.0f} N at most; {fx.hold(machine, home).leg_force.max():.0f} N at rest")
    print("answer:", "overloaded" if force > ALLOWED else "not overloaded", f"({ALLOWED:.0f} N are allowed)")
    return ratio


if __name__ == "__main__":
    main()
