"""At which frequencies does my machine vibrate, and how does it move in each of them?

A packaged design is loaded (the path of a .toml file does as well) and looked at in its home pose.
"""

import numpy as np

import flexapod as fx


def main() -> float:
    """The lowest natural frequency, Hz."""
    machine = fx.load("precision-positioner")
    home = fx.home_pose(machine)
    modes = fx.natural_modes(machine, home)
    hertz = modes.omega / (2 * np.pi)
    for number, (f, mode) in enumerate(zip(hertz, fx.describe_modes(machine, home), strict=True), 1):
        print(f"mode {number}: {f:6.1f} Hz, {mode.text}")
    for first, second in fx.mechanics.near_repeated(modes.omega):
        print(f"modes {first + 1} and {second + 1} are a pair: any mixture of the two is a mode as well")
    print(f"dynamic stability index: {fx.stability_index(machine, home):.1f} rad/s = {hertz[0]:.1f} Hz")
    return float(hertz[0])


if __name__ == "__main__":
    main()
